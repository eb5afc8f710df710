"""
How thick must a lining be?
===========================

The thickness of PTFE at which the asperities of a steel ball press with 180 MPa, and how sure it is, over the load.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

scene = {"R": "5 mm", "punch": "steel 52100", "layer": "PTFE", "body": "steel 52100", "bonding": "bonded"}
rough = {"Nbar": "1e5 1/mm^2", "Ra": "2 um"}
loads = [f"{load:.3g} N" for load in np.geomspace(0.5, 5, 5)]
designed = rc.design({"p_max": "180 MPa"}, by={"h": ("1 um", "1 mm")}, P=loads, **scene, **rough)
print(rc.summary(designed))

# %%
# Every load has one thickness. For the largest load the ± is nearly as large as the thickness itself, and no thickness
# is sure to be enough: PTFE that is a standard deviation stiffer presses harder, however thick it is.
h, low, high = (designed[name].isel(solution=0) * 1e6 for name in ("h", "h_low", "h_high"))
assert (rc.decode(designed.design_status) == "found").all() and np.isnan(high[-1]) and (h.diff("P") > 0).all()

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.fill_between(h.P, low, high.fillna(1000), alpha=0.3, label="one standard deviation")
axes.loglog(h.P, h, "o-", label="180 MPa")
axes.set(xlabel="load P, N", ylabel="thickness h, µm", ylim=(10, 1000))
axes.set_xticks([0.5, 1, 2, 5], ["0.5", "1", "2", "5"])
axes.minorticks_off()
axes.legend()

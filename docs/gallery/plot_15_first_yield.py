"""
The load at which something yields
==================================

A steel ball presses on a coating on steel: the loads at which the layer, the body and the asperities of a rough ball
first yield, over the thickness of the coating.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

thickness = [f"{h:.3g} um" for h in np.geomspace(30, 300, 3)]
scene = {"R": "5 mm", "layer": "TiN", "h": thickness, "bonding": "bonded", "body": "steel 316L"}
found = rc.first_yield(**scene, micro="smooth")

# %%
# A thick hard layer protects the body; where it is thin the body yields before it.
assert found.P_Y2[-1] > 3 * found.P_Y2[0] and (rc.decode(found.first_yield) == "body").any()

figure, axes = plt.subplots(figsize=(6, 4))
axes.loglog(found.h * 1e6, found.P_Y1, "o-", label="layer, TiN")
axes.loglog(found.h * 1e6, found.P_Y2, "s-", label="body, steel 316L")
axes.set(xlabel="thickness h, µm", ylabel="load at first yield, N")
axes.set_xticks([30, 100, 300], ["30", "100", "300"])
axes.minorticks_off()
axes.legend()

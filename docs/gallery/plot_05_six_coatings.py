"""
Six coatings of one thickness
=============================

The largest pressure on 10 µm of a coating, over that on the bare steel: stiff ones raise it, soft ones lower it.
"""

import matplotlib.pyplot as plt

import roughcoat as rc

coatings = ["PTFE", "PEEK", "PMMA", "DLC a-C:H", "TiN", "ta-C"]
ball = {"R": "5 mm", "punch": "steel 52100", "P": "10 N", "micro": "smooth"}
coated = rc.solve(**ball, layer=coatings, h="10 um", bonding="bonded", body="steel 52100")
bare = rc.solve(**ball, body="steel 52100", base="half_space")

# %%
# In the order of their moduli the pressures rise.
ratio = coated.p0 / bare.p0
assert (ratio.sortby(coated.E1).diff("layer") > 0).all()

figure, axes = plt.subplots(figsize=(6, 4))
axes.barh(coatings, ratio, xerr=coated.p0_spread / bare.p0)
axes.axvline(1, color="0.4", lw=0.8)
axes.set(xlabel="p(0) over that of bare steel", xscale="log")
axes.set_xticks([0.3, 0.5, 0.7, 1], ["0.3", "0.5", "0.7", "1"])
axes.minorticks_off()
figure.tight_layout()

"""
When an asperity feels the substrate
====================================

A gently curved rough punch on 2 µm of three coatings on steel. Where its asperities are farther apart than the coating
is thick, they press on the steel through it.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import roughcoat as rc

names = ["alumina", "DLC a-C:H", "PMMA"]
coatings = [rc.materials.get(name) for name in names]
E1, nu1 = (
    xr.DataArray(v, {"coating": names}, attrs={"units": unit})
    for v, unit in (([c.E for c in coatings], "Pa"), ([c.nu for c in coatings], "1"))
)
pitch = xr.DataArray(np.geomspace(1e-6, 60e-6, 9), dims="pitch")
asperities = {"Nbar": (1 / pitch**2).assign_attrs(units="1/m^2"), "Ra": (10 * pitch).assign_attrs(units="m")}
body = {"E1": E1, "nu1": nu1, "h": "2 um", "bonding": "bonded", "E2": "207 GPa", "nu2": 0.29}
felt = ["layer", "half_space"]  # "auto", the default, takes the layer where the pitch is above h
contacts = rc.solve(R="2 m", P="10 N", **asperities, **body, micro="square_lattice", asperities_on=felt, x=2)

# %%
# The farther apart they are, the more the steel affects the pressure of a spot: it rises on a soft coating, and falls
# on a hard one. On a coating as stiff as steel nothing changes.
p_max = contacts.p_max.transpose("coating", "pitch", "asperities_on")
ratio = p_max.sel(asperities_on="layer") / p_max.sel(asperities_on="half_space")
assert (abs(ratio[:, :3] - 1) < 0.01).all() and abs(ratio.sel(coating="DLC a-C:H") - 1).max() < 0.05
assert ratio.sel(coating="alumina")[-1] < 0.8 and ratio.sel(coating="PMMA")[-1] > 2

figure, axes = plt.subplots(figsize=(6, 4))
for coating in names:
    axes.loglog(pitch / 2e-6, ratio.sel(coating=coating), "o-", ms=3, label=coating)
axes.set(xlabel="pitch/h", ylabel="pressure in a spot, over that\non a half-space of the coating")
axes.set_xticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"])
axes.set_yticks([0.7, 1, 1.5, 2, 3, 4], ["0.7", "1", "1.5", "2", "3", "4"])
axes.minorticks_off()
axes.legend()
figure.tight_layout()

"""
Where the model holds
=====================

`validity` is a sum of masks, one for each assumption that a contact violates: here over thickness and load.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

h, P = np.geomspace(1e-3, 0.3, 40), np.geomspace(1e-8, 1e-2, 40)
contacts = rc.solve(h=h, P=P, n=0.2, bonding="bonded", Nbar=250000, Ra=0.004, base="thin_layer", x=2, profiles=False)

# %%
# Each mask has a name. Where none is set the thin layer serves.
names = dict(zip(contacts.validity.flag_masks.tolist(), contacts.validity.flag_meanings.split(), strict=True))
found = [mask for mask in names if (contacts.validity.values & mask).any()]
assert (contacts.validity == 0).any() and 1 in found and 2 in found

figure, axes = plt.subplots(figsize=(6, 4.2))
for mask, hatch in zip(found, ("///", "\\\\\\", "...", "xx", "oo", "++"), strict=False):
    there = (contacts.validity.values & mask) > 0
    axes.contourf(h, P, there.T.astype(float), levels=[0.5, 2], colors="none", hatches=[hatch])
    axes.fill_between([], [], facecolor="none", edgecolor="k", hatch=hatch, label=names[mask].replace("_", " "))
axes.set(xscale="log", yscale="log", xlabel="h/R", ylabel="P/(E2* R²)")
axes.legend(fontsize=8, loc="lower left")

"""
Where the model holds
=====================

`validity` is a sum of masks, one for each assumption that a contact violates: here over thickness and load.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

h, P = np.geomspace(1e-3, 0.3, 120), np.geomspace(1e-8, 1e-2, 120)
contacts = rc.solve(h=h, P=P, n=0.2, bonding="bonded", Nbar=250000, Ra=0.004, base="thin_layer", x=2, profiles=False)

# %%
# Each mask has a name, and a line around the contacts that violate it. Where it is white the thin layer serves.
names = dict(zip(contacts.validity.flag_masks.tolist(), contacts.validity.flag_meanings.split(), strict=True))
flags = contacts.validity.values.T
broken = [mask for mask in names if (flags & mask).any()]
assert (flags == 0).any() and 1 in broken and 2 in broken

figure, axes = plt.subplots(figsize=(6, 4.6), layout="constrained")
axes.contourf(h, P, flags > 0, levels=[0.5, 2], colors="0.9")
for i, mask in enumerate(broken):
    axes.contour(h, P, flags & mask > 0, levels=[0.5], colors=f"C{i}", linewidths=1.5)
    axes.plot([], [], color=f"C{i}", label=names[mask].replace("_", " "))
axes.set(xscale="log", yscale="log", xlabel="h/R", ylabel="P/(E2* R²)")
figure.legend(fontsize=8, loc="outside upper center", ncols=3)

"""
A map of parameters with dask
=============================

With `chunks` the contacts are dask arrays: they are solved when they are asked for, by whatever scheduler is active.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

contacts = rc.solve(
    n=np.geomspace(0.1, 10, 16),
    h=np.geomspace(0.005, 0.1, 16),
    P=[1e-6, 1e-5, 1e-4],
    bonding="bonded",
    Nbar=250000,
    Ra=0.004,
    x=2,
    chunks={"n": 4},
)
print(contacts.p_max.data)

# %%
# Only the selected part is computed: a slice of the map, and the place in it where the real pressure is smallest.
chosen = contacts.p_max.sel(P=1e-5).compute()
least = chosen.where(chosen == chosen.min(), drop=True)
assert chosen.shape == (16, 16) and least.n.item() == contacts.n.min()

figure, axes = plt.subplots(figsize=(6, 4.2))
picture = axes.contourf(chosen.h, chosen.n, chosen, levels=15)
axes.set(xscale="log", yscale="log", xlabel="h/R", ylabel="n = E1*/E2*")
figure.colorbar(picture, label="largest real pressure p_max/E2*")

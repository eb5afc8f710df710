"""
Lattices beside the disc cell
=============================

In the paper each asperity has a disc of its own, and its neighbours are smeared outside it. In a square or hexagonal
lattice the neighbours have places. The laws differ where spots are about to merge.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

laws = ["disc_cell", "square_lattice", "hex_lattice"]
loads = np.geomspace(1e-7, 1e-3, 25)
contacts = rc.solve(P=loads, base="half_space", micro=laws, Nbar=250000, Ra=0.004, x=2)

# %%
# Spots that are far apart do not feel how their neighbours are placed.
ratio = contacts.A0 / contacts.A0.sel(micro="square_lattice")
assert abs(ratio.sel(micro="disc_cell")[0] - 1) < 0.02 and ratio.sel(micro="disc_cell").max() > 1.05

figure, axes = plt.subplots(figsize=(6, 4))
for law in laws:
    axes.semilogx(contacts.lam0.sel(micro=law), ratio.sel(micro=law), label=law.replace("_", " "))
axes.set(xlabel="relative contact area in the centre, λ(0)", ylabel="A[p(0)] over that of the square lattice")
axes.set_xticks([0.05, 0.1, 0.2, 0.5], ["0.05", "0.1", "0.2", "0.5"])
axes.minorticks_off()
axes.legend()

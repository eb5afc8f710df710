"""
A law of your own
=================

A law says how far the asperities are pressed in under a pressure, A[p], which share of the area they touch, and how
large the real pressure is. A file with these columns is a law, from a measurement or from another program.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

# %%
# Here A = 0.1 p^0.5 R, a power law, so that the answer can be compared with that of the law `power_law`.
p = np.geomspace(1e-7, 1, 200)
file = Path(tempfile.mkdtemp()) / "measured.csv"
table = np.column_stack([p, 0.1 * p**0.5, 0.9 * p**0.5, 2 * p**0.5])
np.savetxt(file, table, delimiter=",", header="p,A,lam,p_max", comments="")

loads = np.geomspace(1e-6, 1e-4, 9)
measured = rc.solve(P=loads, base="half_space", micro=f"table:{file}", x=33)
power = rc.solve(P=loads, base="half_space", micro="power_law", Nbar=250000, Ra=0.004, B=0.1 / 0.004, beta=0.5)
assert (abs(measured.a / power.a - 1) < 1e-4).all()

figure, axes = plt.subplots(figsize=(6, 4))
axes.loglog(loads, power.a, label="power law")
axes.loglog(loads, measured.a, "o", label="table of it")
axes.set(xlabel="P/(E2* R²)", ylabel="a/R")
axes.legend()

"""
Pressure against depth
======================

A thick soft layer lowers the pressure and sinks. The front consists of those among 60 contacts that keep to limits,
and that no other one beats in both pressure and depth.
"""

import warnings

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

scene = {"R": "50 mm", "punch": "steel 52100", "body": "steel 52100", "bonding": "bonded", "P": "10 N"}
layers = ["PTFE", "PEEK", "PMMA"]
thickness = [f"{h:.4g} um" for h in np.geomspace(5, 500, 20)]
with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # thin PTFE flows: `feasible` takes it out
    contacts = rc.solve(**scene, layer=layers, h=thickness, micro="smooth", profiles=False)

good = rc.feasible(contacts, D="< 10 um", validity=0)
chosen = rc.front(contacts.where(good), least=["p0", "D"])

# %%
# PTFE has the smallest pressures, PMMA and PEEK the smallest depths. Linings of PTFE that yield, by the strength of the
# material, do not count: their `validity` is not 0.
best = chosen.on_front
count = dict(zip(layers, best.sum("h").values.tolist(), strict=True))
assert min(count.values()) > 10 and not (best & ~good).any() and not good.sel(layer="PTFE").all()

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for name in layers:
    one = contacts.sel(layer=name)
    (line,) = axes.plot(one.D * 1e6, one.p0 / 1e6, ".:", alpha=0.5, label=name)
    front = one.where(best.sel(layer=name), drop=True)
    axes.plot(front.D * 1e6, front.p0 / 1e6, "o", color=line.get_color())
axes.set(xlabel="depth D, µm", ylabel="pressure in the centre p(0), MPa", xscale="log")
axes.legend(title="circles: on the front")

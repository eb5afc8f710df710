"""
Pressure against depth
======================

A thick soft layer lowers the pressure and sinks. Of 60 contacts those that no other one beats in both are the
front, of those that keep to limits.
"""

import warnings

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

scene = {"R": "5 mm", "punch": "steel 52100", "body": "steel 52100", "bonding": "bonded", "P": "5 N"}
layers = ["PTFE", "PEEK", "PMMA"]
thickness = [f"{h:.4g} um" for h in np.geomspace(5, 500, 20)]
with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # thin layers are strained too much: `feasible` takes these out
    contacts = rc.solve(**scene, layer=layers, h=thickness, Nbar="1e5 1/mm^2", Ra="2 um", profiles=False)

good = rc.feasible(contacts, p_max="< 1.3 GPa", D="< 10 um", validity=0)
chosen = rc.front(contacts.where(good), least=["p_max", "D"])

# %%
# PTFE has the least pressures, PMMA the least depths; PEEK is beaten by PMMA everywhere. Thin linings are strained
# beyond the model and do not count.
best = chosen.on_front
count = dict(zip(layers, best.sum("h").values.tolist(), strict=True))
assert count["PTFE"] > 1 and count["PMMA"] > 5 and count["PEEK"] == 0 and not (best & ~good).any()

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for name in layers:
    one = contacts.sel(layer=name)
    (line,) = axes.plot(one.D * 1e6, one.p_max / 1e6, ".:", alpha=0.5, label=name)
    front = one.where(best.sel(layer=name), drop=True)
    axes.plot(front.D * 1e6, front.p_max / 1e6, "o", color=line.get_color())
axes.set(xlabel="depth D, µm", ylabel="largest pressure p_max, MPa", xscale="log")
axes.legend(title="circles: on the front")

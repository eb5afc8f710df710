"""
How deep to press, before measuring
===================================

A plan: the uncertainty of the modulus of a film over the depth of the measurement, if its thickness is known and if
it is not.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

film = {"R": "5 um", "punch": "rigid", "nu1": 0.45, "bonding": "bonded", "body": "glass soda-lime", "micro": "smooth"}
deepest = np.array([50, 100, 200, 400, 800])  # nm
depths = np.linspace(-0.2, 1, 200) * deepest[:, None]

# %%
# Each point has a noise of 10 pN, the film 20 kPa and 2 µm. Its thickness is known exactly, to 5 %, or not at all.
spread = {}
for words, h, free in (
    ("h known", "2 um", ["E1"]),
    ("h ± 5 %", "2.0 ± 0.1 um", ["E1"]),
    ("h not known", "2 um", ["E1", "h"]),
):
    plan = rc.fit({"D": (depths, "nm")}, **film, E1="20 kPa", h=h, free=free, sigma="10 pN", plan=True)
    spread[words] = plan.E1_spread / 20e3
assert (spread["h not known"] > spread["h ± 5 %"]).all() and (spread["h ± 5 %"] > spread["h known"]).all()

figure, axes = plt.subplots(figsize=(6, 4))
for (words, relative), line in zip(spread.items(), ("-", "--", ":"), strict=True):
    axes.loglog(deepest, 100 * relative, line, marker="o", label=words)
axes.set(xlabel="deepest point, nm", ylabel="± of E1, %")
axes.set_xticks(deepest, [f"{x}" for x in deepest])
axes.xaxis.set_minor_formatter("")
axes.legend()

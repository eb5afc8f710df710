"""
A stamp on a soft layer
=======================

A flat stamp presses on silicone on glass. Its pressure is infinite at a sharp edge; a rounded edge makes it finite.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

silicone = {"layer": "PDMS", "body": "glass soda-lime", "bonding": "bonded", "punch": "rigid", "micro": "smooth"}
stamp = {"flat_radius": "100 um", "P": "2 mN"}
x = np.sin(np.linspace(0, np.pi / 2, 60))
flat = rc.solve(**silicone, **stamp, shape="flat", h=["20 um", "50 um", "200 um", "2 mm"], x=x)
rounded = rc.solve(**silicone, **stamp, shape="rounded_flat", edge_radius="1 mm", h="200 um", x=x)

# %%
# The thinner the layer, the more the pressure moves into the middle: silicone keeps its volume and cannot flow away.
middle = flat.p0 / flat.P * np.pi * flat.a**2
assert (middle.diff("h") < 0).all() and middle[0] > 1.3 and abs(middle[-1] - 0.5) < 0.05

# %%
# The edge of radius 1 mm touches a little outside the flat, where the pressure falls to 0.
assert rounded.a > 100e-6 and np.isfinite(rounded.p).all()

figure, axes = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
for one in (flat.isel(h=i) for i in range(4)):
    axes[0].plot(one.x, one.p / (one.P / (np.pi * one.a**2)), label=f"h = {one.h.item() * 1e6:g} µm")
axes[0].set(xlabel="r/a", ylabel="p over the mean pressure", ylim=(0, 3), title="(a) sharp edge")
axes[0].legend()
for one, name in ((flat.sel(h=2e-4), "sharp"), (rounded, "rounded, 1 mm")):
    axes[1].plot(one.x * one.a * 1e6, one.p / 1e3, label=name)
axes[1].set(xlabel="radius r, µm", ylabel="pressure p, kPa", ylim=(0, 250), title="(b) h = 200 µm")
axes[1].legend()

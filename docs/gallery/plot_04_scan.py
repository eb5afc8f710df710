"""
From a scan to the real pressure
================================

The number, the radius and the heights of the asperities follow from a profile of the surface, as an instrument writes
it.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

# %%
# Heights every 50 nm, in nm: a random surface with waves of 1 µm and more.
x = np.arange(4000) * 0.05
waves = np.fft.rfftfreq(len(x), 0.05)
random = np.random.default_rng(4)
shape = np.where((waves > 0) & (waves < 1), np.maximum(waves, 0.05) ** -1.3, 0) * np.exp(
    2j * np.pi * random.random(len(waves))
)
z = np.fft.irfft(shape, len(x))
z *= 50 / z.std()
file = Path(tempfile.mkdtemp()) / "scan.csv"
np.savetxt(file, np.column_stack([x, z]), delimiter=",", header="x (um), z (nm)")

asperities = rc.roughness.measure(rc.roughness.read(file, unit="um", height_unit="nm"))
print(asperities)

# %%
# If the heights differ, fewer asperities touch, and each of them is pressed harder.
ball = {"R": "20 mm", "punch": "steel 52100", "body": "brass", "base": "half_space", "P": "5 N"}
spread = rc.solve(**ball, **asperities.parameters("normal"))
equal = rc.solve(**ball, **asperities.parameters("equal"))
assert spread.Ar_An < equal.Ar_An

figure, axes = plt.subplots(figsize=(6, 4))
for contact, words in ((spread, "normal heights"), (equal, "equal heights")):
    axes.plot(contact.x * contact.a * 1e6, contact.lam, label=words)
axes.set(xlabel="r, µm", ylabel="real over nominal area λ")
axes.legend()

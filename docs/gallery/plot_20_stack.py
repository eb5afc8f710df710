"""
A coating on an adhesion layer, and a contact lens
==================================================

A hard coating sits on a thin layer of chromium on steel; the surface of a contact lens grows stiffer with the depth.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

coating = {"material": "DLC a-C:H", "h": "2 um", "bonding": "bonded"}
chromium = {"E1": "280 GPa", "nu": 0.21, "bonding": "bonded"}
ball = {"R": "0.2 mm", "punch": "steel 52100", "body": "PEEK", "P": "0.1 N", "micro": "smooth"}
thickness = {"layers.2.h": ["0.05 um", "0.2 um", "0.5 um", "1 um", "2 um", "5 um"]}
stack = rc.solve(**ball, layers=[coating, chromium], **thickness, x=2)
alone = rc.solve(**ball, layers=[coating], x=2)

# %%
# A thin adhesion layer hardly changes the contact.
assert abs(stack.D[0] / alone.D - 1) < 0.05 and stack.D[-1] < 0.8 * stack.D[0]

# %%
# A lens whose modulus grows from 30 kPa to 1.5 MPa over 20 µm seems stiffer, the deeper the bead is pressed in.
depths = [f"{depth:.3g} um" for depth in np.geomspace(0.05, 5, 7)]
profile = {"E1": ["30 kPa", "1.5 MPa"], "nu": 0.49, "h": "20 um", "profile": "exponential", "bonding": "bonded"}
bead = {"R": "50 um", "E2": "1.5 MPa", "nu2": 0.49, "micro": "smooth", "D": depths}
lens = rc.solve(**bead, layers=[profile], rtol=1e-3, x=2)
hertz = rc.solve(**bead, base="half_space", x=2)
apparent = 1.5e6 * lens.P / hertz.P
assert (lens.status == 0).all() and 30e3 < apparent[0] < apparent[-1] < 1.5e6

figure, axes = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
axes[0].semilogx(stack["layers.2.h"] * 1e6, stack.D * 1e6, "o-")
axes[0].axhline(float(alone.D) * 1e6, ls="--", label="no chromium")
axes[0].set(xlabel="thickness of the chromium, µm", ylabel="depth D, µm")
axes[0].legend()
axes[1].loglog(lens.D * 1e6, apparent / 1e3, "o-")
axes[1].set(xlabel="depth D, µm", ylabel="apparent modulus, kPa")

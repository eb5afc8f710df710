"""
A sharp tip on a hard coating
=============================

A Berkovich tip feels the coating first and the steel below later. Its cone alone is on the left; a tip with a round end
begins like a ball.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

coating = {"layer": "DLC ta-C", "body": "steel 52100", "bonding": "bonded", "punch": "diamond", "micro": "smooth"}
depths = [f"{depth:.3g} nm" for depth in np.geomspace(2, 200, 12)]
sharp = rc.solve(**coating, shape="Berkovich", D=depths, h=["0.2 um", "1 um", "5 um"], x=2)
blunt = rc.solve(**coating, shape="blunt_cone", half_angle="70.3 deg", tip_radius="100 nm", D=depths, h="1 um", x=2)
rc.summary(sharp.isel(D=5, h=1))

# %%
# The modulus of a half-space of equal stiffness, (dP/dD)/(2a), is at first that of coating and tip, and tends to that
# of the steel on thin coatings. At one contact radius it is the same for every shape.
stiffness = rc.derived.effective_modulus(sharp)
assert (stiffness.isel(D=-1).diff("h") > 0).all() and (stiffness.isel(D=0).std("h") < 0.05 * stiffness.isel(D=0).mean())
assert (blunt.P.values[:3] > sharp.P.isel(h=1).values[:3]).all()

figure, axes = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
for one in (sharp.isel(h=i) for i in range(3)):
    axes[0].semilogx(one.a * 1e9, rc.derived.effective_modulus(one) / 1e9, "o-", label=f"h = {one.h.item() * 1e6:g} µm")
axes[0].set(xlabel="contact radius a, nm", ylabel="effective modulus, GPa", title="(a) Berkovich")
axes[0].legend()
axes[1].loglog(sharp.D * 1e9, sharp.P.isel(h=1) * 1e6, "o-", label="sharp")
axes[1].loglog(blunt.D * 1e9, blunt.P * 1e6, "s--", label="tip of 100 nm radius")
axes[1].set(xlabel="depth D, nm", ylabel="load P, µN", title="(b) h = 1 µm")
axes[1].legend()

"""
A bead on a gel on glass
========================

An atomic force microscope presses a bead of 5 µm into a gel of 2 µm: the glass below makes the gel seem stiffer.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

bead = {"R": "2.5 um", "punch": "glass borosilicate", "micro": "smooth"}
gel = {"E1": "5 kPa", "nu1": 0.5, "h": "2 um", "bonding": "bonded", "body": "glass soda-lime"}
depths = [f"{depth:.4g} nm" for depth in np.geomspace(5, 300, 25)]
curve = rc.solve(**bead, **gel, D=depths, x=2)
alone = rc.solve(**bead, E2="5 kPa", nu2=0.5, base="half_space", D=depths, x=2)

# %%
# Hertz's force on the gel alone is right for shallow depths only.
ratio = curve.P / alone.P
assert 1 < ratio[0] < 1.1 and ratio[-1] > 1.5

figure, axes = plt.subplots(figsize=(6, 4))
axes.loglog(curve.D * 1e9, curve.P * 1e9, label="gel on glass")
axes.loglog(alone.D * 1e9, alone.P * 1e9, "--", label="gel alone (Hertz)")
axes.set(xlabel="depth D, nm", ylabel="force P, nN")
axes.legend()

# %%
# The force curve that comes with roughcoat was made with E1 = 5 kPa. A fit with the layer finds this modulus.
layer = {"nu1": 0.49, "h": "1.5 um", "bonding": "bonded", "body": "glass soda-lime"}
fitted = rc.fit(rc.samples.curve(), R="5 um", micro="smooth", **layer, free=["E1"])
print(rc.summary(fitted))
assert fitted.E1_low < 5e3 < fitted.E1_high

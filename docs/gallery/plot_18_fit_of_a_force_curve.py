"""
A gel from a force curve
========================

A bead on a thin gel on glass: the modulus that follows from the curve, with its interval, and the one that Hertz's
formula gives.
"""

import numpy as np

import roughcoat as rc

gel = {"R": "10 um", "punch": "rigid", "nu1": 0.49, "h": "1.0 ± 0.1 um", "bonding": "bonded", "body": "glass soda-lime"}
depth = np.linspace(0.5, 95, 200)
made = rc.solve(**gel | {"h": "1 um"}, E1="5 kPa", D=[f"{d} nm" for d in depth], micro="smooth", x=2, profiles=False)
noise = 0.01 * made.P.values.max() * np.random.default_rng(0).standard_normal(250)
measured = {
    "D": (np.append(np.linspace(-25, 0, 50), depth) + 40, "nm"),
    "P": (np.append(np.zeros(50), made.P.values) + noise, "N"),
}

# %%
# The thickness is known to 0.1 µm, which is a prior: it is an unknown of the fit, and widens the interval of E1.
fitted = rc.fit(measured, **gel, micro="smooth", free=["E1"])
assert fitted.E1_low < 5e3 < fitted.E1_high
rc.summary(fitted)

# %%
# Hertz's formula takes no account of the glass, and gives twice this modulus for the same curve.
half_space = {"R": "10 um", "punch": "rigid", "nu2": 0.49, "base": "half_space", "micro": "smooth"}
hertz = rc.fit(measured, **half_space, free=["E2"])
assert hertz.E2 > 1.9 * fitted.E1

figure = rc.plot(fitted)
figure

"""
A bead that adheres to a gel
============================

A bead jumps into contact with a gel and comes off at another depth. How strongly it adheres depends on the glass
below the gel.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

gel = {"R": "5 um", "punch": "rigid", "E1": "5 kPa", "nu1": 0.49, "bonding": "bonded", "body": "glass soda-lime"}
gel |= {"w_adhesion": "1 mJ/m^2", "micro": "smooth", "x": 2}
radii = [f"{a:.4g} um" for a in np.linspace(0.3, 4, 60)]
curve = rc.solve(**gel, h="5 um", a=radii, k_machine="0.05 N/m")
half_space = -1.5 * np.pi * 1e-3 * 5e-6

# %%
# Of the two radii at one depth the larger one is stable. On a cantilever of 0.05 N/m the bead comes off at the point.
stable = curve.stable.values
assert stable[-1] and not stable[0] and (np.diff(stable.astype(int)) >= 0).all()

# %%
# The pull-off load of Johnson, Kendall and Roberts on a half-space, 1.5 π w R, does not hold for a layer about as
# thick as the radius of contact. From a gel that is thinner the bead comes off at up to twice that load.
layers = rc.solve(**gel, h=[f"{h:.4g} um" for h in np.geomspace(0.2, 100, 12)], P="0 N")
over = layers.P_off / half_space
assert over[0] > 1.3 and abs(over[-1] - 1) < 0.05

figure, axes = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
axes[0].plot(curve.D.where(curve.stable) * 1e6, curve.P.where(curve.stable) * 1e9, label="stable")
axes[0].plot(curve.D.where(~curve.stable) * 1e6, curve.P.where(~curve.stable) * 1e9, ":", label="not stable")
axes[0].plot(curve.D_off[0] * 1e6, curve.P_off[0] * 1e9, "o", label="pull-off at 0.05 N/m")
axes[0].set(xlabel="depth D, µm", ylabel="load P, nN", ylim=(-30, 30), title="(a) h = 5 µm")
axes[0].legend()
axes[1].semilogx(layers.h * 1e6, over, "o-")
axes[1].axhline(1, ls=":", color="k")
axes[1].set(xlabel="thickness h, µm", ylabel="pull-off load over 1.5 π w R", title="(b) dead load")

"""Bodies under a pressure, and their stresses at points of a region: docs/stresses.md, Extremes."""

from typing import NamedTuple

import numpy as np

from ..fields import normal, sliding
from ..fields.field import integrals
from ..fields.pressure import Pressure
from ..kernels.two_layers import TwoLayers
from ..numerics import batch

STRESSES = ("sr", "st", "sz", "trz")


@batch.of_cases
class Loaded(NamedTuple):
    """Cases with one mesh, with h in one octave, either all with a layer or all without.

    layers : :class:`~solver.kernels.two_layers.TwoLayers` of B cases
    h : (B,), thickness in a; without a layer it has no meaning
    pressure : :class:`~solver.fields.pressure.Pressure`
    bare : bool, whether there is no layer
    mu : >= 0, friction; residual : (B,), the residual stress of the layer, in units of the pressure
    ring : if the pressure is largest in a narrow ring, as near a flat end, its distance from the edge in a; else 0
    """

    layers: TwoLayers
    h: np.ndarray
    pressure: Pressure
    bare: bool
    mu: float
    residual: np.ndarray
    ring: float = 0.0

    @property
    def signs(self):
        """The signs of x in the plane y = 0, since with sliding the leading and the trailing side differ."""
        return (1.0, -1.0) if self.mu > 0 else (1.0,)

    def stresses(self, r, z, body, roughly=False):
        """sr, st, sz, trz (4, B, S, Z, R), for each sign of x, at radii r (R,) and depths z (B, Z) or (Z,), in a, in
        the layer or in the `body`. At depths below the layer, its field is continued. roughly : whether an error of
        some percent is allowed."""
        z = np.broadcast_to(z, (len(self.h), np.shape(z)[-1]))
        here = self.layers, self.h, self.pressure, r, z, np.full(z.shape[1], body and not self.bare)
        field = normal.components(integrals(normal.NORMAL.of_stresses(), *here, roughly))
        if self.mu > 0:
            friction = sliding.components(integrals(sliding.SLIDING.of_stresses(), *here, roughly))
            field |= {name: self.mu * values for name, values in friction.items()}
        sides = [sliding.in_plane(field, sign < 0) for sign in self.signs] if self.mu > 0 else [field]
        stresses = np.stack([[side[name] for side in sides] for name in STRESSES]).swapaxes(1, 2)
        if not body:
            stresses[:2] += self.residual[:, None, None, None]
        return stresses

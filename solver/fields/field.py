"""The field of pressures on layers: closed forms near the surface, waves elsewhere."""

import numpy as np

from .transfer import Kind
from .waves import Row
from .waves import integrals as of_waves

#: Above this depth times (1 + the largest radius)/2 the field of a half-space is a closed form, to which waves add the
#: difference: so waves need no larger k, however near the surface a row is.
_NEAR = 0.06
#: Below this, the stresses are those of the surface, from which at the edge they differ by the root of the depth.
_SURFACE = 1e-21


def integrals(load, layers, h, pressure, r, z, body):
    """The integrals of a :class:`~.waves.Load` (fields, B, Z, R) on layers.

    layers : :class:`~solver.kernels.two_layers.TwoLayers` of B cases
    h : (B,), thickness in a; all of one octave
    pressure : :class:`~.pressure.Pressure` of the cases
    r : (R,), radii in a; z : (Z,), depths; body : (Z,) bool, in the body. There it is NaN below a rigid base
    """
    same = np.all((layers.n == 1) & (layers.nu1 == layers.nu2) & layers.bonded)
    z = np.where(z < _SURFACE, 0.0, z)
    near = np.full(len(z), True) if same else ~body & (z < _NEAR * (1 + r.max()) / 2)
    kinds = np.where(body, Kind.BODY, np.where(near, Kind.DIFFERENCE, Kind.LAYER))
    whole = np.zeros((len(load.orders), len(h), len(z), len(r)))
    if not same:
        rows = [Row(Kind(kind), depth + 0 * h) for kind, depth in zip(kinds, z, strict=True)]
        whole = of_waves(load, layers, h, pressure, r, rows)
    closed = np.flatnonzero(near)
    if len(closed):
        whole[:, :, closed] += load.closed(pressure, r, z[closed], layers.nu1)
    whole[:, (layers.n == 0)[:, None] & body] = np.nan
    return whole

"""The field of pressures on layers: closed forms near the surface, waves elsewhere."""

import numpy as np

from ..kernels.transfer import Kind
from .waves import Row
from .waves import integrals as of_waves

#: Above this depth times (1 + the largest radius)/2 the field of a half-space is a closed form, to which waves add the
#: difference: so waves need no larger k, however near the surface a row is.
_NEAR = 0.06
#: Below this, the stresses are those of the surface, from which at the edge they differ by the root of the depth.
_SURFACE = 1e-21


def integrals(load, layers, h, pressure, r, z, body, roughly=False):
    """The integrals of a :class:`~.waves.Load` (fields, B, Z, R) on layers.

    layers : :class:`~solver.kernels.two_layers.TwoLayers` of B cases
    h : (B,), thickness in a; all of one octave
    pressure : :class:`~.pressure.Pressure` of the cases
    r : (R,), radii in a; z : (B, Z), depths; body : (Z,) bool, in the body. There it is NaN below a rigid base
    roughly : some percent do
    """
    same = np.all((layers.n == 1) & (layers.nu1 == layers.nu2) & layers.bonded)
    z = np.where(z < _SURFACE, 0.0, z)
    if same:  # no layer is felt; a thick one takes the fewest waves
        h, body = np.full(len(h), 2 * max(1.0, z.max())), np.zeros(len(body), dtype=bool)
    near = ~body & (z.min(axis=0) < _NEAR * (1 + r.max()) / 2)
    if roughly:  # at the interface the difference decays no faster, and a rough one of two large fields is not small
        near &= (z < h[:, None]).any(axis=0)
    kinds = np.where(body, Kind.BODY, np.where(near, Kind.DIFFERENCE, Kind.LAYER))
    whole = np.zeros((len(load.orders), len(h), z.shape[1], len(r)))
    waves, closed = np.flatnonzero(~(near & same)), np.flatnonzero(near)
    if len(waves):
        rows = [Row(Kind(kinds[i]), z[:, i]) for i in waves]
        whole[:, :, waves] = of_waves(load, layers, h, pressure, r, rows, roughly)
    alike = np.all(z[:, closed] == z[:1, closed])  # depths that all cases share are one batch
    for case in [slice(None)] if alike else map(slice, range(len(h)), range(1, len(h) + 1)):
        if len(closed):
            own = pressure.take(case)
            displacements = len(load.orders) > load.stresses
            whole[:, case, closed] += load.in_closed_form(own, r, z[case][0, closed], layers.nu1[case], displacements)
    whole[:, (layers.n == 0)[:, None] & body] = np.nan
    return whole

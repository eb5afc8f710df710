"""The field of pressures on layers, by closed forms near the surface and by waves elsewhere."""

import numpy as np

from .waves import Row
from .waves import integrals as of_waves

#: At depths less than this times (1 + the largest radius)/2 the field is a closed form for a half-space, plus the
#: difference by waves. So waves need no larger k, however near the surface a row is.
_NEAR = 0.06
#: At depths less than this the stresses are those of the surface: at the edge they differ from these by the root of the
#: depth.
_SURFACE = 1e-21


def integrals(load, layers, h, pressure, r, z, region, roughly=False):
    """The integrals of a :class:`~.waves.Load` (fields, B, Z, R) on N layers.

    layers : :class:`~solver.kernels.transfer.Layered` of B cases
    h : (B,), thickness of the first layer in a; the thickness of each layer lies in one octave for all cases
    pressure : :class:`~.pressure.Pressure` of the cases
    r : (R,), radii in a; z : (B, Z), depths in a
    region : (Z,), the layer of the depths, counted from 0, or N for the body. In a rigid body the integrals are NaN
    roughly : whether an error of some percent is allowed
    """
    same, N = layers.uniform(), layers.poisson.shape[1] - 1
    z, region = np.where(z < _SURFACE, 0.0, z), region.astype(int)
    if same:  # the layer makes no difference; a thick one needs the fewest waves
        h, region = np.full(len(h), 2 * max(1.0, z.max())), 0 * region
    near = (region == 0) & (z.min(axis=0) < _NEAR * (1 + r.max()) / 2)
    if roughly:  # at the interface the difference decays no faster, and the errors of two large fields would not cancel
        near &= (z < h[:, None]).any(axis=0)
    whole = np.zeros((len(load.orders), len(h), z.shape[1], len(r)))
    waves, closed = np.flatnonzero(~(near & same)), np.flatnonzero(near)
    if len(waves):
        rows = [Row(int(region[i]), bool(near[i]), z[:, i]) for i in waves]
        whole[:, :, waves] = of_waves(load, layers, h, pressure, r, rows, roughly)
    alike = np.all(z[:, closed] == z[:1, closed])  # depths that all cases share are one batch
    for case in [slice(None)] if alike else map(slice, range(len(h)), range(1, len(h) + 1)):
        if len(closed):
            some = pressure.take(case)
            displacements = len(load.orders) > load.stresses
            whole[:, case, closed] += load.in_closed_form(
                some, r, z[case][0, closed], layers.poisson[case, 0], displacements
            )
    whole[:, layers.rigid[:, None] & (region == N)] = np.nan
    return whole

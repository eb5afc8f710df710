"""The field of normal pressure: docs/stress_fields.md, Waves."""

import numpy as np

from ..kernels.transfer import radial_sum
from .half_space import integrals
from .waves import Load


def amplitudes(waves, row, z):
    """The amplitudes of sr + st, sr - st, sz, trz, 2 G ur and 2 G uz."""
    u, w, S, T = v = waves.state(row.region, z, row.less)
    return radial_sum(v, waves.nu[:, row.region, None, None]), -u, S, T, u, w


def stress_parts(E, F, nu):
    """sr + st, sr - st, sz, trz of half-spaces, from the integrals E_m and F_m of :func:`~.half_space.integrals`."""
    return [F[0] - (1 + 2 * nu) * E[0], (1 - 2 * nu) * E[2] - F[2], -(E[0] + F[0]), -F[1]]


def in_closed_form(pressure, r, z, nu, displacements=True):
    """The quantities of :func:`amplitudes`, (6 or 4, B, Z, R), for half-spaces with Poisson ratios nu (B,), at radii r
    (R,) and depths z (Z,) in a."""
    nu, depth = nu[:, None, None], z[:, None]
    E, F, D = integrals(pressure, r, z, displacements=displacements)
    parts = stress_parts(E, F, nu)
    if displacements:
        parts += [depth * E[1] - (1 - 2 * nu) * D[1], 2 * (1 - nu) * D[0] + depth * E[0]]
    whole = np.stack(parts)
    surface = z == 0
    if surface.any():
        p, mean = pressure.at(r)[:, None], pressure.mean(r)[:, None]
        whole[:4, :, surface] = np.stack([-(1 + 2 * nu) * p, (1 - 2 * nu) * (2 * mean - p), -p, 0 * mean])
    return whole


NAMES = ("sr", "st", "sz", "trz", "ur", "uz")
LOAD = NORMAL = Load((-1.0, 0.0), (0, 2, 0, 1, 1, 0), 4, amplitudes, in_closed_form)


def components(whole, G2=None):
    """sr, st, sz, trz, and ur, uz if `whole` has the displacements, from its quantities; G2 : 2 G, which broadcasts."""
    total, difference, sz, trz, *displacements = whole
    parts = [(total + difference) / 2, (total - difference) / 2, sz, trz, *(v / G2 for v in displacements)]
    return dict(zip(NAMES, parts, strict=False))

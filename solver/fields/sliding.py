"""The field of sliding, of the traction q = p along x (times mu): docs/stress_fields.md, Sliding.

Its stresses and displacements are cosines and sines of the polar angle times amplitudes, which depend on r and z.
"""

import numpy as np

from ..kernels.transfer import radial_sum
from .half_space import integrals, on_surface
from .waves import Load


def amplitudes(waves, row, z):
    """The amplitudes of the nine integrals from which :func:`components` follow."""
    u, w, S, T = v = waves.state(row.region, z, row.less)
    Q, across = waves.antiplane(row.region, z, row.less)
    both, less = u + across, u - across
    M = radial_sum(v, waves.nu[:, row.region, None, None])
    return M, both, -less, S, T + Q, T - Q, w, both, less


def stress_parts(E, F, nu):
    """The six integrals of stresses in half-spaces, from E_m and F_m of :func:`~.half_space.integrals`."""
    return [
        F[1] - 2 * (1 + nu) * E[1],
        F[1] - 2 * (2 - nu) * E[1],
        -F[3] - 2 * nu * E[3],
        -F[1],
        2 * E[0] - F[0],
        -F[2],
    ]


def in_closed_form(pressure, r, z, nu, displacements=True):
    """The integrals of :func:`amplitudes`, (9 or 6, B, Z, R), for half-spaces with Poisson ratios nu (B,), at radii r
    (R,) and depths z (Z,) in a."""
    nu, depth = nu[:, None, None], z[:, None]
    E, F, D = integrals(pressure, r, z, 3, displacements)
    surface = z == 0
    if surface.any():
        E[0][:, surface] = pressure.at(r)[:, None]
        E[1::2, :, surface] = on_surface(pressure, r)[:, :, None]
    parts = stress_parts(E, F, nu)
    if displacements:
        parts += [
            depth * E[1] + (1 - 2 * nu) * D[1],
            depth * E[0] - 2 * (2 - nu) * D[0],
            depth * E[2] + 2 * nu * D[2],
        ]
    return np.stack(parts)


NAMES = ("sr_c", "st_c", "sz_c", "srt_s", "sxz_0", "sxz_2", "uz_c", "ux_0", "ux_2")
LOAD = SLIDING = Load((0.0, 1.0), (1, 1, 3, 1, 0, 2, 1, 0, 2), 6, amplitudes, in_closed_form)


def components(whole, G2=None):
    """The amplitudes of the field for mu = 1, from those integrals; G2 : 2 G, which broadcasts."""
    total, first, third, sz, even, odd, *displacements = whole
    difference = (first + third) / 2
    parts = [
        (total + difference) / 2,
        (total - difference) / 2,
        sz,
        (third - first) / 4,
        -even / 2,
        odd / 2,
        *(factor * v / G2 for factor, v in zip((1, -0.5, 0.5), displacements, strict=False)),
    ]
    return dict(zip(NAMES, parts, strict=False))


def in_plane(names, behind):
    """The field of pressure and friction together in the plane y = 0, across which there is no shear: sr, st, sz, trz
    (which is sxz), and ur (ux) and uz if `names` has them.

    names : name -> array, of both fields
    behind : bool, whether x < 0, on the trailing side
    """
    sign = np.where(behind, -1.0, 1.0)
    along = {name: names[name] + sign * names[f"{name}_c"] for name in ("sr", "st", "sz", "uz") if name in names}
    along["trz"] = sign * names["trz"] + names["sxz_0"] + names["sxz_2"]
    if "ur" in names:
        along["ur"] = sign * names["ur"] + names["ux_0"] + names["ux_2"]
    return along

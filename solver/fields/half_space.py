"""The integrals over k for a half-space, in closed form: docs/stress_fields.md, Near the surface.

They are E_m = ∫ p^ k e^(-kz) J_m dk, F_m = ∫ p^ k (kz) e^(-kz) J_m dk and D_m = ∫ p^ e^(-kz) J_m dk. With Abel's φ,
k p^(k) = ∫₀¹ φ(t) sin(kt) dt, each of them is an integral over t of an elementary function, regular down to the
surface.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.quadrature import gauss_legendre

#: Gauss points on each panel of the angle, t = sin(angle). The panels shrink towards t = r, where the integrand has a
#: singularity at the distance z in the complex plane. With 12 points Hertz is right to 7e-13, with 16 to rounding
#: (tests/fields/test_half_space.py).
_POINTS = 16
#: Most halvings of a panel towards t = r: on the surface, where D has a root there, and below it, where E and F change
#: by the root of z. The number of halvings is rounded up to a multiple of _STEP, so that depths share nodes.
_ON_SURFACE, _BELOW, _STEP = 39, 69, 3
#: A panel of the angle is at most this wide, over the number of nodes: the polynomial has at most 5 of its waves there.
_WIDTH = 10.0
#: Added to denominators that are 0 on a panel without width, where t = r or t = 0 on the surface.
_TINY = 1e-200


class Integrals(NamedTuple):
    """E and F (m + 1, B, Z, R) for the orders 0 to m, and D (3, B, Z, R) for 0, 1, 2, of B pressures at Z depths and R
    radii."""

    E: np.ndarray
    F: np.ndarray
    D: np.ndarray


def integrals(pressure, r, z, most=2, displacements=True):
    """:class:`Integrals` of a :class:`~.pressure.Pressure` at radii r (R,) and depths z (Z,), both in a.

    most : largest order m of E and F. On the surface, z = 0, E and F are set to 0: only D is an integral there
    displacements : whether D is needed; otherwise it is 0
    """
    B = len(pressure.values)
    E, F, D = (np.zeros((count, B, len(z), len(r))) for count in (most + 1, most + 1, 3))
    halvings = _halvings(r, z)
    if not displacements:
        halvings = np.where(z == 0, -1, halvings)
    for count in np.unique(halvings[halvings >= 0]):
        nodes = Nodes.of(pressure, r, count)
        for i in np.flatnonzero(halvings == count):
            for whole, of_order in zip((E, F, D), _kernels(nodes, r[:, None], z[i], most, displacements), strict=True):
                for m, kernel in enumerate(of_order):
                    whole[m, :, i] = np.einsum("brt,rt->br", nodes.weight, kernel)
    return Integrals(E, F, D)


class Nodes(NamedTuple):
    """Nodes t (R, T) of the integrals over t, their distance `gap` = t - r, and the `weight` φ dt there (B, R,
    T)."""

    t: np.ndarray
    gap: np.ndarray
    weight: np.ndarray

    @classmethod
    def of(cls, pressure, r, halvings):
        """The nodes for radii r (R,), on panels that are halved `halvings` times towards t = r."""
        t, gap, s, width = _places(pressure.mesh, r, halvings)
        density = pressure.density(s) * s + (2 / np.pi * pressure.at_edge())[:, None, None]
        weight = density * t * width
        if pressure.A is None:
            return cls(t, gap, weight)
        edge = np.broadcast_to(pressure.A[:, None, None], (len(weight), len(r), 1))
        t, gap = np.hstack([t, np.ones((len(r), 1))]), np.hstack([gap, (1 - r)[:, None]])
        return cls(t, gap, np.concatenate([weight, edge], axis=2))

    @classmethod
    def of_each(cls, pressure, r, halvings):
        """As :meth:`of`, for as many cases as radii, each at its own radius; the weights are (R, T)."""
        t, gap, s, width = _places(pressure.mesh, r, halvings)
        density = pressure.density_of_each(s) * s + (2 / np.pi * pressure.at_edge())[:, None]
        weight = density * t * width
        if pressure.A is None:
            return cls(t, gap, weight)
        t, gap = np.hstack([t, np.ones((len(r), 1))]), np.hstack([gap, (1 - r)[:, None]])
        return cls(t, gap, np.hstack([weight, pressure.A[:, None]]))


def _places(mesh, r, halvings):
    """Nodes t (R, T) for radii r (R,), their distance t - r, s = sqrt(1 - t²), and their weights in the angle."""
    centre = np.arcsin(np.minimum(r, 1.0))[:, None]
    fixed = np.arccos(np.array(mesh.breaks[::-1]))
    widths = np.diff(fixed)
    pieces = np.ceil(widths * mesh.order / _WIDTH).astype(int)
    starts = zip(fixed[:-1], widths, pieces, strict=True)
    fixed = np.concatenate([low + width * np.arange(n) / n for low, width, n in starts])
    graded = np.pi / 2 * 0.5 ** np.arange(1, halvings + 1)
    graded = np.concatenate([-graded, [0.0], graded]) + 0 * centre
    # the variable is the distance from the centre, because angles lose the digits of small distances
    ends = np.concatenate([graded, fixed - centre, np.pi / 2 - centre], axis=1)
    ends = np.sort(np.clip(ends, -centre, np.pi / 2 - centre), axis=1)
    x, w = gauss_legendre(_POINTS)
    width = np.diff(ends)[..., None]
    distance = (ends[:, :-1, None] + width * x).reshape(len(r), -1)
    angle = centre + distance
    t, s = np.sin(angle), np.maximum(np.cos(angle), 0.0)
    gap = 2 * np.cos(centre + distance / 2) * np.sin(distance / 2) - np.maximum(r - 1, 0.0)[:, None]
    return t, gap, s, (width * w).reshape(len(r), -1)


def _halvings(r, z):
    """(Z,) int: number of halvings after which panels are as narrow as the distance of the singularity, for any r."""
    return halvings_at(r, z[:, None]).max(axis=1)


def halvings_at(r, z):
    """As :func:`_halvings`, for each of the points r, z, which broadcast."""
    most = np.where(z == 0, _ON_SURFACE, _BELOW)
    far = np.abs(np.arcsin(r + 1j * z).imag)
    needed = np.ceil(np.log2(np.pi / 2 / np.maximum(far, 2.0 ** -(most - 1))) / _STEP).astype(int)
    return np.clip(needed * _STEP, 0, most)


def _kernels(nodes, r, z, most, displacements):
    """Kernels (R, T) of E, F and D at the depth z, a list over the order each."""
    t = nodes.t
    real, imaginary = z * z - nodes.gap * (t + r), z * t  # real part of rho², and its imaginary part over -2
    large = np.sqrt((np.hypot(real, 2 * imaginary) + np.abs(real)) / 2) + _TINY
    small = imaginary / large
    rho = np.where(real >= 0, large - 1j * small, small - 1j * large)
    ze = z - 1j * t
    g = r / (rho + ze + _TINY)
    power = [1.0, g, g * g]
    D = [np.arctan2(t - rho.imag, rho.real + z), g.imag, power[2].imag / 2] if displacements else []
    if z == 0:
        return [], [], D
    power += [power[2] * g] if most > 2 else []
    once = 1 / rho
    cubed = z * once * once * once
    E = [(p * once).imag for p in power]
    F = [(p * (m * rho + ze) * cubed).imag for m, p in enumerate(power)]
    return E, F, D


def on_surface(pressure, r):
    """E_1 and E_3 (2, B, R) at z = 0 and radii r (R,).

    E_m = ∫ φ sin(mb) db with t = r sin(b), up to t = 1. For r = 1 this is smooth in the angle. For other radii the
    panels are halved towards t = min(1, r), until the other root is not near.
    """
    inner = np.minimum(r, 1.0)[:, None]
    fixed = np.sqrt(np.maximum(1 - np.array(pressure.mesh.breaks[::-1]) ** 2, 0.0))
    fixed = np.arcsin(np.minimum(fixed / np.maximum(inner, _TINY), 1.0))
    graded = np.pi / 2 * (1 - 0.5 ** np.arange(1, _ON_SURFACE)) + 0 * inner
    ends = np.sort(np.concatenate([fixed, graded, np.full(inner.shape, np.pi / 2)], axis=1), axis=1)
    x, w = gauss_legendre(2 * _POINTS)
    width = np.diff(ends)[..., None]
    angle = (ends[:, :-1, None] + width * x).reshape(len(r), -1)
    sin, cos = np.sin(angle), np.cos(angle)
    t, within = inner * sin, r[:, None] <= 1
    s = np.where(within, np.sqrt((1 - inner) * (1 + inner) + (inner * cos) ** 2), cos)
    root = np.where(within, 1.0, np.sqrt(np.maximum(r[:, None] ** 2 - t**2, _TINY)) / s)
    φ = (pressure.density(s) + (2 / np.pi * pressure.at_edge())[:, None, None] / s) * t
    b = np.where(within, angle, np.arcsin(np.minimum(t / np.maximum(r[:, None], 1.0), 1.0)))
    weight = (width * w).reshape(len(r), -1) / root
    whole = np.stack([np.einsum("brt,rt->br", φ, weight * np.sin(m * b)) for m in (1, 3)])
    if pressure.A is not None:
        outside = np.maximum(r, 1.0)
        root = np.sqrt((outside - 1) * (outside + 1))
        of_edge = np.stack([np.sin(m * np.arcsin(1 / outside)) / root for m in (1, 3)])
        whole = whole + pressure.A[:, None] * np.where(r < 1, 0.0, of_edge)[:, None]
    return whole

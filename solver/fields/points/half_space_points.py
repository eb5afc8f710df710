"""The field of half-spaces at single points near the surface with its derivatives by r and z; the integrals over k are
in closed form.

With ζ = z - it, ρ = sqrt(r² + ζ²) and g = r/(ρ + ζ), the integrals ∫ k^j e^(-kζ) J_m dk are I_m0 = g^m/ρ and

    ρ² I_m,j+1 = (2j + 1) ζ I_mj - (j² - m²) I_m,j-1,    I_m,-1 = g^m/m,

and each derivative multiplies the integrand by one more k: that of e^(-kz) by z, and by r that of J_m, whose J_m' is
(J_(m-1) - J_(m+1))/2.
"""

import numpy as np

from .. import normal, sliding
from ..half_space import Nodes, halvings_at

#: Points that are computed together. Each has about 500 nodes with 25 complex numbers.
_AT_ONCE = 32


def normal_below(pressure, case, nu, r, z):
    """sr + st, sr - st, sz, trz by pressure with their derivatives, (JET, 4, P), at P points.

    pressure, case : :class:`~..pressure.Pressure`, and for each point its case in it (P,)
    nu : (P,), Poisson ratios of the half-spaces; r, z : (P,), z > 0
    """
    E, F = _potentials(pressure, case, r, z, 2)
    return np.stack(normal.stress_parts(E, F, nu), axis=1)


def sliding_below(pressure, case, nu, r, z):
    """The six integrals of stresses by sliding with their derivatives, (JET, 6, P); arguments as of
    :func:`normal_below`."""
    E, F = _potentials(pressure, case, r, z, 3)
    return np.stack(sliding.stress_parts(E, F, nu), axis=1)


def _potentials(pressure, case, r, z, most):
    """E_m = ∫ p^ k e^(-kz) J_m dk and F_m = ∫ p^ k (kz) e^(-kz) J_m dk with their derivatives: two lists over m of
    arrays (JET, P)."""
    K = np.empty((most + 3, 4, len(r)))
    halvings = halvings_at(r, z)
    for count in np.unique(halvings):
        index = np.flatnonzero(halvings == count)
        for some in np.array_split(index, -(-len(index) // _AT_ONCE)):
            K[..., some] = _integrals(pressure.take(case[some]), r[some], z[some], count, most)
    E, G = ([_jet(K, m, j) for m in range(most + 1)] for j in (0, 1))
    F = []
    for value, by_r, by_z, rr, rz, zz in G:
        F.append(np.stack([z * value, z * by_r, value + z * by_z, z * rr, by_r + z * rz, 2 * by_z + z * zz]))
    return E, F


def _jet(K, m, j):
    """∫ p^ k^(j+1) e^(-kz) J_m dk and its derivatives, (JET, P), from the integrals K[m, j]."""

    def at(m, j):
        return K[m, j] if m >= 0 else (-1) ** m * K[-m, j]

    def slope(m, j):
        return (at(m - 1, j) - at(m + 1, j)) / 2

    values = at(m, j), slope(m, j + 1), -at(m, j + 1)
    return np.stack([*values, (slope(m - 1, j + 2) - slope(m + 1, j + 2)) / 2, -slope(m, j + 2), at(m, j + 2)])


def _integrals(pressure, r, z, halvings, most):
    """∫ p^ k^(j+1) e^(-kz) J_m dk, (most + 3, 4, P) over m, j and the points; `pressure` has one case for each."""
    nodes = Nodes.of_each(pressure, r, halvings)
    ζ = z[:, None] - 1j * nodes.t
    real = z[:, None] ** 2 - nodes.gap * (nodes.t + r[:, None])
    ρ = np.sqrt(real - 2j * z[:, None] * nodes.t)
    once = 1 / ρ
    g, twice = r[:, None] / (ρ + ζ), once * once
    integrals, power = np.empty((most + 3, 4, len(r))), np.ones_like(ρ)
    fall = ζ * twice
    for m in range(most + 3):
        before, now = power / max(m, 1), power * once
        integrals[m, 0] = np.einsum("pt,pt->p", nodes.weight, now.imag)
        for j in range(3):
            before, now = now, (2 * j + 1) * fall * now - (j * j - m * m) * twice * before
            integrals[m, j + 1] = np.einsum("pt,pt->p", nodes.weight, now.imag)
        power = power * g
    return integrals

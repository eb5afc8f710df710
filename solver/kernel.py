"""The exact kernel L(u), u = kh, of an elastic layer on an elastic half-space, frictionless or bonded.

Surface displacement u(r) = (2/E1*) ∫ L(kh) p̂(k) J0(kr) dk. L(0) = n, L(∞) = 1. What the solver uses is L - 1, which
decays like e^(-2u); both, and u dL/du, are formed without cancellation from u = 0 to infinity.
"""

from typing import NamedTuple

import numpy as np


class Kernel(NamedTuple):
    """L(u), L(u) - 1 and u dL/du; arrays of one shape."""

    L: np.ndarray
    L1: np.ndarray
    uL: np.ndarray


def layered_kernel(u, n, nu1, nu2, bonded):
    """L(u) of a layer on a half-space for any Poisson ratios.

    Parameters
    ----------
    u : array, >= 0
        Wave number times thickness; broadcast against the others.
    n : array, > 0
        E1*/E2*.
    nu1, nu2 : array, (-1, 0.5]
        Poisson ratios of layer and half-space; not used without friction.
    bonded : array of bool
        Perfect bond, or a frictionless interface.

    Returns
    -------
    Kernel
        L and L - 1 to a relative 1e-13 (L - 1 relative to its largest term where it changes sign), u dL/du to 1e-12.
    """
    u, n, nu1, nu2, bonded = np.broadcast_arrays(np.asarray(u, float), n, nu1, nu2, bonded)
    if bonded.all():
        return bonded_kernel(u, n, nu1, nu2)
    if not bonded.any():
        return frictionless_kernel(u, n)
    both = bonded_kernel(u, n, nu1, nu2), frictionless_kernel(u, n)
    return Kernel(*(np.where(bonded, b, f) for b, f in zip(*both, strict=True)))


def frictionless_kernel(u, n):
    """L = [s² + n(sc + u)]/[(sc + u) + n(s² - u²)], s = sinh u, c = cosh u; arguments as in :func:`layered_kernel`."""
    e, rest, rest2 = np.exp(-2 * u), -np.expm1(-2 * u), -np.expm1(-4 * u)  # e, 1 - e, 1 - e²
    wedge = rest2 + 4 * u * e  # 4e (sc + u)
    gap, d_gap = _gap(u, e, rest)
    below = wedge + n * gap
    L = (rest * rest + n * wedge) / below
    bracket = (n - 1) * (rest / 2 + u) + n * u * u
    above1 = 4 * e * bracket  # L - 1 = above1/below
    d_above1 = -2 * above1 + 4 * e * ((n - 1) * (e + 1) + 2 * n * u)
    d_below = 4 * e * (e + 1 - 2 * u) + n * d_gap
    L1 = above1 / below
    small = u == 0
    below = np.where(small, 1.0, below)
    L, L1 = np.where(small, n, L), np.where(small, n - 1, L1)
    return Kernel(L, L1, np.where(small, 0.0, u * (d_above1 - L1 * d_below) / below))


def bonded_kernel(u, n, nu1, nu2):
    """L = [1 + 4b'ue - a'b'e²]/[1 - (a' + b' + 4b'u²)e + a'b'e²], e = exp(-2u); arguments as in :func:`layered_kernel`.

    With alpha = G1/G2 and g = 3 - 4 nu: a' = (alpha g2 - g1)/(1 + alpha g2), b' = (alpha - 1)/(alpha + g1). 1 - a',
    1 - b', 1 + a' and 1 - a'b' are taken in product form, sinh x - x by its series.
    """
    alpha, g1, g2 = n * (1 - nu1) / (1 - nu2), 3 - 4 * nu1, 3 - 4 * nu2
    da, db = 1 + alpha * g2, alpha + g1
    a, b = (alpha * g2 - g1) / da, (alpha - 1) / db
    one_a, one_b = (1 + g1) / da, (1 + g1) / db
    plus_a = (2 * alpha * g2 - 2 * (1 - 2 * nu1)) / da
    one_ab = alpha * (1 + g1) * (1 + g2) / (da * db)
    e, rest = np.exp(-2 * u), -np.expm1(-2 * u)
    gap, d_gap = _gap(u, e, rest)
    above = one_ab + 2 * a * b * _sinh_excess(u, e) + 4 * u * b * plus_a * e
    stiff = one_a * one_b + one_a * b * (rest - 4 * u * u * e) + a * one_b * rest + a * b * gap
    soft = _one_minus(a, one_a, e, rest) * (1 - b * e) - 4 * b * u * u * e
    hard = b > 0  # then 1 - b e nearly vanishes at small u
    below = np.where(hard, stiff, soft)
    bracket = 4 * b * u * (1 + u) + a * one_b + b * one_a + 2 * a * b * rest
    above1 = e * bracket
    d_above1 = -2 * above1 + e * (4 * b * (1 + 2 * u) + 4 * a * b * e)
    d_stiff = 2 * e * (one_a * b * (1 - 4 * u + 4 * u * u) + a * one_b) + a * b * d_gap
    d_soft = e * (2 * (a + b + 4 * b * u * u) - 8 * b * u - 4 * a * b * e)
    d_below = np.where(hard, d_stiff, d_soft)
    L1 = above1 / below
    return Kernel(above / below, L1, u * (d_above1 - L1 * d_below) / below)


def _one_minus(a, one_a, e, rest):
    """1 - a e without cancellation for a of either sign."""
    return np.where(a > 0, one_a + a * rest, 1 - a * e)


def _gap(u, e, rest):
    """(1 - e)² - 4u²e = 4e (sinh² u - u²) and its derivative."""
    v = np.minimum(u, 0.6)
    z = 4 * v * v  # cosh 2u - 1 - 2u² = Σ (2u)^(2j)/(2j)!, j >= 2
    series = (
        z
        * z
        / 24
        * (1 + z / 30 * (1 + z / 56 * (1 + z / 90 * (1 + z / 132 * (1 + z / 182 * (1 + z / 240 * (1 + z / 306)))))))
    )
    gap = np.where(u < 0.6, 2 * e * series, rest * rest - 4 * u * u * e)
    return gap, 4 * _sinh_excess(u, e) - 2 * gap


def _sinh_excess(u, e):
    """e (sinh 2u - 2u)."""
    v = np.minimum(u, 0.6)
    z = 4 * v * v
    series = (
        2
        * v
        * z
        / 6
        * (1 + z / 20 * (1 + z / 42 * (1 + z / 72 * (1 + z / 110 * (1 + z / 156 * (1 + z / 210 * (1 + z / 272)))))))
    )
    return np.where(u < 0.6, e * series, (1 - e * e) / 2 - 2 * u * e)

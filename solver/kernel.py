"""The exact kernel L(u), u = kh, of an elastic layer on an elastic half-space, frictionless or bonded.

Surface displacement u(r) = (2/E1*) ∫ L(kh) p̂(k) J0(kr) dk. L(0) = n, L(∞) = 1. What the solver uses is L - 1, which
decays like e^(-2u), and u dL/du; all are formed without cancellation from u = 0 to infinity.
"""

from typing import NamedTuple

import numpy as np

#: Below this u, differences of hyperbolic functions and their first terms are taken from series.
_SERIES = 0.8


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
        L and L - 1 to a relative 1e-13 (L - 1 relative to its largest term where it changes sign), u dL/du to 1e-13 of
        the larger of |L - 1| and itself.

    Examples
    --------
    >>> print(f"{float(layered_kernel(0.01, 0.5, 0.3, 0.3, False).L):.6f}")
    0.505000
    """
    u, n, nu1, nu2, bonded = np.broadcast_arrays(np.asarray(u, float), n, nu1, nu2, bonded)
    shape = u.shape
    u, n, nu1, nu2, bonded = (np.atleast_1d(v) for v in (u, n, nu1, nu2, bonded))
    L, L1, uL = whole(u, n, nu1, nu2, bonded), *decaying_part(u, n, nu1, nu2, bonded)
    return Kernel(*(v.reshape(shape) for v in (L, L1, uL)))


def whole(u, n, nu1, nu2, bonded):
    """L alone, of arrays u (at least one-dimensional); arguments as in :func:`layered_kernel`."""
    bonded = np.asarray(bonded)
    if bonded.all():
        return _bonded_whole(u, n, nu1, nu2)
    if not bonded.any():
        return _frictionless_whole(u, n)
    return np.where(bonded, _bonded_whole(u, n, nu1, nu2), _frictionless_whole(u, n))


def decaying_part(u, n, nu1, nu2, bonded):
    """L - 1 and u dL/du; arguments as in :func:`layered_kernel`, the materials broadcast against u."""
    bonded = np.asarray(bonded)
    if bonded.all():
        return _bonded(u, n, nu1, nu2)
    if not bonded.any():
        return _frictionless(u, n)
    both = zip(_bonded(u, n, nu1, nu2), _frictionless(u, n), strict=True)
    return tuple(np.where(bonded, b, f) for b, f in both)


def _frictionless_parts(u, n):
    """Terms, times 4e, of L = [s² + n(sc + u)]/[(sc + u) + n(s² - u²)], s = sinh u, c = cosh u, e = exp(-2u)."""
    e, rest = np.exp(-2 * u), -np.expm1(-2 * u)
    wedge = rest * (1 + e) + 4 * u * e  # 4e (sc + u)
    limit = _SERIES if np.any(n > 2) else 0.01  # beside the wedge, a small n times the gap needs no series
    gap = _gap(u, e, rest, limit)  # 4e (s² - u²)
    return e, rest, wedge, gap, np.where(u == 0, 1.0, wedge + n * gap), limit


def _frictionless_whole(u, n):
    _, rest, wedge, _, below, _ = _frictionless_parts(u, n)
    return np.where(u == 0, n, (rest * rest + n * wedge) / below)


def _frictionless(u, n):
    e, rest, _, gap, below, limit = _frictionless_parts(u, n)
    above = 4 * e * ((n - 1) * (rest / 2 + u) + n * u * u)  # L - 1 = above/below
    d_above = 4 * e * ((n - 1) * (e + 1) + 2 * n * u) - 2 * above
    d_below = 4 * e * (e + 1 - 2 * u) + n * _gap_slope(u, e, gap, limit)
    L1 = np.where(u == 0, n - 1, above / below)
    return L1, u * (d_above - L1 * d_below) / below


class _Bond(NamedTuple):
    """Constants of the bonded kernel: with alpha = G1/G2 and g = 3 - 4 nu, a = (alpha g2 - g1)/(1 + alpha g2),
    b = (alpha - 1)/(alpha + g1), and 1 - a, 1 - b, 1 + a, 1 - ab in product form."""

    a: np.ndarray
    b: np.ndarray
    one_a: np.ndarray
    one_b: np.ndarray
    plus_a: np.ndarray
    one_ab: np.ndarray


def _bond(n, nu1, nu2):
    alpha, g1, g2 = n * (1 - nu1) / (1 - nu2), 3 - 4 * nu1, 3 - 4 * nu2
    da, db = 1 + alpha * g2, alpha + g1
    excess = ((n - 1) * (1 - nu1) + (nu2 - nu1)) / (1 - nu2)  # alpha - 1
    return _Bond(
        a=(excess * g2 + 4 * (nu1 - nu2)) / da,
        b=excess / db,
        one_a=(1 + g1) / da,
        one_b=(1 + g1) / db,
        plus_a=(2 * alpha * g2 - 2 * (1 - 2 * nu1)) / da,
        one_ab=alpha * (1 + g1) * (1 + g2) / (da * db),
    )


def _bonded_below(u, e, rest, bond):
    """Denominator 1 - (a + b + 4bu²)e + ab e² of L and its derivative."""
    a, b, one_a, one_b, _, _ = bond
    soft = _one_minus(a, one_a, e, rest) * (1 - b * e) - 4 * b * u * u * e
    d_soft = e * (2 * (a + b + 4 * b * u * u) - 8 * b * u - 4 * a * b * e)
    hard = b > 0  # then 1 - b e nearly vanishes at small u: written in 1 - a, 1 - b and s² - u²
    if not np.any(hard):
        return soft, d_soft
    gap = _gap(u, e, rest)
    stiff = one_a * one_b + one_a * b * (rest - 4 * u * u * e) + a * one_b * rest + a * b * gap
    d_stiff = 2 * e * (one_a * b * (1 - 4 * u + 4 * u * u) + a * one_b) + a * b * _gap_slope(u, e, gap)
    return np.where(hard, stiff, soft), np.where(hard, d_stiff, d_soft)


def _bonded_whole(u, n, nu1, nu2):
    bond, e, rest = _bond(n, nu1, nu2), np.exp(-2 * u), -np.expm1(-2 * u)
    excess = _sinh_excess(u, e)
    above = bond.one_ab + 2 * bond.a * bond.b * excess + 4 * u * bond.b * bond.plus_a * e  # 1 + 4bue - ab e²
    return above / _bonded_below(u, e, rest, bond)[0]


def _bonded(u, n, nu1, nu2):
    bond, e, rest = _bond(n, nu1, nu2), np.exp(-2 * u), -np.expm1(-2 * u)
    a, b = bond.a, bond.b
    below, d_below = _bonded_below(u, e, rest, bond)
    above = e * (4 * b * u * (1 + u) + (n - 1) * bond.one_a * bond.one_b + 2 * a * b * rest)  # L - 1 = above/below
    d_above = e * (4 * b * (1 + 2 * u) + 4 * a * b * e) - 2 * above
    L1 = above / below
    return L1, u * (d_above - L1 * d_below) / below


def _one_minus(a, one_a, e, rest):
    """1 - a e without cancellation for a of either sign."""
    return np.where(a > 0, one_a + a * rest, 1 - a * e)


def _gap(u, e, rest, limit=_SERIES):
    """(1 - e)² - 4u²e = 4e (sinh² u - u²)."""
    gap = rest * rest - 4 * u * u * e
    small = u < limit
    v, z = _small(u, small)
    # cosh 2u - 1 - 2u² = Σ (2u)^(2j)/(2j)!, j >= 2
    series = z * z / 24 * _nested(z, (30, 56, 90, 132, 182, 240, 306, 380))
    gap[small] = 2 * np.exp(-2 * v) * series
    return gap


def _gap_slope(u, e, gap, limit=_SERIES):
    """Derivative of :func:`_gap` by u."""
    return 4 * _sinh_excess(u, e, limit) - 2 * gap


def _sinh_excess(u, e, limit=_SERIES):
    """e (sinh 2u - 2u)."""
    excess = (1 - e * e) / 2 - 2 * u * e
    small = u < limit
    v, z = _small(u, small)
    series = _nested(z, (20, 42, 72, 110, 156, 210, 272, 342))
    excess[small] = np.exp(-2 * v) * v * z / 3 * series
    return excess


def _nested(z, divisors):
    """1 + z/d1 (1 + z/d2 (1 + ...))."""
    total = 1.0
    for d in reversed(divisors):
        total = 1 + z / d * total
    return total


def _small(u, small):
    v = u[small]
    return v, 4 * v * v

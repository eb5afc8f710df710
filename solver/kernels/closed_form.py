"""The exact kernel L(u), u = kh, of an elastic layer on an elastic half-space, frictionless or bonded.

The displacement of the surface is (2/E1*) ∫ L(kh) p̂(k) J0(kr) dk. L(0) = n, L(∞) = 1. The solver uses L - 1, which
decays like e^(-2u), and u dL/du. All are formed without cancellation from u = 0 to infinity.
"""

from typing import NamedTuple

import numpy as np

#: Below this u, a hyperbolic function less the first terms of its series is the sum of the further terms.
_SERIES = 0.8
#: It stands for u = 0: the quotients that are 0/0 there have their limits here.
_LEAST = 1e-300


class Values(NamedTuple):
    """L(u), L(u) - 1 and u dL/du; arrays of one shape."""

    L: np.ndarray
    L1: np.ndarray
    uL: np.ndarray


def layered_kernel(u, n, nu1, nu2, bonded):
    """:class:`Values` of a layer on a half-space for any Poisson ratios; the arguments broadcast.

    The relative error of L and of L - 1 is 1e-13 (where L - 1 changes sign, relative to its largest term). The error of
    u dL/du is 1e-13 of the larger of |L - 1| and |u dL/du|.

    u : wave number times thickness, >= 0
    n : E1*/E2* >= 0; 0 on a rigid base, where L(0) = 0
    nu1, nu2 : Poisson ratios of layer and half-space, in (-1, 0.5]; without friction they have no effect
    bonded : True: perfect bond; False: frictionless interface

    >>> print(f"{float(layered_kernel(0.01, 0.5, 0.3, 0.3, False).L):.6f}")
    0.505000
    """
    arrays = np.broadcast_arrays(np.asarray(u, float), n, nu1, nu2, bonded)
    flat = [np.atleast_1d(v) for v in arrays]
    return Values(*(v.reshape(arrays[0].shape) for v in (whole(*flat), *decaying_part(*flat))))


def whole(u, n, nu1, nu2, bonded):
    """L alone, at an array u of at least one dimension; arguments as in :func:`layered_kernel`."""
    return _by_interface(bonded, lambda: _bonded_whole(u, n, nu1, nu2), lambda: _frictionless_whole(u, n))


def decaying_part(u, n, nu1, nu2, bonded):
    """L - 1 and u dL/du; arguments as in :func:`layered_kernel`, the materials broadcast against u."""
    return _by_interface(bonded, lambda: _bonded(u, n, nu1, nu2), lambda: _frictionless(u, n))


def _by_interface(bonded, of_bonded, of_frictionless):
    """The values for bonded and for frictionless cases, each from its own function. A function whose interface does not
    occur is not called."""
    if np.all(bonded):
        return of_bonded()
    return np.where(bonded, of_bonded(), of_frictionless()) if np.any(bonded) else of_frictionless()


class _Frictionless(NamedTuple):
    """Terms of L = [s² + n(sc + u)]/[(sc + u) + n(s² - u²)], s = sinh u, c = cosh u.

    With e = exp(-2u): rest = 1 - e, e4 = 4e, ue4 = 4ue. The others are multiplied by 4e: wedge = sc + u, gap = s² - u²,
    excess = sc - u, and `below`, the denominator.
    """

    e: np.ndarray
    rest: np.ndarray
    e4: np.ndarray
    ue4: np.ndarray
    wedge: np.ndarray
    gap: np.ndarray
    excess: np.ndarray
    below: np.ndarray


def _frictionless_terms(u, n):
    """The terms at u > 0, an array in any memory order."""
    u = np.ascontiguousarray(u)  # in another order, reshape(-1) below makes a copy, and what is written there is lost
    e, rest = np.exp(-2 * u), -np.expm1(-2 * u)
    e4 = 4 * e
    ue4 = u * e4
    wedge = rest * (1 + e) + ue4
    gap, excess = rest * rest - u * ue4, wedge - 2 * ue4
    if np.any(n > 2):  # for smaller n, the digits that gap and excess lose by cancellation are small beside the wedge
        small = np.flatnonzero(u < _SERIES)
        gap.reshape(-1)[small], half_excess = _series(u.reshape(-1)[small], e.reshape(-1)[small])
        excess.reshape(-1)[small] = 2 * half_excess
    return _Frictionless(e, rest, e4, ue4, wedge, gap, excess, wedge + n * gap)


def _frictionless_whole(u, n):
    t = _frictionless_terms(np.maximum(u, _LEAST), n)
    return (t.rest * t.rest + n * t.wedge) / t.below


def _frictionless(u, n):
    u = np.maximum(u, _LEAST)
    t = _frictionless_terms(u, n)
    inverse, nu, more, one_e = 1 / t.below, n * u, n - 1, 1 + t.e
    share = t.e4 * inverse
    L1 = share * (more * (t.rest / 2 + u) + nu * u)  # L - 1
    d_below = t.e4 * one_e - 2 * t.ue4 + 2 * n * (t.excess - t.gap)
    uL = u * (share * (more * one_e + 2 * nu) - L1 * (2 + d_below * inverse))
    return L1, np.where(u > _LEAST, uL, 0.0)


class _Bond(NamedTuple):
    """Constants of the bonded kernel: c1 = (alpha g2 - g1)/(1 + alpha g2) and c2 = (alpha - 1)/(alpha + g1), with alpha
    = G1/G2 and g = 3 - 4 nu; and 1 - c1, 1 - c2, 1 + c1, 1 - c1 c2, each as a product."""

    c1: np.ndarray
    c2: np.ndarray
    one_c1: np.ndarray
    one_c2: np.ndarray
    plus_c1: np.ndarray
    one_c1c2: np.ndarray


def bond_constants(n, nu1, nu2):
    """:class:`_Bond` of layers on half-spaces, arrays of one shape."""
    alpha, g1, g2 = n * (1 - nu1) / (1 - nu2), 3 - 4 * nu1, 3 - 4 * nu2
    below1, below2 = 1 + alpha * g2, alpha + g1
    excess = ((n - 1) * (1 - nu1) + (nu2 - nu1)) / (1 - nu2)  # alpha - 1
    return _Bond(
        c1=(excess * g2 + 4 * (nu1 - nu2)) / below1,
        c2=excess / below2,
        one_c1=(1 + g1) / below1,
        one_c2=(1 + g1) / below2,
        plus_c1=(2 * alpha * g2 - 2 * (1 - 2 * nu1)) / below1,
        one_c1c2=alpha * (1 + g1) * (1 + g2) / (below1 * below2),
    )


def _bonded_below(u, e, rest, bond):
    """The denominator 1 - (c1 + c2 + 4c2u²)e + c1c2e² of L, and its derivative by u."""
    c1, c2, one_c1, one_c2, _, _ = bond
    hard = c2 > 0  # 1 - c2 e may nearly vanish at small u: so the denominator is formed of 1 - c1, 1 - c2 and s² - u²
    if not np.all(hard):
        one_c1e = np.where(c1 > 0, one_c1 + c1 * rest, 1 - c1 * e)  # 1 - c1 e, without cancellation for either sign
        soft = one_c1e * (1 - c2 * e) - 4 * c2 * u * u * e
        d_soft = e * (2 * (c1 + c2 + 4 * c2 * u * u) - 8 * c2 * u - 4 * c1 * c2 * e)
        if not np.any(hard):
            return soft, d_soft
    gap, excess = _gap_and_excess(u, e, rest)
    stiff = one_c1 * one_c2 + one_c1 * c2 * (rest - 4 * u * u * e) + c1 * one_c2 * rest + c1 * c2 * gap
    d_stiff = 2 * e * (one_c1 * c2 * (1 - 4 * u + 4 * u * u) + c1 * one_c2) + c1 * c2 * (4 * excess - 2 * gap)
    if np.all(hard):
        return stiff, d_stiff
    return np.where(hard, stiff, soft), np.where(hard, d_stiff, d_soft)


def _bonded_whole(u, n, nu1, nu2):
    bond, e, rest = bond_constants(n, nu1, nu2), np.exp(-2 * u), -np.expm1(-2 * u)
    _, excess = _gap_and_excess(u, e, rest)
    above = bond.one_c1c2 + 2 * bond.c1 * bond.c2 * excess + 4 * u * bond.c2 * bond.plus_c1 * e  # 1 + 4c2ue - c1c2e²
    return above / _bonded_below(u, e, rest, bond)[0]


def _bonded(u, n, nu1, nu2):
    bond, e, rest = bond_constants(n, nu1, nu2), np.exp(-2 * u), -np.expm1(-2 * u)
    c1, c2 = bond.c1, bond.c2
    below, d_below = _bonded_below(u, e, rest, bond)
    above = e * (4 * c2 * u * (1 + u) + (n - 1) * bond.one_c1 * bond.one_c2 + 2 * c1 * c2 * rest)  # L - 1 = above/below
    d_above = e * (4 * c2 * (1 + 2 * u) + 4 * c1 * c2 * e) - 2 * above
    L1 = above / below
    return L1, u * (d_above - L1 * d_below) / below


def _gap_and_excess(u, e, rest):
    """The gap (1 - e)² - 4u²e = 4e (sinh² u - u²) and the excess e (sinh 2u - 2u). The derivative of the gap is
    4 excess - 2 gap."""
    ue = u * e
    gap, excess, small = rest * rest - 4 * u * ue, rest * (1 + e) / 2 - 2 * ue, u < _SERIES
    gap[small], excess[small] = _series(u[small], e[small])
    return gap, excess


def _series(u, e):
    """Gap and excess by the series of cosh 2u - 1 - 2u² = Σ (2u)^(2j)/(2j)!, j >= 2, and of sinh 2u - 2u."""
    z = 4 * u * u
    gap = z * z / 12 * _nested(z, (30, 56, 90, 132, 182, 240, 306, 380))
    return e * gap, e * u * z / 3 * _nested(z, (20, 42, 72, 110, 156, 210, 272, 342))


def _nested(z, divisors):
    """1 + z/d1 (1 + z/d2 (1 + ...))."""
    total = 1.0
    for d in reversed(divisors):
        total = 1 + z / d * total
    return total

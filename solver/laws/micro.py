"""Micro laws: the additional displacement A[p] of identical spherical asperities, and what happens on one contact spot.

The implicit law of the paper, Eqs (6) and (7), becomes explicit in the angle theta = arccos(b/B̄): with p = p* q, A
= A* g,

    p* = 2 E1* B̄/(3 Ra),  A* = B̄²/Ra,  B̄ = 1/sqrt(pi Nbar),
    q = cos³θ/(θ + sinθ cosθ),  g = cos²θ - (4/3) q sinθ,  λ = cos²θ,

so one curve g(q) serves every Nbar, Ra and E1*. The code uses y = cot θ = b/sqrt(B̄² - b²) in (0, ∞), from which
cos, sin and θ all follow without cancellation, from isolated spots (y → 0: q ~ (2/π) y³, g ~ y²) to full contact (y
→ ∞: q ~ y/2, g → 1/3).

A :class:`Law` is what the solver needs of a micro law: p and A as functions of one unknown y in which both are
smooth and increasing and A ~ y² at the edge of the contact.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np


class Curve(NamedTuple):
    """One evaluation of a law: q = p/p*, g = A/A* and their derivatives by y; arrays of the shape of y."""

    q: np.ndarray
    g: np.ndarray
    dq: np.ndarray
    dg: np.ndarray


class Law(NamedTuple):
    """A micro law on a batch.

    evaluate(y, exponent) -> :class:`Curve`;  guess(q, exponent) -> y with q(y) = q within 1 %;
    from_pressure(q, exponent) -> y with q(y) = q;  from_displacement(g, exponent) -> y with g(y) = g;
    power(exponent) -> (gamma, beta) with g ~ gamma q^beta for small q, and sparse(g, exponent) -> q, its inverse;
    limit(new, old) -> y, what a step may do;  spot(y, q) -> y = cot θ of the exact law, q = p over p* of the exact law.
    """

    evaluate: Callable
    guess: Callable
    from_pressure: Callable
    from_displacement: Callable
    power: Callable
    sparse: Callable
    limit: Callable
    spot: Callable


def _within_factor(new, old):
    """y stays positive and changes by no more than a factor of five in a step."""
    return np.clip(new, 0.2 * old, 5.0 * old)


# ---- the exact law of the paper, Eqs (6), (7), (11), (13)
# ---------------------------------------------------------------


def angle(y):
    """sin θ, cos θ and θ = arccos(b/B̄) of y = cot θ, all to full relative accuracy. Any shape."""
    sin = 1 / np.sqrt(1 + y * y)
    return sin, y * sin, np.arctan2(1.0, y)


def spot_curve(y):
    """q(y), g(y) of Eqs (7) and (6) and their derivatives; y = cot θ > 0 of any shape."""
    y = np.asarray(y, dtype=float)
    sin2 = 1 / (1 + y * y)
    sin = np.sqrt(sin2)
    cos, theta = y * sin, np.arctan(1 / y)  # three times as fast as arctan2
    cos2, sc = cos * cos, sin * cos
    inverse = 1 / (theta + sc)
    slope = cos2 * inverse
    q = slope * cos
    # d(q sinθ)/dθ with the cancelling terms taken out by hand; what is left needs θ - sinθ cosθ
    d_q_sin = slope * inverse * ((cos2 - 3 * sin2) * _theta_minus_sc(theta, sc) - 6 * sin2 * sc)
    return Curve(
        q,
        cos2 - (4 / 3) * q * sin,
        sin2 * slope * (3 * sin + 2 * q),
        sin2 * (2 * sc + (4 / 3) * d_q_sin),
    )


def _theta_minus_sc(theta, sc):
    """θ - sinθ cosθ, by its series where the difference would cancel."""
    difference, small = np.asarray(theta - sc), theta < 0.3
    if small.any():
        t = theta[small]
        z2 = 4 * t * t
        difference[small] = t * z2 / 6 * (1 - z2 / 20 * (1 - z2 / 42 * (1 - z2 / 72 * (1 - z2 / 110 * (1 - z2 / 156)))))
    return difference


def spot_from_pressure(q):
    """y = cot θ with q(y) = q: the inverse of Eq. (7), to a few units of rounding for any q > 0; q = 0 gives 0, NaN
    stays NaN."""
    q = np.asarray(q, dtype=float)
    positive = q > 0
    target = np.where(positive, q, 1.0)
    y = _spot_guess(target)
    for _ in range(3):  # Newton on ln q against ln y, whose slope runs from 3 to 1
        curve = spot_curve(y)
        y = y * np.exp(-(curve.q - target) / (curve.dq * y) * _log_ratio(curve.q / target))
    return np.where(positive, y, np.where(np.isnan(q), np.nan, 0.0))


def _log_ratio(r):
    """ln r/(r - 1), 1 at r = 1: turns the difference of two values into that of their logarithms, over the first
    one."""
    d = r - 1
    small = np.abs(d) < 1e-5
    safe = np.where(small, 1.0, d)
    return np.where(small, 1 - d / 2, np.log1p(safe) / safe) * r


def _spot_guess(q):
    """y with q(y) = q within 1 %: the root of y³ = q (2 y² + π/2), which has both ends of Eq. (7)."""
    m, kappa = np.minimum(2 / 3 * q, 1e100), np.minimum(np.pi / 4 * q, 1e200)  # of larger q the cubes overflow
    m2 = m * m
    m3 = m2 * m
    t = np.cbrt(m3 + kappa + np.sqrt(kappa) * np.sqrt(2 * m3 + kappa))
    return np.maximum(m + t + m2 / np.maximum(t, 1e-300), 2 * q)


def spot_from_displacement(g):
    """y = cot θ with g(y) = g: the inverse of Eq. (6). g <= 0 gives 0; g >= 1/3 (beyond full contact) gives NaN."""
    g = np.asarray(g, dtype=float)
    inside = (g > 0) & (g < 1 / 3)
    target = np.where(inside, g, 0.1)
    odds = np.log(target / (1 - 3 * target))  # ~ 2 ln y at both ends
    y = np.sqrt(target / (1 - 3 * target))
    for _ in range(8):
        curve = spot_curve(y)
        rest = np.maximum(1 - 3 * curve.g, 1e-300)
        slope = curve.dg * y / (curve.g * rest)
        y = y * np.exp(np.clip(-(np.log(curve.g / rest) - odds) / slope, -2, 2))
    return np.where(inside, y, np.where(g <= 0, 0.0, np.nan))


disc_cell = Law(
    evaluate=lambda y, exponent: spot_curve(y),
    guess=lambda q, exponent: _spot_guess(q),
    from_pressure=lambda q, exponent: spot_from_pressure(q),
    from_displacement=lambda g, exponent: spot_from_displacement(g),
    power=lambda exponent: ((np.pi / 2) ** (2 / 3) * np.ones_like(exponent), 2 / 3 * np.ones_like(exponent)),
    sparse=lambda g, exponent: 2 / np.pi * g * np.sqrt(g),
    limit=_within_factor,
    spot=lambda y, q: y,
)


# ---- the fit A = B p^β of the paper, Section 4.1
# ------------------------------------------------------------------------


def _power_curve(y, exponent):
    inverse = (2 / exponent)[:, None]
    q = y**inverse
    return Curve(q, y * y, inverse * q / y, 2 * y)


power_law = Law(
    evaluate=_power_curve,
    guess=lambda q, exponent: q ** (exponent[:, None] / 2),
    from_pressure=lambda q, exponent: q ** (exponent[:, None] / 2),
    from_displacement=lambda g, exponent: np.sqrt(np.maximum(g, 0.0)),
    power=lambda exponent: (np.ones_like(exponent), exponent),
    sparse=lambda g, exponent: g ** (1 / exponent[:, None]),
    limit=_within_factor,
    spot=lambda y, q: spot_from_pressure(q),
)


# ---- no roughness: A = 0, the equation is linear in y = q
# --------------------------------------------------------------

smooth = Law(
    evaluate=lambda y, exponent: Curve(y, np.zeros_like(y), np.ones_like(y), np.zeros_like(y)),
    guess=lambda q, exponent: q,
    from_pressure=lambda q, exponent: q,
    from_displacement=lambda g, exponent: np.full_like(g, np.nan),
    power=lambda exponent: (np.ones_like(exponent), np.ones_like(exponent)),
    sparse=lambda g, exponent: g,
    limit=lambda new, old: new,
    spot=lambda y, q: np.full_like(y, np.inf),
)

LAWS = {"smooth": smooth, "disc_cell": disc_cell, "power_law": power_law}
MICROS = tuple(LAWS)


# ---- physical quantities at a given pressure
# ----------------------------------------------------------------------------


def cell_radius(Nbar):
    """B̄ = 1/sqrt(pi Nbar), the radius of the cell of one asperity, in R. Nbar in R⁻²."""
    return 1 / np.sqrt(np.pi * Nbar)


def scales(E, Nbar, Ra):
    """p* = 2 E1* B̄/(3 Ra) (unit of E) and A* = B̄²/Ra (unit of Ra) of the exact law."""
    radius = cell_radius(Nbar)
    return 2 * E * radius / (3 * Ra), radius**2 / Ra


def displacement(p, E, Nbar, Ra):
    """Additional displacement A[p] of the asperities, Eq. (6) with (7).

    Parameters
    ----------
    p : array, unit of E
        Nominal pressure, >= 0.
    E, Nbar, Ra : array or float
        E1* (E2* without a layer), asperities per unit area and asperity radius, all > 0.

    Returns
    -------
    array, unit of Ra
        Relative accuracy 1e-13 from isolated spots to full contact, where it tends to B̄²/(3 Ra).

    Examples
    --------
    >>> round(float(displacement(0.01, 0.5, 250000, 0.004)), 9)
    5.375e-05
    """
    p_star, A_star = scales(E, Nbar, Ra)
    y = spot_from_pressure(p / p_star)
    return A_star * np.where(y > 0, spot_curve(np.where(y > 0, y, 1.0)).g, y)


def contact_fraction(p, E, Nbar, Ra):
    """Relative contact area λ = (b/B̄)², Eqs (11) and (7), in [0, 1). Arguments as in :func:`displacement`."""
    _, cos, _ = angle(spot_from_pressure(p / scales(E, Nbar, Ra)[0]))
    return cos**2


def largest_pressure(p, E, Nbar, Ra):
    """Pressure in the middle of a spot, Eq. (13): 2 E1* b/(pi Ra) + (2 p/pi) arcsin(b/B̄), in the unit of E.

    Arguments as in :func:`displacement`.
    """
    p_star, _ = scales(E, Nbar, Ra)
    y = spot_from_pressure(p / p_star)
    _, cos, theta = angle(y)
    # 2 E1* b/(pi Ra) = (3 p*/pi) cosθ; arcsin(cosθ) = π/2 - θ = arctan y
    return 3 / np.pi * p_star * cos + 2 / np.pi * p * np.arctan(y)

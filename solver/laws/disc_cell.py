"""The micro law of the paper: identical spherical asperities, each in the middle of a disc-shaped cell, Eqs (6), (7).

Both equations become explicit in the angle θ = arccos(b/B̄), where b is the radius of a spot and B̄ = 1/sqrt(pi Nbar)
that of the cell. With p = p* q and A = A* g,

    p* = 2 E B̄/(3 Ra),  A* = B̄²/Ra,  q = cos³θ/(θ + sinθ cosθ),  g = cos²θ - (4/3) q sinθ,  λ = cos²θ,

so one curve g(q) serves every Nbar, Ra and E. The unknown is y = cot θ = b/sqrt(B̄² - b²), from which cos, sin and θ
all follow without cancellation, from isolated spots (y → 0: q ~ (2/π) y³, g ~ y²) to full contact (y → ∞: q ~ y/2,
g → 1/3).
"""

from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from ..parameters import Parameter
from .cell.cell_law import EDGE, of_spots
from .law import Curve, Law, inverse, log_step, where_positive

__all__ = ["LAW", "PARAMETERS", "SMOOTH", "contact_fraction", "displacement", "largest_pressure"]

#: Asperities per unit area, in R⁻², and their radius, in R.
PARAMETERS = {
    "Nbar": Parameter(interval="[1e-4, 1e18]", powers=(0, -2)),
    "Ra": Parameter(interval="[1e-9, 1e2]", powers=(0, 1)),
}


def scales(E, Nbar, Ra):
    """p* = 2 E B̄/(3 Ra), in the unit of E, and A* = B̄²/Ra, in the unit of Ra."""
    radius = 1 / np.sqrt(np.pi * Nbar)  # B̄
    return 2 * E * radius / (3 * Ra), radius**2 / Ra


def spot_curve(y):
    """q(y) of Eq. (7), g(y) of Eq. (6), and their derivatives; y = cot θ > 0 has any shape."""
    y = np.asarray(y, dtype=float)
    q, dq, sin, sin2, cos2, theta, sc, slope = _pressure(y)
    # d(q sinθ)/dθ, written so that nothing cancels except in θ - sinθ cosθ, which has a series
    d_q_sin = slope / (theta + sc) * ((cos2 - 3 * sin2) * _theta_minus_sc(theta, sc) - 6 * sin2 * sc)
    return Curve(q, cos2 - (4 / 3) * q * sin, dq, sin2 * (2 * sc + (4 / 3) * d_q_sin))


def _pressure(y):
    """q(y), dq/dy, sinθ, sin²θ, cos²θ, θ, sinθ cosθ, and cos²θ/(θ + sinθ cosθ)."""
    sin2 = 1 / (1 + y * y)
    sin = np.sqrt(sin2)
    cos, theta = y * sin, np.arctan(1 / y)
    cos2, sc = cos * cos, sin * cos
    slope = cos2 / (theta + sc)
    q = slope * cos
    return q, sin2 * slope * (3 * sin + 2 * q), sin, sin2, cos2, theta, sc, slope


def _theta_minus_sc(theta, sc):
    """θ - sinθ cosθ; a series where the two terms would cancel."""
    difference, small = np.asarray(theta - sc), theta < 0.3
    if small.any():
        t = theta[small]
        z2 = 4 * t * t
        difference[small] = t * z2 / 6 * (1 - z2 / 20 * (1 - z2 / 42 * (1 - z2 / 72 * (1 - z2 / 110 * (1 - z2 / 156)))))
    return difference


def spot_area(y):
    """λ = (b/B̄)² = cos²θ, Eq. (11)."""
    return 1 / (1 + y**-2.0)


def spot_peak(y, q):
    """p_max/p*, Eq. (13): 2 E b/(pi Ra) + (2 p/pi) arcsin(b/B̄), where arcsin(cosθ) = π/2 - θ = arctan y."""
    return 3 / np.pi / np.sqrt(1 + y**-2.0) + 2 / np.pi * q * np.arctan(y)


def spot_guess(q):
    """y with q(y) = q, right to 1 %: the root of y³ = q (2 y² + π/2), to which Eq. (7) tends for small and for large
    y."""
    m, kappa = np.minimum(2 / 3 * q, 1e100), np.minimum(np.pi / 4 * q, 1e200)  # for larger q the cubes would overflow
    m2 = m * m
    m3 = m2 * m
    t = np.cbrt(m3 + kappa + np.sqrt(kappa) * np.sqrt(2 * m3 + kappa))
    return np.maximum(m + t + m2 / np.maximum(t, 1e-300), 2 * q)


def spot_from_pressure(q):
    """y = cot θ with q(y) = q: the inverse of Eq. (7), to a few units of rounding for any q > 0; q <= 0 gives 0."""
    q = np.asarray(q, dtype=float)
    target = np.where(q > 0, q, 1.0)
    y = spot_guess(target)
    for _ in range(3):  # d ln q/d ln y is between 1 and 3: three steps are enough from a guess right to 1 %
        y = y * np.exp(log_step(lambda y: _pressure(y)[:2], target, y))
    return where_positive(q, y)


def _odds(curve):
    """The odds g/(1 - 3 g), which tend to y² for small and for large y, and their derivative by y."""
    rest = np.maximum(1 - 3 * curve.g, 1e-300)
    return curve.g / rest, curve.dg / rest**2


def spot_from_displacement(g):
    """y = cot θ with g(y) = g: the inverse of Eq. (6). g <= 0 gives 0; g >= 1/3 (beyond full contact) gives NaN."""
    g = np.asarray(g, dtype=float)
    odds = np.where(g < 1 / 3, g, np.nan) / (1 - 3 * g)
    start = np.sqrt(np.maximum(odds, 0.0)) * np.interp(odds, *_near())
    return inverse(lambda y: _odds(spot_curve(y)), odds, start)


@cache
def _near():
    """A table (2, 200): the odds, ascending, and y over their square root. y interpolated in it is right to 0.5 %."""
    y = np.geomspace(1e-2, 1e2, 200)
    odds, _ = _odds(spot_curve(y))
    return odds, y / np.sqrt(odds)


LAW = Law(
    name="disc_cell",
    parameters=PARAMETERS,
    scales=scales,
    curve=spot_curve,
    area=lambda y, q: spot_area(y),
    peak=spot_peak,
    edge=lambda: EDGE,
    rise=1.1,
    from_pressure=spot_from_pressure,
    from_displacement=spot_from_displacement,
    guess=spot_guess,
    on_body=of_spots("disc_cell", "disc", scales, parameters=PARAMETERS, rise=1.1),
    cell="disc",
)

#: No asperities: A = 0, and the equation is linear in y = q, with p* = E.
SMOOTH = Law(
    name="smooth",
    scales=lambda E: (E, 0.0),
    curve=lambda y: Curve(y, np.zeros_like(y), np.ones_like(y), np.zeros_like(y)),
    area=lambda y, q: np.ones_like(y),
    peak=lambda y, q: q,
    edge=lambda: (1.0, 1.0),
    rough=False,
    from_pressure=lambda q: q,
)


def displacement(p: ArrayLike, E: ArrayLike, Nbar: ArrayLike, Ra: ArrayLike) -> np.ndarray:
    """Additional displacement A[p] of the asperities, Eq. (6) with (7).

    Its relative accuracy is 1e-13 from isolated spots to full contact, where it tends to B̄²/(3 Ra).

    Parameters
    ----------
    p : nominal pressure >= 0, in the unit of E
    E, Nbar, Ra : modulus that the asperities feel (docs/model.md), their number on the unit area, their radius; all > 0

    Returns
    -------
    numpy.ndarray : in the unit of Ra; the arguments broadcast

    Examples
    --------
    >>> round(float(displacement(0.01, 0.5, 250000, 0.004)), 9)
    5.375e-05
    """
    return LAW.at(p, E, Nbar=Nbar, Ra=Ra).A


def contact_fraction(p: ArrayLike, E: ArrayLike, Nbar: ArrayLike, Ra: ArrayLike) -> np.ndarray:
    """Relative contact area λ, Eqs (11) and (7).

    Parameters
    ----------
    p : nominal pressure >= 0, in the unit of E
    E, Nbar, Ra : modulus that the asperities feel (docs/model.md), their number on the unit area, their radius; all > 0

    Returns
    -------
    numpy.ndarray : in [0, 1); the arguments broadcast

    Examples
    --------
    >>> round(float(contact_fraction(0.01, 0.5, 250000, 0.004)), 6)
    0.288467
    """
    return LAW.at(p, E, Nbar=Nbar, Ra=Ra).lam


def largest_pressure(p: ArrayLike, E: ArrayLike, Nbar: ArrayLike, Ra: ArrayLike) -> np.ndarray:
    """Pressure in the middle of a spot, Eq. (13).

    Parameters
    ----------
    p : nominal pressure >= 0, in the unit of E
    E, Nbar, Ra : modulus that the asperities feel (docs/model.md), their number on the unit area, their radius; all > 0

    Returns
    -------
    numpy.ndarray : in the unit of E; the arguments broadcast

    Examples
    --------
    >>> round(float(largest_pressure(0.01, 0.5, 250000, 0.004)), 6)
    0.051837
    """
    return LAW.at(p, E, Nbar=Nbar, Ra=Ra).p_max

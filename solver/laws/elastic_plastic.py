"""The micro law of identical asperities that yield: the disc cell, with spots that flow beyond their elastic limit.

A spot of radius b is elastic until the peak of its Hertz pressure is q(ν) Y, of :func:`..closed_forms.yield_pressure`.
With x = 4 E b/(3 pi Ra H), the mean Hertz pressure over the hardness H, that is at x_y = (2/3) q(ν) Y/H. Beyond, with
τ = max(x - x_y, 0)/(1 - x_y),

    mean pressure of the spot   p_s = H (x - x_y²)/(x + 1 - 2 x_y), which is H x before, and tends to H,
    approach                    δ = (b²/Ra)/(1 + χ), χ = τ²/(τ² + 2.5 τ + 2): b² grows from Ra δ to 2 Ra δ,
    peak of the spot            p_s (1 + 0.5/(1 + τ)), from 3/2 p_s to p_s.

The neighbours of a spot act on it as in :mod:`.disc_cell`, with y = cot θ as there. So with t = b/B̄ = cosθ,
X = 2 p*/(pi H), x = X t and f = p_s/(H x),

    q = f cos³θ/(θ + sinθ cosθ),  g = t²/(1 + χ) - (4/3) q sinθ,  λ = t²,
    p_max/p* = (2 t/pi) f (1 + 0.5/(1 + τ)) + (2 q/pi) arcsin t.

Where nothing yields all numbers are those of the disc cell to the last bit. The law holds while the load rises.
"""

from typing import NamedTuple

import numpy as np

from ..closed_forms import yield_pressure
from ..parameters import Parameter
from . import disc_cell
from .law import Curve, Law, inverse

#: Hardness over yield strength, where only one of both is given (Jackson and Green, J. Tribol. 127, 2005, 343).
TABOR = 2.84
#: Bounds of x_y. Above 1/2 the peak of a spot would fall while its load rises; below 1/5 the hardness is more than five
#: times the yield strength, which no metal has.
X_Y = (0.2, 0.5)
#: Spots whose mean pressure is below this part of Hertz's have their first guess from a law of their own. It is low, so
#: that a contact that stays elastic begins as that of the disc cell does.
_FLOWING = 0.5


def _scales(E, Nbar, Ra, hardness, yield_strength, nu):
    """p*, A* of the disc cell; X and x_y."""
    p_star, A_star = disc_cell.scales(E, Nbar, Ra)
    hardness, x_y = _strengths(hardness, yield_strength, nu)
    return p_star, A_star, 2 * p_star / (np.pi * hardness), x_y


def _strengths(hardness, yield_strength, nu):
    """The hardness, and x_y; of hardness and yield strength one may be NaN."""
    hardness, Y = (
        np.where(np.isnan(hardness), TABOR * yield_strength, hardness),
        np.where(np.isnan(yield_strength), hardness / TABOR, yield_strength),
    )
    return hardness, (2 / 3) * yield_pressure(nu) * Y / hardness


def _allows(hardness, yield_strength, nu, **_):
    """(B,) bool: x_y is within its bounds."""
    _, x_y = _strengths(hardness, yield_strength, nu)
    return (x_y >= X_Y[0]) & (x_y <= X_Y[1])


class Spot(NamedTuple):
    """x and τ of a spot; f, its derivative by x, and 1 - f without cancellation: 1, 0, 0 where it is elastic."""

    x: np.ndarray
    tau: np.ndarray
    f: np.ndarray
    slope: np.ndarray
    lost: np.ndarray


def _spot(y, X, x_y):
    x = X / np.sqrt(1 + y**-2.0)
    above = np.maximum(x - x_y, 0.0)
    tau, denominator = above / (1 - x_y), x * (x + 1 - 2 * x_y)
    f = np.where(above > 0, (x - x_y**2) / denominator, 1.0)
    return Spot(x, tau, f, ((1 + tau) ** -2.0 - f) / x, above**2 / denominator)


def _curve(y, X, x_y):
    """That of the disc cell, and what yielding adds: exactly nothing where a spot is elastic."""
    elastic, (_, tau, f, slope, lost) = disc_cell.spot_curve(y), _spot(y, X, x_y)
    sin = 1 / np.sqrt(1 + y * y)
    t, dx = y * sin, X * sin**3
    N = tau**2 + 2.5 * tau + 2
    chi, d_chi = tau**2 / N, (2.5 * tau**2 + 4 * tau) / N**2 / (1 - x_y) * dx
    relief, d_relief = 4 / 3 * elastic.q * lost * sin, elastic.dq * lost - elastic.q * (slope * dx + lost * y * sin**2)
    g = elastic.g + (relief - t * t * chi / (1 + chi))
    dg = 4 / 3 * sin * d_relief - (2 * t * sin**3 * chi + t * t * d_chi / (1 + chi)) / (1 + chi)
    return Curve(f * elastic.q, g, f * elastic.dq + elastic.q * slope * dx, elastic.dg + dg)


def _peak(y, q, X, x_y):
    spot = _spot(y, X, x_y)
    flowing = spot.x / X * (2 / np.pi) * spot.f * (1 + 0.5 / (1 + spot.tau)) + 2 / np.pi * q * np.arctan(y)
    return np.where(spot.tau > 0, flowing, disc_cell.spot_peak(y, q))


def _guess(q, X, x_y):
    """That of the disc cell; where the spots flow, the sum of two roots of q without the elastic part: at small and at
    large y."""
    y = disc_cell.spot_guess(q)
    return np.where(_spot(y, X, x_y).f < _FLOWING, np.maximum(y, np.sqrt(np.pi / 2 * X * q) + 2 * X * q), y)


def _from_pressure(q, X, x_y):
    elastic = disc_cell.spot_from_pressure(q)
    yields = _spot(elastic, X, x_y).tau > 0
    if not yields.any():
        return elastic
    return np.where(yields, inverse(lambda y: _curve(y, X, x_y)[0::2], q, _guess(np.maximum(q, 0.0), X, x_y)), elastic)


def _yielded(X, x_y):
    """λ at which the spots begin to yield, above 1 where none does."""
    return (x_y / X) ** 2


#: Of the softer of asperity and what it presses on.
_STRENGTH = Parameter(interval="[1e-15, 1e15]", powers=(1, 0), instead="")
LAW = Law(
    name="elastic_plastic",
    parameters=disc_cell.PARAMETERS
    | {"hardness": _STRENGTH._replace(instead="yield_strength"), "yield_strength": _STRENGTH},
    scales=_scales,
    curve=_curve,
    area=lambda y, q, X, x_y: disc_cell.spot_area(y),
    peak=_peak,
    edge=lambda X, x_y: disc_cell.LAW.edge(),
    poisson=True,
    allows=_allows,
    yielded=_yielded,
    rise=disc_cell.LAW.rise,
    from_pressure=_from_pressure,
    guess=_guess,
)

"""The micro law of identical asperities that yield: the disc cell, with spots that flow beyond their elastic limit.

A spot of radius b is elastic until the peak of its Hertz pressure is q(ν) Y (:func:`..closed_forms.yield_pressure`).
Let x = 4 E b/(3 pi Ra H) be the mean Hertz pressure over the hardness H. The limit is at x_y = (2/3) q(ν) Y/H. Above
it, with τ = max(x - x_y, 0)/(1 - x_y),

    mean pressure of the spot   p_s = H (x - x_y²)/(x + 1 - 2 x_y), which is H x at the limit, and tends to H,
    approach                    δ = (b²/Ra)/(1 + χ), χ = τ²/(τ² + 2.5 τ + 2): b² grows from Ra δ to 2 Ra δ,
    peak of the spot            p_s (1 + 0.5/(1 + τ)), which falls from 3/2 p_s to p_s.

The neighbours of a spot act on it as in :mod:`.disc_cell`, with y = cot θ as there. So with t = b/B̄ = cosθ,
X = 2 p*/(pi H), x = X t and f = p_s/(H x),

    q = f cos³θ/(θ + sinθ cosθ),  g = t²/(1 + χ) - (4/3) q sinθ,  λ = t²,
    p_max/p* = (2 t/pi) f (1 + 0.5/(1 + τ)) + (2 q/pi) arcsin t.

Where nothing yields, all numbers are those of the disc cell to the last bit. The law holds while the load rises.

On the coated body itself (:mod:`.cell.cell_law`) the q_e and g_e of elastic spots at t = y are those of the disc cell's
family, and x is the mean pressure of the elastic spot there, x = X y exp(P - P0). P0 is that of a half-space,

    exp(P0) = (π/2)/(arccos t + t sqrt(1 - t²)).

Under a hard film on a soft body this mean falls where the film bends over its asperities (b/h above 1.2). A spot that
has flowed does not become elastic again: x is the largest mean up to this radius. The part of the approach that comes
from the neighbours and the body below is elastic, and is reduced by the factor f as the load is. The pressure in the
middle tends from the elastic one to the mean of the spot, M = (2/π) x/X:

    q = f q_e,   g = t²/(1 + χ) - f (t² - g_e),   p_max/p* = f (M + (S - M)/(1 + τ)) + N,
    N = (2 q/π) arcsin t, S = p_max,e/p* - (2 q_e/π) arcsin t.
"""

from typing import NamedTuple

import numpy as np

from ..closed_forms import yield_pressure
from ..parameters import Parameter
from . import disc_cell
from .cell import cell_law as cell
from .cell.family import half_space
from .law import Bound, Curve, Law, inverse

#: Hardness over yield strength, used if a case has only one of them (Jackson and Green, J. Tribol. 127, 2005, 343).
TABOR = 2.84
#: Bounds of x_y. Above 1/2 the peak of a spot would fall while its load rises; below 1/5 the hardness is more than five
#: times the yield strength, which no metal has.
X_Y = (0.2, 0.5)
#: Spots whose mean pressure is below this part of Hertz's have a first guess of their own. It is so low that a contact
#: that stays elastic begins like one of the disc cell.
_FLOWING = 0.5


def _scales(E, Nbar, Ra, hardness, yield_strength, nu):
    """p* and A* of the disc cell, X, and x_y."""
    p_star, A_star = disc_cell.scales(E, Nbar, Ra)
    hardness, x_y = _strengths(hardness, yield_strength, nu)
    return p_star, A_star, 2 * p_star / (np.pi * hardness), x_y


def _strengths(hardness, yield_strength, nu):
    """The hardness, and x_y. Either the hardness or the yield strength may be NaN."""
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
    """x and τ of a spot; f; `slope`, df/dx; and `lost`, 1 - f without cancellation. The last three are 1, 0, 0 where
    the spot is elastic."""

    x: np.ndarray
    tau: np.ndarray
    f: np.ndarray
    slope: np.ndarray
    lost: np.ndarray


def _spot(y, X, x_y):
    return _flow(X / np.sqrt(1 + y**-2.0), x_y)


def _flow(x, x_y):
    """:class:`Spot` at x."""
    above = np.maximum(x - x_y, 0.0)
    tau, denominator = above / (1 - x_y), x * (x + 1 - 2 * x_y)
    f = np.where(above > 0, (x - x_y**2) / denominator, 1.0)
    return Spot(x, tau, f, ((1 + tau) ** -2.0 - f) / x, above**2 / denominator)


def _curve(y, X, x_y):
    """The curve of the disc cell plus the changes by yielding, which are exactly 0 where a spot is elastic."""
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
    """The guess of the disc cell. Where the spots flow it is a sum of two terms: y as it is at small and at large q for
    spots without elasticity."""
    y = disc_cell.spot_guess(q)
    return np.where(_spot(y, X, x_y).f < _FLOWING, np.maximum(y, np.sqrt(np.pi / 2 * X * q) + 2 * X * q), y)


def _from_pressure(q, X, x_y):
    elastic = disc_cell.spot_from_pressure(q)
    yields = _spot(elastic, X, x_y).tau > 0
    if not yields.any():
        return elastic
    return np.where(yields, inverse(lambda y: _curve(y, X, x_y)[0::2], q, _guess(np.maximum(q, 0.0), X, x_y)), elastic)


def _yielded(X, x_y):
    """λ at which the spots begin to yield; above 1 where they never do."""
    return (x_y / X) ** 2


def _on_body(kernel, m, h, E, Nbar, Ra, **strengths):
    """:class:`~solver.laws.law.Bound` of spots on the coated body. Its `own` are the rows of the families of the disc
    cell, X, x_y, and the λ at which spots begin to yield."""
    p_star, A_star, X, x_y = _scales(E, Nbar, Ra, **strengths)
    rows = cell.rows_of("disc", kernel, m, h, Nbar)
    X, x_y = (np.asarray(v * np.ones(np.shape(E)))[:, None] for v in (X, x_y))

    def pressure(y):
        x, slope = _mean(y, rows, X)
        return x, slope * x / y

    with np.errstate(all="ignore"):
        first = inverse(pressure, x_y * np.ones_like(X), x_y / X)
    return Bound(_ON_BODY, p_star, A_star, (rows, X, x_y, np.where(np.isnan(first), np.inf, first**2)))


def _mean(y, rows, X):
    """x, the mean pressure of elastic spots over the hardness, and d ln x/d ln y. x never falls with y."""
    P, dP = cell.exponent(rows, 0, y)
    t = np.minimum(y, cell.number(rows, "end"))
    ratio, slope = half_space(t)
    x = X * y * np.exp(P - slope * np.log(y / t)) / ratio  # beyond the end of the family it is a power of y
    top = np.where(y > cell.number(rows, "turn"), X * cell.number(rows, "top"), 0.0)
    return np.maximum(x, top), np.where(x < top, 0.0, 1 + dP - slope)


def _body_curve(y, rows, X, x_y, yields):
    elastic, (x, slope) = cell.spot_curve(y, rows), _mean(y, rows, X)
    _, tau, f, by_x, lost = _flow(x, x_y)
    dx = slope * x / y
    N = tau**2 + 2.5 * tau + 2
    chi, d_chi = tau**2 / N, (2.5 * tau**2 + 4 * tau) / N**2 / (1 - x_y) * dx
    less, d_less = y * y - elastic.g, 2 * y - elastic.dg
    g = elastic.g + (lost * less - y * y * chi / (1 + chi))
    dg = elastic.dg + (lost * d_less - by_x * dx * less - (2 * y * chi + y * y * d_chi / (1 + chi)) / (1 + chi))
    return Curve(f * elastic.q, g, f * elastic.dq + elastic.q * by_x * dx, dg)


def _body_peak(y, q, rows, X, x_y, yields):
    x, _ = _mean(y, rows, X)
    _, tau, f, _, _ = _flow(x, x_y)
    neighbours, mean = 2 / np.pi * q * np.arcsin(np.minimum(y, 1.0)), f * (2 / np.pi) * x / X
    spot = f * cell.spot_peak(y, q, rows) - neighbours
    return neighbours + mean + (spot - mean) / (1 + tau)


def in_the_middle(y, rows, X, x_y, yields):
    """The elastic p_max/p* (B,) of spots on the body at y (B, 1), and the factor (B,) by which yielding reduces the
    differences of pressure within a spot."""
    _, tau, f, _, _ = _flow(_mean(y, rows, X)[0], x_y)
    return cell.spot_peak(y, None, rows)[:, 0], (f / (1 + tau))[:, 0]


def _body_guess(q, rows, X, x_y, yields):
    """As :func:`_guess`: flowing spots obey the same law on any body."""
    y, flows = cell.spot_guess(q, rows), np.sqrt(np.pi / 2 * X * q) + 2 * X * q
    f = _flow(_mean(y, rows, X)[0], x_y).f
    return np.where(f < _FLOWING, np.maximum(y, flows / np.hypot(1, flows)), y)


def _body_from_pressure(q, *own):
    elastic = cell.spot_from_pressure(q, own[0])
    if not (elastic**2 > own[3]).any():
        return elastic
    start = _body_guess(np.maximum(q, 0.0), *own)
    return np.where(elastic**2 > own[3], inverse(lambda y: _body_curve(y, *own)[0::2], q, start), elastic)


def _body_end(*own):
    return np.minimum(_body_curve(cell.number(own[0], "end"), *own).q, cell.number(own[0], "most"))


#: The strength of the softer body, the asperity or the one that it presses on.
_STRENGTH = Parameter(interval="[1e-15, 1e15]", powers=(1, 0), instead="")
_REST = {
    "parameters": disc_cell.PARAMETERS
    | {"hardness": _STRENGTH._replace(instead="yield_strength"), "yield_strength": _STRENGTH},
    "scales": _scales,
    "poisson": True,
    "allows": _allows,
    "rise": disc_cell.LAW.rise,
}
_ON_BODY = Law(
    name="elastic_plastic_on_body",
    curve=_body_curve,
    area=lambda y, q, *own: cell.spot_area(y, q, own[0]),
    peak=_body_peak,
    edge=lambda *own: cell.EDGE,
    yielded=lambda rows, X, x_y, yields: yields,
    from_pressure=_body_from_pressure,
    guess=_body_guess,
    end=_body_end,
    **_REST,
)
LAW = Law(
    name="elastic_plastic",
    curve=_curve,
    area=lambda y, q, X, x_y: disc_cell.spot_area(y),
    peak=_peak,
    edge=lambda X, x_y: disc_cell.LAW.edge(),
    yielded=_yielded,
    from_pressure=_from_pressure,
    guess=_guess,
    on_body=_on_body,
    cell="disc",
    **_REST,
)

"""The micro laws of equal asperities on the coated body itself: docs/coated_body.md.

The unknown is y = b/Bbar, the radius of a spot over that of a disc with the area of the cell, Bbar = 1/sqrt(pi Nbar).
With P, G and Q of the family of a case (:mod:`.family`), and p* = 2 E Bbar/(3 Ra), A* = Bbar²/Ra as in the disc cell,

    q = (2/pi) y³ e^P,   g = y² e^G,   λ = y²,   p_max/p* = (3/pi) y e^Q.

P, G and Q end where the spots are no longer circles. Beyond the end they soon become straight lines in ln y, so that
Newton's method converges. Such a contact is outside the law, whose largest pressure :func:`end` returns.
"""

from functools import partial

import numpy as np

from ..law import Bound, Curve, Law, log_step, where_positive
from .family import GUESS, NUMBERS, families
from .summits import clenshaw

__all__ = [
    *("EDGE", "end", "exponent", "number", "of_spots", "rows_of", "settled_slope", "stacked"),
    *("spot_area", "spot_curve", "spot_from_pressure", "spot_guess", "spot_peak"),
]

_AT = {name: i for i, name in enumerate(NUMBERS)}
#: Newton steps from the guess, which is right to 1e-2 or better: the third step is below rounding.
_STEPS = 3
#: Length of a row if there are no cases: any number does.
_ANY = 64
#: gamma and beta of g ~ gamma q^beta: small spots are isolated ones, with q = (2/pi) y³ and g = y².
EDGE = (np.pi / 2) ** (2 / 3), 2 / 3


def rows_of(lattice, kernel, m, h, Nbar):
    """The numbers (B, K) of the families of B cases, :meth:`.family.Family.row`, which are `rows` in the functions
    below.

    lattice : "square", "hex" or "disc"; kernel, m, h : of the body, as in `on_body` of :class:`~solver.laws.law.Law`
    """
    with np.errstate(all="ignore"):
        members, index = families(lattice, 1 / (h * np.sqrt(Nbar)), kernel, m)
    return stacked(members, index)


def stacked(members, index):
    """The rows (B, K) of B cases from their families or summits, `members`, by the `index` (B,) of each case. All have
    the length of the longest. If there is only one member, they are a view of one row."""
    if not members:
        return np.zeros((0, _ANY))
    terms = max(member.terms for member in members)
    rows = np.array([member.row(terms) for member in members])
    return rows[index] if len(members) > 1 else np.broadcast_to(rows, (len(index), rows.shape[1]))


def of_spots(name, lattice, scales, **rest):
    """`on_body` of the :class:`~solver.laws.law.Law` of this name, for equal asperities on a lattice. `scales` and
    `rest` are those of the law."""
    parts = {"curve": spot_curve, "area": spot_area, "peak": spot_peak, "edge": _edge, "guess": spot_guess, "end": _end}
    law = Law(name=f"{name}_on_body", scales=scales, from_pressure=spot_from_pressure, **parts, **rest)
    return partial(_bound, law, lattice)


def _bound(law, lattice, kernel, m, h, E, Nbar, Ra):
    return Bound(law, *law.scales(E, Nbar, Ra), (rows_of(lattice, kernel, m, h, Nbar),))


def end(bound):
    """The largest nominal pressures (B,) for which a law has numbers, in the unit of p*; infinite for laws without an
    end."""
    if bound.law.end is None:
        return np.full(len(bound.p_star), np.inf)
    return bound.p_star * np.broadcast_to(bound.law.end(*bound.own), (len(bound.p_star), 1))[:, 0]


def number(rows, name):
    """The number of this name, one of the NUMBERS, of the families of B cases, (B, 1)."""
    return rows[:, _AT[name], None]


def settled_slope(rows):
    """dP/d ln y far beyond the end, (B, 1)."""
    return number(rows, "slope_P") + number(rows, "bend_P") / number(rows, "settles")


def _along(rows, y):
    """x = 2 v - 1 of the series at y (B, m), dx/d ln y, and ln(y/end), which is 0 where y is not beyond the end."""
    scale, last = number(rows, "scale"), number(rows, "end")
    past_end = np.log(np.maximum(y / last, 1.0))
    beta, width = scale * np.minimum(y, last), 2 * number(rows, "width")
    return width * np.arcsinh(beta) - 1, width * beta / np.hypot(1, beta), past_end


def _series(rows, which, x):
    """The series P, G or Q (`which`: 0, 1, 2) at x (B, m), and its derivative by x: Clenshaw's recurrence."""
    terms = (rows.shape[1] - len(NUMBERS) - GUESS) // 3
    first = len(NUMBERS) + which * terms
    return clenshaw(rows[:, first : first + terms], x)


def exponent(rows, which, y):
    """P, G or Q at y (B, m), and its derivative by ln y."""
    x, dx, past_end = _along(rows, y)
    value, slope = _series(rows, which, x)
    last, bend = (rows[:, _AT[name] + which, None] for name in ("slope_P", "bend_P"))
    settles = number(rows, "settles")
    turned = bend * -np.expm1(-settles * past_end) / settles
    return value + (last + bend / settles) * past_end - turned / settles, np.where(
        past_end > 0, last + turned, slope * dx
    )


def _pressure(rows, y):
    """q and dq/dy at y (B, m)."""
    P, dP = exponent(rows, 0, y)
    slope = 2 / np.pi * y**2 * np.exp(P)
    return slope * y, slope * (3 + dP)


def spot_curve(y, rows):
    """:class:`~solver.laws.law.Curve` at y (B, m)."""
    q, dq = _pressure(rows, y)
    G, dG = exponent(rows, 1, y)
    slope = y * np.exp(G)
    return Curve(q, slope * y, dq, slope * (2 + dG))


def spot_guess(q, rows):
    """y with q(y) = q, roughly, by the inverse of the family: a series in asinh(r/h), where r is the radius of a lone
    spot."""
    r, last = np.cbrt(np.pi / 2 * np.maximum(q, 0.0)), number(rows, "end_r")
    x = 2 * number(rows, "width_r") * np.arcsinh(number(rows, "scale") * np.minimum(r, last)) - 1
    inside, _ = clenshaw(rows[:, -GUESS:], x)
    past_end = np.log(np.maximum(r / last, 1.0))
    return np.minimum(r, last) * np.exp(inside + past_end * 3 / (3 + settled_slope(rows)))


def spot_from_pressure(q, rows):
    """y with q(y) = q, to a few units of rounding; 0 where q <= 0, NaN where it is NaN."""
    target = np.where(q > 0, q, 1.0)
    y = spot_guess(target, rows)
    for _ in range(_STEPS):
        y = y * np.exp(log_step(lambda y: _pressure(rows, y), target, y))
    return where_positive(q, y)


def spot_area(y, q, rows):
    """λ = y²."""
    return np.minimum(y * y, 1.0)


def spot_peak(y, q, rows):
    """p_max/p*, the pressure in the middle of a spot."""
    return 3 / np.pi * y * np.exp(exponent(rows, 2, y)[0])


def _end(rows):
    return number(rows, "most")


def _edge(rows):
    return EDGE

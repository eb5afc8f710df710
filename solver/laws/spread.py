"""The spots of asperities of random heights in the mean field of the disc cell: means over the spots, and their tables.

Units are p* and A*; q = p/p*, k = 2 q/3, and δ = A/A* is the approach of the highest summit. A summit that lies ζ below
it has the approach δ - ζ. Where 0 < δ - ζ + 2 k and δ - ζ < 1 it has a spot of radius c = b/B̄, with v = sqrt(1 - c²),

    δ - ζ = 1 - v² - 2 k v,   its load on the area of a cell:   f = (2/π) (c³ + q (arccos v - v c)),

by (6) and (7). At δ - ζ = 1 the spot fills its cell. From there on the cell is pressed like a flat punch of its size,
f = 2/π + q + (3/π) (δ - ζ - 1). f and its first two derivatives by δ are continuous there. At full contact, where all
cells are filled, δ is the mean relief <ζ> + 1/3, as it must be.

The nominal pressure is the mean over the density of ζ, q = <f>. With fixed spots f is linear in q,
<f> = P + (1 - S) q. So the equation is P = q S, in which nothing cancels.

The unknown is y = sqrt(δ/u) (1 + q/w). Then δ = u (y/(1 + q/w))² is explicit, and P - q S falls with q at any y. w and
u are 1 unless the heights spread far beyond A*. There they are larger, so that y stays in the range of the tables
(:func:`depth`).
"""

from typing import NamedTuple

import numpy as np

from ..numerics.quadrature import gauss_legendre

#: Gauss points on each smooth piece of the density: for summits with a spot, and for those that fill their cell.
_SPOTS, _FILLED = 24, 16
#: Approximate number of spots that are computed at a time, so that their arrays stay in the processor's cache. Compared
#: with all spots at once, the first use of a histogram of 32 classes took 0.4 of the processor time on one machine, and
#: that of 20 laws of normal heights 0.7. The bits of the numbers do not depend on it
#: (tests/laws/heights/test_histograms.py).
_AT_A_TIME = 2**15
#: Newton's method on ln q: the largest number of steps; the change below which a step is the last, since the next would
#: be below rounding; the change below which a step may leave the bracket of the root, since that is rounding; and the
#: largest change.
_STEPS, _LAST, _NEAR, _LONGEST = 60, 1e-9, 1e-6, 2.0
#: Knots of a table in ln y: the first, their distance, their number. A quintic through six of them errs by less than
#: 5e-6 in q and 2e-4 in λ, and at the last knot δ is as near to its limit (tests/laws/heights/test_heights.py).
FIRST, STEP, KNOTS = np.log(1e-4), 0.025, 992
#: The largest y that a table covers; the last two knots are beyond it.
LAST = np.exp(FIRST + STEP * (KNOTS - 3))
#: The relief <ζ> + 1/3 above which w exceeds 1, and the relief above which u does. So the tables begin where δ is 1e-16
#: of the relief. tests/laws/heights/test_heights_far.py has heights below, between and above both.
_FAR, _FARTHEST = 10.0, 1e8
#: Every sixth knot is solved first. The others start from values interpolated between these, and take fewer steps.
EVERY = 6


class Means(NamedTuple):
    """Means over the spots at q and δ; arrays of one shape.

    load, rest : P and S of the equation P = q S
    area : λ
    c : the mean of c
    fall : d(q - <f>)/dq at constant δ
    """

    load: np.ndarray
    rest: np.ndarray
    area: np.ndarray
    c: np.ndarray
    fall: np.ndarray


def depth(y, q, relief):
    """δ at y and q; and w, with d ln δ/dq = -2/(w + q) at constant y."""
    w = np.maximum(1.0, relief / _FAR)
    return np.maximum(1.0, relief / _FARTHEST) * (y / (1 + q / w)) ** 2, w


def spot(approach, k):
    """v and c² of a spot with this approach δ - ζ, by the equation of the module."""
    v = np.clip((1 - approach) / (k + np.sqrt(np.maximum(k * k + 1 - approach, 0.0))), 0.0, 1.0)
    return v, np.clip((approach + 2 * k) * (1 + v) / (1 + v + 2 * k), 0.0, 1.0)


def unknown(delta, q, relief):
    """y at δ and q."""
    return np.sqrt(delta / depth(1.0, q, relief)[0])


def extrapolated(y, q, slope, relief):
    """q and d ln q/d ln y at y. Where y is above LAST, they are extrapolated from `q` and `slope` at LAST: w + q
    continues as the power of y that it is there. The exponent is nearly 1, so that δ is nearly constant."""
    w = depth(1.0, q, relief)[1]
    power, ratio = slope * q / (w + q), np.maximum(y / LAST, 1.0)
    more = q + (w + q) * np.expm1(power * np.log(ratio))
    return more, power * (w + more) / more


def means(edges, density, field, q, delta, sigma):
    """:class:`Means` at q and delta (B, m).

    edges : (B, J + 1), ends of the smooth pieces of the density in x = ζ/sigma, the depth below the highest summit
    density : x (B, m, J, n) -> the density there
    field : 1, or 0 if asperities do not feel each other
    sigma : (B, 1), standard deviation of the heights, in A*
    """
    count = max(1, _AT_A_TIME // (_SPOTS * len(q) * (edges.shape[1] - 1)))
    columns = [slice(first, first + count) for first in range(0, q.shape[1], count)]
    parts = (_means(edges, density, field, q[:, some], delta[:, some], sigma) for some in columns)
    return Means(*(np.concatenate(values, axis=1) for values in zip(*parts, strict=True)))


def _means(edges, density, field, q, delta, sigma):
    low, high = (edges[:, None, part, None] for part in (slice(None, -1), slice(1, None)))
    sigma, delta, q = sigma[..., None, None], delta[..., None, None], q[..., None, None]
    k, divisor = field * (2 / 3) * q, np.where(sigma > 0, sigma, 1.0)
    full, touching = (delta - 1) / divisor, (delta + 2 * k) / divisor
    begin, end = np.clip(full, low, high), np.clip(touching, low, high)

    tau, weight = gauss_legendre(_SPOTS)
    # sin² makes the roots at both ends smooth: f begins as (touching - ζ)^(3/2), and v as sqrt(1 - δ + ζ)
    x = end - (end - begin) * np.sin(np.pi / 2 * tau) ** 2
    w = np.pi / 2 * weight * np.sin(np.pi * tau) * (end - begin) * density(x)
    v, c2 = spot(delta - sigma * x, k)
    c = np.sqrt(c2)

    tau, weight = gauss_legendre(_FILLED)
    x_full = low + (begin - low) * tau
    w_full = weight * (begin - low) * density(x_full)
    excess = delta - sigma * x_full - 1

    share = (w.sum(axis=(-1, -2)) + w_full.sum(axis=(-1, -2)))[..., None, None]  # share of the summits that touch
    every = touching >= edges[:, None, -1:, None]  # where all touch, the share must be exactly 1
    w, w_full = w / np.where(every, share, 1.0), w_full / np.where(every, share, 1.0)
    free = np.where(every, 0.0, 1 - share)[..., 0, 0]

    def of(values, filled=0.0):
        return (w * values).sum(axis=(-1, -2)) + (w_full * filled).sum(axis=(-1, -2))

    arc = np.arctan2(v, c) if field else np.pi / 2
    rest = free + of((2 / np.pi) * (arc + field * v * c), 1 - field)
    fall = free + of((2 / np.pi) * (arc - field * v * c), 1 - field)
    load = of((2 / np.pi) * c * c2, 2 / np.pi + (3 / np.pi) * excess)
    return Means(load, rest, of(c2, 1.0), of(c, 1.0), fall)


def pressure(edges, density, field, y, sigma, relief, q=None):
    """q (B, m) at y (B, m) > 0, and :class:`Means` there, by Newton's method on ln q.

    relief : (B, 1), the limit of δ
    q : the first guess, or None
    edges, density, field, sigma : as in :func:`means`
    """
    if q is None:
        delta, w = depth(y, 0.0, relief)
        at = means(edges, density, field, np.full_like(y, 1e-300), delta, sigma)  # q = 0 might give 0/0
        q = np.clip(at.load / at.rest, 1e-300, w * np.sqrt(delta / relief))
    low, high = np.zeros_like(y), np.full_like(y, np.inf)
    for _ in range(_STEPS):
        delta, w = depth(y, q, relief)
        at = means(edges, density, field, q, delta, sigma)
        more = at.load > q * at.rest
        low, high = np.where(more, q, low), np.where(more, high, q)
        slope = -at.fall - (6 / np.pi) * at.c * delta / (w + q)  # of P - q S
        step = np.clip((at.load / q - at.rest) / -slope, -_LONGEST, _LONGEST)
        new = q * np.exp(step)
        astray = (low > 0) & (high < np.inf) & (np.abs(step) > _NEAR) & ((new <= low) | (new >= high))
        step = np.where(astray, np.log(np.sqrt(low * np.where(astray, high, 1.0)) / q), step)
        q = q * np.exp(step)
        if np.abs(step).max() <= _LAST:
            break
    # the means are those at the last q: at the q before, their last digits would depend on the company in the batch
    return q, means(edges, density, field, q, depth(y, q, relief)[0], sigma)


def _weights():
    """(6, 6): a row for each of the values at -2, ..., 3, and a column for each power of t. They make a quintic in t
    from 0 to 1. At each end it has the value and the first two derivatives of the polynomial through the five values
    around that end."""
    first = np.array([1, -8, 0, 8, -1]) / 12
    second = np.array([-1, 16, -30, 16, -1]) / 12
    hermite = np.array([
        [1, 0, 0, -10, 15, -6], [0, 1, 0, -6, 8, -3], [0, 0, 0.5, -1.5, 1.5, -0.5],
        [0, 0, 0, 10, -15, 6], [0, 0, 0, -4, 7, -3], [0, 0, 0, 0.5, -1, 0.5],
    ])  # fmt: skip
    rows = np.zeros((6, 6))  # rows: value, first and second derivative at 0, then at 1; columns: the six values
    for end in (0, 1):
        rows[3 * end, 2 + end] = 1
        rows[3 * end + 1, end : end + 5] = first
        rows[3 * end + 2, end : end + 5] = second
    return rows.T @ hermite


_WEIGHTS = _weights()
#: Number of places that are looked up at a time, so that the arrays of the sums stay in the processor's cache: 320,000
#: places take 0.27 of the time of all at once. The bits of the numbers do not depend on it
#: (tests/laws/heights/test_heights.py).
_LOOKED_UP = 2**14


def look_up(table, group, y, step=STEP):
    """The logarithms of `table` (G, n), interpolated between its knots to y (B, m), and their derivative by ln y, both
    (B, m). `group` (B,) is the row of each case. The distance of the knots is `step`. Beyond them the logarithm is a
    straight line."""
    rows = max(1, _LOOKED_UP // max(1, y.shape[1]))
    if len(y) <= rows:
        return _interpolated(table, group, y, step)
    values, slopes = np.empty_like(y), np.empty_like(y)
    for some in (slice(first, first + rows) for first in range(0, len(y), rows)):
        values[some], slopes[some] = _interpolated(table, group[some], y[some], step)
    return values, slopes


def _interpolated(table, group, y, step):
    place, count = (np.log(y) - FIRST) / step, table.shape[1]
    knot = np.clip(place.astype(int), 2, count - 4)
    t = np.clip(place - knot, 0.0, 1.0)
    start = knot + count * group[:, None]
    around = [table.take(start + offset) for offset in range(-2, 4)]
    value, slope = np.zeros_like(t), np.zeros_like(t)
    term, total = np.empty_like(t), np.empty_like(t)
    for row in _WEIGHTS.T[::-1]:  # Horner's scheme, in place: new arrays take longer than their numbers
        slope *= t
        slope += value
        value *= t
        total[:] = 0.0
        for weight, values in zip(row, around, strict=True):
            if weight:
                total += np.multiply(values, weight, out=term)
        value += total
    return value + slope * (place - knot - t), slope / step


def tables(edges, density, field, sigma, relief, fine=1):
    """(2, G, KNOTS * fine): ln q and ln λ of G laws at the knots, whose distance is STEP / fine; arguments as those of
    :func:`pressure`."""
    y = knots(fine) * np.ones((len(sigma), 1))
    coarse, _ = pressure(edges, density, field, y[:, :: EVERY * fine], sigma, relief)
    guess, _ = look_up(np.log(coarse), np.arange(len(y)), y, EVERY * STEP)
    q, at = pressure(edges, density, field, y, sigma, relief, np.exp(guess))
    return np.log(np.stack([q, at.area]))


def knots(fine=1):
    """y (KNOTS * fine,) at the knots of tables."""
    return np.exp(FIRST + STEP / fine * np.arange(KNOTS * fine))

"""The pull-off of a contact with adhesion, and the radii with a given load or depth.

A machine of the stiffness k holds the punch; its far end moves by Q = D + P/k, which is the depth for an infinite k.
For k = 0, Q stands for the load. Along the curve of :mod:`.jkr` the contact is stable where Q rises with a. From large
radii down Q falls to its last minimum, and there the punch is pulled off. On a stiff plate Q has more minima, at
smaller radii.

The search evaluates Q at radii from above the last minimum down. Between two neighbours it takes Q as the cubic
polynomial with the right values and slopes; where that has an extremum, it evaluates the middles as well.
"""

from typing import NamedTuple

import numpy as np

from ...numerics import batch
from ...numerics.batch import march
from ...numerics.bracket import between, turns_between
from ...shapes.shape import column
from ..radius import LAST, MOST, Radii, rising_root
from .jkr import State

#: Distance of the radii in the variable of :class:`~..radius.Radii`, and how many are evaluated together.
_STEP, _TOGETHER = 0.25, 8
#: The radii begin at _ABOVE times the radius of pull-off on the softest half-space: the one that yields to every wave
#: as much as the body does to any. They end where the shape adds to the slope of D less than _BELOW of what the edge
#: takes, and a is below _THIN of the thickness of the first layer.
_ABOVE, _BELOW, _THIN = 4.0, 1e-3, 0.02
#: For shapes with a flat part of the radius b, the search ends at (a - b)/b = _CORNER: the slope of a frustum is that
#: at its corner there.
_CORNER = 1e-6
#: Waves u = kh at which the kernel is evaluated.
_WAVES = np.geomspace(1e-9, 30.0, 72)
#: If the first Newton step of :func:`highest` is longer than this, the search starts at its end.
_FAR = 100.0
#: Below this the square of a number underflows.
_SMALL = 1e-150
#: Width of a bracket, in the variable, at which the search for a minimum or a radius ends.
_NARROW = 1e-14


class States:
    """The states of B cases as functions of the variable x of their radii; `counts` (B,) counts evaluations."""

    def __init__(self, law):
        self.law, self.radii = law, Radii(law.shape)
        self.pieces, self.counts = [], np.zeros(len(law.w), dtype=np.int32)

    def at(self, x, index):
        """The :class:`~.jkr.State` at x (b,) of the cases `index`, and da/dx."""
        a, da = self.radii.at(x, index)
        np.add.at(self.counts, index, 1)
        return self.law.take(index).at(a), da


def highest(law, radii):
    """x (B,) above every minimum of Q. On a half-space with the modulus E of the surface all minima lie below the
    radius at which F²/a = 9π w/(2 E); on a layered body E is divided by the largest factor by which the body yields
    more to a wave."""
    body = law.body
    softest = np.ones(len(law.w))
    if body.kernel is not None:
        L = body.kernel.whole(np.tile(_WAVES, (len(softest), 1)))
        softest = np.maximum((np.maximum(L.max(axis=1), body.kernel.L0) + body.m) / (1 + body.m), 1.0)

    def evaluate(x, index):
        a, da = radii.at(x, index)
        part = law.shape.take(index)
        F, slope = (f(column(a))[:, 0] for f in (part.lifted, part.lifted_slope))
        size = np.where(F > _SMALL, np.log(F**2 / a), 2 * np.log(F) - np.log(a))  # if F² underflows
        g = size - np.log(4.5 * np.pi * law.w[index] * softest[index] / body.E[index])
        return np.where(np.abs(g) < 0.01, 0.0, g), (2 * slope / F - 1 / a) * da

    start = np.where(np.isfinite(radii.most) | (radii.least > 0), -1.0, np.log(0.05))
    g, slope = evaluate(start, np.arange(len(start)))
    start = np.where(np.abs(g / slope) > _FAR, start - g / slope, start)  # tiny w: the search would run out of steps
    x, _ = rising_root(evaluate, start)
    return np.where(radii.ends, np.minimum(x + np.log(_ABOVE), LAST), x + np.log(_ABOVE))


def lowest(law, x, index, radii):
    """(b,) bool for the cases `index`: Q falls with a everywhere below x, or x is next to the corner of the flat
    part."""
    a, _ = radii.at(x, index)
    part, w, E = law.shape.take(index), law.w[index], law.body.E[index]
    slope = part.lifted_slope(column(a))[:, 0]
    falls = slope < _BELOW * np.sqrt(2 * np.pi * w / E / a)
    if law.body.kernel is not None:
        falls &= a < _THIN * law.body.h[index]
    least = radii.least[index]
    return np.where(least > 0, a - least < _CORNER * least, falls)


@batch.of_cases
class Turn(NamedTuple):
    """The last minimum of Q in B cases.

    above : an x above every minimum
    x, state : of the minimum
    corner : whether the minimum is at the corner of the flat part, where x is -inf
    at_axis : whether it is at a = 0; then `x` is the least that was evaluated
    """

    above: np.ndarray
    x: np.ndarray
    state: State
    corner: np.ndarray
    at_axis: np.ndarray


def last_minimum(curve, holder, start):
    """The :class:`Turn` of B cases, searched from x = `start` (B,), above every minimum, down."""

    def slope(x, index):
        state, _ = curve.at(x, index)
        return holder.take(index).of(state.dP, state.dD)

    interval = descend(curve, holder, start, lambda Q, dQ, _: (dQ[:, :-1] >= 0) & (dQ[:, 1:] < 0))
    x, corner = interval.high.copy(), interval.ended & (curve.radii.least > 0)
    inside = np.flatnonzero(~interval.ended)
    if len(inside):
        low, high = interval.low[inside], interval.high[inside]
        ends = interval.dQ_low[inside], interval.dQ_high[inside]
        tolerance = np.full(len(inside), _NARROW)
        scale = ends[1] - ends[0]
        x[inside], _ = between(
            lambda y, i: slope(y, inside[i]) / scale[i], low, high, ends[0] / scale, ends[1] / scale, tolerance
        )
    at_axis = interval.ended & ~corner & curve.law.reaches_axis & np.isfinite(interval.low)
    x = np.where(interval.ended & ~corner, np.where(at_axis, interval.low, np.nan), np.where(corner, -np.inf, x))
    state, _ = curve.at(x, np.arange(len(x)))
    return Turn(start, x, state, corner, at_axis)


class Interval(NamedTuple):
    """Neighbours low < high in x, and Q and its slope dQ by a at both, (B,) each. Where the search `ended` without
    finding any, `low` is the last x and the rest is NaN."""

    low: np.ndarray
    high: np.ndarray
    Q_low: np.ndarray
    Q_high: np.ndarray
    dQ_low: np.ndarray
    dQ_high: np.ndarray
    ended: np.ndarray


def descend(curve, holder, start, wanted, until=-np.inf):
    """The highest :class:`Interval` below `start` (B,) that is `wanted`. A search ends at the :func:`lowest` x, but not
    while Q is below `until` (B,).

    wanted : ``wanted(Q, dQ, index) -> (b, m - 1) bool``: which intervals of the cases `index` are wanted, from Q and
        its slope (b, m) at descending radii
    """
    size, until = len(start), np.broadcast_to(until, len(start))
    out = Interval(*np.full((6, size), np.nan), np.ones(size, dtype=bool))

    def step(active, *looked):
        below = looked[0] - _STEP * np.arange(1, _TOGETHER + 1)
        more = _looked_at(curve, holder, below, active)
        looked = tuple(np.hstack(pair) for pair in zip(looked, more, strict=True))
        turns = _turns(curve, *looked, active)
        goes_on = np.ones(len(active), dtype=bool)
        for rows in (np.flatnonzero(~turns), np.flatnonzero(turns)):
            if len(rows):
                x, Q, dQ = (values[rows] for values in looked)
                if turns[rows[0]]:
                    x, Q, dQ = _with_middles(curve, holder, x, Q, dQ, active[rows])
                goes_on[rows] = ~_note(out, active[rows], wanted(Q, dQ, active[rows]), x, Q, dQ)
        last = looked[0][:, -1]
        out.low[active] = np.where(goes_on, last, out.low[active])
        ends = lowest(curve.law, last, active, curve.radii) & ~(looked[1][:, -1] < until[active])
        return ~goes_on | ends | np.isnan(last), *(values[:, -1:] for values in looked)

    march(step, np.arange(size), *_looked_at(curve, holder, start[:, None], np.arange(size)))
    return out


def _note(out, index, hits, x, Q, dQ):
    """Write for each case the first interval that is one of its `hits` (b, m - 1) into `out`, at `index`; returns
    whether there is one (b,)."""
    rows, first = np.flatnonzero(hits.any(axis=1)), hits.argmax(axis=1)
    places, index_of = first[rows], index[rows]
    for low, high, values in zip(out[:6:2], out[1:6:2], (x, Q, dQ), strict=True):
        low[index_of], high[index_of] = values[rows, places + 1], values[rows, places]
    out.ended[index_of] = False
    return hits.any(axis=1)


def _looked_at(curve, holder, x, index):
    """x, and Q and its slope by a, at x (b, m) of the cases `index`."""
    places = np.repeat(index, x.shape[1])
    state, _ = curve.at(x.ravel(), places)
    part = holder.take(places)
    return x, part.of(state.P, state.D).reshape(x.shape), part.of(state.dP, state.dD).reshape(x.shape)


def _turns(curve, x, Q, dQ, index):
    """(b,) bool: between some neighbours with slopes of the same sign the cubic polynomial has extrema."""
    _, da = curve.radii.at(x.ravel(), np.repeat(index, x.shape[1]))
    slope = dQ * da.reshape(x.shape)
    pairs = ((values[:, 1:], values[:, :-1]) for values in (Q, slope))
    return turns_between(-np.diff(x, axis=1), *pairs).any(axis=1)


def _with_middles(curve, holder, x, Q, dQ, index):
    """x, Q and dQ with those at the middles of all intervals inserted."""
    middles = _looked_at(curve, holder, (x[:, 1:] + x[:, :-1]) / 2, index)
    out = [np.empty((len(index), 2 * x.shape[1] - 1)) for _ in range(3)]
    for array, ends, inner in zip(out, (x, Q, dQ), middles, strict=True):
        array[:, ::2], array[:, 1::2] = ends, inner
    return out


def above_turn(curve, holder, value, turn, start):
    """x (B,) > turn.x at which Q has the `value` (B,), at least that at the :class:`Turn`; NaN where there is none.
    `start` is a first guess."""
    Q_off = holder.of(turn.state.P, turn.state.D)
    scale = np.maximum(np.abs(value), np.abs(Q_off))

    def evaluate(x, index):
        state, da = curve.at(x, index)
        part, unit = holder.take(index), scale[index]
        return (part.of(state.P, state.D) - value[index]) / unit, part.of(state.dP, state.dD) * da / unit

    start = np.fmax(start, np.where(turn.corner, turn.above, turn.x + 0.3))
    x, counts = rising_root(evaluate, start, low=turn.x)
    return np.where(counts < MOST, x, np.nan)


def below(curve, holder, value, start, rising):
    """The largest x (B,) < `start` at which Q has the `value` (B,) and rises with a if `rising`, otherwise falls; NaN
    where there is none."""
    sign = 1.0 if rising else -1.0

    def wanted(Q, _, index):
        off = sign * (Q - value[index, None])
        return (off[:, :-1] > 0) & (off[:, 1:] <= 0)

    to_axis = (value < 0) & (curve.radii.least == 0) & (not rising)  # Q rises to 0 there, at the axis
    interval = descend(curve, holder, start, wanted, np.where(to_axis, value, -np.inf))
    x, inside = np.full(len(start), np.nan), np.flatnonzero(~interval.ended)
    if len(inside):
        v, part = value[inside], holder.take(inside)
        scale = np.abs(interval.Q_high - interval.Q_low)[inside]

        def off(y, i):
            state, _ = curve.at(y, inside[i])
            return sign * (part.take(i).of(state.P, state.D) - v[i]) / scale[i]

        ends = (sign * (Q[inside] - v) / scale for Q in (interval.Q_low, interval.Q_high))
        low, high = interval.low[inside], interval.high[inside]
        x[inside], _ = between(off, low, high, *ends, np.full(len(inside), _NARROW))
    return x

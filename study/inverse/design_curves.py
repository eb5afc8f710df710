"""Curves of one result over one input: their scan, their turns, and the places where they cross a level."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import elementwise

SCAN = 24
"""Number of points in a scan. Between two of them a curve may turn twice unseen: tools/errors/designs.py counts how
often."""
EDGE = 1e-6
"""Distance from a bound, in ln of the input, within which a crossing is at the bound."""
#: Least second difference of three points, over the middle one, for the search of a turn. Curves with smaller ones are
#: flat except for the error of the solver.
_BENT = 1e-5
#: Precision of the places of turns, over the distance between points of the scan. A curve is flat at a turn, so its
#: value errs by the square of this.
_TURN = 1e-3
#: Distance of a further point from each bound, over that between points of the scan. It shows a turn in the last
#: interval.
_STEP_INSIDE = 0.01
_HALVINGS = 12  # number of halvings of the interval in which contacts cease to have a solution
_NEAR = 1e-12  # distance between the ends of a bracket, in ln of the input

Evaluate = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""(t (b,), row (b,)) -> the result (b,) where the input is exp(t), or t, in the case `row`; NaN without a solution."""


@dataclass(frozen=True)
class Curves:
    """A curve for each of k cases: points in the order of t. Finite neighbours are joined.

    t, y : (k, m); after the last point of a row t is inf and y is NaN
    """

    t: np.ndarray
    y: np.ndarray

    def reach(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Smallest y of each row and its t, largest y and its t, (k,) each; NaN and the first t for a row without y."""
        low, high = (np.where(np.isnan(self.y), fill, self.y) for fill in (np.inf, -np.inf))
        places = np.argmin(low, axis=1), np.argmax(high, axis=1)
        rows = np.arange(len(self.t))
        return tuple(array[rows, place] for place in places for array in (self.y, self.t))

    def at(self, rows: np.ndarray) -> "Curves":
        """The curves of some rows."""
        return Curves(self.t[rows], self.y[rows])


def scanned(evaluate: Evaluate, rows: np.ndarray, low: float, high: float) -> Curves:
    """The curves of the cases `rows` between two bounds of t. The ends of gaps and the turns are among the points."""
    points, k = np.linspace(low, high, SCAN), len(rows)
    near = _STEP_INSIDE * (points[1] - points[0])
    t = np.tile([low, low + near, *points[1:-1], high - near, high], (k, 1))
    curves = Curves(t, evaluate(t.ravel(), np.repeat(rows, t.shape[1])).reshape(t.shape))
    curves = _with(curves, *_ends_of_gaps(evaluate, rows, curves))
    return _with(curves, *_turns(evaluate, rows, curves, _TURN * (high - low) / (SCAN - 1)))


def _with(curves: Curves, place: np.ndarray, t: np.ndarray, y: np.ndarray) -> Curves:
    """The curves with further points.

    place : row of each point, (b,)
    """
    if not len(place):
        return curves
    count = np.bincount(place, minlength=len(curves.t))
    order = np.argsort(place, kind="stable")
    column = np.arange(len(place)) - (np.cumsum(count) - count)[place[order]]
    more = [np.full((len(curves.t), count.max()), fill) for fill in (np.inf, np.nan)]
    for array, values in zip(more, (t, y), strict=True):
        array[place[order], column] = values[order]
    t, y = (np.concatenate(pair, axis=1) for pair in zip((curves.t, curves.y), more, strict=True))
    order = np.argsort(t, axis=1, kind="stable")
    return Curves(np.take_along_axis(t, order, axis=1), np.take_along_axis(y, order, axis=1))


def _ends_of_gaps(evaluate: Evaluate, rows: np.ndarray, curves: Curves) -> tuple:
    """(row, t, y) of the last point with a solution before one without, by halving the interval."""
    finite = np.isfinite(curves.y)
    place, left = np.nonzero(finite[:, 1:] != finite[:, :-1])
    left_is_good = finite[place, left]
    good = curves.t[place, np.where(left_is_good, left, left + 1)]
    bad = curves.t[place, np.where(left_is_good, left + 1, left)]
    y = curves.y[place, np.where(left_is_good, left, left + 1)]
    for _ in range(_HALVINGS if len(place) else 0):
        middle = 0.5 * (good + bad)
        value = evaluate(middle, rows[place])
        solved = np.isfinite(value)
        good, y, bad = np.where(solved, middle, good), np.where(solved, value, y), np.where(solved, bad, middle)
    return place, good, y


def _turns(evaluate: Evaluate, rows: np.ndarray, curves: Curves, near: float) -> tuple:
    """(row, t, y) of the turns of the curves, each found between three neighbouring points."""
    before, middle, after = curves.y[:, :-2], curves.y[:, 1:-1], curves.y[:, 2:]
    turning = (middle - before) * (middle - after) >= 0
    place, left = np.nonzero(turning & (np.abs(before - 2 * middle + after) > _BENT * np.abs(middle)))
    if not len(place):
        return place, np.array([]), np.array([])
    sign = np.sign(before - middle + (after - middle))[place, left]
    ends = tuple(curves.t[place, left + i] for i in range(3))
    size = np.abs(middle[place, left])

    def downwards(t: np.ndarray, row: np.ndarray, sign: np.ndarray, size: np.ndarray) -> np.ndarray:
        return sign * evaluate(t, row) / size

    tolerances = {"xatol": near, "xrtol": 0.0, "fatol": 0.0, "frtol": 0.0}
    least = elementwise.find_minimum(downwards, ends, args=(rows[place], sign, size), tolerances=tolerances)
    solved = np.isfinite(least.f_x)
    return place[solved], least.x[solved], (sign * least.f_x * size)[solved]


def crossings(evaluate: Evaluate, curves: Curves, rows: np.ndarray, level: np.ndarray, rtol: float) -> np.ndarray:
    """t (k, n) at which the curves of the cases `rows` have the value `level` (k,), in order and padded with NaN.

    The value is right to `rtol`. A curve that begins or ends within rtol of its level crosses it at that end.
    """
    level = np.asarray(level, dtype=float)
    with np.errstate(invalid="ignore"):
        above = np.where(np.isnan(curves.y), np.nan, curves.y >= level[:, None])
        crossed = (above[:, 1:] != above[:, :-1]) & np.isfinite(above[:, 1:] + above[:, :-1])
        crossed &= np.isfinite(level)[:, None]
    place, left = np.nonzero(crossed)
    t = np.empty(0)
    if len(place):

        def distance(t: np.ndarray, row: np.ndarray, level: np.ndarray) -> np.ndarray:
            return evaluate(t, row) / level - 1

        bracket = curves.t[place, left], curves.t[place, left + 1]
        tolerances = {"xatol": _NEAR, "xrtol": 0.0, "fatol": 0.1 * rtol, "frtol": 0.0}
        args = rows[place], level[place]
        root = elementwise.find_root(distance, bracket, args=args, tolerances=tolerances)
        t = np.where(np.abs(root.f_x) <= rtol, root.x, np.nan)  # otherwise it jumps: base = "auto" changes its model
    last = np.isfinite(curves.t).sum(axis=1) - 1
    for column, interval in ((np.zeros_like(last), np.zeros_like(last)), (last, last - 1)):
        numbers = np.arange(len(level))
        at_end = np.abs(curves.y[numbers, column] / level - 1) <= rtol
        touching = np.flatnonzero(at_end & ~crossed[numbers, interval])
        place, t = np.append(place, touching), np.append(t, curves.t[touching, column[touching]])
    place, t = place[np.isfinite(t)], t[np.isfinite(t)]
    order = np.lexsort((t, place))
    count = np.bincount(place, minlength=len(level))
    solutions = np.full((len(level), max(1, count.max(initial=0))), np.nan)
    solutions[place[order], np.arange(len(place)) - (np.cumsum(count) - count)[place[order]]] = t[order]
    return solutions


def ends(
    evaluate: Evaluate, curves: Curves, rows: np.ndarray, t: np.ndarray, level: float, spread: np.ndarray, rtol: float
) -> tuple[np.ndarray, np.ndarray]:
    """t below and above each solution, (k, n) each, at which the result is `spread` (k, n) off, on the same branch.

    t : (k, n) solutions, padded with NaN

    A rising result is sought at level - spread below the solution and at level + spread above it, a falling one the
    other way round. NaN where the next solution, or the end of the curve, comes first; t itself without a spread.
    """
    low, high = np.where(spread == 0, t, np.nan), np.where(spread == 0, t, np.nan)
    place, number = np.nonzero(np.isfinite(t) & (spread > 0))
    if len(place):
        mine, at, off = curves.at(place), t[place, number], spread[place, number]
        up, down = (crossings(evaluate, mine, rows[place], level + sign * off, rtol) for sign in (1, -1))
        rising, limits = _rises(mine, at, level), np.pad(t, ((0, 0), (1, 1)), constant_values=np.nan)
        for array, sign in (low, -1), (high, 1):
            limit = limits[place, number + 1 + sign]
            limit = np.where(np.isnan(limit), np.inf, sign * limit)
            nearest = [_nearest(sign * places, sign * at, limit) for places in (up, down)]
            array[place, number] = sign * np.where(rising == (sign > 0), *nearest)
    return low, high


def _nearest(places: np.ndarray, at: np.ndarray, limit: np.ndarray) -> np.ndarray:
    """The first of the places (k, m) after `at` and up to `limit`, (k,) each; NaN if there is none."""
    is_between = (places > at[:, None]) & (places <= limit[:, None])
    nearest = np.where(is_between, places, np.inf).min(axis=1)
    return np.where(np.isfinite(nearest), nearest, np.nan)


def _rises(curves: Curves, at: np.ndarray, level: float) -> np.ndarray:
    """(k,) bool: whether the result rises with the input at a solution."""
    numbers = np.arange(len(at))
    right = np.minimum(np.sum(curves.t <= at[:, None], axis=1), curves.y.shape[1] - 1)
    left = np.maximum(np.sum(curves.t < at[:, None], axis=1) - 1, 0)
    behind = curves.y[numbers, right]
    return np.where(np.isfinite(behind), behind > level, curves.y[numbers, left] < level)

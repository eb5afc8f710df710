"""Fits of the curves of one block: starts, least squares, intervals, status."""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from scipy import special

from solver.status import Codes

from .averages import LONG, Averages, averages_of
from .curve import MeasuredCurves
from .intervals import covariance_of, profiles
from .least_squares import SURE, Data, Minimum, inverse, minimise, normal
from .question import Question
from .residuals import Worth, parts_of, worth_of
from .starts import best_of, starts_of
from .tables.branch import radii
from .tables.ratio_table import RatioTable
from .tables.sticking_points import StickingPoints
from .tables.term_table import TermTable

#: Precision of the search from one of several starts, some 0.03 of a spread. The best search goes on to the end.
_ROUGHLY = 1e-4
#: Logarithms of works of adhesion at which searches for a retraction begin, relative to the best one.
_ABOUT = np.linspace(-0.3, 0.3, 8)
#: The contacts at so many equal parts of the depth are judged by the assumptions of the model.
JUDGED = 16
_SURE = 0.999  # level of the F test that there is a contact
_SAME = 1e-3  # minima whose unknowns differ by less than this share of a spread are one


class FitStatus(Codes):
    """How the fit of a curve ended."""

    CONVERGED = 0
    AT_BOUND = 1
    ITERATION_LIMIT = 2
    SEVERAL_MINIMA = 3
    NOT_IDENTIFIABLE = 4
    NO_CONTACT = 5
    INVALID_INPUT = 6


class _LeastSquares(NamedTuple):
    """Curves as a problem of least squares.

    few : averages of neighbouring points of long curves, with which searches begin; None: searches use all points
    starts : unknowns (B, k) from which searches begin, an array for each start
    variance : (B,) of a point of weight 1, if it is known without a fit of all unknowns
    prior : (B,), the variance of a point that the stiffness of priors assumes
    """

    question: Question
    curve: MeasuredCurves
    data: Data
    few: Averages | None
    starts: list[np.ndarray]
    variance: np.ndarray
    prior: np.ndarray

    @property
    def inputs(self) -> int:
        """The number of unknowns that are inputs; they come first."""
        return len(self.question.model.unknowns)


class _Minima(NamedTuple):
    """The best fits with all points; and the costs (starts, B) and unknowns (starts, B, k) at the ends of the searches
    from all starts, by averages if the curves are long."""

    best: Minimum
    costs: np.ndarray
    places: np.ndarray


class _Spread(NamedTuple):
    """The uncertainty of the unknowns of the best fits.

    variance : (B,) of a point of weight 1
    share : (B, n), the depth of each point over that of the deepest
    t : (B, k), Student's t of the level of the intervals
    covariance : (B, k, k)
    """

    variance: np.ndarray
    share: np.ndarray
    worth: Worth
    t: np.ndarray
    covariance: np.ndarray


class _Intervals(NamedTuple):
    """The ends (B, k) of intervals; whether an end is a bound, and whether another minimum lies within them, (B,)."""

    low: np.ndarray
    high: np.ndarray
    open: np.ndarray
    several: np.ndarray


def fit_block(
    question: Question, table: RatioTable | TermTable, x: np.ndarray, y: np.ndarray, sigma: np.ndarray | None
) -> dict[str, Any]:
    """Fit curves (B, n), NaN where there is no point. Every curve has more points than unknowns.

    sigma : (B, n) standard deviations of y; None: from the residuals

    Returns the unknowns p (B, k), the ends low and high of their intervals, their covariance (B, k, k) and the
    covariance from the spreads of other inputs (`propagated`), Student's t (B, k), status (B,), the fit of y (B, n),
    the units of x and y (wide and top, (B,)) for D0, P0 and tilt, the fields of :class:`.residuals.Worth`, and the
    first unknown by parts of the contact (`parts`, (B, PARTS)); of contacts that stick their radii in m at
    parts of the depth (`radii`, (B, JUDGED)), else NaN.
    """
    problem = _problem(question, table, x, y, sigma)
    minima = _minima(problem)
    spread = _spread(problem, minima.best, sigma is None)
    intervals = _intervals(problem, minima, spread)
    curve, data, best = problem.curve, problem.data, minima.best
    is_point = np.isfinite(x) & np.isfinite(y)
    return {
        "p": best.p,
        "low": intervals.low,
        "high": intervals.high,
        "covariance": spread.covariance,
        "t": spread.t,
        "status": _status(problem, best, intervals),
        "propagated": _propagated(problem, best),
        "wide": curve.wide,
        "top": curve.high,
        "parts": parts_of(curve, data, best, spread.share, spread.worth),
        **spread.worth._asdict(),
        "fit": np.where(is_point, best.model * curve.high[:, None], np.nan),
        "radii": _radii(curve, best),
    }


def _radii(curve: MeasuredCurves, best: Minimum) -> np.ndarray:
    """The radii (B, JUDGED) of contacts that stick; NaN where a machine, which the table does not know, holds them."""
    table, parts = curve.table, np.arange(1, JUDGED + 1) / JUDGED
    if not isinstance(table, TermTable) or "k_machine" in table.model.scene.values:
        return np.full((len(best.p), JUDGED), np.nan)
    begin = best.p[:, curve.names.index("D0")] * curve.wide if "D0" in curve.shifts else 0.0
    deepest = curve.x.max(axis=1) - begin
    return radii(table, curve.values(best.p), np.maximum(deepest, 1e-3 * curve.wide)[:, None] * parts)


def _problem(
    question: Question, table: RatioTable | TermTable, x: np.ndarray, y: np.ndarray, sigma: np.ndarray | None
) -> _LeastSquares:
    is_point = np.isfinite(x) & np.isfinite(y)
    curve, data, least = _weighted(question, table, x, y, sigma)
    few = averages_of(curve, data) if x.shape[1] > LONG and bool((is_point.sum(axis=1) > LONG).all()) else None
    part, points = (few.curve, few.data) if few else (curve, data)
    starts, low, high = starts_of(question, part, points.w > 0, points.y * curve.high[:, None], curve.high, least)
    data, points = (each._replace(low=low, high=high) for each in (data, points))
    if question.model.sticks:
        curve, part = (_with_sticking_points(*pair) for pair in ((curve, data), (part, points)))
        starts = best_of(part, points, starts)
    variance = prior = np.ones(len(x))
    if question.priors:
        center, stiffness, variance, prior = _priors(question, curve, data, starts[0], sigma is None)
        data, points = (each._replace(center=center, stiffness=stiffness) for each in (data, points))
    few = few and few._replace(curve=part, data=points)
    return _LeastSquares(question, curve, data, few, starts, variance, prior)


def _weighted(
    question: Question, table: RatioTable | TermTable, x: np.ndarray, y: np.ndarray, sigma: np.ndarray | None
) -> tuple[MeasuredCurves, Data, np.ndarray]:
    """The curves in their units, their points with weights but without bounds, and the least x (B,) of each curve."""
    is_point = np.isfinite(x) & np.isfinite(y)
    top = np.where(is_point, y, -np.inf).max(axis=1) - np.where(is_point, y, np.inf).min(axis=1)
    largest, least = np.where(is_point, x, -np.inf).max(axis=1), np.where(is_point, x, np.inf).min(axis=1)
    wide = np.where(largest - least > 0, largest - least, largest) if "D0" in question.shifts else largest
    curve = MeasuredCurves(table, np.where(is_point, x, largest[:, None]), wide, top, question.shifts)
    with np.errstate(divide="ignore", invalid="ignore"):
        w = np.where(is_point, 1.0 if sigma is None else top[:, None] / np.where(is_point, sigma, 1.0), 0.0)
    y = np.where(is_point, y, 0.0) / top[:, None]
    unknown = np.zeros((len(x), len(curve.names)))
    return curve, Data(y, w, unknown, unknown, unknown, unknown, question.loss == "huber"), least


def _with_sticking_points(curve: MeasuredCurves, data: Data) -> MeasuredCurves:
    points = StickingPoints.of(curve.x, data.y, data.w, len(curve.names), data.huber)
    return replace(curve, points=points)


def _priors(
    question: Question, curve: MeasuredCurves, data: Data, start: np.ndarray, unknown: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The centers and the stiffness (B, k) of priors, the variance (B,) of the points, and the variance that priors
    assume.

    unknown : whether the variance is not known; otherwise it is 1

    They come from a fit with the inputs at their priors. Points with correlated errors are worth fewer independent
    points, and must not overrule a prior.
    """
    columns = [question.model.unknowns.index(name) for name in question.priors]
    center, sd = np.array(list(question.priors.values())).T
    begin, fixed = start.copy(), np.zeros(start.shape, bool)
    begin[:, columns], fixed[:, columns] = center, True
    fit = minimise(curve, data, begin, fixed)
    freedom = np.maximum((data.w > 0).sum(axis=1) - start.shape[1] + len(columns), 1)
    variance = fit.cost / freedom if unknown else np.ones(len(start))
    worth = worth_of(curve.x, data, fit, variance, 0 * variance, _share(curve, fit))
    prior = variance * worth.factors[:, : len(question.model.unknowns)].max(axis=1)
    centers, stiffness = np.zeros(start.shape), np.zeros(start.shape)
    centers[:, columns], stiffness[:, columns] = center, prior[:, None] / sd**2
    return centers, stiffness, variance, prior


def _count(question: Question, data: Data) -> np.ndarray:
    """The number (B,) of points, less one with adhesion, where the point at which the contact begins counts as an
    unknown."""
    return (data.w > 0).sum(axis=1) - question.model.sticks


def _minima(problem: _LeastSquares) -> _Minima:
    few = problem.few
    curve, data = (few.curve, few.data) if few else (problem.curve, problem.data)
    starts, B = problem.starts, len(data.y)
    # all starts at once: the time of a step is that of its calls, hardly that of its numbers
    every = np.tile(np.arange(B), len(starts))
    rough = SURE if len(starts) == 1 else _ROUGHLY
    fits = minimise(curve.take(every), data.take(every), np.concatenate(starts), sure=rough)
    costs, places = fits.cost.reshape(len(starts), -1), fits.p.reshape(len(starts), B, -1)
    best = fits.take(costs.argmin(axis=0) * B + np.arange(B))
    if problem.question.model.sticks and problem.curve.points.retracts.any():
        costs, places = _to_the_ends(problem, (curve, data), best.p, (costs, places))
        best = best._replace(p=places[costs.argmin(axis=0), np.arange(B)])
    if few or len(starts) > 1:
        best = minimise(problem.curve, problem.data, best.p)
    return _Minima(best, costs, places)


def _to_the_ends(problem: _LeastSquares, few: tuple[MeasuredCurves, Data], p: np.ndarray, minima: tuple) -> tuple:
    """The costs and unknowns of searches; for retractions, of searches without a ramp after the end of the branch.

    Each point that passes the end makes the cost jump, and a search on one side does not see the other side. So these
    searches begin near the best unknowns p (B, k) of the search with a ramp: with other works of adhesion, or other
    values of the first unknown if the work is known. The other unknowns are fitted to these first.
    """
    (curve, data), model, (costs, places) = few, problem.question.model, minima
    place = model.unknowns.index("w_adhesion") if "w_adhesion" in model.unknowns else 0
    count, B = len(_ABOUT), len(p)
    every, begin = np.tile(np.arange(B), count), np.tile(p, (count, 1))
    fixed = np.zeros(begin.shape, bool)
    fixed[:, place] = True
    begin[:, place] = np.clip(
        begin[:, place] + np.repeat(_ABOUT, B), *(end[every, place] for end in (data.low, data.high))
    )
    curves, points = curve.take(every), data.take(every)
    begin = minimise(curves, points, begin, fixed, sure=_ROUGHLY).p
    for each in (curves, curve, problem.curve):
        each.ends = True
    fits = minimise(curves, points, begin, sure=_ROUGHLY)
    retracts = problem.curve.points.retracts
    more = np.where(retracts, fits.cost.reshape(count, B), np.inf)
    costs = np.concatenate([np.where(retracts, np.inf, costs), more])
    return costs, np.concatenate([places, fits.p.reshape(count, B, -1)])


def _spread(problem: _LeastSquares, best: Minimum, unknown: bool) -> _Spread:
    """The uncertainty of the unknowns.

    unknown : whether the variance of the points is not known, and follows from the residuals
    """
    question, curve, data = problem.question, problem.curve, problem.data
    variance = problem.variance
    if unknown and not question.priors:
        variance = best.cost / np.maximum(_count(question, data) - best.p.shape[1], 1)
    share = _share(curve, best)
    worth = worth_of(curve.x, data, best, variance, problem.prior, share)
    tail = (1 + question.level) / 2
    t = special.stdtrit(np.maximum(worth.freedom - question.model.sticks, 1), tail)
    t = t if unknown else np.where(worth.factors > 1, t, special.ndtri(tail))
    root = np.sqrt(worth.factors)
    covariance = covariance_of(data, best, variance) * root[:, :, None] * root[:, None, :]
    return _Spread(variance, share, worth, t, covariance)


def _intervals(problem: _LeastSquares, minima: _Minima, spread: _Spread) -> _Intervals:
    """Intervals of the inputs by profiles, if the question wants these; other intervals from the covariance."""
    best, costs, places = minima
    inputs = problem.inputs
    sd = np.sqrt(np.einsum("bii->bi", spread.covariance))
    # cost at the ends of the interval of an input, above the least cost
    above = (spread.t**2 * spread.variance[:, None] * spread.worth.factors)[:, :inputs]
    few = problem.few and problem.few.about(best, problem.curve, problem.data)
    least = costs.min(axis=0) if few else best.cost  # of the same points as the other minima
    within = costs <= least + above.max(axis=1)
    differ = np.abs(places[:, :, :inputs] - best.p[:, :inputs]) > np.maximum(sd[:, :inputs], _SAME)
    several = (within & differ.any(axis=2)).any(axis=0)
    ends = _Intervals(best.p - spread.t * sd, best.p + spread.t * sd, np.zeros(len(best.p), bool), several)
    if problem.question.intervals != "profile" or problem.data.huber:
        return ends
    curve, data = problem.curve, problem.data
    if few:
        curve, data = few.curve, few.data
        best = minimise(curve, data, best.p)
        costs = costs - least + best.cost
    return _by_profiles(curve, data, _Minima(best, costs, places), above, ends)


def _by_profiles(curve: MeasuredCurves, data: Data, minima: _Minima, above: np.ndarray, ends: _Intervals) -> _Intervals:
    """The intervals with those of the inputs by profiles, which begin at the farthest minima within them.

    above : (B, inputs), cost at the ends of an interval, above the least cost
    """
    best, costs, places = minima
    inputs, every = above.shape[1], np.arange(len(best.p))
    far = [
        np.where(costs <= best.cost + above[:, i], side * places[:, :, i], -np.inf).argmax(axis=0)
        for i in range(inputs)
        for side in (-1, 1)
    ]
    begin = [(places[start, every], costs[start, every]) for start in far]
    first = np.clip(np.abs(ends.high - best.p), 1e-6, (data.high - data.low) / 4)
    value, bound = profiles(curve, data, best, begin, best.cost[:, None] + above, first)
    low, high = ends.low.copy(), ends.high.copy()
    low[:, :inputs], high[:, :inputs] = value[:, :, 0], value[:, :, 1]
    return ends._replace(low=low, high=high, open=bound.any(axis=(1, 2)))


def _status(problem: _LeastSquares, best: Minimum, intervals: _Intervals) -> np.ndarray:
    """The :class:`FitStatus` (B,) of each curve: the first that holds."""
    question, data = problem.question, problem.data
    at_bound = ((best.p <= data.low) | (best.p >= data.high))[:, : problem.inputs].any(axis=1)
    # for curves over a load or a radius, the contact is not in doubt
    no_contact = _no_contact(problem, best) & (question.model.x == "D")
    cases = {
        FitStatus.NO_CONTACT: no_contact,
        FitStatus.ITERATION_LIMIT: ~best.ended,
        FitStatus.AT_BOUND: at_bound,
        FitStatus.NOT_IDENTIFIABLE: intervals.open,
        FitStatus.SEVERAL_MINIMA: intervals.several,
    }
    status = np.select([*cases.values()], [*cases], FitStatus.CONVERGED)
    return np.where(np.isfinite(best.cost), status, FitStatus.INVALID_INPUT)


def _share(curve: MeasuredCurves, fit: Minimum) -> np.ndarray:
    """The depth of each point below the contact point over that of the deepest, (B, n); 0 before the contact, and
    slightly above 0 where a contact adheres before that depth."""
    depth = curve.x
    if "D0" in curve.shifts:
        depth = depth - fit.p[:, [curve.names.index("D0")]] * curve.wide[:, None]
    share = np.maximum(depth, 0.0) / np.maximum(depth.max(axis=1, keepdims=True), 1e-300)
    return np.maximum(share, 1e-9 * (curve.contact(fit.p)[0] != 0)) if curve.table.model.sticks else share


def _no_contact(problem: _LeastSquares, best: Minimum) -> np.ndarray:
    """Whether a straight line fits as well: the model reduces the sum of squares of the line by no more than chance
    would in all curves except one in a thousand."""
    data, k = problem.data, best.p.shape[1]
    w2 = data.w**2
    x = problem.curve.x / problem.curve.wide[:, None]
    total = w2.sum(axis=1)
    xm, ym = (w2 * x).sum(axis=1) / total, (w2 * data.y).sum(axis=1) / total
    dx, dy = x - xm[:, None], data.y - ym[:, None]
    sxx, sxy, syy = ((w2 * a * b).sum(axis=1) for a, b in ((dx, dx), (dx, dy), (dy, dy)))
    line = syy - np.where(sxx > 0, sxy**2 / np.where(sxx > 0, sxx, 1.0), 0.0)
    residual = (w2 * (data.y - best.model) ** 2).sum(axis=1)
    free, more = np.maximum(_count(problem.question, data) - k, 1), max(k - 2, 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        F = (line - residual) / more / (residual / free)
    return ~(special.fdtri(more, free, _SURE) < F) & np.isfinite(best.cost)


def _propagated(problem: _LeastSquares, best: Minimum) -> np.ndarray:
    """The covariance (B, k, k) from the spreads of other inputs: the unknowns follow a change of each input."""
    question, k = problem.question, best.p.shape[1]
    whole = np.zeros((len(best.p), k, k))
    if not question.model.moved:
        return whole
    _, _, derivatives = problem.curve.contact(best.p, moved=True)
    A, _ = normal(problem.data, best.p, best.model, best.J, best.weights)
    A = inverse(A)
    for name, by in zip(question.model.moved, derivatives, strict=True):
        follows = -np.einsum("bij,bnj,bn,bn->bi", A, best.J, best.weights, by) * question.spreads[name]
        whole += follows[:, :, None] * follows[:, None, :]
    return whole

"""Fits of the curves of one block: starts, least squares, intervals, status."""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from scipy import special

from solver.status import Codes

from .asked import Asked
from .curve import Curve
from .intervals import covariance_of, profiles
from .least_squares import SURE, Data, Fit, inverse, minimise, normal
from .points.parts import parts_of
from .points.thinned import LONG, Thinned, thinned
from .points.worth import worth_of
from .starts import best_of, starts_of
from .sticking.labels import Points
from .sticking.ladder import Ladder
from .tables import Table

_ROUGHLY = (
    1e-4  # how sure a search from one of several starts is, some 0.03 of a spread; the best one goes on to the end
)
#: About the best work of adhesion of a retraction, its logarithm less that: searches begin there.
_ABOUT = np.linspace(-0.3, 0.3, 8)
_SURE = 0.999  # level of the F test that there is a contact
_SAME = 1e-3  # minima whose unknowns differ by less than this part of a spread are one


class FitStatus(Codes):
    """What became of the fit of a curve; the first that holds in the order of `_ORDER`."""

    CONVERGED = 0
    AT_BOUND = 1
    ITERATION_LIMIT = 2
    SEVERAL_MINIMA = 3
    NOT_IDENTIFIABLE = 4
    NO_CONTACT = 5
    INVALID_INPUT = 6


class _Posed(NamedTuple):
    """Curves as a problem of least squares: all points, and fewer if the curves are long."""

    asked: Asked
    curve: Curve
    data: Data
    few: Thinned | None
    starts: list
    variance: np.ndarray
    prior: np.ndarray


def fit_block(
    asked: Asked, table: Table | Ladder, x: np.ndarray, y: np.ndarray, sigma: np.ndarray | None
) -> dict[str, Any]:
    """Fit curves (B, n), NaN where there is no point. Every curve has more points than unknowns.

    sigma : (B, n) standard deviations of y; None: from the residuals

    Returns the unknowns p (B, k), the ends low and high of their intervals, their covariance (B, k, k) and what the
    spreads of other inputs add to it (`propagated`), Student's t (B, k), status (B,), the fit of y (B, n), the units of
    x and y (wide and top, (B,)) in which D0, P0 and tilt are, what the residuals say (:class:`.points.worth.Worth`)
    and the first unknown by parts of the contact (`parts`, (B, PARTS)).
    """
    posed = _posed(asked, table, x, y, sigma)
    curve, data, there = posed.curve, posed.data, np.isfinite(x) & np.isfinite(y)
    best, costs, places = _searched(posed)
    count, k = _count(asked, data), best.p.shape[1]
    variance = posed.variance
    if sigma is None and not asked.priors:
        variance = best.cost / np.maximum(count - k, 1)
    share = _share(curve, best)
    worth = worth_of(curve.x, data, best, variance, posed.prior, share)
    freedom = worth.freedom - asked.model.sticks
    tail = (1 + asked.level) / 2
    t = special.stdtrit(np.maximum(freedom, 1), tail)
    t = t if sigma is None else np.where(worth.factors > 1, t, special.ndtri(tail))
    root = np.sqrt(worth.factors)
    covariance = covariance_of(data, best, variance) * root[:, :, None] * root[:, None, :]
    sd = np.sqrt(np.einsum("bii->bi", covariance))
    sides = _Ends(best.p - t * sd, best.p + t * sd, np.zeros(len(x), bool), np.zeros(len(x), bool))
    above = (t**2 * variance[:, None] * worth.factors)[:, : len(asked.model.unknowns)]
    sides = _intervals(posed, best, (costs, places), sides, sd, above)
    at_bound = ((best.p <= data.low) | (best.p >= data.high))[:, : above.shape[1]].any(axis=1)
    no_contact = _no_contact(curve, data, best, count, k) & (asked.model.x == "D")  # else the contact is not in doubt
    status = np.select(
        [no_contact, ~best.ended, at_bound, sides.open, sides.several],
        [
            FitStatus.NO_CONTACT,
            FitStatus.ITERATION_LIMIT,
            FitStatus.AT_BOUND,
            FitStatus.NOT_IDENTIFIABLE,
            FitStatus.SEVERAL_MINIMA,
        ],
        FitStatus.CONVERGED,
    )
    status = np.where(np.isfinite(best.cost), status, FitStatus.INVALID_INPUT)
    numbers = {"p": best.p, "low": sides.low, "high": sides.high, "covariance": covariance, "t": t, "status": status}
    numbers |= {"propagated": _propagated(asked, curve, data, best), "wide": curve.wide, "top": curve.high}
    numbers |= {"parts": parts_of(curve, data, best, share, worth), **worth._asdict()}
    return numbers | {"fit": np.where(there, best.model * curve.high[:, None], np.nan)}


def _posed(asked: Asked, table: Table | Ladder, x: np.ndarray, y: np.ndarray, sigma: np.ndarray | None) -> _Posed:
    model, there = asked.model, np.isfinite(x) & np.isfinite(y)
    top = np.where(there, y, -np.inf).max(axis=1) - np.where(there, y, np.inf).min(axis=1)
    largest, least = np.where(there, x, -np.inf).max(axis=1), np.where(there, x, np.inf).min(axis=1)
    wide = np.where(largest - least > 0, largest - least, largest) if "D0" in asked.shifts else largest
    x = np.where(there, x, largest[:, None])
    curve = Curve(table, x, wide, top, asked.shifts)
    with np.errstate(divide="ignore", invalid="ignore"):
        w = np.where(there, 1.0 if sigma is None else top[:, None] / np.where(there, sigma, 1.0), 0.0)
    y = np.where(there, y, 0.0)
    k = len(curve.names)
    none = np.zeros((len(x), k))
    data = Data(y / top[:, None], w, none, none, none, none.copy(), asked.loss == "huber")
    long = x.shape[1] > LONG and bool((there.sum(axis=1) > LONG).all())
    few = thinned(curve, data) if long else None
    of, points = (few.curve, few.data) if few else (curve, data)
    starts, low, high = starts_of(asked, of, points.w > 0, points.y * top[:, None], top, least)
    data, points = (part._replace(low=low, high=high, center=none.copy()) for part in (data, points))
    if model.sticks:
        curve, of = (replace(c, points=Points.of(c.x, d.y, d.w, k, d.huber)) for c, d in ((curve, data), (of, points)))
        starts = best_of(of, points, starts)
    variance = prior = np.ones(len(x))
    if asked.priors:
        columns = [model.unknowns.index(name) for name in asked.priors]
        center, sd = np.array(list(asked.priors.values())).T
        variance, prior = _scatter(curve, data, starts[0], columns, center, sigma is None)
        for each in (data, points):
            each.center[:, columns] = center
        data.stiffness[:, columns] = prior[:, None] / sd**2
        points = points._replace(stiffness=data.stiffness)
    few = few and few._replace(curve=of, data=points)
    return _Posed(asked, curve, data, few, starts, variance, prior)


def _scatter(
    curve: Curve, data: Data, start: np.ndarray, columns: list[int], center: np.ndarray, unknown: bool
) -> tuple[np.ndarray, np.ndarray]:
    """The variance (B,) of the points, if it is unknown, else 1, and what a prior counts it as, from a fit with the
    inputs `columns` at their priors: points that hang together are so many fewer, and must not overrule it."""
    begin, held = start.copy(), np.zeros(start.shape, bool)
    begin[:, columns], held[:, columns] = center, True
    fit = minimise(curve, data, begin, held)
    freedom = np.maximum((data.w > 0).sum(axis=1) - start.shape[1] + len(columns), 1)
    variance = fit.cost / freedom if unknown else np.ones(len(start))
    worth = worth_of(curve.x, data, fit, variance, 0 * variance, _share(curve, fit))
    return variance, variance * worth.factors[:, : len(curve.table.model.unknowns)].max(axis=1)


def _count(asked: Asked, data: Data) -> np.ndarray:
    """Points (B,). Of what sticks, the point above which the others are in contact counts like an unknown."""
    return (data.w > 0).sum(axis=1) - asked.model.sticks


def _searched(posed: _Posed) -> tuple[Fit, np.ndarray, np.ndarray]:
    """The best fits, of all points, and the costs (starts, B) and unknowns (starts, B, k) at which searches from all
    starts have ended, of fewer points if there are many."""
    curve, data = (posed.few.curve, posed.few.data) if posed.few else (posed.curve, posed.data)
    starts, B = posed.starts, len(data.y)
    # all starts at once: what a step costs is that of its calls, hardly that of its numbers
    every = np.tile(np.arange(B), len(starts))
    rough = SURE if len(starts) == 1 else _ROUGHLY
    fits = minimise(curve.take(every), data.take(every), np.concatenate(starts), sure=rough)
    costs, places = fits.cost.reshape(len(starts), -1), fits.p.reshape(len(starts), B, -1)
    best = fits.take(costs.argmin(axis=0) * B + np.arange(B))
    if posed.asked.model.sticks and posed.curve.points.retracts.any():
        costs, places = _to_the_ends(posed, (curve, data), best.p, (costs, places))
        best = best._replace(p=places[costs.argmin(axis=0), np.arange(B)])
    if posed.few or len(starts) > 1:
        best = minimise(posed.curve, posed.data, best.p)
    return best, costs, places


def _to_the_ends(posed: _Posed, few: tuple[Curve, Data], p: np.ndarray, minima: tuple) -> tuple:
    """The costs and unknowns of searches, of retractions those without a ramp beyond the end of the branch.

    Each point that passes the end makes the cost jump, and a search from one side does not see the other. So it begins
    about the best unknowns p (B, k) of the search with a ramp: with other works of adhesion, or values of the first
    unknown if that is known, for which the others are fitted first.
    """
    (curve, data), model, (costs, places) = few, posed.asked.model, minima
    place = model.unknowns.index("w_adhesion") if "w_adhesion" in model.unknowns else 0
    count, B = len(_ABOUT), len(p)
    every, begin = np.tile(np.arange(B), count), np.tile(p, (count, 1))
    held = np.zeros(begin.shape, bool)
    held[:, place] = True
    begin[:, place] = np.clip(
        begin[:, place] + np.repeat(_ABOUT, B), *(end[every, place] for end in (data.low, data.high))
    )
    of, to = curve.take(every), data.take(every)
    begin = minimise(of, to, begin, held, sure=_ROUGHLY).p
    for each in (of, curve, posed.curve):
        each.ends = True
    fits = minimise(of, to, begin, sure=_ROUGHLY)
    retracts = posed.curve.points.retracts
    more = np.where(retracts, fits.cost.reshape(count, B), np.inf)
    costs = np.concatenate([np.where(retracts, np.inf, costs), more])
    return costs, np.concatenate([places, fits.p.reshape(count, B, -1)])


class _Ends(NamedTuple):
    """The ends (B, k) of intervals, and whether one is a bound, and whether another minimum lies within, (B,)."""

    low: np.ndarray
    high: np.ndarray
    open: np.ndarray
    several: np.ndarray


def _intervals(posed: _Posed, best: Fit, minima: tuple, ends: _Ends, sd: np.ndarray, above: np.ndarray) -> _Ends:
    """Intervals of the inputs by profiles, if they are asked for; the others stay.

    above : (B, inputs), by how much the cost at the ends of the interval of an input is above the least one
    """
    (costs, places), inputs = minima, above.shape[1]
    curve, data, least = posed.curve, posed.data, best.cost
    if posed.few:
        few = posed.few.about(best, curve, data)
        curve, data = few.curve, few.data
        least = costs.min(axis=0)  # of the same points as the other minima
    within = costs <= least + above.max(axis=1)
    apart = np.abs(places[:, :, :inputs] - best.p[:, :inputs]) > np.maximum(sd[:, :inputs], _SAME)
    ends = ends._replace(several=(within & apart.any(axis=2)).any(axis=0))
    if posed.asked.intervals != "profile" or data.huber:
        return ends
    if posed.few:
        best = minimise(curve, data, best.p)
        costs = costs - least + best.cost
    every = np.arange(len(best.p))
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


def _share(curve: Curve, fit: Fit) -> np.ndarray:
    """The depth below the contact point of each point over that of the deepest, (B, n); 0 before the contact, and
    hardly above it where a contact sticks before that depth."""
    depth = curve.x
    if "D0" in curve.shifts:
        depth = depth - fit.p[:, [curve.names.index("D0")]] * curve.wide[:, None]
    share = np.maximum(depth, 0.0) / np.maximum(depth.max(axis=1, keepdims=True), 1e-300)
    return np.maximum(share, 1e-9 * (curve.contact(fit.p)[0] != 0)) if curve.table.model.sticks else share


def _no_contact(curve: Curve, data: Data, best: Fit, count: np.ndarray, k: int) -> np.ndarray:
    """Whether a straight line fits as well: the model lowers its sum of squares by no more than chance would, in all
    but one of a thousand curves."""
    w2 = data.w**2
    x = curve.x / curve.wide[:, None]
    total = w2.sum(axis=1)
    xm, ym = (w2 * x).sum(axis=1) / total, (w2 * data.y).sum(axis=1) / total
    dx, dy = x - xm[:, None], data.y - ym[:, None]
    sxx, sxy, syy = ((w2 * a * b).sum(axis=1) for a, b in ((dx, dx), (dx, dy), (dy, dy)))
    line = syy - np.where(sxx > 0, sxy**2 / np.where(sxx > 0, sxx, 1.0), 0.0)
    residual = (w2 * (data.y - best.model) ** 2).sum(axis=1)
    free, more = np.maximum(count - k, 1), max(k - 2, 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        F = (line - residual) / more / (residual / free)
    return ~(special.fdtri(more, free, _SURE) < F) & np.isfinite(best.cost)


def _propagated(asked: Asked, curve: Curve, data: Data, best: Fit) -> np.ndarray:
    """The covariance (B, k, k) that the spreads of other inputs make: the unknowns follow each of them."""
    k = best.p.shape[1]
    whole = np.zeros((len(best.p), k, k))
    if not asked.model.moved:
        return whole
    _, _, others = curve.contact(best.p, moved=True)
    A, _ = normal(data, best.p, best.model, best.J, best.weights)
    A = inverse(A)
    for name, by in zip(asked.model.moved, others, strict=True):
        follows = -np.einsum("bij,bnj,bn,bn->bi", A, best.J, best.weights, by) * asked.spreads[name]
        whole += follows[:, :, None] * follows[:, None, :]
    return whole

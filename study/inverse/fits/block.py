"""Fits of the curves of one block: starts, least squares, intervals, status."""

from typing import Any

import numpy as np
from scipy import special

from solver.numerics.codes import Codes

from .asked import Asked
from .curve import Curve
from .intervals import covariance_of, profiles
from .least_squares import SURE, Data, Fit, minimise
from .starts import best_of, starts_of
from .sticking.labels import Points
from .sticking.ladder import Ladder
from .tables import Table

_ROUGHLY = (
    1e-4  # how sure a search from one of several starts is, some 0.03 of a spread; the best one goes on to the end
)
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


def fit_block(
    asked: Asked, table: Table | Ladder, x: np.ndarray, y: np.ndarray, sigma: np.ndarray | None
) -> dict[str, Any]:
    """Fit curves (B, n), NaN where there is no point. Every curve has more points than unknowns.

    sigma : (B, n) standard deviations of y; None: from the residuals

    Returns the unknowns p (B, k), the ends low and high of their intervals, their covariance (B, k, k) and what the
    spreads of other inputs add to it (`propagated`), Student's t (B,), status (B,), the fit of y (B, n), and the units
    of x and y (wide and top, (B,)) in which D0, P0 and tilt are.
    """
    model, there = asked.model, np.isfinite(x) & np.isfinite(y)
    top = np.where(there, y, -np.inf).max(axis=1) - np.where(there, y, np.inf).min(axis=1)
    largest, least = np.where(there, x, -np.inf).max(axis=1), np.where(there, x, np.inf).min(axis=1)
    wide = np.where(largest - least > 0, largest - least, largest) if "D0" in asked.shifts else largest
    x = np.where(there, x, largest[:, None])
    curve = Curve(table, x, wide, top, asked.shifts)
    with np.errstate(divide="ignore", invalid="ignore"):
        w = np.where(there, 1.0 if sigma is None else top[:, None] / np.where(there, sigma, 1.0), 0.0)
    # of what sticks, the point above which the others are in contact counts like an unknown
    count, k = there.sum(axis=1) - model.sticks, len(curve.names)
    starts, low, high = starts_of(asked, curve, there, y, top, least)
    data = Data(np.where(there, y, 0.0) / top[:, None], w, low, high, *_no_prior(low), asked.loss == "huber")
    if model.sticks:
        curve.points = Points.of(x, data.y, data.w, k, data.huber)
        starts = best_of(curve, data, starts)
    variance = np.ones(len(x))
    if asked.priors:
        columns = [model.unknowns.index(name) for name in asked.priors]
        center, sd = np.array(list(asked.priors.values())).T
        if sigma is None:  # the scatter of the points, from a fit with the inputs at their priors
            held = np.zeros(low.shape, bool)
            held[:, columns] = True
            begin = starts[0].copy()
            begin[:, columns] = center
            variance = minimise(curve, data, begin, held).cost / np.maximum(count - k + len(columns), 1)
        data.center[:, columns], data.stiffness[:, columns] = center, variance[:, None] / sd**2
    # all starts at once: what a step costs is that of its calls, hardly that of its numbers
    every = np.tile(np.arange(len(x)), len(starts))
    rough = SURE if len(starts) == 1 else _ROUGHLY
    fits = minimise(curve.take(every), data.take(every), np.concatenate(starts), sure=rough)
    costs, places = fits.cost.reshape(len(starts), -1), fits.p.reshape(len(starts), len(x), k)
    best = fits.take(costs.argmin(axis=0) * len(x) + np.arange(len(x)))
    best = minimise(curve, data, best.p) if len(starts) > 1 else best
    if sigma is None and not asked.priors:
        variance = best.cost / np.maximum(count - k, 1)
    tail = (1 + asked.level) / 2
    t = special.stdtrit(np.maximum(count - k, 1), tail) if sigma is None else np.full(len(x), special.ndtri(tail))
    covariance = covariance_of(data, best, variance)
    limit = best.cost + t**2 * variance
    sd = np.sqrt(np.einsum("bii->bi", covariance))
    ends_low, ends_high = best.p - t[:, None] * sd, best.p + t[:, None] * sd
    open_, inputs = np.zeros((len(x), len(model.unknowns), 2), bool), len(model.unknowns)
    within = costs <= limit
    apart = np.abs(places[:, :, :inputs] - best.p[:, :inputs]) > np.maximum(sd[:, :inputs], _SAME)
    several = (within & apart.any(axis=2)).any(axis=0)
    if asked.intervals == "profile" and not data.huber:
        far = [
            np.where(within, side * places[:, :, i], -np.inf).argmax(axis=0) for i in range(inputs) for side in (-1, 1)
        ]
        ends = [(places[start, np.arange(len(x))], costs[start, np.arange(len(x))]) for start in far]
        first = np.clip(sd * t[:, None], 1e-6, (high - low) / 4)
        value, bound = profiles(curve, data, best, ends, limit, first)
        ends_low[:, :inputs], ends_high[:, :inputs] = value[:, :, 0], value[:, :, 1]
        open_ = bound
    at_bound = ((best.p <= low) | (best.p >= high))[:, :inputs].any(axis=1)
    no_contact = _no_contact(curve, data, best, count, k) & (model.x == "D")  # else the contact is not in doubt
    status = np.select(
        [no_contact, ~best.ended, at_bound, open_.any(axis=(1, 2)), several],
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
    propagated = _propagated(asked, curve, data, best)
    fitted = np.where(there, best.model * top[:, None], np.nan)
    numbers = {"p": best.p, "low": ends_low, "high": ends_high, "covariance": covariance, "propagated": propagated}
    return numbers | {"t": t, "status": status, "fit": fitted, "wide": wide, "top": top}


def _no_prior(low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.zeros(low.shape), np.zeros(low.shape)


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
    from .least_squares import inverse, normal

    _, _, others = curve.contact(best.p, moved=True)
    A, _ = normal(data, best.p, best.model, best.J, best.weights)
    A = inverse(A)
    for name, by in zip(asked.model.moved, others, strict=True):
        follows = -np.einsum("bij,bnj,bn,bn->bi", A, best.J, best.weights, by) * asked.spreads[name]
        whole += follows[:, :, None] * follows[:, None, :]
    return whole

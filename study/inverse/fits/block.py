"""Fits of the curves of one block: starts, least squares, intervals, status."""

from dataclasses import replace
from enum import IntEnum
from typing import Any

import numpy as np
from scipy import stats

from .asked import DECADE, Asked
from .curve import Curve
from .intervals import covariance_of, profiles
from .least_squares import SURE, Data, Fit, minimise
from .model import HERTZ, is_ratio
from .sticking import Direct
from .tables import Table

_ROUGHLY = (
    1e-4  # how sure a search from one of several starts is, some 0.03 of a spread; the best one goes on to the end
)
_STARTS = 6  # across the bounds of a second unknown input
_SURE = 0.999  # level of the F test that there is a contact
#: y = _HERTZ x^q E^e R^r of a rigid ball on a half-space.
_HERTZ = {("D", "P"): 4 / 3, ("P", "a"): 0.75 ** (1 / 3), ("a", "dP_dD"): 2.0}
_SAME = 1e-3  # minima whose unknowns differ by less than this part of a spread are one


class FitStatus(IntEnum):
    """What became of the fit of a curve; the first that holds in the order of `_ORDER`."""

    CONVERGED = 0
    AT_BOUND = 1
    ITERATION_LIMIT = 2
    SEVERAL_MINIMA = 3
    NOT_IDENTIFIABLE = 4
    NO_CONTACT = 5
    INVALID_INPUT = 6


def fit_block(
    asked: Asked, table: Table | Direct, x: np.ndarray, y: np.ndarray, sigma: np.ndarray | None
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
    count, k = there.sum(axis=1), len(curve.names)
    starts, low, high = _starts(asked, curve, there, y, top, least)
    data = Data(np.where(there, y, 0.0) / top[:, None], w, low, high, *_no_prior(low), asked.loss == "huber")
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
    t = stats.t.ppf(tail, np.maximum(count - k, 1)) if sigma is None else np.full(len(x), stats.norm.ppf(tail))
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


def _starts(asked: Asked, curve: Curve, there: np.ndarray, y: np.ndarray, top: np.ndarray, least: np.ndarray) -> tuple:
    """A list of unknowns (B, k), at each of which a search begins, and their bounds (B, k)."""
    model, names, B = asked.model, curve.names, len(y)
    power = HERTZ[model.x, model.y][0]
    D0, P0, depth, load = _contact_points(asked, curve, there, y, power[0])
    E = np.clip(load / (_HERTZ[model.x, model.y] * depth ** power[0] * model.scene.R ** power[2]), 1e-300, None) ** (
        1 / power[1]
    )
    nu = {"E1": "nu1", "E2": "nu2"}[model.modulus]
    hertz = np.log(E * (1 - float(model.scene.values.get(nu, 0.3)) ** 2))
    p, low, high = (np.zeros((B, len(names))) for _ in range(3))
    for i, name in enumerate(names):
        if name == "D0":  # within the points, and as far before them
            p[:, i] = D0 / curve.wide
            low[:, i], high[:, i] = least / curve.wide - 1.0, least / curve.wide + 0.999
        elif name in ("P0", "tilt"):
            p[:, i] = P0 / top if name == "P0" else 0.0
            low[:, i], high[:, i] = p[:, i] - 1e3, p[:, i] + 1e3
        elif name in asked.bounds:
            low[:, i], high[:, i] = model.coordinate(name, np.array(asked.bounds[name]))
            p[:, i] = (low[:, i] + high[:, i]) / 2
        elif name in asked.priors:
            center, sd = asked.priors[name]
            p[:, i], low[:, i], high[:, i] = center, center - 10 * sd, center + 10 * sd
            high[:, i] = np.minimum(high[:, i], 0.5) if is_ratio(name) else high[:, i]
        else:
            p[:, i], low[:, i], high[:, i] = hertz, hertz - 3 * DECADE, hertz + 3 * DECADE
    scanned = [i for i, name in enumerate(model.unknowns) if name in asked.free and name != model.modulus][:1]
    places = [(j + 0.5) / _STARTS for j in range(_STARTS)] if scanned else [0.5]
    starts = []
    for place in places:
        start = p.copy()
        for i in scanned:
            start[:, i] = low[:, i] + place * (high[:, i] - low[:, i])
        starts.append(_with_modulus(asked, curve, start, low, high, D0 + depth, load))
    return starts, low, high


def _with_modulus(asked, curve, p, low, high, x, load):
    """The unknowns p with that modulus, if it is unknown, which brings the curve through the deepest point: by Newton's
    steps in logarithms."""
    model = asked.model
    if model.modulus not in model.unknowns:
        return p
    i = model.unknowns.index(model.modulus)
    alone = replace(curve, x=x[:, None])
    wanted = np.log(np.maximum(load / curve.high, 1e-300))
    p = p.copy()
    p[:, i] = np.clip(p[:, i], low[:, i], high[:, i])
    for _ in range(12):
        F, by, _ = alone.contact(p)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = (wanted - np.log(F[:, 0])) / np.maximum(np.abs(by[model.modulus][:, 0] / F[:, 0]), 0.03)
        step *= np.sign(HERTZ[model.x, model.y][0][1])
        p[:, i] = np.clip(p[:, i] + np.clip(np.nan_to_num(step), -2.0, 2.0), low[:, i], high[:, i])
    return p


def _contact_points(asked: Asked, curve: Curve, there: np.ndarray, y: np.ndarray, q: float) -> tuple:
    """First values (B,) of D0 and P0, and the depth and load of the deepest point above them.

    P0 is the mean of the first tenth of the points. D0 follows from the depths at 10 and 50 % of the load, as if the
    load rose with the power q of the depth.
    """
    B = len(y)
    D0, P0, deepest, load = np.zeros(B), np.zeros(B), np.zeros(B), np.zeros(B)
    part = 0.2 ** (1 / q)
    for b in range(B):
        order = np.argsort(curve.x[b][there[b]], kind="stable")
        xs, ys = curve.x[b][there[b]][order], y[b][there[b]][order]
        tenth = max(1, len(xs) // 10)
        P0[b] = ys[:tenth].mean() if "P0" in asked.shifts else 0.0
        high = np.sort(ys)[-max(1, len(ys) // 50) :].mean() - P0[b]
        if "D0" in asked.shifts:
            x10, x50 = (xs[max(np.flatnonzero(ys - P0[b] < share * high), default=0)] for share in (0.1, 0.5))
            D0[b] = np.clip((x10 - part * x50) / (1 - part), xs[0], xs[-1] - 1e-3 * curve.wide[b])
        deepest[b], load[b] = xs[-1] - D0[b], max(high, 1e-300)
    return D0, P0, deepest, load


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
    return ~(stats.f.ppf(_SURE, more, free) < F) & np.isfinite(best.cost)


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

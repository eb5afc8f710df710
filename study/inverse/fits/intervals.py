"""How sure a fit is: covariances, and intervals by profiles of the likelihood."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .least_squares import HUBER, Data, Fit, inverse, minimise, normal, scale

_INNER, _INNER_SURE = 30, 1e-4  # steps of an inner fit, and by what part of the mean square it may be off
_OUTWARD, _BETWEEN = 24, 8  # steps of the walk to the limit, and between its last two places
_PRECISE = 2e-3  # of the width of an interval


class Sure(NamedTuple):
    """covariance (B, k, k) of the unknowns; low, high (B, k); open (B, k, 2): ends that are bounds."""

    covariance: np.ndarray
    low: np.ndarray
    high: np.ndarray
    open: np.ndarray


def covariance_of(data: Data, fit: Fit, variance: np.ndarray) -> np.ndarray:
    """(B, k, k) from the curvature at the minimum; of Huber's loss the sandwich.

    variance : (B,) of a point of weight 1
    """
    if not data.huber:
        A, _ = normal(data, fit.p, fit.model, fit.J, fit.weights)
        return inverse(A) * variance[:, None, None]
    residual = np.where(data.w > 0, data.w * (data.y - fit.model), 0.0)
    limit = HUBER * scale(residual, data.w)[:, None]
    inside = np.where(np.abs(residual) <= limit, data.w**2, 0.0)
    A = np.einsum("bni,bn,bnj->bij", fit.J, inside, fit.J) + np.eye(fit.p.shape[1]) * data.stiffness[:, :, None]
    score = data.w * np.clip(residual, -limit, limit)
    middle = np.einsum("bni,bn,bnj->bij", fit.J, score**2, fit.J)
    middle = middle + np.eye(fit.p.shape[1]) * (data.stiffness * variance[:, None])[:, :, None]
    A = inverse(A)
    return np.einsum("bij,bjk,bkl->bil", A, middle, A)


def profile(
    curve: Callable,
    data: Data,
    best: Fit,
    ends: tuple[np.ndarray, np.ndarray],
    limit: np.ndarray,
    sd: np.ndarray,
    i: int,
    side: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Where the profile of unknown i reaches `limit` on a side, -1 or 1: its place (B,), and whether it is a bound
    (B,).

    ends : unknowns (B, k) where the walk begins: of the minima within the limit the farthest on this side
    sd : (B,) first step
    """
    held = np.zeros(best.p.shape, bool)
    held[:, i] = True
    bound = (data.high if side > 0 else data.low)[:, i]
    p, inside = ends[0].copy(), ends[0][:, i].copy()
    start = best.cost
    height = np.sqrt(np.maximum(ends[1] - start, 0.0))
    top = np.sqrt(np.maximum(limit - start, 0.0))
    outside, beyond, open_ = np.full(len(p), np.nan), np.full(len(p), np.nan), np.zeros(len(p), bool)
    step, done = np.maximum(sd, 1e-6), ~np.isfinite(limit)
    for _ in range(_OUTWARD):
        if done.all():
            break
        trial = inside + side * step
        trial = np.minimum(trial, bound) if side > 0 else np.maximum(trial, bound)
        p, h = _inner(curve, data, p, held, i, trial, start, ~done)
        out = ~done & (h > top)
        outside, beyond = np.where(out, trial, outside), np.where(out, h, beyond)
        at_bound = ~done & ~out & (trial == bound)
        open_ |= at_bound
        moving = ~done & ~out
        inside, height = np.where(moving, trial, inside), np.where(moving, h, height)
        done = done | out | at_bound
        p[out, i] = inside[out]
        step = step * 1.7
    place = np.where(open_, bound, inside)
    found = np.isfinite(outside)
    for _ in range(_BETWEEN):
        width = np.abs(outside - inside)
        left = found & (width > _PRECISE * np.abs(outside - best.p[:, i]))
        if not left.any():
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (top - height) / (beyond - height)
        share = np.clip(np.where(np.isfinite(share), share, 0.5), 0.05, 0.95)
        trial = inside + share * (outside - inside)
        p, h = _inner(curve, data, p, held, i, trial, start, left)
        out = left & (h > top)
        outside, beyond = np.where(out, trial, outside), np.where(out, h, beyond)
        inside, height = np.where(left & ~out, trial, inside), np.where(left & ~out, h, height)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.clip((top - height) / (beyond - height), 0.0, 1.0)
    return np.where(found, inside + np.where(np.isfinite(share), share, 0.5) * (outside - inside), place), open_


def _inner(curve, data, p, held, i, value, start, wanted):
    """The other unknowns where unknown i has a value, and the root of what the cost is above that of the best fit; of the
    curves that are `wanted`. Others stay: what a curve gets must not depend on how far its company has to walk."""
    rows, p, height = np.flatnonzero(wanted), p.copy(), np.full(len(p), np.nan)
    p[rows, i] = value[rows]
    fit = minimise(curve.take(rows), data.take(rows), p[rows], held[rows], _INNER, _INNER_SURE)
    p[rows], height[rows] = fit.p, np.sqrt(np.maximum(fit.cost - start[rows], 0.0))
    return p, height

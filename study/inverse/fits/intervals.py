"""The uncertainty of a fit: covariances, and intervals by profiles of the likelihood."""

from typing import Any

import numpy as np

from .least_squares import HUBER, Data, Minimum, inverse, minimise, normal, scale

_INNER, _INNER_SURE = 30, 1e-4  # number of steps of an inner fit, and its precision over the mean square
#: Steps with hardly a gain that end an inner fit: the root of the cost, which counts, is then right to a hundredth.
_PATIENCE = 8
_OUTWARD, _BETWEEN = 24, 8  # number of steps of the walk to the limit, and between its last two places
_PRECISE = 2e-3  # precision of an end, over the width of the interval


def covariance_of(data: Data, fit: Minimum, variance: np.ndarray) -> np.ndarray:
    """The covariance (B, k, k) of the unknowns, from the curvature at the minimum. Under Huber's loss it is the
    "sandwich" of two curvatures, which also holds for errors that are not normal.

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


def profiles(
    curve: Any,
    data: Data,
    best: Minimum,
    ends: list[tuple[np.ndarray, np.ndarray]],
    limit: np.ndarray,
    first: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """The low and high ends (B, unknowns, 2) of the intervals of the first unknowns, and whether an end is a bound.

    The profile of an unknown is the least cost for each of its values. Its interval ends where the profile reaches
    `limit` (B, unknowns). The walk goes outward from the minima, all ends at once: a row is a curve, an unknown and a
    side.

    ends : the beginnings of the walks, for the low and the high end of the first unknown, then of the next: unknowns
        (B, k) and costs (B,) of the minimum within the limit that lies farthest on this side
    first : (B, k) first steps
    """
    B, walks = len(best.p), len(ends)
    rows, walk = np.tile(np.arange(B), walks), np.repeat(np.arange(walks), B)
    which, side = walk // 2, np.where(walk % 2, 1.0, -1.0)
    begin = np.concatenate([p for p, _ in ends]), np.concatenate([cost for _, cost in ends])
    place, at_bound = _walk(
        (curve.take(rows), data.take(rows)), best.take(rows), begin, limit[rows, which], first[rows, which], which, side
    )
    shape = (walks // 2, 2, B)
    return np.moveaxis(place.reshape(shape), 2, 0), np.moveaxis(at_bound.reshape(shape), 2, 0)


def _walk(
    of: tuple[Any, Data],
    best: Minimum,
    begin: tuple[np.ndarray, np.ndarray],
    limit: np.ndarray,
    step: np.ndarray,
    which: np.ndarray,
    side: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """The value (B,) of unknown `which` (B,) at which its profile reaches `limit`, and whether that is a bound.

    side : (B,) -1 or 1, the direction of the walk

    The steps of the walk grow until one exceeds the limit. Then the place between the last two is searched.
    """
    every, data, start = np.arange(len(which)), of[1], best.cost
    bound = np.where(side > 0, data.high[every, which], data.low[every, which])
    p, inside = begin[0].copy(), begin[0][every, which]
    height = np.sqrt(np.maximum(begin[1] - start, 0.0))
    top = np.sqrt(np.maximum(limit - start, 0.0))
    outside, outer_height, open_ = np.full(len(p), np.nan), np.full(len(p), np.nan), np.zeros(len(p), bool)
    step, done = np.maximum(step, 1e-6), ~np.isfinite(limit)
    for _ in range(_OUTWARD):
        if done.all():
            break
        trial = inside + side * step
        trial = np.where(side > 0, np.minimum(trial, bound), np.maximum(trial, bound))
        p, h = _inner(of, p, which, trial, start, ~done)
        out = ~done & (h > top)
        outside, outer_height = np.where(out, trial, outside), np.where(out, h, outer_height)
        at_bound = ~done & ~out & (trial == bound)
        open_ |= at_bound
        moving = ~done & ~out
        inside, height = np.where(moving, trial, inside), np.where(moving, h, height)
        done = done | out | at_bound
        step = step * 1.7
    place = np.where(open_, bound, inside)
    crossed = np.isfinite(outside)
    for _ in range(_BETWEEN):
        width = np.abs(outside - inside)
        left = crossed & (width > _PRECISE * np.abs(outside - best.p[every, which]))
        if not left.any():
            break
        share = np.clip(_share(top, height, outer_height), 0.05, 0.95)
        trial = inside + share * (outside - inside)
        p, h = _inner(of, p, which, trial, start, left)
        out = left & (h > top)
        outside, outer_height = np.where(out, trial, outside), np.where(out, h, outer_height)
        inside, height = np.where(left & ~out, trial, inside), np.where(left & ~out, h, height)
    share = np.clip(_share(top, height, outer_height), 0.0, 1.0)
    return np.where(crossed, inside + share * (outside - inside), place), open_


def _share(top: np.ndarray, height: np.ndarray, outer_height: np.ndarray) -> np.ndarray:
    """The share of the way from `height` to `outer_height` at which a straight line reaches the top."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (top - height) / (outer_height - height)
    return np.where(np.isfinite(share), share, 0.5)


def _inner(
    of: tuple[Any, Data], p: np.ndarray, which: np.ndarray, value: np.ndarray, start: np.ndarray, wanted: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Fits with unknown `which` fixed at a value: the unknowns, and the root of the cost above the best cost.

    Rows that are not `wanted` stay as they are: the numbers of a curve must not depend on the walks of others.
    """
    rows, p, height = np.flatnonzero(wanted), p.copy(), np.full(len(p), np.nan)
    p[rows, which[rows]] = value[rows]
    fixed = np.zeros((len(rows), p.shape[1]), bool)
    fixed[np.arange(len(rows)), which[rows]] = True
    fit = minimise(of[0].take(rows), of[1].take(rows), p[rows], fixed, _INNER, _INNER_SURE, _PATIENCE)
    p[rows], height[rows] = fit.p, np.sqrt(np.maximum(fit.cost - start[rows], 0.0))
    return p, height

"""Levenberg-Marquardt for many curves at once. Arrays have the curves first: B curves, n points, k unknowns.

The result of a curve does not depend on the others in the batch: every sum is over one curve.
"""

from typing import Any, NamedTuple

import numpy as np

from solver.numerics import batch

STEPS = 100  # largest number of steps
_CLOSE = 1e-9  # smaller steps of all unknowns end the search; all unknowns are of order 1
#: Precision of a search; unknowns are then within 1e-4 of their spreads.
SURE = 1e-8
#: A batch is padded to a multiple of so many curves: numpy sums the points of a lone curve in another order.
AT_LEAST = 2
#: Number of steps with hardly a gain that end the search: where a point lies at the beginning of the contact, the cost
#: has a crease, along which steps are short. Unknowns are then within some 1e-3 of their spreads.
_IDLE = 30
_STIFF = 1e10  # damping above which only rounding errors remain
#: Huber's loss: residuals above HUBER times the scale count linearly. The scale is MAD times the median deviation.
HUBER, MAD = 1.345, 1.4826


@batch.of_cases
class Data(NamedTuple):
    """The points of curves, and bounds and priors of their unknowns.

    y, w : (B, n), values and weights, which are 0 where there is no point
    low, high : (B, k) bounds of the unknowns
    center, stiffness : (B, k) of Gaussian priors, whose cost is stiffness (p - center)²; 0: none
    huber : whether residuals count by Huber's loss
    """

    y: np.ndarray
    w: np.ndarray
    low: np.ndarray
    high: np.ndarray
    center: np.ndarray
    stiffness: np.ndarray
    huber: bool = False


@batch.of_cases
class Minimum(NamedTuple):
    """The end of a search: unknowns p (B, k), cost (B,), model (B, n) and its derivatives J (B, n, k), weights (B, n)
    of the squared residuals, and whether the search ended by itself (B,)."""

    p: np.ndarray
    cost: np.ndarray
    model: np.ndarray
    J: np.ndarray
    weights: np.ndarray
    ended: np.ndarray


def minimise(
    curve: Any,
    data: Data,
    p: np.ndarray,
    fixed: np.ndarray | None = None,
    steps: int = STEPS,
    sure: float = SURE,
    patience: int = _IDLE,
) -> Minimum:
    """Minimise the sum of the squares of w (y - curve(p)), from p on, within the bounds.

    curve : p -> values (B, n) and derivatives (B, n, k), NaN where there are none; `take(index)` selects curves
    fixed : (B, k) bool, unknowns that stay
    sure : the search ends when a step would lower the cost by less than this share of the mean square
    patience : and after so many steps with hardly a gain
    """
    fixed = np.zeros(p.shape, bool) if fixed is None else fixed
    model, J = curve(p)
    fit = Minimum(p.copy(), np.zeros(len(p)), model, J, *weighed(data, p, model)[:1], np.zeros(len(p), bool))
    fit.cost[:] = weighed(data, p, model)[1]
    count = np.maximum((data.w > 0).sum(axis=1), 1)
    left, damping = np.flatnonzero(np.isfinite(fit.cost)), np.full(len(p), 1e-3)
    fit.ended[~np.isfinite(fit.cost)] = True
    idle, little = np.zeros(len(p), int), max(sure, min(1e3 * sure, 1e-5))
    for _ in range(steps):
        if not len(left):
            break
        # Curves that are done leave the batch, which stays a multiple of AT_LEAST
        rows = filled(left)
        new, decrease = _step(data.take(rows), fit.take(rows), fixed[rows], damping[rows])
        part = curve.take(rows)
        new_model, new_J = part(new)
        # The new cost uses Huber's limit of the old residuals, so that both costs can be compared. With the limit of
        # the new residuals it could fall merely because the limit falls
        limit = huber_limit(data.take(rows), fit.model[rows])
        weights, cost = weighed(data.take(rows), new, new_model, limit)
        once = slice(0, len(left))
        better = (cost <= fit.cost[rows])[once]
        small = np.abs(new - fit.p[rows])[once].max(axis=1) < _CLOSE
        near = (decrease <= sure * fit.cost[rows] / count[rows])[once] & (damping[left] <= 1e-3)
        gain = np.where(better, (fit.cost[rows] - cost)[once], 0.0)
        idle[left] = np.where(gain <= little * fit.cost[left] / count[left], idle[left] + 1, 0)
        done = small | (better & near) | (~better & (damping[left] > _STIFF)) | (idle[left] >= patience)
        take = left[better]
        for array, value in zip(fit[:5], (new, cost, new_model, new_J, weights), strict=True):
            array[take] = value[once][better]
        if data.huber:  # the limit of the new residuals, for the next step
            fit.weights[take], fit.cost[take] = weighed(data.take(take), fit.p[take], fit.model[take])
        damping[left] = np.where(better, np.maximum(damping[left] * 0.1, 1e-14), damping[left] * 8)
        fit.ended[left[done]] = True
        left = left[~done]
    return fit


def filled(left: np.ndarray) -> np.ndarray:
    """The numbers of curves, filled up with the first of them to a multiple of AT_LEAST."""
    return left if len(left) % AT_LEAST == 0 else np.resize(left, -(-len(left) // AT_LEAST) * AT_LEAST)


def _step(data: Data, fit: Minimum, fixed: np.ndarray, damping: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The unknowns after a damped step, within the bounds, and the expected decrease of the cost."""
    p, eye = fit.p, np.eye(fit.p.shape[1], dtype=bool)
    A, slope = normal(data, p, fit.model, fit.J, fit.weights)
    still = fixed | ((p <= data.low) & (slope < 0)) | ((p >= data.high) & (slope > 0))
    diagonal = np.maximum(np.einsum("bii->bi", A), 1e-300)
    damped = np.where(still[:, :, None] | still[:, None, :], eye, A + eye * (damping[:, None] * diagonal)[:, :, None])
    damped = np.where(np.isfinite(damped), damped, eye)
    slope = np.where(still, 0.0, slope)
    step = np.linalg.solve(damped, slope[:, :, None])[:, :, 0]
    return np.where(fixed, p, np.clip(p + step, data.low, data.high)), (slope * step).sum(axis=1)


def normal(data: Data, p: np.ndarray, model: np.ndarray, J: np.ndarray, weights: np.ndarray) -> tuple:
    """The matrix (B, k, k) of the normal equations, and their right-hand side (B, k)."""
    weighted = J * weights[:, :, None]
    A = np.einsum("bni,bnj->bij", weighted, J) + np.eye(p.shape[1]) * data.stiffness[:, :, None]
    slope = np.einsum("bni,bn->bi", weighted, data.y - model) + data.stiffness * (data.center - p)
    return A, slope


def weighed(
    data: Data, p: np.ndarray, model: np.ndarray, limit: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Weights of the squares of the residuals, and the cost; infinite where the model has no value.

    limit : (B, 1) of Huber's loss; None: that of these residuals
    """
    residual = np.where(data.w > 0, data.w * (data.y - model), 0.0)
    weights = data.w**2
    squares = residual**2
    if data.huber:
        limit = huber_limit(data, model) if limit is None else limit
        large = np.abs(residual) > limit
        weights = np.where(large, weights * limit / np.where(large, np.abs(residual), 1.0), weights)
        squares = np.where(large, 2 * limit * np.abs(residual) - limit**2, squares)
    cost = squares.sum(axis=1) + (data.stiffness * (p - data.center) ** 2).sum(axis=1)
    return weights, np.where(np.isfinite(cost), cost, np.inf)


def huber_limit(data: Data, model: np.ndarray) -> np.ndarray | None:
    """The limit (B, 1) above which residuals count linearly; None if all count by their squares."""
    if not data.huber:
        return None
    return HUBER * scale(np.where(data.w > 0, data.w * (data.y - model), 0.0), data.w)[:, None]


def scale(residual: np.ndarray, w: np.ndarray) -> np.ndarray:
    """The scale (B,) of the residuals of each curve: 1.4826 of the median of their sizes."""
    return MAD * np.nanmedian(np.where(w > 0, np.abs(residual), np.nan), axis=1)


def inverse(A: np.ndarray) -> np.ndarray:
    """Inverses of symmetric matrices (B, k, k); infinite variances where they are singular."""
    size = np.sqrt(np.maximum(np.einsum("bii->bi", A), 1e-300))
    scaled = A / (size[:, :, None] * size[:, None, :])
    values, vectors = np.linalg.eigh(np.where(np.isfinite(scaled), scaled, np.eye(A.shape[1])))
    with np.errstate(divide="ignore", over="ignore"):
        parts = np.where(values > 1e-14, 1 / values, np.inf)
    whole = np.einsum("bik,bk,bjk->bij", vectors, np.minimum(parts, 1e30), vectors)
    return whole / (size[:, :, None] * size[:, None, :])

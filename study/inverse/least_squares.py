"""Levenberg-Marquardt for many curves at once. Arrays have the curves first: B curves, n points, k unknowns.

What a curve gets does not depend on the others of the batch: every sum is over one curve.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

STEPS = 100  # at most
_CLOSE = 1e-9  # steps of all unknowns below this end the search; all unknowns are of order 1
_STIFF = 1e10  # damping at which only rounding is left
#: Of Huber's loss: residuals beyond this times the scale count linearly; the scale is this times the median deviation.
HUBER, MAD = 1.345, 1.4826


class Data(NamedTuple):
    """Curves and what is known beforehand.

    y, w : (B, n), values and weights, 0 of what is no point
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


class Fit(NamedTuple):
    """Where the search ended: unknowns p (B, k), cost (B,), model (B, n) and its derivatives J (B, n, k), the weights (B, n)
    of the residuals' squares, and whether it ended by itself (B,)."""

    p: np.ndarray
    cost: np.ndarray
    model: np.ndarray
    J: np.ndarray
    weights: np.ndarray
    ended: np.ndarray


def minimise(curve: Callable, data: Data, p: np.ndarray, held: np.ndarray | None = None, steps: int = STEPS) -> Fit:
    """The least squares of w (y - curve(p)), from p, without leaving the bounds.

    curve : p -> values (B, n) and derivatives (B, n, k); NaN where there is none
    held : (B, k) bool, unknowns that stay
    """
    held = np.zeros(p.shape, bool) if held is None else held
    model, J = curve(p)
    weights, cost = _weighed(data, p, model)
    damping, ended = np.full(len(p), 1e-3), ~np.isfinite(cost)
    eye = np.eye(p.shape[1], dtype=bool)
    for _ in range(steps):
        if ended.all():
            break
        A, slope = normal(data, p, model, J, weights)
        still = held | ((p <= data.low) & (slope < 0)) | ((p >= data.high) & (slope > 0))
        both = still[:, :, None] | still[:, None, :]
        diagonal = np.einsum("bii->bi", A)
        damped = np.where(both, eye, A + eye * (damping[:, None] * np.maximum(diagonal, 1e-300))[:, :, None])
        damped = np.where(np.isfinite(damped), damped, eye)
        step = np.linalg.solve(damped, np.where(still, 0.0, slope)[:, :, None])[:, :, 0]
        new = np.where(ended[:, None] | held, p, np.clip(p + step, data.low, data.high))
        new_model, new_J = curve(new)
        new_weights, new_cost = _weighed(data, new, new_model)
        better = (new_cost <= cost) & ~ended
        small = np.abs(new - p).max(axis=1) < _CLOSE
        flat = better & (cost - new_cost <= 1e-13 * cost) & (damping <= 1e-3)
        ended |= (better & small) | flat | (~better & (damping > _STIFF)) | (~better & small)
        take = better[:, None]
        p, model, J = np.where(take, new, p), np.where(take, new_model, model), np.where(take[..., None], new_J, J)
        weights, cost = np.where(take, new_weights, weights), np.where(better, new_cost, cost)
        if data.huber:  # the scale moves with the residuals: the cost by the new scale counts
            weights, cost = _weighed(data, p, model)
        damping = np.where(better, np.maximum(damping * 0.1, 1e-14), damping * 8)
    return Fit(p, cost, model, J, weights, ended)


def normal(data: Data, p: np.ndarray, model: np.ndarray, J: np.ndarray, weights: np.ndarray) -> tuple:
    """The matrix (B, k, k) of the normal equations, and their right-hand side (B, k)."""
    weighted = J * weights[:, :, None]
    A = np.einsum("bni,bnj->bij", weighted, J) + np.eye(p.shape[1]) * data.stiffness[:, :, None]
    slope = np.einsum("bni,bn->bi", weighted, data.y - model) + data.stiffness * (data.center - p)
    return A, slope


def _weighed(data: Data, p: np.ndarray, model: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights of the squares of the residuals, and the cost; infinite where the model has no value."""
    residual = np.where(data.w > 0, data.w * (data.y - model), 0.0)
    weights = data.w**2
    squares = residual**2
    if data.huber:
        limit = HUBER * scale(residual, data.w)[:, None]
        large = np.abs(residual) > limit
        weights = np.where(large, weights * limit / np.where(large, np.abs(residual), 1.0), weights)
        squares = np.where(large, 2 * limit * np.abs(residual) - limit**2, squares)
    cost = squares.sum(axis=1) + (data.stiffness * (p - data.center) ** 2).sum(axis=1)
    return weights, np.where(np.isfinite(cost), cost, np.inf)


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

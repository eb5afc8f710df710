"""How sure the unknowns of fits are, by what their residuals say, and whether an unknown changes with the depth."""

from typing import NamedTuple

import numpy as np
from scipy import special

from ..least_squares import Data, Minimum, huber_limit, inverse, normal
from .noise import noise_of

#: Level at which an unknown changes with the depth, and the least change that is worth a sentence.
_SURE, _LEAST = 0.999, 0.03
#: Residuals below this part of the range of y are those of the table of the model.
_EXACT = 2e-5
#: Freedom of Student's t that is left where hardly a point is independent of the others.
_FREEDOM = 2.0


class Worth(NamedTuple):
    """Of B fits.

    factors : (B, k), by what the variance of each unknown is larger than with independent points
    freedom : (B, k) of Student's t
    ratio, larger : (B,) of :class:`.noise.Noise`
    change, changes : (B,) the relative change of the first unknown from the beginning of the contact to the deepest
        point, and whether it is sure and worth a word
    """

    factors: np.ndarray
    freedom: np.ndarray
    ratio: np.ndarray
    larger: np.ndarray
    change: np.ndarray
    changes: np.ndarray


def worth_of(
    x: np.ndarray, data: Data, fit: Minimum, variance: np.ndarray, prior: np.ndarray, share: np.ndarray
) -> Worth:
    """The :class:`Worth` of fits at x (B, n).

    variance : (B,) of a point of weight 1, if points are independent
    prior : (B,) times the stiffness of a prior this is the variance of its slope
    share : (B, n) of the depth, 0 before the contact
    """
    B, k = fit.p.shape
    rows = Worth(*(np.ones((B, k)) for _ in range(2)), *(np.full(B, value) for value in (np.nan, False, 0.0, False)))
    A = inverse(normal(data, fit.p, fit.model, fit.J, fit.weights)[0])
    residual = np.where(data.w > 0, data.w * (data.y - fit.model), 0.0)
    limit = huber_limit(data, fit.model)
    residual = residual if limit is None else np.clip(residual, -limit, limit)
    off = np.sqrt((np.where(data.w > 0, data.y - fit.model, 0.0) ** 2).mean(axis=1))
    for b in np.flatnonzero(off > _EXACT):
        there = data.w[b] > 0
        e, X = residual[b, there], (data.w[b, :, None] * fit.J[b])[there]
        noise = noise_of(x[b, there], e, X, share[b, there] > 0)
        rows.ratio[b], rows.larger[b] = noise.ratio, noise.larger
        if noise.middle is not None:
            of_points = float(e @ e) / max(len(e) - k, 1) if data.huber else variance[b]
            usual = of_points * (X.T @ X + np.diag(data.stiffness[b]))
            rows.factors[b] = _factors(A[b], usual, noise.middle + np.diag(data.stiffness[b] * prior[b]))
        rows.change[b], rows.changes[b] = _change(x[b, there], e, X, share[b, there])
    count = (data.w > 0).sum(axis=1)[:, None]
    honest = np.maximum(count / rows.factors - k, np.minimum(count - k, _FREEDOM))
    return rows._replace(freedom=np.where(rows.factors == 1, count - k, honest))


def _factors(A: np.ndarray, usual: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """(k,), at least 1, by the covariance A whole A (a "sandwich") over that of independent points."""
    with np.errstate(divide="ignore", invalid="ignore"):
        factors = np.einsum("ij,jk,ik->i", A, whole, A) / np.einsum("ij,jk,ik->i", A, usual, A)
    return np.where(np.isfinite(factors), np.maximum(factors, 1.0), 1.0)


def _change(x: np.ndarray, e: np.ndarray, X: np.ndarray, share: np.ndarray) -> tuple[float, bool]:
    """By how much the logarithm of the first unknown changes along the contact: a further unknown of the fit, at the
    size that lowers the residuals most."""
    z = X[:, 0] * np.where(share > 0, share - 0.5, 0.0)
    wide = np.column_stack([z, X])
    size = np.sqrt(np.maximum((wide**2).sum(axis=0), 1e-300))
    A = inverse(((wide / size).T @ (wide / size))[None])[0] / size / size[:, None]
    follows = A @ (wide.T @ e)
    freedom = len(e) - wide.shape[1]
    if freedom < 1 or not np.isfinite(follows).all():
        return 0.0, False
    left = e - wide @ follows
    variance = float(left @ left) / freedom * A[0, 0]
    change, t = float(follows[0]), special.stdtrit(freedom, (1 + _SURE) / 2)
    if abs(change) < _LEAST or change**2 < t**2 * variance:
        return change, False
    noise = noise_of(x, left, wide, share > 0)
    if noise.middle is not None:
        honest = float(A[0] @ noise.middle @ A[0])
        freedom = max(len(e) * variance / max(honest, variance) - wide.shape[1], _FREEDOM)
        t = special.stdtrit(freedom, (1 + _SURE) / 2)
        variance = max(honest, variance)
    return change, bool(change**2 > t**2 * variance)

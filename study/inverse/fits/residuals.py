"""The residuals of fits: the number of independent points that they are worth, and changes of an unknown with the
depth.

The errors of neighbouring points are correlated: drift, feedback, and a model that is not quite right leave waves in
the residuals. If the points counted as independent, they would seem to say far more than they do. The residuals,
averaged in at most _MOST blocks along x, are modelled as the sum of white noise and of noise whose correlation decays.
Their covariance is

    cov(i, j) = v ((1 - s) delta_ij + s exp(-|i - j|/l)).

s and l maximise the restricted likelihood, which takes into account the part that the fit itself has removed from the
residuals. The noise counts as white, s = 0, unless a correlation is far likelier.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy import special

from .curve import MeasuredCurves
from .least_squares import Data, Minimum, huber_limit, inverse, minimise, normal

#: Largest number of blocks. With 100 to 10,000 points and correlations of neighbours of 0.5 to 0.95, 95 % intervals
#: hold in 94 to 98 % of cases (tests/inverse/misfit/test_correlated_noise.py).
_MOST = 128
_FEWEST = 16  # least number of blocks for the search of a correlation
_LENGTHS = 12  # number of lengths l, from half a block to an eighth of all blocks
_SHARES = np.array([0.0, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.96, 1.0])
#: Twice the logarithm of a likelihood over that of white noise above which noise is not white. Some 2 % of curves with
#: white noise exceed it.
_LIKELIER = 6.0
#: Correlation of neighbours in standard deviations below which the likelihood is not computed; and the same for single
#: points above which their noise is not white, whatever the likelihood of the blocks.
_LAGS, _SURE_LAGS = 2.0, 3.5
#: Level of the tests that the misfit in contact is larger than the noise before it, and that an unknown changes with
#: the depth.
_SURE = 0.999
#: Least number of points on either side for the first test.
_ASIDE = 10
#: Least change of an unknown that is worth a sentence.
_LEAST = 0.03
#: Residuals below this share of the range of y come from the table of the model.
_EXACT = 2e-5
#: Freedom of Student's t that remains where hardly a point is independent of the others.
_FREEDOM = 2.0
#: Number of parts of the depth below the contact point, of equal width.
PARTS = 4
_STEPS, _ENOUGH = 12, 3  # number of steps of the search in a part, and least number of points in a part


class Noise(NamedTuple):
    """The residuals e (n,) of one curve and the derivatives X (n, k) of the fit, both over the standard deviation of a
    point.

    middle : (k, k), X' S X with S the covariance of e; None: the points are independent and of one variance
    ratio : rms of the residuals in contact over that before it; NaN where one side has too few points
    larger : whether the ratio is surely above 1
    """

    middle: np.ndarray | None
    ratio: float
    larger: bool


class Worth(NamedTuple):
    """The information in the points of B fits.

    factors : (B, k), ratio of the variance of each unknown to that with independent points
    freedom : (B, k) of Student's t
    ratio, larger : (B,) of :class:`Noise`
    change, changes : (B,) the relative change of the first unknown from the beginning of the contact to the deepest
        point, and whether it is sure and worth a word
    """

    factors: np.ndarray
    freedom: np.ndarray
    ratio: np.ndarray
    larger: np.ndarray
    change: np.ndarray
    changes: np.ndarray


@lru_cache(maxsize=32)
def _family(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (_LENGTHS, n) and eigenvectors (_LENGTHS, n, n) of exp(-|i - j|/l) for each length l."""
    lengths = np.exp(np.linspace(np.log(0.5), np.log(n / 8), _LENGTHS))
    distances = np.abs(np.arange(n)[:, None] - np.arange(n))
    values, vectors = np.linalg.eigh(np.exp(-distances / lengths[:, None, None]))
    return np.maximum(values, 1e-9), vectors


def noise_of(x: np.ndarray, e: np.ndarray, X: np.ndarray, contact: np.ndarray) -> Noise:
    """The :class:`Noise` of residuals at x (n,).

    contact : whether a point is in contact, (n,)
    """
    k = X.shape[1]
    e, X = (np.where(np.isfinite(array), array, 0.0) for array in (e, X))
    places, blocks = _blocks(x)
    count = np.bincount(blocks)
    E = np.bincount(blocks, e) / np.sqrt(count)
    single = np.bincount(places, e) / np.sqrt(np.bincount(places))
    if len(E) < max(_FEWEST, 3 * k) or not e.any():
        return Noise(None, np.nan, False)
    D = np.stack([np.bincount(blocks, column) for column in X.T], axis=1) / np.sqrt(count)[:, None]
    touches = np.bincount(blocks, contact) > count / 2
    sure = _lag(single) > _SURE_LAGS
    waves = sure or _hangs_together(E)
    distinct = np.bincount(places, contact) > 0
    ratio, larger = _ratio(single, distinct, (_worth(E[touches]), _worth(E[~touches])) if waves else (1.0, 1.0))
    level = np.ones(len(E))
    if larger:  # one standard deviation in contact, another before it
        level = np.where(touches, ratio, 1.0)
        waves = sure or _hangs_together(E / level)
    values, vectors, variance = _likeliest(E / level, D / level[:, None], waves, 0.0 if sure else _LIKELIER)
    if not (larger or sure) and np.all(values == 1):
        return Noise(None, ratio, False)
    turned = vectors.T @ (D * level[:, None])
    return Noise(variance * (turned.T * values) @ turned, ratio, larger)


def _blocks(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The rank (n,) of each x, and the number (n,) of its block. Readings at the same x share a rank, and count as
    independent."""
    distinct, places = np.unique(x, return_inverse=True)
    return places.ravel(), places.ravel() // -(-len(distinct) // _MOST)


def _lag(E: np.ndarray) -> float:
    """The correlation of neighbours, over its standard deviation under white noise."""
    return float((E[1:] * E[:-1]).sum() * np.sqrt(len(E)) / max(float(E @ E), 1e-300))


def _hangs_together(E: np.ndarray) -> bool:
    """Whether neighbours among the blocks (n,), or among averages of several blocks, are similar."""
    while len(E) >= _FEWEST:
        if _lag(E) > _LAGS:
            return True
        E = E[: len(E) // 2 * 2].reshape(-1, 2).sum(axis=1)
    return False


def _ratio(e: np.ndarray, contact: np.ndarray, worth: tuple[float, float]) -> tuple[float, bool]:
    """rms in contact over rms before it, and whether it is surely above 1, by an F test.

    worth : number of independent points that a point counts as, in contact and before it
    """
    inside, outside = int(contact.sum()), int((~contact).sum())
    if min(inside, outside) < _ASIDE or not e[~contact].any():
        return np.nan, False
    F = float(np.mean(e[contact] ** 2) / np.mean(e[~contact] ** 2))
    freedom = [max(number * part, 2.0) for number, part in zip((inside, outside), worth, strict=True)]
    return float(np.sqrt(F)), bool(special.fdtr(*freedom, F) > _SURE)


def _worth(E: np.ndarray) -> float:
    """The number of independent points that a residual is worth in a sum of squares, at most 1. The correlation is
    assumed to decay by the same factor from each point to the next."""
    if len(E) < 3 or not E.any():
        return 1.0
    lag = float(np.clip((E[1:] * E[:-1]).sum() / (E**2).sum(), 0.0, 0.99)) ** 2
    return (1 - lag) / (1 + lag)


def _likeliest(E: np.ndarray, D: np.ndarray, waves: bool, more: float) -> tuple[np.ndarray, np.ndarray, float]:
    """The covariance of residuals E (n,) as eigenvalues (n,), which are 1 for white noise, eigenvectors (n, n) and a
    factor.

    D : (n, k) derivatives of the fit
    more : excess of twice the logarithm of the likelihood over that of white noise that a correlation needs
    """
    n, k = D.shape
    white = float(E @ E) / (n - k)
    if not waves:
        return np.ones(n), np.eye(n), white
    values, vectors = _family(n)  # of each length
    E_, D_ = E @ vectors, np.swapaxes(vectors, 1, 2) @ D
    spectra = 1 + _SHARES[:, None] * (values[:, None] - 1)  # of each length and share
    scaled = D_ / np.sqrt(np.maximum(np.einsum("lnk,lnk->lk", D_, D_), 1e-300))[:, None]
    A = np.einsum("lsn,lnk,lnj->lskj", 1 / spectra, scaled, scaled) + 1e-12 * np.eye(k)
    b = np.einsum("lsn,lnk,ln->lsk", 1 / spectra, scaled, E_)
    fitted = np.einsum("lsk,lsk->ls", b, np.linalg.solve(A, b[..., None])[..., 0])
    squares = np.maximum((E_[:, None] ** 2 / spectra).sum(axis=2) - fitted, 1e-300)
    twice = -(n - k) * np.log(squares) - np.log(spectra).sum(axis=2) - np.linalg.slogdet(A)[1]
    length, share = np.unravel_index(twice.argmax(), twice.shape)
    if twice[length, share] > twice[0, 0] + more:  # the share 0 is white noise
        return spectra[length, share], vectors[length], float(squares[length, share]) / (n - k)
    return np.ones(n), np.eye(n), white


def worth_of(
    x: np.ndarray, data: Data, fit: Minimum, variance: np.ndarray, prior: np.ndarray, share: np.ndarray
) -> Worth:
    """The :class:`Worth` of fits at x (B, n).

    variance : (B,) of a point of weight 1, if points are independent
    prior : (B,), the variance of the slope of a prior over its stiffness
    share : (B, n) of the depth, 0 before the contact
    """
    B, k = fit.p.shape
    rows = Worth(*(np.ones((B, k)) for _ in range(2)), *(np.full(B, value) for value in (np.nan, False, 0.0, False)))
    A = inverse(normal(data, fit.p, fit.model, fit.J, fit.weights)[0])
    residual = np.where(data.w > 0, data.w * (data.y - fit.model), 0.0)
    limit = huber_limit(data, fit.model)
    residual = residual if limit is None else np.clip(residual, -limit, limit)
    off = np.sqrt((np.where(data.w > 0, data.y - fit.model, 0.0) ** 2).mean(axis=1))
    distinct = len(x) - _copies(x, data, fit)
    for b in np.flatnonzero(off[:distinct] > _EXACT):
        is_point = data.w[b] > 0
        e, X = residual[b, is_point], (data.w[b, :, None] * fit.J[b])[is_point]
        noise = noise_of(x[b, is_point], e, X, share[b, is_point] > 0)
        rows.ratio[b], rows.larger[b] = noise.ratio, noise.larger
        if noise.middle is not None:
            of_points = float(e @ e) / max(len(e) - k, 1) if data.huber else variance[b]
            usual = of_points * (X.T @ X + np.diag(data.stiffness[b]))
            rows.factors[b] = _factors(A[b], usual, noise.middle + np.diag(data.stiffness[b] * prior[b]))
        rows.change[b], rows.changes[b] = _change(x[b, is_point], e, X, share[b, is_point])
    for array in rows:
        array[distinct:] = array[distinct - 1]
    count = (data.w > 0).sum(axis=1)[:, None]
    honest = np.maximum(count / rows.factors - k, np.minimum(count - k, _FREEDOM))
    return rows._replace(freedom=np.where(rows.factors == 1, count - k, honest))


def _copies(x: np.ndarray, data: Data, fit: Minimum) -> int:
    """The number of last curves that repeat the one before them, since they pad the batch."""
    arrays = x, data.y, data.w, data.stiffness, fit.p, fit.model
    same = [((array == array[-1]) | (np.isnan(array) & np.isnan(array[-1]))).all(axis=1) for array in arrays]
    return int(np.logical_and.reduce(same)[::-1].cumprod().sum()) - 1


def _factors(A: np.ndarray, usual: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """(k,), at least 1: the ratio of the covariance A whole A (a "sandwich") to that of independent points."""
    with np.errstate(divide="ignore", invalid="ignore"):
        factors = np.einsum("ij,jk,ik->i", A, whole, A) / np.einsum("ij,jk,ik->i", A, usual, A)
    return np.where(np.isfinite(factors), np.maximum(factors, 1.0), 1.0)


def _change(x: np.ndarray, e: np.ndarray, X: np.ndarray, share: np.ndarray) -> tuple[float, bool]:
    """The change of the logarithm of the first unknown along the contact, and whether it is sure and worth a word.

    The change is a further unknown of the fit, with the value that reduces the residuals most.
    """
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


def parts_of(curve: MeasuredCurves, data: Data, best: Minimum, share: np.ndarray, worth: Worth) -> np.ndarray:
    """The first unknown (B, PARTS) by the points of each part of the depth, for fits whose points disagree: those with
    intervals widened for correlated noise, or with a change with the depth. NaN for other fits, and at a bound.

    share : (B, n) of the depth, 0 before the contact
    """
    value = np.full((len(best.p), PARTS), np.nan)
    rows = np.flatnonzero((worth.factors > 1).any(axis=1) | worth.changes)
    if not len(rows):
        return value
    every, part = np.repeat(rows, PARTS), np.tile(np.arange(PARTS), len(rows))
    inside = (share[every] > part[:, None] / PARTS) & (share[every] <= (part[:, None] + 1) / PARTS)
    some = data.take(every)
    some = some._replace(w=np.where(inside, some.w, 0.0), stiffness=0 * some.stiffness)
    fixed = np.ones((len(every), best.p.shape[1]), bool)
    fixed[:, 0] = False
    fit = minimise(curve.take(every), some, best.p[every], fixed, _STEPS)
    p = fit.p[:, 0]
    good = ((some.w > 0).sum(axis=1) >= _ENOUGH) & (p > some.low[:, 0]) & (p < some.high[:, 0]) & np.isfinite(fit.cost)
    value[every, part] = np.where(good, p, np.nan)
    return value

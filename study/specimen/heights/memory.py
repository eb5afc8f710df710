"""Statistics of large maps without copying them: a map of 4096 × 4096 points has 134 MB."""

import math
from collections.abc import Iterator

import numpy as np

#: Number of points in a block of rows.
_BLOCK = 250_000


def row_blocks(z: np.ndarray, more: int = 0) -> Iterator[slice]:
    """The rows of a map in blocks. Each block also has the first `more` rows of the next one."""
    size = max(1, _BLOCK // max(1, math.prod(z.shape[1:])))
    return (slice(low, min(low + size + more, len(z))) for low in range(0, max(0, len(z) - more), size))


def present(values: np.ndarray) -> np.ndarray:
    """The finite values, flat, in the order of memory; a view of them if all are."""
    values = values.ravel(order="K")
    finite = np.isfinite(values)
    return values if finite.all() else values[finite]


def mean(values: np.ndarray) -> float:
    """The mean of the finite values."""
    return float(present(values).mean())


def variance(values: np.ndarray) -> float:
    """The variance of the finite values, which are overwritten."""
    values = present(values)
    values -= values.mean()
    values *= values
    return float(values.mean())


def kurtosis(z: np.ndarray) -> float:
    """Sku, the fourth moment of the finite heights about their mean over the square of the second; NaN for a plane."""
    middle, squares, fourths, count = mean(z), 0.0, 0.0, 0
    for rows in row_blocks(z):
        heights = present(z[rows]) - middle
        heights *= heights
        squares += float(heights.sum())
        heights *= heights
        fourths += float(heights.sum())
        count += len(heights)
    return fourths * count / squares**2 if squares else math.nan

"""Statistics of large maps without copying them: a map of 4096 × 4096 points has 134 MB."""

import math
from collections.abc import Iterator

import numpy as np

#: Number of points in a block of rows.
_BLOCK = 250_000


def row_blocks(z: np.ndarray, more: int = 0, arrays: int = 1) -> Iterator[slice]:
    """The rows of a map in blocks. Each block also has the first `more` rows of the next one.

    arrays : of its size that a block takes while it is worked on; the blocks are as much smaller
    """
    size = max(1, _BLOCK // arrays // max(1, math.prod(z.shape[1:])))
    return (slice(low, min(low + size + more, len(z))) for low in range(0, max(0, len(z) - more), size))


def present(values: np.ndarray) -> np.ndarray:
    """The finite values, flat, in the order of memory; a view of them if all are."""
    values = values.ravel(order="K")
    finite = np.isfinite(values)
    return values if finite.all() else values[finite]


def compressed(values: np.ndarray) -> np.ndarray:
    """The finite values, flat, in the order of memory. The values are overwritten where some are not finite."""
    values, last = values.ravel(order="K"), 0
    for low in range(0, len(values), _BLOCK):
        block = values[low : low + _BLOCK]
        finite = np.isfinite(block)
        if last < low or not finite.all():
            block = block[finite]
            values[last : last + len(block)] = block
        last += len(block)
    return values[:last]


def mean(values: np.ndarray) -> float:
    """The mean of the finite values."""
    return float(present(values).mean())


def median(values: np.ndarray) -> float:
    """The median of the finite values, which are overwritten; NaN if there are none."""
    values = compressed(values)
    return float(np.median(values, overwrite_input=True)) if values.size else math.nan


def variance(values: np.ndarray) -> float:
    """The variance of the finite values, which are overwritten."""
    values = compressed(values)
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

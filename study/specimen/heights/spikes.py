"""Spikes of a scan: points far from the median of their neighbours."""

import math
import numbers
import warnings

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from .memory import median, row_blocks

#: Dimensions of a scan -> neighbours on each side along an axis. A point of a map has eight neighbours in all.
_REACH = {1: 4, 2: 1}
#: Standard deviation of a Gaussian variable over the median, and over the mean, of its absolute values.
_BY_MEDIAN, _BY_MEAN = 1.4826, math.sqrt(math.pi / 2)


def despiked(z: np.ndarray, despike: float | None, name: str) -> tuple[np.ndarray, int]:
    """The heights, NaN where a point is a spike, and the number of spikes.

    A spike is further than `despike` robust deviations from the median of its eight neighbours. The robust deviation
    is 1.4826 times the median of all these distances. Where that is 0, since the heights come in coarse steps, it is
    √(π/2) times their mean. A tilt has no effect: the medians of the differences along each axis are subtracted first.
    Outside a border a map continues as its point reflection through the border, and a profile as its point reflection
    through the median of its last three points.

    Raises ValueError: a `despike` that is not a positive number.
    """
    if despike is None:
        return z, 0
    number = isinstance(despike, numbers.Real) and not isinstance(despike, bool)
    if not (number and 0 < despike < math.inf):
        raise ValueError(f"{name}: despike = {despike!r}: must be a positive number of robust deviations, such as 5")
    if np.isinf(z).any() or np.isnan(z).all():  # refused with the missing points
        return z, 0
    distances = _distances(_without_tilt(z))
    deviation = _BY_MEDIAN * median(distances.copy()) or _BY_MEAN * float(np.nanmean(distances))
    spikes = distances > despike * deviation
    del distances  # as large as the map
    return np.where(spikes, np.nan, z), int(spikes.sum())


def _without_tilt(z: np.ndarray) -> np.ndarray:
    """The heights minus a plane that spikes do not affect. On a tilt a spike would shift the medians of neighbours."""
    rises = [np.nan_to_num(median(np.diff(z, axis=axis))) for axis in range(z.ndim)]
    level = z.copy()
    for rows in row_blocks(z):
        places = np.meshgrid(np.arange(rows.start, rows.stop), *map(np.arange, z.shape[1:]), indexing="ij", sparse=True)
        level[rows] -= sum(rise * place for rise, place in zip(rises, places, strict=True))
    return level


def _distances(z: np.ndarray) -> np.ndarray:
    """The distance of each point from the median of its measured neighbours, NaN where there are none."""
    reach, distances = _REACH[z.ndim], np.empty(z.shape)
    for rows in row_blocks(z, arrays=50):  # numpy's median of windows of 9 points takes about so many
        windows = sliding_window_view(_surrounded(z, rows, reach), (2 * reach + 1,) * z.ndim)
        windows = windows.reshape(*z[rows].shape, -1)
        neighbours = np.delete(windows, windows.shape[-1] // 2, axis=-1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # of points without a neighbour
            medians = np.nanmedian(neighbours, axis=-1)
        distances[rows] = np.abs(z[rows] - medians)
    return distances


def _surrounded(z: np.ndarray, rows: slice, reach: int) -> np.ndarray:
    """Rows of a map, or points of a profile, with their neighbours on each side, inside the scan or outside."""
    if z.ndim == 1:
        return _lengthened(z, reach)[rows.start : rows.stop + 2 * reach]
    outside = int(rows.start == 0), int(rows.stop == len(z))
    inside = z[rows.start - 1 + outside[0] : rows.stop + 1 - outside[1]]
    return np.pad(inside, (outside, (1, 1)), mode="reflect", reflect_type="odd")


def _lengthened(z: np.ndarray, reach: int) -> np.ndarray:
    """A profile with the point reflections of its ends through the median of their last three points.

    A reflection through the last point alone would follow a spike there.
    """
    middles = [np.median(part[~np.isnan(part)]) if not np.isnan(part).all() else np.nan for part in (z[:3], z[-3:])]
    return np.concatenate([2 * middles[0] - z[3 : 3 + reach][::-1], z, 2 * middles[1] - z[-3 - reach : -3][::-1]])

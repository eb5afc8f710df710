"""Spikes of a scan: points far from the median of their neighbours."""

import math
import numbers
import warnings

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

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
    level = _without_tilt(z)
    distances = np.abs(level - _median_of_neighbours(level))
    deviation = _BY_MEDIAN * float(np.nanmedian(distances)) or _BY_MEAN * float(np.nanmean(distances))
    spikes = distances > despike * deviation
    return np.where(spikes, np.nan, z), int(spikes.sum())


def _without_tilt(z: np.ndarray) -> np.ndarray:
    """The heights minus a plane that spikes do not affect. On a tilt a spike would shift the medians of neighbours."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # where no two neighbours are measured
        rises = [np.nan_to_num(np.nanmedian(np.diff(z, axis=axis))) for axis in range(z.ndim)]
    places = np.meshgrid(*map(np.arange, z.shape), indexing="ij", sparse=True)
    return z - sum(rise * place for rise, place in zip(rises, places, strict=True))


def _median_of_neighbours(z: np.ndarray) -> np.ndarray:
    """The median of each point's measured neighbours, NaN where there are none."""
    reach = _REACH[z.ndim]
    wide = np.pad(z, reach, mode="reflect", reflect_type="odd") if z.ndim == 2 else _lengthened(z, reach)
    windows = sliding_window_view(wide, (2 * reach + 1,) * z.ndim).reshape(*z.shape, -1)
    middle = windows.shape[-1] // 2
    neighbours = np.delete(windows, middle, axis=-1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of points without a neighbour
        return np.nanmedian(neighbours, axis=-1)


def _lengthened(z: np.ndarray, reach: int) -> np.ndarray:
    """A profile with the point reflections of its ends through the median of their last three points.

    A reflection through the last point alone would follow a spike there.
    """
    middles = [np.median(part[~np.isnan(part)]) if not np.isnan(part).all() else np.nan for part in (z[:3], z[-3:])]
    return np.concatenate([2 * middles[0] - z[3 : 3 + reach][::-1], z, 2 * middles[1] - z[-3 - reach : -3][::-1]])

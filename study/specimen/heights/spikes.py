"""Spikes of a scan: points far from the median of their neighbours."""

import math
import numbers
import warnings

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

#: Points on each side along an axis: of a map the eight neighbours, of a profile four on each side.
_REACH = {1: 4, 2: 1}
#: Standard deviation of a Gaussian variable over the median, and over the mean, of its absolute values.
_BY_MEDIAN, _BY_MEAN = 1.4826, math.sqrt(math.pi / 2)


def despiked(z: np.ndarray, despike: float | None, name: str) -> tuple[np.ndarray, int]:
    """The heights, NaN where a point is a spike, and the number of spikes.

    A spike is further than `despike` robust deviations from the median of its eight neighbours. The robust deviation
    is 1.4826 times the median of all these distances; where that is 0, heights in coarse steps, √(π/2) times their
    mean. A tilt counts for nothing: the medians of the differences along each axis are removed first. Beyond a border
    the heights go on as their mirror image through it, of a profile through the median of its last three points.

    Raises ValueError: a `despike` that is no positive number.
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
    """The heights without a plane that spikes do not move. With it a spike moves the medians of its neighbours."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # where no two neighbours are there
        rises = [np.nan_to_num(np.nanmedian(np.diff(z, axis=axis))) for axis in range(z.ndim)]
    places = np.meshgrid(*map(np.arange, z.shape), indexing="ij", sparse=True)
    return z - sum(rise * place for rise, place in zip(rises, places, strict=True))


def _median_of_neighbours(z: np.ndarray) -> np.ndarray:
    """The median of the neighbours of each point that are there, NaN where none is."""
    reach = _REACH[z.ndim]
    wide = np.pad(z, reach, mode="reflect", reflect_type="odd") if z.ndim == 2 else _lengthened(z, reach)
    windows = sliding_window_view(wide, (2 * reach + 1,) * z.ndim).reshape(*z.shape, -1)
    middle = windows.shape[-1] // 2
    neighbours = np.delete(windows, middle, axis=-1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of points without a neighbour
        return np.nanmedian(neighbours, axis=-1)


def _lengthened(z: np.ndarray, reach: int) -> np.ndarray:
    """A profile with its mirror images through the medians of three points; a spike at its end would be half of it."""
    middles = [np.median(part[~np.isnan(part)]) if not np.isnan(part).all() else np.nan for part in (z[:3], z[-3:])]
    return np.concatenate([2 * middles[0] - z[3 : 3 + reach][::-1], z, 2 * middles[1] - z[-3 - reach : -3][::-1]])

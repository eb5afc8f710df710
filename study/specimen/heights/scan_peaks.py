"""Statistics of a grid of heights: low-pass, spectral moments, summits.

Heights z have the shape (x) for a profile and (y, x) for a map; steps are the distances between points along these
axes. Every function serves both. NaN is a missing point: differences and summits that need it are left out.

Where the steps of a map along x and y differ, slopes and curvatures along both are taken over the larger step. N̄ and
Ra depend on the distance: a mean over two distances would belong to neither.
"""

import itertools
import math
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from .memory import compressed, row_blocks
from .missing import filled

#: ISO 16610-21: a Gaussian of this width, in cutoffs, halves the amplitude of a wave as long as the cutoff.
ALPHA = math.sqrt(math.log(2) / math.pi)
#: The window reaches four standard deviations of the Gaussian, 0.75 cutoffs, to each side; 6e-5 of it lie beyond.
REACH = 4 * ALPHA / math.sqrt(2 * math.pi)
#: Least share of measured points in the window; with fewer the filtered height is missing. Missing points are filled
#: first: N̄ and Ra are then off by less than 1 %, even where gaps as wide as two asperities take a fifth of the scan.
#: The mean of the measured points alone would make N̄ 1.6 times too large
#: (tests/specimen/heights/test_missing_points.py).
MEASURED = 0.5
#: Steps of the filling of gaps before a low-pass. Points deeper in a gap have no filtered height anyway.
_FILLING = 200
#: Shortest cutoff, in steps: the sampled Gaussian still passes half of it, to 0.2 %.
SHORTEST = 3.0

#: Isotropic Gaussian surface (Nayak 1971). With κ the mean curvature of a point in units of √(m4/3), the curvatures of
#: the summits have the density (κ² - 2) exp(-κ²/4) + 2 exp(-3κ²/4). Its integral gives the density of summits, its
#: first moment their mean curvature, its second the spread of their heights.
SUMMITS_PER_AREA = 1 / (6 * math.pi * math.sqrt(3))  # times m4/m2
CURVATURE = 8 / (3 * math.sqrt(math.pi))  # times √m4: 1/R with R = 0.375 √(π/m4)
HEIGHTS = 1 + 16 / math.pi - 3 * math.sqrt(3)  # 0.8968: σ_s² = (1 - 0.8968/α) m0
MEDIAN = 0.67449  # the median of |x| over the standard deviation of a normal x
#: The same for the peaks of a profile (Rice): √(m4/m2)/2π peaks per unit length, with the mean curvature √(π m4/2).
PEAKS_PER_LENGTH = 1 / (2 * math.pi)
PEAK_CURVATURE = math.sqrt(math.pi / 2)
PEAK_HEIGHTS = math.pi / 2 - 1  # 0.5708


class Moments(NamedTuple):
    """Variance of the heights (m²), of the slopes, and of the second derivatives (m⁻²), along a line."""

    m0: float
    m2: float
    m4: float


class Asperities(NamedTuple):
    """Number per area (m⁻²), mean curvature (m⁻¹), standard deviation of heights (m).

    counted : number of summits that were counted; None where the asperities follow from moments
    median_curvature : median of the summits' curvatures (m⁻¹), to which a few spikes add nothing
    """

    density: float
    curvature: float
    spread: float
    counted: int | None = None
    median_curvature: float = math.nan


def low_pass(z: np.ndarray, steps: tuple, cutoff: float) -> np.ndarray:
    """Gaussian mean of the heights, ISO 16610-21 and -61, without the border where the window leaves the scan.

    s(x) = exp(-π (x/(α λc))²)/(α λc), α = √(ln 2/π); along each axis. The border is 0.75 cutoffs wide. Gaps are filled
    first. Where half of the window or more is missing, the filtered height is missing too.
    """
    measured = np.isfinite(z)
    if measured.all():
        return _gaussian(z, steps, cutoff)
    means = _gaussian(filled(z, _FILLING), steps, cutoff)
    means[_gaussian(measured, steps, cutoff) <= MEASURED] = np.nan
    return means


def _gaussian(z: np.ndarray, steps: tuple, cutoff: float) -> np.ndarray:
    for axis, step in enumerate(steps):
        z = _along(z, axis, step, cutoff)
    return z


def _along(z: np.ndarray, axis: int, step: float, cutoff: float) -> np.ndarray:
    """The Gaussian mean along one axis, without its borders, in blocks of lines; of truths in single precision."""
    reach = math.ceil(min(REACH * cutoff / step, z.shape[axis]))
    inside = slice(reach, max(z.shape[axis] - reach, reach))
    sigma = ALPHA * cutoff / math.sqrt(2 * math.pi) / step
    shape = [inside.stop - reach if i == axis else n for i, n in enumerate(z.shape)]
    means = np.empty(shape, dtype=np.result_type(z, np.float32))
    lines, answers = (np.atleast_2d(np.moveaxis(array, axis, -1)) for array in (z, means))
    # a window longer than the scan leaves no points, and would take hours if the cutoff has the wrong unit
    for block in row_blocks(lines) if means.size else ():
        part = np.asarray(lines[block], dtype=float)
        answers[block] = gaussian_filter1d(part, sigma, axis=-1, radius=reach)[:, inside]
    return means


def moments(z: np.ndarray, steps: tuple) -> list[Moments]:
    """Moments of profiles along each axis, from differences between points (McCool 1987).

    m0 = <z²>, m2 = <(z_{i+1} - z_i)²>/d², m4 = <(z_{i+1} - 2 z_i + z_{i-1})²>/d⁴ with d the larger step. Along the axis
    of the smaller step the points i and i + 1 are a distance d apart as well: see `_average_square`.
    """
    m0, d = float(np.nanvar(z)), max(steps)
    return [
        Moments(m0, *(_average_square(z, axis, d / step, order, np.mean) / d ** (2 * order) for order in (1, 2)))
        for axis, step in enumerate(steps)
    ]


def _average_square(z: np.ndarray, axis: int, lag: float, order: int, mean) -> float:
    """Mean of the squared first or second differences between points `lag` apart, where all of them are measured.

    mean : the mean, or another average

    Between two whole lags it is interpolated by a power of the lag, as on a self-affine surface.
    """
    low = math.floor(lag + 1e-6)
    values = [mean(_squares(z, axis, whole, order)) for whole in (low, low + 1)[: 1 + (lag > low)]]
    if lag <= low * (1 + 1e-6) or min(values) == 0:
        return float(values[0])
    return float(values[0] * (values[1] / values[0]) ** (math.log(lag / low) / math.log1p(1 / low)))


def _squares(z: np.ndarray, axis: int, lag: int, order: int) -> np.ndarray:
    """Squared first or second differences over `lag` points along one axis, flat, where all points are measured; a
    single zero if there are none."""
    z = np.moveaxis(z, axis, 0)
    if order == 1:
        values = z[lag:] - z[:-lag]
    else:
        values = -2 * z[lag:-lag]
        values += z[2 * lag :]
        values += z[: -2 * lag]
    values = compressed(values)
    values *= values
    return values if values.size else np.zeros(1)


def mean_moments(along: list[Moments]) -> Moments:
    """The moments of a profile in any direction: the means over the axes."""
    return Moments(along[0].m0, *np.mean([m[1:] for m in along], axis=0).tolist())


def number_of(z: np.ndarray, steps: tuple, density: float) -> float:
    """Number of asperities on the area of the measured points, or along their length on a profile."""
    share = np.isfinite(z).mean()
    return float(share * math.prod(n * step * math.sqrt(density) for n, step in zip(z.shape, steps, strict=True)))


def bandwidth(m: Moments) -> float:
    """α = m0 m4/m2² of Nayak: at least 1.5 on an isotropic Gaussian surface, large when waves of many lengths add."""
    return m.m0 * m.m4 / m.m2**2


def gaussian_summits(m: Moments) -> Asperities:
    """Summits of the isotropic Gaussian surface whose profiles have these moments (Nayak 1971, McCool 1987).

    N̄ = m4/(6π√3 m2), 1/Ra = (8/3) √(m4/π), σ_s² = (1 - 0.8968/α) m0.
    """
    spread = math.sqrt(max(0.0, 1 - HEIGHTS / bandwidth(m)) * m.m0)
    return Asperities(SUMMITS_PER_AREA * m.m4 / m.m2, CURVATURE * math.sqrt(m.m4), spread)


def counted_summits(z: np.ndarray, steps: tuple) -> Asperities | None:
    """Summits of a map, or peaks of a profile, found point by point; None if there are none.

    Of equal neighbours the last counts, so that a flat top is one summit. Neighbours are the larger step away, along
    both axes. Where that is not a whole number of points, each result is interpolated by a power of the distance. Near
    a border the last point stands in for a neighbour outside the scan. Points with a missing neighbour are not counted,
    nor is their area. Peaks of a profile are lower and blunter than the summits that the profile passes: they are
    converted by the ratios of an isotropic Gaussian surface.
    """
    lags = [max(steps) / step for step in steps]
    low, high = ([max(1, math.floor(lag + add)) for lag in lags] for add in (1e-6, 1 - 1e-6))
    near = _summits(z, steps, low)
    far = near if low == high else _summits(z, steps, high)
    if near is None or far is None or near is far:
        return near and far
    share = max(math.log(lag / i) / math.log1p(1 / i) for lag, i in zip(lags, low, strict=True))
    between = [value ** (1 - share) * far_value**share for value, far_value in zip(near, far, strict=True)]
    return Asperities(*between[:3], round(between[3]), between[4])


def _summits(z: np.ndarray, steps: tuple, lags: list[int]) -> Asperities | None:
    """The summits above neighbours that are `lags` points away along each axis."""
    padded = np.pad(z, [(lag - 1, lag - 1) for lag in lags], mode="edge")
    centre_offset = (0,) * z.ndim
    around = {
        offset: padded[tuple(slice(lag + i * lag, lag + i * lag + n - 2) for i, lag, n in parts)]
        for offset in itertools.product((-1, 0, 1), repeat=z.ndim)
        for parts in [list(zip(offset, lags, z.shape, strict=True))]
    }
    centre = around.pop(centre_offset)
    highest, whole = np.ones(centre.shape, dtype=bool), np.isfinite(centre)
    for offset, neighbour in around.items():
        highest &= centre > neighbour if offset > centre_offset else centre >= neighbour
        whole &= np.isfinite(neighbour)
    count = int((highest & whole).sum())
    if count == 0:
        return None
    highest &= whole
    distances = [lag * step for lag, step in zip(lags, steps, strict=True)]
    second_derivatives = (
        (around[tuple(axis)][highest] + around[tuple(-axis)][highest] - 2 * centre[highest]) / d**2
        for axis, d in zip(np.eye(z.ndim, dtype=int), distances, strict=True)
    )
    curvatures = -sum(second_derivatives) / z.ndim
    curvature, median = float(curvatures.mean()), float(np.median(curvatures))
    # points at these distances form interleaved grids; the area of a point is the cell of its grid
    density = count / (whole.sum() * math.prod(distances))
    variance = float(np.var(centre[highest]))
    if z.ndim == 1:
        (m,) = moments(z, steps)
        density = density**2 * SUMMITS_PER_AREA / PEAKS_PER_LENGTH**2
        curvature, median = (CURVATURE / PEAK_CURVATURE * value for value in (curvature, median))
        variance = max(0.0, variance - (HEIGHTS - PEAK_HEIGHTS) * m.m2**2 / m.m4)
    return Asperities(density, curvature, math.sqrt(variance), count, median)


def whole(z: np.ndarray, steps: tuple) -> int:
    """Number of points whose neighbours, the larger step away along each axis, are all measured."""
    present = np.isfinite(z)
    for axis, step in enumerate(steps):
        lag, present = max(1, round(max(steps) / step)), np.moveaxis(present, axis, 0)
        present = np.moveaxis(present[lag:-lag] & present[2 * lag :] & present[: -2 * lag], 0, axis)
    return int(present.sum())


def median_curvature(z: np.ndarray, steps: tuple) -> float:
    """The curvature of `gaussian_summits` with √m4 from the median of the squared second differences.

    A few spikes do not change the median; for Gaussian heights it gives the same √m4.
    """
    d = max(steps)
    median = partial(np.median, overwrite_input=True)
    medians = [_average_square(z, axis, d / step, 2, median) / d**4 for axis, step in enumerate(steps)]
    return CURVATURE * math.sqrt(np.mean(medians)) / MEDIAN

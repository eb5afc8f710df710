"""Statistics of a grid of heights: low-pass, spectral moments, summits.

Heights z of a profile have shape (x), of a map (y, x); steps are the distances of the points along these axes. Every
function serves both. NaN is a missing point: what needs it is left out.

Where the points of a map are not as far apart along x as along y, slopes and curvatures along both are those over the
larger distance. N̄ and Ra depend on the distance: a mean over two distances would belong to neither.
"""

import itertools
import math
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from .memory import present
from .missing import filled

#: ISO 16610-21: a Gaussian of this width, in cutoffs, lets half of a wave of the cutoff's length pass.
ALPHA = math.sqrt(math.log(2) / math.pi)
#: The window reaches four standard deviations of the Gaussian, 0.75 cutoffs, to each side; 6e-5 of it lie beyond.
REACH = 4 * ALPHA / math.sqrt(2 * math.pi)
#: Least part of the window that has measured points; elsewhere the filter has no answer. Missing points are filled in
#: first: N̄ and Ra are then off by less than 1 %, also where gaps as wide as two asperities take a fifth of the scan. By
#: the mean of the points that are there N̄ would be 1.6 times too large (tests/specimen/heights/test_missing_points.py).
MEASURED = 0.5
#: Steps of filling gaps before a low-pass: points deeper in a gap have no answer anyway.
_FILLING = 200
#: Shortest cutoff, in steps: the sampled Gaussian still passes half of it, to 0.2 %.
SHORTEST = 3.0

#: Isotropic Gaussian surface (Nayak 1971). With κ the mean curvature of a point in units of √(m4/3), the curvatures of
#: the summits have the density (κ² - 2) exp(-κ²/4) + 2 exp(-3κ²/4). Its integral gives the density of summits, its
#: first moment their mean curvature, its second the spread of their heights.
SUMMITS_PER_AREA = 1 / (6 * math.pi * math.sqrt(3))  # times m4/m2
CURVATURE = 8 / (3 * math.sqrt(math.pi))  # times √m4: 1/R with R = 0.375 √(π/m4)
HEIGHTS = 1 + 16 / math.pi - 3 * math.sqrt(3)  # 0.8968: σ_s² = (1 - 0.8968/α) m0
MEDIAN = 0.67449  # of |x| of a normal x, over its standard deviation
#: The same of the peaks of a profile (Rice): √(m4/m2)/2π of them in a unit of length, of mean curvature √(π m4/2).
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

    counted : how many were counted; None where moments give them
    usual : the curvature by medians (m⁻¹), to which a few spikes add nothing
    """

    density: float
    curvature: float
    spread: float
    counted: int | None = None
    usual: float = math.nan


def low_pass(z: np.ndarray, steps: tuple, cutoff: float) -> np.ndarray:
    """Gaussian mean of the heights, ISO 16610-21 and -61, without the border where the window leaves the scan.

    s(x) = exp(-π (x/(α λc))²)/(α λc), α = √(ln 2/π); along each axis. The border is 0.75 cutoffs wide. Gaps are filled
    before; where half of the window or more is missing, the answer is missing too.
    """
    absent = np.isnan(z)
    if not absent.any():
        return _gaussian(z, steps, cutoff)
    means = _gaussian(filled(z, _FILLING), steps, cutoff)
    return np.where(_gaussian((~absent).astype(float), steps, cutoff) > MEASURED, means, np.nan)


def _gaussian(z: np.ndarray, steps: tuple, cutoff: float) -> np.ndarray:
    for axis, step in enumerate(steps):
        reach = math.ceil(min(REACH * cutoff / step, z.shape[axis]))
        left = np.arange(reach, max(z.shape[axis] - reach, reach))
        sigma = ALPHA * cutoff / math.sqrt(2 * math.pi) / step
        # a window longer than the scan leaves nothing, and takes hours where the unit of the cutoff is mistaken
        z = (gaussian_filter1d(z, sigma, axis=axis, radius=reach) if left.size else z).take(left, axis=axis)
    return z


def moments(z: np.ndarray, steps: tuple) -> list[Moments]:
    """Moments of profiles along each axis, from differences of points as McCool 1987 takes them.

    m0 = <z²>, m2 = <(z_{i+1} - z_i)²>/d², m4 = <(z_{i+1} - 2 z_i + z_{i-1})²>/d⁴, d the larger step. Along the other
    axis the points i and i + 1 are as far apart: see `_over`.
    """
    m0, d = float(np.nanvar(z)), max(steps)
    return [
        Moments(m0, *(_over(z, axis, d / step, order, np.mean) / d ** (2 * order) for order in (1, 2)))
        for axis, step in enumerate(steps)
    ]


def _over(z: np.ndarray, axis: int, lag: float, order: int, mean) -> float:
    """Mean of the squared first or second differences of points `lag` apart, over the points whose partners are there.
    Between two whole lags it is a power of the lag, as on a self-affine surface."""
    low = math.floor(lag + 1e-6)
    values = [mean(_squares(z, axis, whole, order)) for whole in (low, low + 1)[: 1 + (lag > low)]]
    if lag <= low * (1 + 1e-6) or min(values) == 0:
        return float(values[0])
    return float(values[0] * (values[1] / values[0]) ** (math.log(lag / low) / math.log1p(1 / low)))


def _squares(z: np.ndarray, axis: int, lag: int, order: int) -> np.ndarray:
    """Squared first or second differences over `lag` points along one axis, flat, those that are there; a zero if there
    is none."""
    z = np.moveaxis(z, axis, 0)
    if order == 1:
        values = z[lag:] - z[:-lag]
    else:
        values = -2 * z[lag:-lag]
        values += z[2 * lag :]
        values += z[: -2 * lag]
    values = present(values)
    values *= values
    return values if values.size else np.zeros(1)


def mean_moments(along: list[Moments]) -> Moments:
    """The moments of a profile in any direction: the means over the axes."""
    return Moments(along[0].m0, *np.mean([m[1:] for m in along], axis=0).tolist())


def number_of(z: np.ndarray, steps: tuple, density: float) -> float:
    """How many asperities the measured points have: on their area, or on a profile along their length."""
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
    both axes. Where that is between two whole numbers of points, each result is a power of the distance. Near a border
    the last point stands for one beyond it. Points with a missing neighbour are not counted, nor is their area. Peaks
    of a profile are lower, and blunter, than the summits beside which they pass: they are converted by the ratios of an
    isotropic Gaussian surface.
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
    here = (0,) * z.ndim
    around = {
        offset: padded[tuple(slice(lag + i * lag, lag + i * lag + n - 2) for i, lag, n in parts)]
        for offset in itertools.product((-1, 0, 1), repeat=z.ndim)
        for parts in [list(zip(offset, lags, z.shape, strict=True))]
    }
    centre = around.pop(here)
    highest, whole = np.ones(centre.shape, dtype=bool), np.isfinite(centre)
    for offset, neighbour in around.items():
        highest &= centre > neighbour if offset > here else centre >= neighbour
        whole &= np.isfinite(neighbour)
    count = int((highest & whole).sum())
    if count == 0:
        return None
    highest &= whole
    apart = [lag * step for lag, step in zip(lags, steps, strict=True)]
    second = (
        (around[tuple(axis)][highest] + around[tuple(-axis)][highest] - 2 * centre[highest]) / d**2
        for axis, d in zip(np.eye(z.ndim, dtype=int), apart, strict=True)
    )
    curvatures = -sum(second) / z.ndim
    curvature, usual = float(curvatures.mean()), float(np.median(curvatures))
    # points that are `apart` form interleaved grids; each point has its summits and the cell of its grid
    density = count / (whole.sum() * math.prod(apart))
    variance = float(np.var(centre[highest]))
    if z.ndim == 1:
        (m,) = moments(z, steps)
        density = density**2 * SUMMITS_PER_AREA / PEAKS_PER_LENGTH**2
        curvature, usual = (CURVATURE / PEAK_CURVATURE * value for value in (curvature, usual))
        variance = max(0.0, variance - (HEIGHTS - PEAK_HEIGHTS) * m.m2**2 / m.m4)
    return Asperities(density, curvature, math.sqrt(variance), count, usual)


def whole(z: np.ndarray, steps: tuple) -> int:
    """Number of points all of whose neighbours are there, the larger step away along each axis."""
    present = np.isfinite(z)
    for axis, step in enumerate(steps):
        lag, present = max(1, round(max(steps) / step)), np.moveaxis(present, axis, 0)
        present = np.moveaxis(present[lag:-lag] & present[2 * lag :] & present[: -2 * lag], 0, axis)
    return int(present.sum())


def usual_curvature(z: np.ndarray, steps: tuple) -> float:
    """The curvature of `gaussian_summits` with m4 from the median of the second differences, a Gaussian one of √m4."""
    d = max(steps)
    median = partial(np.median, overwrite_input=True)
    medians = [_over(z, axis, d / step, 2, median) / d**4 for axis, step in enumerate(steps)]
    return CURVATURE * math.sqrt(np.mean(medians)) / MEDIAN

"""What is computed on a grid of heights: removal of form, low-pass, spectral moments, summits.

Heights z of a profile have shape (x), of a map (y, x); steps are the distances of the points along these axes. Every
function serves both.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

#: ISO 16610-21: a Gaussian of this width, in cutoffs, lets half of a wave of the cutoff's length pass.
ALPHA = math.sqrt(math.log(2) / math.pi)
#: The window reaches four standard deviations of the Gaussian, 0.75 cutoffs, to each side; 6e-5 of it lie beyond.
REACH = 4 * ALPHA / math.sqrt(2 * math.pi)
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
    """Number per area (m⁻²), mean curvature (m⁻¹), standard deviation of heights (m), how many were counted.

    usual : the curvature by medians (m⁻¹), to which a few spikes add nothing
    """

    density: float
    curvature: float
    spread: float
    found: int | None = None
    usual: float = math.nan


def without_form(z: np.ndarray, steps: tuple, form: str | float) -> np.ndarray:
    """The heights without their mean, their plane (least squares) or a sphere of known radius and the plane.

    The slope of the plane of least squares is that of the sphere in the middle of the scan: from it follows where the
    top of the sphere is.
    """
    if form == "mean":
        return z - z.mean()
    lines = [(np.arange(n) - (n - 1) / 2) * step for n, step in zip(z.shape, steps, strict=True)]
    x = np.meshgrid(*lines, indexing="ij")
    if form != "plane":
        top = [form * slope for slope in _plane(z, x)[1:]]
        squared = sum((one - at) ** 2 for one, at in zip(x, top, strict=True))
        z = z + squared / (form * (1 + np.sqrt(np.maximum(0.0, 1 - squared / form**2))))
    mean, *slopes = _plane(z, x)
    return z - mean - sum(slope * one for slope, one in zip(slopes, x, strict=True))


def _plane(z: np.ndarray, x: list[np.ndarray]) -> list[float]:
    """Mean and slopes of the plane of least squares; the x are centred, so each is found alone."""
    return [z.mean(), *(np.sum(z * one) / np.sum(one**2) for one in x)]


def low_pass(z: np.ndarray, steps: tuple, cutoff: float) -> np.ndarray:
    """Gaussian mean of the heights, ISO 16610-21 and -61, without the border where the window leaves the scan.

    s(x) = exp(-π (x/(α λc))²)/(α λc), α = √(ln 2/π); along each axis. The border is 0.75 cutoffs wide.
    """
    for axis, step in enumerate(steps):
        reach = math.ceil(min(REACH * cutoff / step, z.shape[axis]))
        left = np.arange(reach, max(z.shape[axis] - reach, reach))
        sigma = ALPHA * cutoff / math.sqrt(2 * math.pi) / step
        # a window longer than the scan leaves nothing, and takes hours where the unit of the cutoff is mistaken
        z = (gaussian_filter1d(z, sigma, axis=axis, radius=reach) if left.size else z).take(left, axis=axis)
    return z


def moments(z: np.ndarray, steps: tuple) -> list[Moments]:
    """Moments of profiles along each axis, from differences of neighbours as McCool 1987 takes them.

    m0 = <z²>, m2 = <(z_{i+1} - z_i)²>/d², m4 = <(z_{i+1} - 2 z_i + z_{i-1})²>/d⁴, d the step.
    """
    m0 = float(np.var(z))
    found = []
    for axis, step in enumerate(steps):
        m2 = np.mean(np.diff(z, axis=axis) ** 2) / step**2
        m4 = np.mean(np.diff(z, 2, axis=axis) ** 2) / step**4
        found.append(Moments(m0, float(m2), float(m4)))
    return found


def bandwidth(m: Moments) -> float:
    """α = m0 m4/m2² of Nayak: at least 1.5 on an isotropic Gaussian surface, large when waves of many lengths add."""
    return m.m0 * m.m4 / m.m2**2


def of_moments(m: Moments) -> Asperities:
    """Summits of the isotropic Gaussian surface whose profiles have these moments (Nayak 1971, McCool 1987).

    N̄ = m4/(6π√3 m2), 1/Ra = (8/3) √(m4/π), σ_s² = (1 - 0.8968/α) m0.
    """
    spread = math.sqrt(max(0.0, 1 - HEIGHTS / bandwidth(m)) * m.m0)
    return Asperities(SUMMITS_PER_AREA * m.m4 / m.m2, CURVATURE * math.sqrt(m.m4), spread)


def of_summits(z: np.ndarray, steps: tuple) -> Asperities | None:
    """Summits of a map, or peaks of a profile, found point by point; None if there are none.

    Of equal neighbours the last counts, so that a flat top is one summit. Peaks of a profile are lower, and blunter,
    than the summits beside which they pass: they are converted by the ratios of an isotropic Gaussian surface.
    """
    inner = (slice(1, -1),) * z.ndim
    centre = z[inner]
    highest = np.ones(centre.shape, dtype=bool)
    here = (0,) * z.ndim
    for offset in itertools.product((-1, 0, 1), repeat=z.ndim):
        if offset != here:
            neighbour = z[tuple(slice(1 + i, n - 1 + i) for i, n in zip(offset, z.shape, strict=True))]
            highest &= centre > neighbour if offset > here else centre >= neighbour
    found = int(highest.sum())
    if found == 0:
        return None
    second = (_second_differences(z, axis)[highest] / step**2 for axis, step in enumerate(steps))
    curvatures = -sum(second) / z.ndim
    curvature, usual = float(curvatures.mean()), float(np.median(curvatures))
    density = found / (centre.size * math.prod(steps))
    variance = float(np.var(centre[highest]))
    if z.ndim == 1:
        (m,) = moments(z, steps)
        density = density**2 * SUMMITS_PER_AREA / PEAKS_PER_LENGTH**2
        curvature, usual = (CURVATURE / PEAK_CURVATURE * one for one in (curvature, usual))
        variance = max(0.0, variance - (HEIGHTS - PEAK_HEIGHTS) * m.m2**2 / m.m4)
    return Asperities(density, curvature, math.sqrt(variance), found, usual)


def usual_curvature(z: np.ndarray, steps: tuple) -> float:
    """The curvature of `of_moments` with m4 from the median of the second differences, a Gaussian one of √m4."""
    medians = [np.median(np.abs(np.diff(z, 2, axis=axis))) / step**2 for axis, step in enumerate(steps)]
    return CURVATURE * math.sqrt(np.mean(np.square(medians))) / MEDIAN


def _second_differences(z: np.ndarray, axis: int) -> np.ndarray:
    """Second differences of the inner points along one axis."""
    inner = (slice(None) if i == axis else slice(1, -1) for i in range(z.ndim))
    return np.diff(z[tuple(inner)], 2, axis=axis)

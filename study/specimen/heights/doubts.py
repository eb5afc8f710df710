"""The doubts about a measured roughness, each a sentence."""

import math
from collections.abc import Iterator

import numpy as np

from .. import summits

#: Least distance of asperities in points of the scan. Those of white noise are three points apart, one in nine points.
RESOLVED = 5
#: With fewer asperities N̄ is uncertain by more than 1/√100 = 10 %; by twice that on a profile, where N̄ is a square.
MANY = 100
#: Skewness that a Gaussian surface of 100 asperities has by chance once in a thousand times, 3 √(6/100), rounded up.
SKEWED = 0.8
#: Mean squares of the slopes along x and y may differ by this factor. A surface stretched so far along one axis has N̄
#: 18 % below, and Ra 5 % above, what the isotropic formulas give.
ISOTROPIC = 2.0
#: Mean curvature over the one by medians: at most 1.5 on random maps of any size, and beyond 2 on hardly a profile, of
#: few peaks (tests/specimen/test_scans_as_they_come.py).
SPIKED = 2.0


def doubts(
    z: np.ndarray, steps: tuple, along: list[summits.Moments], found: summits.Asperities, number: float
) -> Iterator[str]:
    """The doubts about asperities `found` on heights z, of which a scan of this size has this number.

    along : the moments along each axis
    """
    if z.ndim == 1:
        yield "a profile: the surface is taken to be isotropic and Gaussian, and N̄ is not counted on an area"
    yield from _of_the_step(found, steps)
    if number < MANY:
        percent = (3 - z.ndim) * 100 / math.sqrt(number)
        yield f"about {number:.0f} asperities: N̄ is uncertain by some {percent:.0f} %"
    yield from _of_spikes(z, steps, found)
    slopes = [one.m2 for one in along]
    if max(slopes) > ISOTROPIC * min(slopes):
        ratio = math.sqrt(max(slopes) / min(slopes))
        yield f"slopes along one axis are {ratio:.2g} times those along the other: asperities are long, not round"
    skewness, alpha = float(np.nanmean((z - np.nanmean(z)) ** 3) / np.nanstd(z) ** 3), summits.bandwidth(mean(along))
    if found.found is None and (abs(skewness) > SKEWED or alpha < 1.5):
        yield (
            f"skewness {skewness:.2g}, α = {alpha:.3g}: a Gaussian surface has 0, and at least 1.5; "
            'prefer method="summits"'
        )


def mean(along: list[summits.Moments]) -> summits.Moments:
    """The moments of a profile in any direction: the means over the axes."""
    return summits.Moments(along[0].m0, *np.mean([one[1:] for one in along], axis=0).tolist())


def number_of(z: np.ndarray, steps: tuple, density: float) -> float:
    """How many asperities the measured points have: on their area, or on a profile along their length."""
    share = np.isfinite(z).mean()
    return float(share * math.prod(n * step * math.sqrt(density) for n, step in zip(z.shape, steps, strict=True)))


def _of_the_step(found: summits.Asperities, steps: tuple) -> Iterator[str]:
    apart = found.density**-0.5 / max(steps)
    if apart < RESOLVED:
        yield (
            f"asperities are {apart:.2g} points apart, {RESOLVED} are needed to see them: N̄ and Ra are "
            "those of the step or of noise; give a cutoff, or measure with a smaller step"
        )


def _of_spikes(z: np.ndarray, steps: tuple, found: summits.Asperities) -> Iterator[str]:
    usual = summits.usual_curvature(z, steps) if found.found is None else found.usual
    if found.curvature > SPIKED * usual:
        ratio = f"{found.curvature / usual:.2g} times" if usual > 0 else "far"
        yield (
            f"a few sharp points make Ra {ratio} smaller than the others do: spikes, dust, or heights in coarse steps; "
            "take them out, or give a cutoff"
        )

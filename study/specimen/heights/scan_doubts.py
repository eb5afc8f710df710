"""The doubts about a measured roughness, each a sentence."""

import math
from collections.abc import Iterator

import numpy as np

from ...terminal import rounded
from . import scan_peaks
from .form import taken_by_polynomial
from .measured_asperities import length
from .memory import kurtosis, mean
from .row_jumps import jumps

#: Least distance of asperities in points of the scan. Those of white noise are three points apart, one in nine points.
RESOLVED = 5
#: With fewer asperities N̄ is uncertain by more than 1/√100 = 10 %; by twice that on a profile, where N̄ is a square.
MANY = 100
#: Skewness that a Gaussian surface of 100 asperities has by chance once in a thousand times, 3 √(6/100), rounded up.
SKEWED = 0.8
#: Mean squares of the slopes along x and y may differ by this factor. A surface stretched so far along one axis has N̄
#: 18 % below, and Ra 5 % above, what the isotropic formulas give.
ISOTROPIC = 2.0
#: Mean curvature over the curvature by medians: at most 1.5 on random maps of any size, and above 2 on few profiles,
#: which have few peaks (tests/specimen/test_scans_as_they_come.py).
SPIKED = 2.0
#: A quadratic may have this part of the variance of heights without a form. On random surfaces it has more only where
#: waves as long as the scan are most of the roughness (tests/specimen/heights/test_forms.py).
FORMED = 0.2
#: Kurtosis Sku from which on a few points make the tail of the heights: 3 on a Gaussian surface.
PEAKED = 6.0
#: Steps along x and y that differ by less are equal.
UNEQUAL = 1.001
#: A doubt with this word is one of jumps.
JUMP = "jump against each other"


def jump_doubts(z: np.ndarray) -> Iterator[str]:
    """Doubts whether the rows of a map jump, or its columns."""
    if z.ndim == 1:
        return
    for lines, map_, way_out in (
        ("rows", z, 'rows="median" removes them'),
        ("columns", z.T, 'turn the map, z.T with dx and dy exchanged, and remove them with rows="median"'),
    ):
        size = jumps(map_)
        if size is not None:
            yield (
                f"the {lines} {JUMP} by some {length(size)} (standard deviation): offsets of the instrument, which "
                f"count as roughness and make N̄ too large and Ra too small; {way_out}"
            )


def form_doubts(z: np.ndarray, steps: tuple, form) -> Iterator[str]:
    """Doubts whether heights without their form still have one."""
    share = 0.0 if form == "quadratic" else taken_by_polynomial(z, steps, 2)
    if share > FORMED:
        yield (
            f"a quadratic has {100 * share:.0f} % of the variance of the heights: the form of a ball or a bow, or "
            'waves as long as the scan, count as roughness; form="quadratic" or "sphere" removes them'
        )


def doubts(
    z: np.ndarray,
    steps: tuple,
    along: list[scan_peaks.Moments],
    asperities: scan_peaks.Asperities,
    number: float,
    before: tuple[str, ...],
) -> Iterator[str]:
    """The doubts about the `asperities` of heights z, as many as `number` in a scan of this size.

    along : the moments along each axis
    before : the doubts about the heights; jumps are no long asperities
    """
    if z.ndim == 1:
        yield "a profile: the surface is taken to be isotropic and Gaussian, and N̄ is not counted on an area"
    yield from _of_the_step(asperities, steps)
    counted = number if asperities.counted is None else asperities.counted  # far fewer where there are gaps
    if counted < MANY:
        percent = (3 - z.ndim) * 100 / math.sqrt(counted)
        yield f"about {counted:.0f} asperities: N̄ is uncertain by some {percent:.0f} %"
    yield from _of_spikes(z, steps, asperities)
    yield from _of_kurtosis(z)
    slopes = [m.m2 for m in along]
    if max(slopes) > ISOTROPIC * min(slopes) and not any(JUMP in note for note in before):
        ratio = rounded(math.sqrt(max(slopes) / min(slopes))) if min(slopes) > 0 else "infinitely many"
        yield f"slopes along one axis are {ratio} times those along the other: asperities are long, not round"
    cubes = z - np.nanmean(z)
    cubes **= 3
    third = mean(cubes)
    del cubes  # as large as the map
    skewness, alpha = third / float(np.nanstd(z)) ** 3, scan_peaks.bandwidth(scan_peaks.mean_moments(along))
    if asperities.counted is None and (abs(skewness) > SKEWED or alpha < 1.5):
        yield (
            f"skewness {skewness:.2g}, α = {alpha:.3g}: a Gaussian surface has skewness 0 and α of "
            'at least 1.5; prefer method="summits"'
        )


def _of_the_step(asperities: scan_peaks.Asperities, steps: tuple) -> Iterator[str]:
    apart = asperities.density**-0.5 / max(steps)
    if apart < RESOLVED:
        yield (
            f"asperities are {rounded(apart)} points apart, {RESOLVED} are needed to see them: N̄ and Ra "
            "come from the step or from noise; give a cutoff, or measure with a smaller step"
        )
    if asperities.curvature * max(steps) > 1:
        yield (
            f"Ra = {length(1 / asperities.curvature)} is below the distance of the points, {length(max(steps))}: no "
            "asperity is seen by so few points; check the units, take out spikes, or give a cutoff"
        )
    if max(steps) > UNEQUAL * min(steps):
        yield (
            f"points are {' and '.join(map(length, reversed(steps)))} apart along x and y: slopes and curvatures along "
            f"both are those over {length(max(steps))}"
        )


def _of_spikes(z: np.ndarray, steps: tuple, asperities: scan_peaks.Asperities) -> Iterator[str]:
    usual = scan_peaks.usual_curvature(z, steps) if asperities.counted is None else asperities.usual
    if asperities.curvature > SPIKED * usual:
        ratio = f"{rounded(asperities.curvature / usual)} times" if usual > 0 else "far"
        yield (
            f"a few sharp points make Ra {ratio} smaller than the others do: spikes, dust, or heights in coarse steps; "
            "take them out, or give a cutoff"
        )


def _of_kurtosis(z: np.ndarray) -> Iterator[str]:
    Sku = kurtosis(z)
    if Sku > PEAKED:
        yield (
            f"Sku = {rounded(Sku)}, the kurtosis of the heights, is above {PEAKED:g}; a Gaussian surface has 3: a "
            "few points stand far out. If they are real, p_max of the contact is larger than the law of heights says, "
            "by boundary elements 1.7 to 13 times on scans with spikes, and 20 % at most on Gaussian ones; if they are "
            "errors of the instrument, read the scan with despike=5"
        )

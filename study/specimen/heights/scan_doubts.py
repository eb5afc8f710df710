"""The doubts about a measured roughness, each a sentence."""

import math
from collections.abc import Iterator

import numpy as np

from ...terminal import rounded
from . import scan_peaks
from .form import share_of_polynomial
from .measured_asperities import length
from .memory import compressed, kurtosis
from .row_jumps import jumps

#: Least distance between asperities, in points of the scan. On white noise it is three points: one in nine is a summit.
RESOLVED = 5
#: With fewer asperities N̄ is uncertain by more than 1/√100 = 10 %, and by twice that on a profile, where N̄ is the
#: square of a density of peaks.
MANY = 100
#: Skewness that a Gaussian surface of 100 asperities has by chance once in a thousand times, 3 √(6/100), rounded up.
SKEWED = 0.8
#: Mean squares of the slopes along x and y may differ by this factor. A surface stretched so far along one axis has N̄
#: 18 % below, and Ra 5 % above, what the isotropic formulas give.
ISOTROPIC = 2.0
#: Largest ratio of the mean curvature to the curvature by medians without spikes. It is at most 1.5 on random maps of
#: any size, and above 2 on a few profiles, which have few peaks (tests/specimen/test_scans_as_they_come.py).
SPIKED = 2.0
#: Largest share of a quadratic in the variance of heights without a form. On random surfaces the share is larger only
#: where waves as long as the scan make up most of the roughness (tests/specimen/heights/test_forms.py).
FORMED = 0.2
#: Kurtosis Sku above which a few points make up the tail of the heights. A Gaussian surface has 3.
PEAKED = 6.0
#: Steps along x and y count as equal up to this ratio.
UNEQUAL = 1.001
#: A doubt that contains these words is about jumps.
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
    share = 0.0 if form == "quadratic" else share_of_polynomial(z, steps, 2)
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
    """The doubts about the `asperities` of heights z.

    along : the moments along each axis
    number : of asperities in a scan of this size
    before : the doubts about the heights. Jumps explain unequal slopes, which then do not mean long asperities
    """
    if z.ndim == 1:
        yield "a profile: the surface is taken to be isotropic and Gaussian, and N̄ is not counted on an area"
    yield from _step_doubts(asperities, steps)
    counted = number if asperities.counted is None else asperities.counted  # far fewer where there are gaps
    if counted < MANY:
        percent = (3 - z.ndim) * 100 / math.sqrt(counted)
        yield f"about {counted:.0f} asperities: N̄ is uncertain by some {percent:.0f} %"
    yield from _spike_doubts(z, steps, asperities)
    yield from _kurtosis_doubts(z)
    slopes = [m.m2 for m in along]
    if max(slopes) > ISOTROPIC * min(slopes) and not any(JUMP in note for note in before):
        ratio = rounded(math.sqrt(max(slopes) / min(slopes))) if min(slopes) > 0 else "infinitely many"
        yield f"slopes along one axis are {ratio} times those along the other: asperities are long, not round"
    cubes = z - np.nanmean(z)
    cubes **= 3
    third = float(compressed(cubes).mean())
    del cubes  # as large as the map
    skewness, alpha = third / float(np.nanstd(z)) ** 3, scan_peaks.bandwidth(scan_peaks.mean_moments(along))
    if asperities.counted is None and (abs(skewness) > SKEWED or alpha < 1.5):
        yield (
            f"skewness {skewness:.2g}, α = {alpha:.3g}: a Gaussian surface has skewness 0 and α of "
            'at least 1.5; prefer method="summits"'
        )


def _step_doubts(asperities: scan_peaks.Asperities, steps: tuple) -> Iterator[str]:
    spacing = asperities.density**-0.5 / max(steps)
    if spacing < RESOLVED:
        yield (
            f"asperities are {rounded(spacing)} points apart, {RESOLVED} are needed to see them: N̄ and Ra "
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


def _spike_doubts(z: np.ndarray, steps: tuple, asperities: scan_peaks.Asperities) -> Iterator[str]:
    median_curvature = (
        scan_peaks.median_curvature(z, steps) if asperities.counted is None else asperities.median_curvature
    )
    if asperities.curvature > SPIKED * median_curvature:
        ratio = f"{rounded(asperities.curvature / median_curvature)} times" if median_curvature > 0 else "far"
        yield (
            f"a few sharp points make Ra {ratio} smaller than the others do: spikes, dust, or heights in coarse steps; "
            "take them out, or give a cutoff"
        )


def _kurtosis_doubts(z: np.ndarray) -> Iterator[str]:
    Sku = kurtosis(z)
    if Sku > PEAKED:
        yield (
            f"Sku = {rounded(Sku)}, the kurtosis of the heights, is above {PEAKED:g}; a Gaussian surface has 3: a "
            "few points stand far out. If they are real, p_max of the contact is larger than the law of heights says, "
            "by boundary elements 1.7 to 13 times on scans with spikes, and 20 % at most on Gaussian ones; if they are "
            "errors of the instrument, read the scan with despike=5"
        )

"""From a scan to the density and the radius of its asperities, and the spread of their heights."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from ..scan import BLUNTEST, FEWEST, FLATTEST, Scan, number
from . import scan_peaks
from .form import without_form
from .measured_asperities import Roughness, length, over
from .memory import compressed
from .row_jumps import aligned
from .scan_doubts import doubts, form_doubts, jump_doubts


def measure(
    scan: Scan,
    *,
    method: Literal["moments", "summits"] = "moments",
    form: str | float = "plane",
    rows: Literal["median"] | None = None,
    cutoff: float | Sequence[float] | None = None,
) -> Roughness:
    """Asperities of a scan: density, radius, spread of their heights.

    Parameters
    ----------
    scan : made by `read`, `profile` or `height_map`
    method : "moments": the summits of the isotropic Gaussian surface with the same m0, m2, m4 (Nayak 1971,
        McCool 1987); "summits": the points higher than their eight neighbours, or than their two on a profile. On a
        random surface both agree; on a designed one only "summits" is right.
    form : the form to subtract: "mean", "plane", "quadratic", "sphere" (the best fit), or the radius of a sphere, in m
        or as text with its unit (< 0: a cup). After a sphere the plane is subtracted too
    rows : "median" subtracts the median of the differences between neighbouring rows of a map, before the form; it
        removes the row offsets of a scanning probe
    cutoff : wavelength, m, of a Gaussian low-pass (ISO 16610-21, -61); None: no low-pass. With a list the numbers of
        the answer are arrays over it

    Returns
    -------
    Roughness : in m

    Raises
    ------
    ValueError : an unknown method, form or rows, a cutoff below three steps or an empty list, a sphere smaller than
        the scan; fewer than 16 points in a direction, counted by the larger of two steps; too few points with all their
        neighbours; no heights, or no summits; unless the scan is `huge`, heights with an rms below 1 pm after the form,
        and asperities with a radius above 1 km

    Examples
    --------
    >>> from study import roughness, samples
    >>> answer = measure(roughness.read(samples.scan()))
    >>> print(f"{answer.Nbar / 1e12:.4f} 1/um^2, {answer.Ra * 1e6:.1f} um, {answer.sigma * 1e9:.1f} nm")
    0.0732 1/um^2, 9.7 um, 41.9 nm
    """
    if not isinstance(scan, Scan):
        raise ValueError("give a scan: that of study.roughness.read, or of height_map or profile, which take arrays")
    if method not in ("moments", "summits"):
        raise ValueError(f'{scan.name}: method = {method!r}; allowed are "moments" and "summits"')
    cutoffs = _cutoffs(scan, cutoff)
    flat, treatment, notes = _flat(scan, form, rows)
    answers = [_asperities(scan, *_filtered(scan, flat, treatment, each), method, notes) for each in cutoffs]
    if np.ndim(cutoff) == 0:
        return answers[0]
    return over(cutoffs, answers, f"{treatment}; Gaussian low-pass (ISO 16610) with each cutoff, {_BORDERS}")


_BORDERS = "borders of 0.75 cutoffs cut away"


def _cutoffs(scan: Scan, cutoff) -> list[float | None]:
    """The cutoffs, m. Raises ValueError for a cutoff that is not a length, or too short."""
    if cutoff is None:
        return [None]
    least = scan_peaks.SHORTEST * max(scan.steps)
    values = [cutoff] if np.ndim(cutoff) == 0 else np.array(cutoff, dtype=object).ravel().tolist()
    if np.ndim(cutoff) > 1 or not values or len(set(values)) < len(values):
        raise ValueError(f"{scan.name}: cutoff = {cutoff}; a list must have one cutoff or more, each of them once")
    for value in values:
        if not least <= number(f"{scan.name}: cutoff", value, "m") < math.inf:
            raise ValueError(
                f"{scan.name}: cutoff = {value} m; it must be finite and at least three steps, {least:.4g} m"
            )
    return values


def _flat(scan: Scan, form, rows) -> tuple[np.ndarray, str, tuple[str, ...]]:
    """The heights minus row offsets and form, this treatment in words, and notes on offsets or form that may remain."""
    if rows not in (None, "median") or (rows and scan.z.ndim == 1):
        rule = "a profile has no rows; leave it out" if scan.z.ndim == 1 else 'allowed are "median" and None'
        raise ValueError(f"{scan.name}: rows = {rows!r}; {rule}")
    z = aligned(scan.z) if rows else scan.z
    notes = () if rows else tuple(jump_doubts(scan.z))
    z, treatment = without_form(z, scan.steps, form, scan.name)
    treatment = f"the median of the differences of neighbouring rows removed; {treatment}" if rows else treatment
    _refuse_rounding_errors(scan, z, treatment)
    rms = float(np.nanstd(z))
    if rms < FLATTEST and not scan.huge:
        raise ValueError(
            f"{scan.name}: the heights spread by {rms:.3g} m (rms, {treatment}); no surface is smoother than "
            f"{FLATTEST:g} m, 1 pm. {_WAY_OUT}."
        )
    return z, treatment, (*notes, *form_doubts(z, scan.steps, form))


_WAY_OUT = "Give unit and height_unit as the scan has them, or huge=True beside them if it is so"


def _refuse_rounding_errors(scan: Scan, z: np.ndarray, treatment: str) -> None:
    """Raise ValueError where only the rounding errors of a subtraction remain."""
    if np.nanstd(z) <= 1e-12 * np.nanmax(np.abs(scan.z)):
        raise ValueError(f"{scan.name}: nothing is left of the heights: {treatment}")


def _filtered(scan: Scan, z: np.ndarray, treatment: str, cutoff: float | None) -> tuple[np.ndarray, str]:
    """The heights without short waves, and the whole treatment in words."""
    if cutoff is None:
        treatment += "; no low-pass, so instrument and step set the shortest waves"
    else:
        z = scan_peaks.low_pass(z, scan.steps, cutoff)
        treatment += f"; Gaussian low-pass (ISO 16610) with a cutoff of {length(cutoff)}, {_BORDERS}"
        if min(z.shape) < FEWEST:
            raise ValueError(
                f"{scan.name}: {' × '.join(map(str, z.shape))} points are left by a cutoff of {cutoff:g} m, which "
                f"takes 0.75 cutoffs from each border; at least {FEWEST} in each direction are needed"
            )
    _check_enough_points(scan, z)
    _refuse_rounding_errors(scan, z, treatment)
    return z, treatment


def _check_enough_points(scan: Scan, z: np.ndarray) -> None:
    """Raise ValueError for too few points over the larger step, or too few that have all their neighbours."""
    spacing = max(scan.steps)
    shape = [1 + math.floor((n - 1) * step / spacing + 1e-6) for n, step in zip(z.shape, scan.steps, strict=True)]
    if min(shape) < FEWEST:
        i = shape.index(min(shape))
        size = (z.shape[i] - 1) * scan.steps[i]
        raise ValueError(
            f"{scan.name}: slopes and curvatures along x and y are those over the larger of the two steps, "
            f"{length(spacing)}, and {min(shape)} points so far apart are on the {length(size)} along {'yx'[i]}; "
            f"at least {FEWEST} are needed"
        )
    whole, least = scan_peaks.whole(z, scan.steps), (FEWEST // 2) ** z.ndim
    if whole < least:
        raise ValueError(
            f"{scan.name}: {whole} of {z.size} points have all their neighbours; at least {least} are needed. Give a "
            "scan with fewer missing points, or crop it to a part without gaps"
        )


def _asperities(scan: Scan, z: np.ndarray, filtered: str, method: str, notes: tuple) -> Roughness:
    """The roughness of heights whose form and short waves have been removed."""
    along = scan_peaks.moments(z, scan.steps)
    m = scan_peaks.mean_moments(along)
    asperities = scan_peaks.gaussian_summits(m) if method == "moments" else scan_peaks.counted_summits(z, scan.steps)
    if asperities is None or not (asperities.density > 0 and asperities.curvature > 0):
        raise ValueError(
            f"{scan.name}: no summits: none of {_points(z)} is higher than all around it. "
            "Take off the form, or measure a larger area."
        )
    if not (scan.huge or 1 / asperities.curvature <= BLUNTEST):
        raise ValueError(
            f"{scan.name}: Ra = {1 / asperities.curvature:.3g} m, the radius of an asperity; at most {BLUNTEST:g} m is "
            f"taken. The heights have an rms of {np.nanstd(z):.3g} m on {max(scan.sizes):.3g} m. {_WAY_OUT}."
        )
    how = {
        "moments": f"spectral moments (McCool 1987) of profiles, m0 = {m.m0:.4g} m², m2 = {m.m2:.4g}, "
        f"m4 = {m.m4:.4g} m⁻², α = {scan_peaks.bandwidth(m):.3g}; the surface is taken to be Gaussian and isotropic",
        "summits": f"{asperities.counted} summits found as points above their eight neighbours"
        if z.ndim == 2
        else f"{asperities.counted} peaks found as points above their two neighbours, converted to summits of an "
        "isotropic Gaussian surface",
    }
    deviations = z - np.nanmean(z)
    iso_Ra = float(compressed(np.abs(deviations, out=deviations)).mean())
    del deviations
    count = scan_peaks.number_of(z, scan.steps, asperities.density)
    answer = Roughness(
        *map(float, (asperities.density, 1 / asperities.curvature, asperities.spread, iso_Ra, count)),
        method=how[method],
        filter=filtered,
        resolution=_resolution(scan),
    )
    doubted = doubts(z, scan.steps, along, asperities, count, notes)
    return replace(answer, notes=(*scan.notes, *notes, *doubted, answer.about_cut()))


def _points(z: np.ndarray) -> str:
    """The points that may be summits, in words."""
    gaps = " with all their neighbours" if np.isnan(z).any() else ""
    return f"{' × '.join(map(str, z.shape))} points{gaps}"


def _resolution(scan: Scan) -> str:
    """Points and distances of the scan, x before y."""
    points, steps, sizes = (
        " × ".join(reversed(texts))
        for texts in (list(map(str, scan.z.shape)), list(map(length, scan.steps)), list(map(length, scan.sizes)))
    )
    return f"{scan.name}, {points} points {steps} apart, {sizes}"

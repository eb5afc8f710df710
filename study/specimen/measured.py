"""Density and radius of the asperities of a scan, how they were found, and the doubts about them, in words."""

import math
import numbers
from dataclasses import dataclass

import numpy as np

from . import summits
from .quantities import readable
from .scan import FEWEST, Scan, number

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


@dataclass(frozen=True)
class Roughness:
    """Asperities of a scan, by one method, after one filter, at one resolution: N̄ and Ra depend on all three.

    Nbar : asperities per unit area, 1/m²
    Ra : radius of an asperity, 1/(mean curvature of the summits), m
    sigma_summits : standard deviation of the heights of the summits, m; the model supposes 0
    iso_Ra : mean deviation of the height from its mean, m: Ra of ISO 21920, Sa of ISO 25178. Not `Ra`.
    method, filter, resolution, notes : sentences; notes has the doubts about this scan
    units : the unit of all lengths
    """

    Nbar: float
    Ra: float
    sigma_summits: float
    iso_Ra: float
    method: str
    filter: str
    resolution: str
    notes: tuple[str, ...] = ()
    units: str = "m"

    def parameters(self) -> dict[str, str]:
        """Nbar and Ra as text with units, all digits."""
        return {"Nbar": f"{self.Nbar!r} 1/m^2", "Ra": f"{self.Ra!r} m"}

    def __str__(self) -> str:
        relief = 1 / (3 * math.pi * self.Nbar * self.Ra)
        density = (self.Nbar / 1e12, "µm⁻²") if self.Nbar >= 1e10 else (self.Nbar / 1e6, "mm⁻²")
        return "\n".join([
            f"N̄ = {density[0]:.3g} {density[1]}: one asperity in a square of {_length(self.Nbar**-0.5)}.",
            f"Ra = {_length(self.Ra)}, the radius of an asperity. The ISO roughness Ra (mean height) is "
            f"{_length(self.iso_Ra)}: another quantity.",
            f"The summits' heights spread by {_length(self.sigma_summits)} (standard deviation). The model takes "
            f"them as equal, and can press its asperities by {_length(relief)} at most, 1/(3π N̄ Ra): "
            f"the spread is {self.sigma_summits / relief:.2g} times that.",
            *(f"{name}: {text}." for name, text in (
                ("Resolution", self.resolution), ("Filter", self.filter), ("Method", self.method))),
            *(f"Note: {note}." for note in self.notes),
        ])  # fmt: skip


def _length(x: float) -> str:
    """A length as text, in m, mm, µm or nm, to three digits."""
    return readable(float(f"{x:.3g}"), "m")


def measure(scan: Scan, *, method="moments", form="plane", cutoff=None) -> Roughness:
    """Asperities of a scan: density, radius, spread of their heights.

    scan : of `read`, `profile` or `height_map`
    method : "moments", the summits that an isotropic Gaussian surface of the same m0, m2, m4 has (Nayak 1971,
        McCool 1987); "summits", the points higher than their eight neighbours, or two on a profile. On a random surface
        they agree; on a designed one only "summits" is right.
    form : what is taken off: "mean", "plane", or the radius of a sphere, m (< 0: a cup), and then the plane
    cutoff : wavelength, m, of a Gaussian low-pass (ISO 16610-21, -61); None: none

    Raises ValueError: an unknown method or form, a cutoff below three steps, a sphere smaller than the scan; after the
    filter fewer than 16 points in a direction, no heights, or no summits.
    """
    if not isinstance(scan, Scan):
        raise ValueError("give a scan: that of study.roughness.read, or of height_map or profile, which take arrays")
    if method not in ("moments", "summits"):
        raise ValueError(f'{scan.name}: method = {method!r}; allowed are "moments" and "summits"')
    z, filtered = _filtered(scan, form, cutoff)
    along = summits.moments(z, scan.steps)
    m = summits.Moments(along[0].m0, *np.mean([one[1:] for one in along], axis=0).tolist())
    found = summits.of_moments(m) if method == "moments" else summits.of_summits(z, scan.steps)
    if found is None or not (found.density > 0 and found.curvature > 0):
        raise ValueError(
            f"{scan.name}: no summits: none of {' × '.join(map(str, z.shape))} points is higher than all around it. "
            "Take off the form, or measure a larger area."
        )
    how = {
        "moments": f"spectral moments (McCool 1987) of profiles, m0 = {m.m0:.4g} m², m2 = {m.m2:.4g}, "
        f"m4 = {m.m4:.4g} m⁻², α = {summits.bandwidth(m):.3g}; the surface is taken to be Gaussian and isotropic",
        "summits": f"{found.found} summits found as points above their eight neighbours"
        if z.ndim == 2
        else f"{found.found} peaks found as points above their two neighbours, converted to summits of an isotropic "
        "Gaussian surface",
    }
    iso_Ra = float(np.mean(np.abs(z - z.mean())))
    notes = scan.notes + tuple(_notes(z, scan.steps, along, m, found))
    texts = {"method": how[method], "filter": filtered, "resolution": _resolution(scan), "notes": notes}
    return Roughness(found.density, 1 / found.curvature, found.spread, iso_Ra, **texts)


def _filtered(scan: Scan, form: str | float, cutoff: float | None) -> tuple[np.ndarray, str]:
    """The heights without form and short waves, and what was done, in words."""
    if form in ("mean", "plane"):
        said = f"{form} taken off"
    elif not isinstance(form, numbers.Real) or isinstance(form, bool):
        raise ValueError(f'{scan.name}: form = {form!r}; allowed are "mean", "plane" and the radius of a sphere in m')
    elif not abs(form) > math.hypot(*scan.sizes):
        raise ValueError(f"{scan.name}: form = {form} m: a sphere must be larger than the scan, {scan.sizes} m")
    else:
        said = f"a sphere of radius {'-' * (form < 0)}{_length(abs(form))} and the plane taken off"
    z = summits.without_form(scan.z, scan.steps, form)
    if cutoff is None:
        said += "; no low-pass, so the shortest waves are those of the instrument and the step"
    elif not summits.SHORTEST * max(scan.steps) <= number(f"{scan.name}: cutoff", cutoff, "m") < math.inf:
        least = summits.SHORTEST * max(scan.steps)
        raise ValueError(f"{scan.name}: cutoff = {cutoff} m; it must be finite and at least three steps, {least:.4g} m")
    else:
        z = summits.low_pass(z, scan.steps, cutoff)
        said += f"; Gaussian low-pass (ISO 16610) with a cutoff of {_length(cutoff)}, borders of 0.75 cutoffs cut away"
        if min(z.shape) < FEWEST:
            raise ValueError(
                f"{scan.name}: {' × '.join(map(str, z.shape))} points are left by a cutoff of {cutoff:g} m, which "
                f"takes 0.75 cutoffs from each border; at least {FEWEST} in each direction are needed"
            )
    if np.std(z) <= 1e-12 * np.abs(scan.z).max():  # only rounding errors of the subtraction are left
        raise ValueError(f"{scan.name}: nothing is left of the heights: {said}")
    return z, said


def _resolution(scan: Scan) -> str:
    """Points and distances of the scan, x before y."""
    points, steps, sizes = (
        " × ".join(reversed(of))
        for of in (list(map(str, scan.z.shape)), list(map(_length, scan.steps)), list(map(_length, scan.sizes)))
    )
    return f"{scan.name}, {points} points {steps} apart, {sizes}"


def _notes(z, steps, along, m, found):
    """The doubts about a scan, each a sentence."""
    spacing = found.density**-0.5
    expected = math.prod((n * step / spacing) for n, step in zip(z.shape, steps, strict=True))
    if z.ndim == 1:
        yield "a profile: the surface is taken to be isotropic and Gaussian, and N̄ is not counted on an area"
    if spacing < RESOLVED * max(steps):
        yield (
            f"asperities are {spacing / max(steps):.2g} points apart, {RESOLVED} are needed to see them: N̄ and Ra are "
            "those of the step or of noise; give a cutoff, or measure with a smaller step"
        )
    if expected < MANY:
        percent = (3 - z.ndim) * 100 / math.sqrt(expected)
        yield f"about {expected:.0f} asperities: N̄ is uncertain by some {percent:.0f} %"
    usual = summits.usual_curvature(z, steps) if found.found is None else found.usual
    if found.curvature > SPIKED * usual:
        ratio = f"{found.curvature / usual:.2g} times" if usual > 0 else "far"
        yield (
            f"a few sharp points make Ra {ratio} smaller than the others do: spikes, dust, or heights in coarse steps; "
            "take them out, or give a cutoff"
        )
    slopes = [one.m2 for one in along]
    if max(slopes) > ISOTROPIC * min(slopes):
        ratio = math.sqrt(max(slopes) / min(slopes))
        yield f"slopes along one axis are {ratio:.2g} times those along the other: asperities are long, not round"
    skewness, alpha = float(np.mean((z - z.mean()) ** 3) / np.std(z) ** 3), summits.bandwidth(m)
    if found.found is None and (abs(skewness) > SKEWED or alpha < 1.5):
        yield (
            f"skewness {skewness:.2g}, α = {alpha:.3g}: a Gaussian surface has 0, and at least 1.5; "
            'prefer method="summits"'
        )

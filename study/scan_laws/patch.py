"""One period of heights from a scan, and its contact under a nominal pressure."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.fft import dctn, idctn

from solver.laws.cell.periodic import pressed, response_of, waves_times

from ..specimen.heights import scan_peaks
from ..specimen.heights.form import without_form
from ..specimen.scan import FEWEST, Scan

#: Ways to make a period of a scan.
PERIODS = ("mirror", "taper", "given")
#: A tapered scan goes to its mean within this share of each side.
_BORDER = 0.125


@dataclass(frozen=True)
class Patch:
    """One period of a surface.

    Attributes
    ----------
    z : heights (ny, nx), m
    steps : along y and x, m
    mirrored : whether the period is z beside its mirror images, so that z is a quarter of it
    treatment : of the scan, in words
    """

    z: np.ndarray
    steps: tuple[float, float]
    mirrored: bool
    treatment: str = ""

    @property
    def slope(self) -> float:
        """Root mean square of the gradient, by differences of neighbouring points."""
        along = [np.diff(self.z, axis=axis) / step for axis, step in enumerate(self.steps)]
        return float(np.sqrt(sum(np.mean(slopes**2) for slopes in along)))

    def quarters(self) -> "list[Patch]":
        """The four quarters of the patch. Each makes a period with its mirror images."""
        (half_y, half_x), z = (count // 2 for count in self.z.shape), self.z
        parts = (z[:half_y, :half_x], z[:half_y, -half_x:], z[-half_y:, :half_x], z[-half_y:, -half_x:])
        return [Patch(part, self.steps, True) for part in parts]

    def within(self, most: int) -> "Patch":
        """The corner of a mirrored patch with at most `most` points along a side, as a mirrored patch."""
        return Patch(self.z[:most, :most], self.steps, True)

    def halved(self) -> "Patch":
        """A mirrored patch with points at half the distance, by its Fourier series."""
        waves = np.pad(dctn(self.z, norm="forward"), [(0, count) for count in self.z.shape])
        fine = idctn(waves, norm="forward")
        return Patch(fine, (self.steps[0] / 2, self.steps[1] / 2), True)


class Pressing:
    """The contact of a patch on a body, at one pressure after another.

    kernel : L as a function of k (1/m), or None
    """

    def __init__(self, patch: Patch, kernel: Callable | None):
        self.depths, self.mirrored = patch.z.max() - patch.z, patch.mirrored
        self.response = response_of(patch.z.shape, patch.steps[1], patch.steps[0], kernel, patch.mirrored)
        self.pressures: np.ndarray | None = None

    def at(self, p: float, name: str = "the scan") -> tuple[float, float, float]:
        """A in m, λ and p_max at a nominal pressure. The pressures stay as the start of the next contact.

        p : over the modulus of body and punch in series

        Raises ValueError if the iteration has not ended.
        """
        start = np.ones_like(self.depths) if self.pressures is None else self.pressures
        field, A, ended = pressed(self.depths, self.response, p, start * (p / start.mean()), self.mirrored)
        if not ended:
            raise ValueError(f"{name}: the contact at p = {p:.3g} E1* has not converged: take a smaller patch")
        self.pressures = field
        return float(A), np.count_nonzero(field) / field.size, float(field.max())

    def gap(self, A: float) -> np.ndarray:
        """The gap (ny, nx), m, under the last pressures, whose approach is A; 0 at points in contact."""
        assert self.pressures is not None
        gap = waves_times(self.pressures, self.response, self.mirrored) + self.depths - A
        return np.where(self.pressures > 0, 0.0, np.maximum(gap, 0.0))


def patch_of(scan: Any, form: Any, cutoff: float | None, periodic: str, refine: int, caller: str) -> Patch:
    """The period of a scan. Raises ValueError for a scan that is not a map without gaps, or a wrong argument."""
    if not isinstance(scan, Scan) or scan.z.ndim != 2:
        raise ValueError(f"{caller}: needs a map of heights, from roughness.read or roughness.height_map")
    if np.isnan(scan.z).any():
        gaps = int(np.isnan(scan.z).sum())
        raise ValueError(f'{scan.name}: {gaps} points are missing: read it with missing="fill", or crop it')
    if periodic not in PERIODS:
        raise ValueError(f'{caller}: periodic = {periodic!r}; allowed are "mirror", "taper", "given"')
    if not (isinstance(refine, (int, np.integer)) and not isinstance(refine, bool) and 1 <= refine <= 8):
        raise ValueError(f"{caller}: refine = {refine!r}: must be a whole number, 1 to 8")
    steps = float(scan.steps[0]), float(scan.steps[1])
    z, treatment = without_form(scan.z, steps, form, scan.name)
    if cutoff is not None:
        z = _filtered(scan, z, cutoff)
        treatment += f"; Gaussian low-pass (ISO 16610) with a cutoff of {cutoff:.3g} m"
    if periodic == "taper":
        windows = [_window(count) for count in z.shape]
        z, treatment = z.mean() + (z - z.mean()) * windows[0][:, None] * windows[1], f"{treatment}; tapered"
    treatment += "; mirrored" * (periodic == "mirror")
    if refine == 1:
        return Patch(z, steps, periodic == "mirror", treatment)
    if periodic == "mirror":
        z = np.concatenate([z, z[:, ::-1]], axis=1)
        z = np.concatenate([z, z[::-1]], axis=0)
    fine = (steps[0] / refine, steps[1] / refine)
    return Patch(_refined(z, int(refine)), fine, False, f"{treatment}; {refine} points a pixel by the Fourier series")


def _filtered(scan: Scan, z: np.ndarray, cutoff: float) -> np.ndarray:
    least = scan_peaks.SHORTEST * max(scan.steps)
    if not (isinstance(cutoff, (int, float)) and least <= cutoff < np.inf):
        raise ValueError(f"{scan.name}: cutoff = {cutoff} m; it must be finite and at least three steps, {least:.4g} m")
    z = scan_peaks.low_pass(z, scan.steps, cutoff)
    if min(z.shape, default=0) < FEWEST:
        raise ValueError(f"{scan.name}: a cutoff of {cutoff:g} m leaves {' × '.join(map(str, z.shape))} points")
    return z


def _window(count: int) -> np.ndarray:
    """A window that is 1 inside and 0 at both ends, with cosines between."""
    from_end = np.minimum(np.arange(count), np.arange(count)[::-1]) / (_BORDER * count)
    return 0.5 - 0.5 * np.cos(np.pi * np.minimum(from_end, 1.0))


def _refined(z: np.ndarray, times: int) -> np.ndarray:
    """The Fourier series of one period at `times` as many points along each side; the points of z are among them."""
    waves = np.zeros([times * count for count in z.shape], dtype=complex)
    places = [np.fft.fftfreq(count, 1 / count).astype(int) % (times * count) for count in z.shape]
    waves[np.ix_(*places)] = np.fft.fft2(z)
    return np.fft.ifft2(waves).real * times**2

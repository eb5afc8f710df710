"""The form of a scan, which is not roughness: its mean, a plane, a quadratic, or a sphere of given or fitted radius.

Heights z have the shape (x) for a profile and (y, x) for a map; steps are the distances between points along these
axes. NaN is a missing point, which every fit leaves out.
"""

import math
import numbers
from collections.abc import Callable
from functools import partial

import numpy as np

from ..quantities import has_unit, quantity, readable
from .memory import row_blocks, variance

#: Name of a polynomial -> its degree.
DEGREES = {"mean": 0, "plane": 1, "quadratic": 2}
#: Largest number of steps in the fit of a sphere. A scan whose diagonal is a tenth of the radius takes 5, a scan whose
#: diagonal is the radius 22 (tests/specimen/heights/test_forms.py).
_STEPS = 30
#: The fit ends when the height of the sphere changes by less than this fraction of the heights' standard deviation.
_SETTLED = 1e-9


def without_form(z: np.ndarray, steps: tuple, form, name: str) -> tuple[np.ndarray, str]:
    """The heights without their form, and the form in words.

    form : "mean", "plane" (least squares), "quadratic" (least squares), "sphere" (the best fit), or the radius of a
        sphere, in m or as text with its unit; a negative radius is a cup

    Raises ValueError: an unknown form, or a sphere that is smaller than the scan.
    """
    sizes = tuple((n - 1) * step for n, step in zip(z.shape, steps, strict=True))
    if isinstance(form, str) and form in DEGREES:
        return _residual(z, steps, DEGREES[form]), f"{form} removed"
    if isinstance(form, str) and form == "sphere":
        z, curvature = _without_sphere(z, steps, None)
        if not abs(curvature) * math.hypot(*sizes) < 1:
            raise ValueError(
                f'{name}: form = "sphere": the one that fits has a radius of {_text(1 / curvature)}, but must be '
                f"larger than the scan, {' × '.join(map(_text, reversed(sizes)))}; crop the scan, or give another form"
            )
        return z, f"a sphere of the fitted radius {_text(1 / curvature)} and the plane removed"
    radius = _radius(form, name)
    if not abs(radius) > math.hypot(*sizes):
        raise ValueError(f"{name}: form = {radius} m: a sphere must be larger than the scan, {sizes} m")
    z, _ = _without_sphere(z, steps, 1 / radius)
    return z, f"a sphere of radius {_text(radius)} and the plane removed"


def share_of_polynomial(z: np.ndarray, steps: tuple, degree: int) -> float:
    """The share of the heights' variance that the least-squares polynomial of this degree explains, 0 to 1."""
    return max(0.0, 1 - variance(_residual(z, steps, degree)) / float(np.nanvar(z)))


def _radius(form, name: str) -> float:
    if has_unit(form):
        return quantity(f"{name}: form", form, "m").value
    if isinstance(form, numbers.Real) and not isinstance(form, bool):
        return float(form)
    raise ValueError(
        f'{name}: form = {form!r}; allowed are "mean", "plane", "quadratic", "sphere" and the radius of a sphere, in m '
        'or as text with its unit, "5 mm"'
    )


def _text(radius: float) -> str:
    return ("-" if radius < 0 else "") + readable(float(f"{abs(radius):.3g}"), "m")


def _residual(z: np.ndarray, steps: tuple, degree: int, out: np.ndarray | None = None) -> np.ndarray:
    """The heights minus the best-fitting polynomial of this total degree; in the array `out`, which may be z."""
    x = _lines(z, steps)
    powers = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i) if z.ndim == 2 or i == 0]
    coefficients = _fitted(z, x, powers, np.eye(len(powers)))
    return _minus(z, x, lambda x: _surface(coefficients, x, powers), np.empty(z.shape) if out is None else out)


def _minus(z: np.ndarray, x: list, surface: Callable[[list], np.ndarray], out: np.ndarray) -> np.ndarray:
    """The heights minus a surface over coordinates like x, in the array `out`."""
    grid, rest = (array.reshape(x[1].size, x[0].size) for array in (z, out))
    for rows in row_blocks(grid):
        np.subtract(grid[rows], surface([x[0], x[1][rows]]), out=rest[rows])
    return out


def _without_sphere(z: np.ndarray, steps: tuple, curvature: float | None) -> tuple[np.ndarray, float]:
    """The heights minus a sphere and a plane, and the curvature of the sphere, 1/m.

    curvature : of the sphere; None: it is fitted

    The fit is one of least squares: the remainder has no slope and, where the curvature is fitted, no part like r². The
    top of the sphere may be anywhere: its slopes in the middle of the scan determine where.
    """
    x, free = _lines(z, steps), curvature is None
    half = max((n - 1) * step for n, step in zip(z.shape, steps, strict=True)) / 2
    powers = [(0, 0), (0, 1), (1, 0), (0, 2), (2, 0)] if z.ndim == 2 else [(0, 0), (0, 1), (0, 2)]
    round_ = np.array([[2 in power for power in powers]], dtype=float)  # r², a sum of two powers
    plain = np.eye(len(powers))[: 1 + z.ndim]
    basis = np.concatenate([plain, round_]) if free else plain
    kappa, slopes, settled = (0.0 if free else half * curvature), np.zeros(2), _SETTLED * np.nanstd(z) / half
    remainder = np.empty(z.shape)
    for _ in range(_STEPS):
        _minus(z, x, partial(_sphere, slopes=slopes, kappa=kappa, size=half), remainder)
        fitted = basis @ _fitted(remainder, x, powers, basis) / half
        change = fitted[1 : 1 + z.ndim]
        slopes = slopes + np.pad(change, (0, 2 - z.ndim))
        kappa -= 2 * fitted[-1] / np.sum(round_) if free else 0.0
        if np.abs(fitted[1:]).max() <= settled:
            break
    _minus(z, x, partial(_sphere, slopes=slopes, kappa=kappa, size=half), remainder)
    return _residual(remainder, steps, 1, out=remainder), kappa / half


def _sphere(x: list, slopes: np.ndarray, kappa: float, size: float) -> np.ndarray:
    """Heights of a sphere above its point in the middle of the scan, where its slopes along x and y are `slopes`.

    Without curvature it is a plane. Outside its equator the sphere goes on as a paraboloid.

    x, kappa : coordinates over `size`, and the curvature times `size`
    """
    sines = slopes / math.sqrt(1 + slopes @ slopes)
    squared = sum((kappa * line - sine) ** 2 for line, sine in zip(x, sines, strict=True))
    linear = sum(2 * sine * line - kappa * line**2 for line, sine in zip(x, sines, strict=True))
    return size * (linear / (np.sqrt(np.maximum(0.0, 1 - squared)) + math.sqrt(1 - sines @ sines)))


def _lines(z: np.ndarray, steps: tuple) -> list[np.ndarray]:
    """The coordinates x (1, nx) and y (ny, 1) from the middle of the scan, in units of half its longer side; y is 0 in
    a profile."""
    half = max((n - 1) * step for n, step in zip(z.shape, steps, strict=True)) / 2
    lines = [(np.arange(n) - (n - 1) / 2) * step / half for n, step in zip(z.shape, steps, strict=True)]
    return [lines[-1][None, :], lines[0][:, None] if z.ndim == 2 else np.zeros((1, 1))]


def _fitted(z: np.ndarray, x: list, powers: list, basis: np.ndarray) -> np.ndarray:
    """Coefficients of the powers (of y, of x) in the best-fitting combination of the rows of `basis`."""
    across, along = (np.vander(line.ravel(), 2 * max(map(max, powers)) + 1, increasing=True) for line in x)
    mean, grid = np.nanmean(z), z.reshape(along.shape[0], across.shape[0])
    sums, moments = np.zeros((2, along.shape[1], across.shape[1]))
    for rows in row_blocks(grid):
        present = np.isfinite(grid[rows])
        sums += along[rows].T @ (present.astype(float) @ across)
        moments += along[rows].T @ (np.where(present, grid[rows] - mean, 0.0) @ across)
    normal = np.array([[sums[i + k, j + m] for k, m in powers] for i, j in powers])
    side = np.array([moments[power] for power in powers])
    coefficients = np.linalg.lstsq(basis @ normal @ basis.T, basis @ side, rcond=1e-14)[0] @ basis
    coefficients[powers.index((0, 0))] += mean
    return coefficients


def _surface(coefficients: np.ndarray, x: list, powers: list) -> np.ndarray:
    """The polynomial on the grid, shape (y, x)."""
    table = np.zeros(np.max(powers, axis=0) + 1)
    table[tuple(np.transpose(powers))] = coefficients
    return np.polynomial.polynomial.polygrid2d(x[1].ravel(), x[0].ravel(), table)

"""A measured surface: heights on a uniform grid, in metres. Numbers that no surface has are refused."""

import difflib
import functools
import inspect
import math
import numbers
import unicodedata
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, ParamSpec, TypeVar

import numpy as np

from .heights.memory import compressed
from .heights.missing import treated
from .heights.spikes import despiked
from .pictures import of_heights

P, T = ParamSpec("P"), TypeVar("T")
#: Metres in a unit. The micro sign and the Greek letter are two characters; keyboards have one or the other.
MICRO = dict.fromkeys(("um", "µm", "μm"), 1e-6)
UNITS = {"m": 1.0, "mm": 1e-3, **MICRO, "nm": 1e-9, "pm": 1e-12, "angstrom": 1e-10, "Å": 1e-10}
#: Other spellings of units, in lower case and without a plural s.
WORDS = {"angstrom": 1e-10, "ångström": 1e-10, "micron": 1e-6}
PREFIXES = {"": 1.0, "milli": 1e-3, "micro": 1e-6, "nano": 1e-9, "pico": 1e-12}
WORDS |= {prefix + word: size for prefix, size in PREFIXES.items() for word in ("meter", "metre")}
#: Fewest points in a direction. They can show two bumps of eight points each.
FEWEST = 16
#: Largest rms slope, 72°. A stylus (cone of 60° or 90°) follows slopes up to 1.7, light up to about 1, the tip of an
#: atomic force microscope up to 2.7. A steeper scan has units other than the caller says, or is full of spikes.
STEEPEST = 3.0
#: Outside these limits the unit of a scan must be wrong: a size above 1 m, which no instrument reaches; heights with an
#: rms below 1 pm, a hundredth of an atom; and asperities with a radius above 1 km, such as waves 8 mm long with an rms
#: of 1 nm, which are as wide as a contact or wider (tests/specimen/heights/test_lengths_refused.py).
LONGEST, FLATTEST, BLUNTEST = 1.0, 1e-12, 1e3
#: Largest distance of a position from the uniform grid, in steps. It is about the relative error of curvatures.
#: Positions that are written to a tenth of the step pass.
UNEVEN = 0.1


#: A word that people may use -> the argument of `read` that they mean.
_MEANT = {
    **dict.fromkeys(("spacing", "step", "steps", "pixel", "pixel_size", "pitch", "resolution", "increment"), "dx"),
    **dict.fromkeys(("units", "xunit", "x_unit"), "unit"),
    **dict.fromkeys(("zunit", "z_unit", "height_units"), "height_unit"),
    **dict.fromkeys(("spikes", "outliers"), "despike"),
}


@dataclass(frozen=True, eq=False)
class Scan:
    """Heights of a surface. `profile`, `height_map` and `read` make a Scan and check its heights.

    Attributes
    ----------
    z : heights in m, shape (x) of a profile or (y, x) of a map; NaN where a point is missing
    steps : distance between points along each axis of z, m
    name : of the file, or as the caller says
    notes : sentences about how the scan was read, which `measure` passes on
    huge : whether the limits of size are off, in `measure` too

    Examples
    --------
    >>> import numpy as np
    >>> scan = Scan(np.zeros((101, 201)), (1e-6, 1e-6), "flat")
    >>> print(f"{scan.sizes[0]:.0e} {scan.sizes[1]:.0e}")
    1e-04 2e-04
    """

    z: np.ndarray
    steps: tuple[float, ...]
    name: str
    notes: tuple[str, ...] = ()
    huge: bool = False

    @property
    def sizes(self) -> tuple[float, ...]:
        """Lengths of the scan along the axes of z, from the first point to the last, m."""
        return tuple((n - 1) * step for n, step in zip(self.z.shape, self.steps, strict=True))

    def _repr_html_(self) -> str:
        return of_heights(self)


def meant(word: str, arguments: Iterable[str]) -> str | None:
    """The argument that somebody may mean by another word, such as "pixel"; None if no argument is close to it."""
    arguments, word = list(arguments), word.lower()
    near = [_MEANT[word]] if word in _MEANT else difflib.get_close_matches(word, arguments, n=1, cutoff=0.75)
    return near[0] if near and near[0] in arguments else None


def refusing_others(function: Callable[P, T]) -> Callable[P, T]:
    """The function with a TypeError for an unknown argument that suggests the argument that may be meant."""
    names = list(inspect.signature(function).parameters)

    @functools.wraps(function)
    def called(*args: P.args, **arguments: P.kwargs) -> T:
        for word in arguments:
            if word not in names and (near := meant(word, names)):
                raise TypeError(f"{function.__name__} takes no {word}; did you mean {near}?")
        return function(*args, **arguments)

    return called


@refusing_others
def profile(
    z: Any,
    *,
    x: Any = None,
    dx: float | None = None,
    unit: str = "m",
    height_unit: str | None = None,
    name: str = "the profile",
    missing: str = "fill",
    steep: bool = False,
    huge: bool = False,
    despike: float | None = None,
) -> Scan:
    """A profile, from its heights and either their positions or the distance between them.

    Parameters
    ----------
    z : heights, in height_unit (None: as `unit`)
    x, dx : positions on a uniform grid, rising or falling, or the distance between two points; in unit
    unit, height_unit : one of m, mm, um, nm, pm, angstrom, or another spelling of these
    name : of the scan, in messages
    missing, steep, huge, despike : as in `height_map`; the neighbours are four points on each side

    Returns
    -------
    Scan : in m

    Raises
    ------
    ValueError : neither or both of x and dx, positions that are not uniform, or heights that `height_map` refuses

    Examples
    --------
    >>> import numpy as np
    >>> scan = profile(np.sin(np.arange(64.0)), dx=0.5, unit="um", height_unit="nm")
    >>> print(scan.z.shape, f"{scan.sizes[0]:.3g}", f"{scan.z.max():.0e}")
    (64,) 3.15e-05 1e-09
    """
    if (x is None) == (dx is None):
        raise ValueError(f"{name}: give either the positions of the points, x, or their distance, dx")
    step = dx if x is None else _step(np.asarray(_in_unit(f"{name}: x", x, unit), dtype=float), np.shape(z), name)
    steps = (number(f"{name}: dx", step, unit),)
    return _checked(z, steps, unit, height_unit, name, missing=missing, steep=steep, huge=huge, despike=despike)


@refusing_others
def height_map(
    z: Any,
    *,
    dx: float,
    dy: float | None = None,
    unit: str = "m",
    height_unit: str | None = None,
    name: str = "the map",
    missing: str = "fill",
    steep: bool = False,
    huge: bool = False,
    despike: float | None = None,
) -> Scan:
    """A map of heights.

    Parameters
    ----------
    z : heights, shape (y, x), in height_unit (None: as `unit`)
    dx, dy : distance between columns and between rows, in unit; dy defaults to dx
    unit, height_unit : one of m, mm, um, nm, pm, angstrom, or another spelling of these
    name : of the scan, in messages
    missing : the treatment of heights that are NaN or under a mask: "fill" interpolates up to 1 % of the points;
        "skip" leaves them, and every statistic uses the points whose neighbours are all measured; "refuse"
    steep : accept slopes that no instrument measures (rms above 3), and heights that span more than the scan is long
    huge : accept a scan longer than 1 m, heights with an rms below 1 pm, and asperities with a radius above 1 km
    despike : count as missing each point that is further than this many robust deviations (1.4826 times the median of
        all these distances) from the median of its eight neighbours; 5 is usual, None keeps all points

    Returns
    -------
    Scan : in m

    Raises
    ------
    ValueError : fewer than 16 points in a direction, heights that are not numbers or all equal, a distance that is not
        positive, an unknown unit, more missing points than allowed, lengths whose unit must be wrong, or a despike
        that is not a positive number

    Examples
    --------
    >>> import numpy as np
    >>> rows, columns = np.arange(32.0)[:, None], np.arange(64.0)
    >>> scan = height_map(np.sin(rows) + np.cos(columns), dx=0.5, unit="um", height_unit="nm")
    >>> print(scan.z.shape, f"{scan.sizes[0]:.3g} {scan.sizes[1]:.3g}")
    (32, 64) 1.55e-05 3.15e-05
    """
    dx = number(f"{name}: dx", dx, unit)
    axes = [z.coords[axis].values for axis in ("x", "y") if axis in getattr(z, "coords", ())]  # of xarray
    steps = [abs(float(x[1] - x[0])) for x in axes if x.dtype.kind in "iuf" and x.size > 1]
    if dy is None and len(steps) == 2 and not np.isclose(steps[0], steps[1], rtol=UNEVEN, atol=0):
        x, y = steps
        raise ValueError(f"{name}: the coordinates of z have steps of {x:g} along x, {y:g} along y: give dy")
    rows = dx if dy is None else number(f"{name}: dy", dy, unit)
    return _checked(z, (rows, dx), unit, height_unit, name, missing=missing, steep=steep, huge=huge, despike=despike)


def metres(unit: str, name: str) -> float:
    """Metres in a unit of length."""
    size = spelt(unit)
    if size is None:
        raise ValueError(f"{name}: the unit {unit!r} is unknown; allowed are {', '.join(UNITS)}")
    return size


def spelt(word) -> float | None:
    """Metres in a unit of length in any spelling, "Ångström", "microns"; None for any other word.

    Å is a character of its own, or an A with a combining ring.
    """
    if not isinstance(word, str):
        return None
    word = unicodedata.normalize("NFC", word)
    return UNITS.get(word) or WORDS.get(word.lower().removesuffix("s"))


def number(name: str, value, unit: str) -> float:
    """A length that is a number in `unit`. Raises ValueError for a text, "2 um", or anything else."""
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return value
    raise ValueError(f"{name} = {value!r}: must be a number, in {unit}")


def _in_unit(name: str, values, unit: str):
    """The values. Raises ValueError for quantities of pint, and for a DataArray with another unit than `unit`.

    Without this check their numbers would be read in a unit that they do not have.
    """
    quantity = hasattr(values, "magnitude")
    units = values.units if quantity else getattr(values, "attrs", {}).get("units", unit)
    if quantity or (units != unit and spelt(units) != spelt(unit)):
        raise ValueError(f"{name} is in {units}, but must be numbers in {unit}: give the numbers, and their unit")
    return values


def _step(x: np.ndarray, shape: tuple, name: str) -> float:
    """Distance between the points of a uniform grid. Raises ValueError for positions that are not uniform."""
    if x.shape != shape or x.ndim != 1 or x.size < 2:
        raise ValueError(f"{name}: {x.shape} positions for {shape} heights; one column of each is needed")
    if not np.isfinite(x).all():
        raise ValueError(f"{name}: {np.sum(~np.isfinite(x))} of {x.size} positions x are not numbers")
    step = (x[-1] - x[0]) / (x.size - 1)
    off = np.abs(x - (x[0] + step * np.arange(x.size)))
    if not (step != 0 and off.max() <= UNEVEN * abs(step)):
        i = int(np.argmax(off))
        raise ValueError(
            f"{name}: the positions x are not uniform: they run from {x[0]:g} to {x[-1]:g}, on average {step:.4g} "
            f"a step, but x = {x[i]:g} in row {i + 1} is {off[i]:.3g} off; at most {UNEVEN:g} steps are allowed. "
            "Interpolate to equal steps, or choose other columns."
        )
    return abs(step)


def _checked(z, steps: tuple, unit: str, height_unit: str | None, name: str, *, missing, steep, huge, despike) -> Scan:
    """The scan in metres. Raises ValueError for heights or distances that no scan has."""
    z = _heights(z, len(steps), height_unit or unit, name)
    if not all(np.isfinite(step) and step > 0 for step in steps):
        raise ValueError(f"{name}: the distances of its points are {steps}; they must be positive")
    lateral, vertical = metres(unit, name), metres(height_unit or unit, name)
    z, spikes = despiked(z, despike, name)
    z, notes = treated(z, missing, name, spikes)
    if np.nanmax(z) == np.nanmin(z):
        raise ValueError(f"{name}: all {z.size} heights equal {np.nanmax(z):g}: there is no roughness to measure")
    z = z * vertical  # the heights of the caller stay; those without spikes and gaps are dropped
    scan = Scan(z, tuple(float(step) * lateral for step in steps), name, notes, bool(huge))
    units_in_words = f"Lengths were taken to be in {unit}, heights in {height_unit or unit}"
    if not huge:
        _check_size(scan, units_in_words)
    if not steep:
        _check_slopes(scan, units_in_words)
    return scan


def _heights(z, dimensions: int, unit: str, name: str) -> np.ndarray:
    """The heights as numbers in `unit`, NaN where one is missing, of (y, x) or (x)."""
    z = _in_unit(f"{name}: z", z, unit)
    z = z.transpose("y", "x") if set(getattr(z, "dims", ())) == {"x", "y"} else z  # of xarray
    try:
        # asarray alone would keep the heights under the mask
        z = np.ma.filled(z.astype(float), np.nan) if np.ma.isMaskedArray(z) else np.asarray(z, dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: the heights are not an array of numbers: {error}") from error
    if z.ndim != dimensions:
        raise ValueError(f"{name}: the heights have shape {z.shape}; {dimensions} dimension(s) are needed")
    if min(z.shape) < FEWEST:
        read = " × ".join(map(str, z.shape))
        raise ValueError(f"{name}: {read} heights; at least {FEWEST} in each direction are needed")
    return z


def _check_size(scan: Scan, units_in_words: str) -> None:
    """Raise ValueError for lengths that no scan of a rough surface has: their unit must be wrong."""
    way_out = f"{units_in_words}: give unit and height_unit as the file has them, or huge=True if it is so"
    if max(scan.sizes) > LONGEST:
        raise ValueError(
            f"{scan.name}: the scan is {max(scan.sizes):.3g} m long; at most {LONGEST:g} m is taken. {way_out}."
        )
    rms = float(np.nanstd(scan.z))
    if rms < FLATTEST:
        raise ValueError(
            f"{scan.name}: the heights spread by {rms:.3g} m (rms); no surface is smoother than {FLATTEST:g} m, 1 pm. "
            f"{way_out}."
        )


def _check_slopes(scan: Scan, units_in_words: str) -> None:
    """Raise ValueError for slopes that no instrument measures: the unit of heights or lengths must be wrong."""
    span = np.nanmax(scan.z) - np.nanmin(scan.z)
    slope = math.sqrt(max(_mean_square_slope(scan.z, axis, step) for axis, step in enumerate(scan.steps)))
    if span > max(scan.sizes) or slope > STEEPEST:
        raise ValueError(
            f"{scan.name}: heights span {span:.3g} m on a scan {max(scan.sizes):.3g} m long, with an rms slope of "
            f"{slope:.3g}; no instrument measures slopes above {STEEPEST:g}. {units_in_words}: give unit and "
            "height_unit as the file has them, cut away its spikes, or take it as it is with steep=True."
        )


def _mean_square_slope(z: np.ndarray, axis: int, step: float) -> float:
    """Mean square of the slopes along an axis of a map; 0 where there is none."""
    slopes = np.diff(z, axis=axis)
    slopes /= step
    slopes = compressed(slopes)
    slopes *= slopes
    return float(slopes.mean()) if slopes.size else 0.0

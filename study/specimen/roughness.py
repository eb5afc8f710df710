"""From a roughness as people specify it to that of the model: asperities per unit area `Nbar`, and their radius `Ra`.

From a design: `square_lattice`, `hexagonal_lattice`, `area_fraction`, `cap_radius`. From a scan: `read` (a file),
`profile`, `height_map` (arrays), then `measure`. `Ra` is the radius of an asperity everywhere here, never the roughness
Ra of ISO 21920 (formerly ISO 4287), which is a mean height: `looks_like_iso_ra`. docs/roughness.md has the method.
"""

import math
from typing import Any

import numpy as np

from ..terminal import rounded
from .heights.measure import measure
from .heights.measured_asperities import Roughness
from .quantities import readable
from .scan import Scan, height_map, profile
from .scan_files import read

__all__ = [
    "Roughness",
    "Scan",
    "area_fraction",
    "cap_radius",
    "height_map",
    "hexagonal_lattice",
    "looks_like_iso_ra",
    "measure",
    "profile",
    "read",
    "square_lattice",
]

#: Circles that do not overlap cover at most this fraction of a plane, in a hexagonal lattice.
DENSEST = math.pi / (2 * math.sqrt(3))
#: Least plausible Ra √Nbar. On a random surface Ra √Nbar = 0.116/s with s the rms slope of its profiles, so 0.1 needs a
#: slope of 49°; on a designed one, even half-spheres of this size cover only π/100 of the area. The ISO Ra of a random
#: surface, mistaken for Ra, gives 0.14 √α s, which is below 0.1 on most (docs/roughness.md has examples).
SHARPEST = 0.1


def square_lattice(pitch: Any) -> Any:
    """Asperities per unit area of a square lattice, Nbar = 1/pitch². Geometry.

    Parameters
    ----------
    pitch : distance of nearest neighbours, > 0

    Returns
    -------
    float or array : in 1/[pitch]²

    Raises
    ------
    ValueError : a pitch that is no positive number, or has a unit as an attribute

    Examples
    --------
    >>> square_lattice(2.0)
    0.25
    """
    return 1 / _positive("pitch", pitch) ** 2


def hexagonal_lattice(pitch: Any) -> Any:
    """Asperities per unit area of a hexagonal lattice, Nbar = 2/(√3 pitch²). Geometry: each has a cell of √3/2 pitch².

    Parameters
    ----------
    pitch : distance of nearest neighbours, > 0

    Returns
    -------
    float or array : in 1/[pitch]²

    Raises
    ------
    ValueError : a pitch that is no positive number, or has a unit as an attribute

    Examples
    --------
    >>> round(hexagonal_lattice(2.0), 6)
    0.288675
    """
    return 2 / (math.sqrt(3) * _positive("pitch", pitch) ** 2)


def area_fraction(fraction: Any, base_radius: Any) -> Any:
    """Asperities per unit area whose circular bases cover a fraction of it, Nbar = fraction/(π base_radius²). Geometry.

    Parameters
    ----------
    fraction : covered, > 0. Circles cover at most π/(2√3) = 0.907 without overlap; more is refused
    base_radius : of the circles, > 0

    Returns
    -------
    float or array : in 1/[base_radius]²

    Raises
    ------
    ValueError : a number out of these bounds, or with a unit as an attribute

    Examples
    --------
    >>> round(area_fraction(0.5, 1.0), 6)
    0.159155
    """
    fraction, base_radius = _positive("fraction", fraction), _positive("base_radius", base_radius)
    if not np.all(fraction <= DENSEST):
        raise ValueError(f"fraction = {fraction}: circles that do not overlap cover at most {DENSEST:.4f} of a plane")
    return fraction / (math.pi * base_radius**2)


def cap_radius(height: Any, width: Any) -> Any:
    """Radius Ra of an asperity that is a spherical cap, Ra = (width²/4 + height²)/(2 height).

    Geometry: Pythagoras on Ra, Ra - height and width/2.

    Parameters
    ----------
    height, width : of the cap, and diameter of its base, > 0. A cap is at most a half-sphere, so height may be at most
        width/2; a taller bump has sides that no cap has, and is refused

    Returns
    -------
    float or array : in the unit of both

    Raises
    ------
    ValueError : a number out of these bounds, or with a unit as an attribute

    Examples
    --------
    >>> cap_radius(1.0, 4.0)
    2.5
    """
    height, width = _positive("height", height), _positive("width", width)
    if not np.all(height <= width / 2):
        raise ValueError(
            f"height = {height} on a base of width = {width}: a spherical cap is at most half as high as wide. "
            "For a taller bump give the radius of its tip as Ra."
        )
    return (width**2 / 4 + height**2) / (2 * height)


def _positive(name: str, value):
    """The value, a list as an array. Raises ValueError for a text, or a number that is not positive and finite."""
    value = np.asarray(value) if isinstance(value, list | tuple) else value
    if getattr(value, "attrs", {}).get("units", "1") != "1":  # two units may differ, and the answer would have one
        raise ValueError(f"{name} is in {value.attrs['units']}: give numbers, all lengths in one unit")
    if isinstance(value, np.ndarray | np.generic) and value.dtype.kind in "iu":
        value = value.astype(float)  # squares of whole numbers of 32 bits overflow from 46,341 on
    if value is None or np.asarray(value).dtype.kind in "OSU" and not hasattr(value, "magnitude"):
        raise ValueError(f"{name} = {value!r}: must be a number, all lengths in one unit, or a quantity of pint")
    if not (np.all(value > 0) and np.all(np.isfinite(value))):
        raise ValueError(f"{name} = {value}: must be > 0 and finite")
    return value


def looks_like_iso_ra(Ra: Any, Nbar: Any, *, si: bool = False) -> str | None:
    """A warning if Ra is too small to be the radius of asperities so dense, perhaps an ISO roughness.

    The test is Ra √Nbar < 0.1 (see `SHARPEST`). A sparse design of small half-spheres may have it and be right.

    Parameters
    ----------
    Ra, Nbar : in one unit of length, or in R; arrays are compared element by element, the sharpest is named
    si : whether they are in m and 1/m², so that the warning has readable units

    Returns
    -------
    str or None : None if they may be right

    Examples
    --------
    >>> looks_like_iso_ra(0.004, 250_000) is None
    True
    """
    sharpness = np.asarray(Ra * np.sqrt(Nbar), dtype=float)
    if not np.any(sharpness < SHARPEST):
        return None
    i = np.unravel_index(np.nanargmin(sharpness), sharpness.shape)
    Ra, Nbar = (float(np.broadcast_to(value, sharpness.shape)[i]) for value in (Ra, Nbar))
    radius, density = (readable(Ra, "m"), readable(Nbar, "1/m^2")) if si else (f"{Ra:.4g}", f"{Nbar:.4g}")
    covered = rounded(100 * math.pi * Ra**2 * Nbar)
    return (
        f"Ra = {radius} is small for Nbar = {density}: the asperities are {1 / math.sqrt(Nbar) / Ra:.3g} radii apart, "
        f"and even as half-spheres they cover {covered} % of the area. Ra is the radius of an "
        "asperity here, often 1 to 1000 µm; the roughness Ra of ISO 21920 (ISO 4287) is a mean height, often 0.01 to "
        "10 µm. study.roughness.cap_radius gives the radius from height and width, study.roughness.measure from a scan."
    )

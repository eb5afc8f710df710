"""The contact of a scan point by point: pressure and gap of one period of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..specimen.quantities import has_unit, quantity
from .bodies import body_of
from .patch import Pressing, patch_of

if TYPE_CHECKING:
    import xarray as xr

#: Two moduli that differ by less than this part are one.
_SAME = 1e-3


def contact_map(
    scan: Any,
    p: Any,
    *,
    E1: Any = None,
    on: Mapping[str, Any] | None = None,
    periodic: str = "mirror",
    refine: int = 1,
    form: Any = "plane",
    cutoff: float | None = None,
) -> xr.Dataset:
    """Pressure and gap of a scan that is pressed flat, at each of its points.

    Parameters
    ----------
    scan : a map of heights without gaps
    p : nominal pressure, > 0: a number over E1*, or a text with a unit, "2 MPa", which needs a modulus
    E1 : reduced modulus E1* = E/(1 - ν²) at the surface of the body, a text with its unit; None: that of `on`, if `on`
        has moduli
    on, periodic, refine, form, cutoff : as in `law`

    Returns
    -------
    xarray.Dataset : `pressure` and `gap` (m) over y, x (m); attributes A, lam and p_max, and A_units and p_max_units.
        Pressures are in Pa if `E1` or `on` gives the modulus, else over E1*. A mirrored period is given without the
        mirror images

    Raises
    ------
    ValueError : arguments that `law` refuses, or a wrong pressure; for `on` a StudyError, a ValueError too

    Examples
    --------
    >>> from study import roughness
    >>> surface = roughness.self_affine((32, 32), "1 um", hurst=0.8, rms="20 nm", seed=3)
    >>> spots = roughness.contact_map(surface, 0.001, periodic="given")
    >>> print(spots.sizes["y"], f"{float(spots.pressure.mean()):.4f} {float(spots.gap.min()):.1g}")
    32 0.0010 0
    """
    import xarray as xr

    body = body_of(on, "contact_map")
    modulus, load = _modulus_and_load(E1, p, body.E1)
    unit = modulus or 1.0
    patch = patch_of(scan, form, cutoff, periodic, refine, "contact_map")
    pressing = Pressing(patch, body.kernel)
    A, lam, p_max = pressing.at(load * (1 + body.m), scan.name)
    unit_of_pressure = unit / (1 + body.m)
    y, x = (np.arange(count) * step for count, step in zip(patch.z.shape, patch.steps, strict=True))
    pressure, of_gap = {"long_name": "pressure"}, {"long_name": "gap", "units": "m"}
    pressure |= {"units": "Pa"} if modulus else {"long_name": "pressure, p/E1*"}
    return xr.Dataset(
        {
            "pressure": (("y", "x"), pressing.pressures * unit_of_pressure, pressure),
            "gap": (("y", "x"), pressing.gap(A), of_gap),
        },
        {"y": ("y", y, {"units": "m"}), "x": ("x", x, {"units": "m"})},
        {
            "A": A,
            "A_units": "m",
            "lam": lam,
            "p_max": p_max * unit_of_pressure,
            "p_max_units": "Pa" if modulus else "E1*",
            "scan": scan.name,
            "treatment": patch.treatment,
        },
    )


def _modulus_and_load(E1: Any, p: Any, of_body: float | None) -> tuple[float | None, float]:
    """The modulus E1* in Pa, None where it is not known, and the nominal pressure over it. Raises ValueError.

    of_body : the modulus of the body on which the scan is pressed, None where it is not known
    """
    modulus = of_body if E1 is None else quantity("contact_map: E1", E1, "Pa").value
    if E1 is not None and of_body is not None and abs(modulus / of_body - 1) > _SAME:
        raise ValueError(f"contact_map: E1 = {E1!r}, but `on` has E1* = {of_body:.6g} Pa: leave E1 out")
    if has_unit(p) and modulus is None:
        way_out = "give E1, the modulus E1*, with its unit too, or moduli in `on`"
        raise ValueError(f"contact_map: p = {p!r} has a unit: {way_out}")
    load = quantity("contact_map: p", p, "Pa").value / modulus if has_unit(p) else p
    if not (isinstance(load, (int, float, np.number)) and 0 < load < np.inf):
        raise ValueError(f"contact_map: p = {p!r}: must be a number > 0")
    return modulus, float(load)

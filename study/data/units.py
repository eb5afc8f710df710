"""Physical and dimensionless quantities: lengths in R, pressures in E2*, loads in E2* R², asperity densities in R⁻²."""

from typing import Any

import numpy as np
import xarray as xr

from ..spec.vocabulary import PARAMETERS, VOCABULARY, suggest

PHYSICAL_SCALE = "physical_scale"  # attribute of every dataset in physical units


def reduced_modulus(E, nu):
    """E* = E/(1 - ν²), in the unit of E."""
    return E / (1 - nu * nu)  # nu**2 of a number and of an array may differ in the last bit


def factor(name: str, R: float, E2_star: float) -> float:
    """What a dimensionless number is multiplied by to be in SI units: R m, E2* Pa."""
    for word, value in (("R", R), ("E2_star", E2_star)):
        if not (np.isfinite(value) and value > 0):
            raise ValueError(f"{word} = {value}: must be > 0 and finite")
    return with_unit(1.0, VOCABULARY[name].powers, E2_star, R)


def without_unit(value: Any, powers: tuple[int, int], unit: Any, R: Any) -> Any:
    """An SI value over unit^i R^j, (i, j) = `powers`."""
    return with_unit(value, (-powers[0], -powers[1]), unit, R)


def with_unit(value: Any, powers: tuple[int, int], unit: Any, R: Any) -> Any:
    """A dimensionless value times unit^i R^j."""
    for factor, power in ((unit, powers[0]), (R, powers[1])):
        for _ in range(abs(power)):
            value = value * factor if power > 0 else value / factor
    return value


def physical_attributes(name: str, given: dict) -> dict:
    """The attributes of a dimensionless variable when its numbers are in SI units."""
    entry = VOCABULARY[name]
    kept = {key: text for key, text in given.items() if key != "scale"}
    return kept | {"long_name": entry.long_name, "units": entry.unit}


def to_physical(dataset: xr.Dataset, *, R: float, E2_star: float) -> xr.Dataset:
    """The dataset in SI units, each named by the attribute `units`; `study.readable` gives µm, mN, MPa.

    Parameters
    ----------
    R : radius of the punch, m; E2_star : reduced modulus E2/(1 - ν2²) of the half-space, Pa; E1* on a rigid base

    Raises
    ------
    ValueError : the dataset is physical already, or holds pressures in E1* (a micro-law study)
    """
    if PHYSICAL_SCALE in dataset.attrs:
        raise ValueError(f"the dataset is in physical units already: {dataset.attrs[PHYSICAL_SCALE]}")
    if "status" not in dataset and any(array.attrs.get("scale") == "E1*" for array in dataset.variables.values()):
        raise ValueError("pressures of a micro-law study are in E1*, not in E2*: no half-space is defined there")
    changed = {}
    for name, array in dataset.variables.items():
        if name in VOCABULARY and VOCABULARY[name].powers != (0, 0):
            attributes = physical_attributes(name, array.attrs)
            fill = {key: value for key, value in array.encoding.items() if key == "_FillValue"}
            changed[name] = array.dims, array.data * factor(name, R, E2_star), attributes, fill
    physical = dataset.assign_coords({name: made for name, made in changed.items() if name in dataset.coords})
    physical = physical.assign({name: made for name, made in changed.items() if name in dataset.data_vars})
    return physical.assign_attrs({PHYSICAL_SCALE: f"R = {R!r} m, E2* = {E2_star!r} Pa"})


def from_physical(*, R: float, E2_star: float, **parameters) -> dict:
    """Dimensionless parameters for `study.solve` from physical ones, in the units that `to_physical` gives.

    Parameters
    ----------
    R : m; E2_star : Pa; P : N; a, D, h, Ra : m; Nbar : 1/m²; everything else is a pure number or text and passes
        unchanged

    Returns
    -------
    dict with the same names, scalars, arrays or DataArrays as given
    """
    found = {}
    for name, given in parameters.items():
        if name not in PARAMETERS:
            raise ValueError(f'"{name}" is not a parameter{suggest(name, PARAMETERS)}')
        if VOCABULARY[name].powers == (0, 0):
            found[name] = given
        else:
            array = given if isinstance(given, xr.DataArray) or np.isscalar(given) else np.asarray(given)
            found[name] = array / factor(name, R, E2_star)
    return found

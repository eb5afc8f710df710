"""Physical and dimensionless quantities: lengths in R, pressures in E2*, loads in E2* R², asperity densities in R⁻²."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import xarray_later as xr
from ..inputs.lexicon import default, lexicon_in
from ..inputs.scene.scene import reduced, with_unit
from ..inputs.vocabulary import Entry, no_parameter
from ..specimen.foreign import plain
from ..specimen.quantities import READABLE, has_unit, multiple, quantity

__all__ = ["factor", "from_physical", "readable", "reduced_modulus", "to_physical"]
PHYSICAL_SCALE = "physical_scale"  # attribute of every dataset in physical units


def reduced_modulus(E: Any, nu: Any) -> Any:
    """The reduced modulus E* = E/(1 - ν²).

    Parameters
    ----------
    E : Young's modulus, numbers or a text such as "210 GPa"
    nu : Poisson ratio in (-1, 0.5]

    Returns
    -------
    float, numpy.ndarray or xarray.DataArray : in the unit of E; in Pa of a text. E and nu broadcast

    Raises
    ------
    ValueError : nu outside (-1, 0.5]; a text that is no modulus

    Examples
    --------
    >>> reduced_modulus("210 GPa", 0.3) / 1e9
    230.76923076923077
    """
    return reduced(_si("E", E, "Pa") if isinstance(E, str) else E, nu)


def factor(name: str, R: float, E2_star: float) -> float:
    """The factor from a dimensionless number to SI units.

    Parameters
    ----------
    name : of a parameter or result
    R : radius of the punch, m
    E2_star : reduced modulus E2* of the half-space, Pa; E1* on a rigid base

    Returns
    -------
    float : the number E2*^i R^j of the powers (i, j) of its unit

    Raises
    ------
    ValueError : R or E2_star is not > 0 and finite

    Examples
    --------
    >>> factor("P", R=0.01, E2_star=2e11)
    20000000.0
    """
    return _factor(default().rows[name], R, E2_star)


def _factor(entry: Entry, R: float, E2_star: float) -> float:
    for word, value in (("R", R), ("E2_star", E2_star)):
        if not (np.isfinite(value) and value > 0):
            raise ValueError(f"{word} = {value}: must be > 0 and finite")
    return with_unit(1.0, entry.powers, E2_star, R)


def _si(name: str, value: Any, unit: str) -> Any:
    """The value, or list of values, as numbers in the SI `unit`. Texts such as "5 mm" and pint are converted.

    Raises ValueError for a text without a unit or with one of another kind, and for a spread, which would be lost.
    """
    is_numbers = type(value) is np.ndarray and value.dtype.kind in "iuf"
    value = value if is_numbers else plain(value)
    if xr.is_array(value):
        size = quantity(name, f"1 {value.attrs['units']}", unit).value if "units" in value.attrs else 1.0
        return value.drop_attrs(deep=False) * size
    if isinstance(value, (list, tuple)):
        return [_si(name, entry, unit) for entry in value]
    if not (isinstance(value, str) or has_unit(value)):
        return value
    number = quantity(name, value, unit)
    if number.spread:
        raise ValueError(f'{name} = "{value}": must have no spread here; study.solve takes spreads, with R and E2')
    return number.value


def _scales(R: Any, E2_star: Any) -> dict[str, float]:
    """R in m and E2_star in Pa, each from a number, a text or a quantity of pint."""
    scales = {}
    for name, value, unit in (("R", R, "m"), ("E2_star", E2_star, "Pa")):
        number = _si(name, value, unit)
        is_number = np.ndim(number) == 0 and np.asarray(number).dtype.kind in "iuf"
        scales[name] = float(number) if is_number else quantity(name, value, unit).value
    return scales


def physical_attributes(entry: Entry, attributes: dict) -> dict:
    """The attributes of a variable, from those it has without units, when its numbers are in SI units.

    entry : its row of the vocabulary
    """
    others = {key: text for key, text in attributes.items() if key != "scale"}
    words = entry.long_name if entry.symbol else attributes.get("long_name", entry.long_name)  # that of stacks differs
    return others | {"long_name": words, "units": entry.unit}


def to_physical(dataset: xr.Dataset, *, R: Any, E2_star: Any) -> xr.Dataset:
    """The dataset in SI units, which the attributes `units` name; `study.readable` gives µm, mN, MPa.

    Parameters
    ----------
    dataset : of dimensionless contacts
    R : radius of the punch: m, or a text such as "5 mm", or a quantity of pint
    E2_star : reduced modulus E2/(1 - ν2²) of the half-space, E1* on a rigid base: Pa, or "230 GPa"

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    ValueError : the dataset is physical already; R is not a length, or E2_star not a pressure

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=1e-5, micro="smooth", base="half_space")
    >>> to_physical(contact, R="10 mm", E2_star="230 GPa").P.item()
    230.0
    """
    scales = _scales(R, E2_star)
    if PHYSICAL_SCALE in dataset.attrs:
        raise ValueError(f"the dataset is in physical units already: {dataset.attrs[PHYSICAL_SCALE]}")
    rows = lexicon_in(dataset).rows
    for name, array in dataset.variables.items():  # contact.a.to_dataset() has lost the attribute of the dataset
        if name in rows and rows[name].powers != (0, 0) and "units" in array.attrs:
            raise ValueError(f"the dataset is in physical units already: {name} has units = {array.attrs['units']!r}")
    changed = {}
    for name, array in dataset.variables.items():
        if isinstance(name, str) and name in rows and rows[name].powers != (0, 0):
            attributes = physical_attributes(rows[name], array.attrs)
            fill = {key: value for key, value in array.encoding.items() if key == "_FillValue"}
            changed[name] = array.dims, array.data * _factor(rows[name], **scales), attributes, fill
    scale = f"R = {scales['R']!r} m, E2* = {scales['E2_star']!r} Pa"
    return dataset.assign(changed).assign_attrs({PHYSICAL_SCALE: scale})


def readable(dataset: xr.Dataset) -> xr.Dataset:
    """A dataset in SI units with each variable in the multiple that suits its largest number, for plots and tables.

    Coordinates change too: sel(h=2.0) selects a thickness of 2e-6 m, in the µm of its attribute `units`. A spread has
    the multiple of its quantity.

    Parameters
    ----------
    dataset : with physical units

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    ValueError : the dataset has no physical units, or comes from `study.fit`

    Examples
    --------
    >>> import study
    >>> contact = study.solve(R="10 mm", E2="210 GPa", P="10 N", micro="smooth", base="half_space")
    >>> readable(contact).a.attrs["units"]
    'µm'
    """
    if not xr.is_dataset(dataset):
        raise ValueError("readable takes the dataset, not an array of it: study.readable(contact).a")
    if "fit_status" in dataset:
        raise ValueError(
            "readable takes contacts: a dataset of study.fit stays in SI, and study.summary prints it in readable units"
        )
    if PHYSICAL_SCALE not in dataset.attrs:
        raise ValueError("the dataset is dimensionless: study.to_physical gives it units")
    changed = {}
    for name, variable in dataset.variables.items():
        owner = dataset.variables.get(str(name).removesuffix("_spread"), variable)
        unit = variable.attrs.get("units", "1")
        if unit not in READABLE or unit == "1" or variable.dtype.kind != "f":
            continue
        finite = np.abs(owner.values[np.isfinite(owner.values)])
        word, size = multiple(finite.max() if finite.size else np.inf, unit)
        changed[name] = xr.Variable(variable.dims, variable.data / size, variable.attrs | {"units": word})
    scale = "readable multiples of SI units, named by the attribute units"
    return dataset.assign(changed).assign_attrs({PHYSICAL_SCALE: scale})


def from_physical(*, R: Any, E2_star: Any, **parameters: Any) -> dict:
    """Dimensionless parameters for `study.solve` from physical ones, in the units that `to_physical` gives.

    Parameters
    ----------
    R : radius of the punch: m, or a text such as "5 mm", or a quantity of pint
    E2_star : reduced modulus E2* of the half-space, E1* on a rigid base: Pa, or "230 GPa"
    parameters : P in N; a, D, h, Ra in m; Nbar in 1/m²; or texts with a unit, or quantities of pint. The others are
        pure numbers or texts and pass unchanged

    Returns
    -------
    dict : the same names, with scalars, arrays or DataArrays as given

    Raises
    ------
    ValueError : no parameter has this name, or a unit is of another kind

    Examples
    --------
    >>> from_physical(R="10 mm", E2_star="230 GPa", h="20 um", bonding="bonded")
    {'h': 0.002, 'bonding': 'bonded'}
    """
    converted, scales, lexicon = {}, _scales(R, E2_star), default()
    for name, value in parameters.items():
        if name not in lexicon.parameters:
            raise ValueError(no_parameter(name, lexicon.parameters))
        if lexicon.rows[name].powers == (0, 0):
            converted[name] = value
        else:
            number = _si(name, value, lexicon.rows[name].unit)
            if np.asarray(number).dtype.kind not in "iuf":
                quantity(name, value, lexicon.rows[name].unit)  # raises: it is neither a number nor several
            array: Any = number if xr.is_array(number) or np.isscalar(number) else np.asarray(number)
            converted[name] = array / _factor(lexicon.rows[name], **scales)
    return converted

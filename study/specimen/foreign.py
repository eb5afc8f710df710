"""Values of other packages (numpy, pandas, polars, dask, pint, pint-xarray, astropy) become plain Python values.

Of these packages only numpy is imported here: a value is recognised by its attributes.
"""

from typing import Any

import numpy as np

_USUAL = {float, int, str}


def plain(value: Any) -> Any:
    """A value of another package as a plain number, text or list.

    An array becomes a list, and an array without dimensions a single value. A quantity of astropy or unyt becomes the
    text of a number with its unit. A DataArray of pint gets the attribute `units`. Everything else is returned as it
    is.
    """
    if type(value) in _USUAL:
        return value
    if type(value) in (list, tuple):
        return value if _USUAL.issuperset(map(type, value)) else type(value)(map(plain, value))
    if hasattr(value, "dims"):  # of xarray
        return _plain_array(value)
    if hasattr(value, "magnitude") and hasattr(value, "units"):  # of pint
        return list(value) if np.ndim(value.magnitude) == 1 else value
    if getattr(getattr(value, "dtype", None), "kind", "") in ("m", "M"):  # times, whose `tolist` may be numbers
        return np.asarray(value).astype(str).tolist()
    unit = getattr(value, "unit", getattr(value, "units", None))
    if unit is not None and hasattr(value, "value") and hasattr(value, "to"):  # of astropy or unyt
        return _with_unit(np.asarray(value.value).tolist(), str(unit))  # their own `tolist` would lose the unit
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "__array__") and hasattr(value, "shape"):  # of polars or dask
        return np.asarray(value).tolist()
    return value


def _plain_array(array: Any) -> Any:
    """A DataArray with plain numbers. Its units in pint, and those of its coordinates, become the attribute `units`.

    A Variable of xarray becomes a DataArray, and a Dataset is returned as it is.
    """
    if not hasattr(array, "shape"):
        return array
    if not hasattr(array, "coords"):
        import xarray as xr  # imported already: `array` is a Variable of it

        array = xr.DataArray(array)
    for name, axis in [(name, axis) for name, axis in array.coords.items() if hasattr(axis.data, "magnitude")]:
        values = axis.dims, axis.data.magnitude, axis.attrs | {"units": _name_of(axis.data.units)}
        array = array.drop_vars(name).assign_coords({name: values})
    if hasattr(array.data, "magnitude"):
        array = array.copy(data=array.data.magnitude).assign_attrs(units=array.data.units)
    if not isinstance(array.attrs.get("units", ""), str):
        array = array.assign_attrs(units=_name_of(array.attrs["units"]))
    return array.astype(str) if array.dtype.kind in "mM" else array


def _name_of(units: Any) -> str:
    """The name of units of pint, whatever default format their registry has."""
    try:
        return format(units, "D")
    except (TypeError, ValueError):
        return str(units)


def _with_unit(number: Any, unit: str) -> Any:
    """The text of a number with its unit, or a list of such texts; without a unit the number as it is."""
    if isinstance(number, list):
        return [_with_unit(each, unit) for each in number]
    return f"{number!r} {unit}" if unit not in ("", "dimensionless") else number

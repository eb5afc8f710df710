"""Values as other packages hand them over: numpy, pandas, polars, dask, pint, pint-xarray, astropy, become plain ones.

None of these packages but numpy is imported here: what a value is, is told by what it has.
"""

from typing import Any

import numpy as np

_USUAL = {float, int, str}


def plain(given: Any) -> Any:
    """What several packages make of numbers, texts and lists as these; a DataArray of pint with the attribute `units`.

    An array becomes a list, one without dimensions a single value, and a quantity of astropy or unyt the text of a
    number with a unit. All else is returned as it is.
    """
    if type(given) in _USUAL:
        return given
    if type(given) in (list, tuple):
        return given if _USUAL.issuperset(map(type, given)) else type(given)(map(plain, given))
    if hasattr(given, "dims"):  # of xarray
        return _plain_array(given)
    if hasattr(given, "magnitude") and hasattr(given, "units"):  # of pint
        return list(given) if np.ndim(given.magnitude) == 1 else given
    if getattr(getattr(given, "dtype", None), "kind", "") in ("m", "M"):  # times, whose `tolist` may be numbers
        return np.asarray(given).astype(str).tolist()
    unit = getattr(given, "unit", getattr(given, "units", None))
    if unit is not None and hasattr(given, "value") and hasattr(given, "to"):  # of astropy or unyt: with no `tolist`
        return _with_unit(np.asarray(given.value).tolist(), str(unit))  # the unit would be lost
    if hasattr(given, "tolist"):
        return given.tolist()
    if hasattr(given, "__array__") and hasattr(given, "shape"):  # of polars or dask
        return np.asarray(given).tolist()
    return given


def _plain_array(array: Any) -> Any:
    """A DataArray with plain numbers; quantities of pint, of its coordinates too, have the attribute `units`.

    A Variable of xarray becomes a DataArray, and a Dataset is returned as it is.
    """
    if not hasattr(array, "shape"):
        return array
    if not hasattr(array, "coords"):
        import xarray as xr  # has been imported: somebody has made a Variable with it

        array = xr.DataArray(array)
    for name, own in [(name, own) for name, own in array.coords.items() if hasattr(own.data, "magnitude")]:
        values = own.dims, own.data.magnitude, own.attrs | {"units": _name_of(own.data.units)}
        array = array.drop_vars(name).assign_coords({name: values})
    if hasattr(array.data, "magnitude"):
        array = array.copy(data=array.data.magnitude).assign_attrs(units=array.data.units)
    if not isinstance(array.attrs.get("units", ""), str):
        array = array.assign_attrs(units=_name_of(array.attrs["units"]))
    return array.astype(str) if array.dtype.kind in "mM" else array


def _name_of(units: Any) -> str:
    """The name of units of pint, whatever format their registry writes by itself."""
    try:
        return format(units, "D")
    except (TypeError, ValueError):
        return str(units)


def _with_unit(given: Any, unit: str) -> Any:
    """A number, or each of a list, as the text of this number with a unit; without a unit as it is."""
    if isinstance(given, list):
        return [_with_unit(one, unit) for one in given]
    return f"{given!r} {unit}" if unit not in ("", "dimensionless") else given

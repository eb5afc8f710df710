"""Coordinates that DataArrays bring with them, such as who measured a load, go on into the results."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from .inputs.vocabulary import BODIES, ROWS
from .specimen.foreign import plain


def with_coordinates(dataset: xr.Dataset, parameters: dict) -> tuple[xr.Dataset, list[str]]:
    """The results with the coordinates of the DataArrays among the parameters, and what is said of those left out.

    What the results call so themselves is left out, and so is a coordinate in which two parameters differ. The levels
    of a MultiIndex become coordinates along its dimension, which netCDF can hold; `set_xindex` makes an index of them.
    """
    arrays = {name: plain(given) for name, given in parameters.items() if hasattr(given, "dims")}
    arrays = {name: array for name, array in arrays.items() if len(getattr(array, "coords", ()))}
    kept, owners, said = {}, {}, {}
    stacked = {dim for array in arrays.values() for dim, index in array.indexes.items() if _is_stacked(dim, index)}
    for owner, name, variable in _candidates(arrays, stacked):
        if _is_ours(name) or name in dataset.variables:
            if "long_name" not in variable.attrs:  # that of earlier results says nothing of these
                said[name] = f"{name} of {owner}: the results have something else of this name, rename it"
        elif name not in kept:
            kept[name], owners[name] = variable, owner
        elif not kept[name].equals(variable):
            said[name] = f"{name}: {owners[name]} and {owner} have other values of it"
    kept = {name: variable for name, variable in kept.items() if name not in said}
    found = dataset.drop_vars(stacked, errors="ignore") if stacked else dataset
    found = found.assign_coords(kept) if kept else found
    for name in kept:
        found.variables[name].encoding["_FillValue"] = None  # CF wants none of coordinates
    for array in arrays.values():
        for dim in {*array.dims} & {*array.coords} - stacked - {*ROWS, *BODIES}:
            found[dim].attrs |= array[dim].attrs
    return found, [f"a coordinate is left out, {text}" for text in said.values()]


def _candidates(arrays: dict[str, xr.DataArray], stacked: set) -> Iterator[tuple[str, str, xr.Variable]]:
    """(parameter, name, values) of each coordinate that is not that of a dimension; without how a file stored it."""
    for owner, array in arrays.items():
        for name, own in array.coords.items():
            if name not in array.dims and name not in stacked:
                data = own.data if isinstance(own.data, np.ndarray) else np.asarray(own.values)
                yield owner, str(name), xr.Variable(own.dims, data, own.attrs)


def _is_stacked(dim: str, index) -> bool:
    """Whether the index along a dimension is a MultiIndex, and not one of its levels."""
    return hasattr(index, "levels") and index.name == dim


def _is_ours(name: str) -> bool:
    """Whether it is the name of a parameter, a result, a body, or a spread of one of these."""
    return name.removesuffix("_spread") in {*ROWS, *BODIES}

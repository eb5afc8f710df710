"""The results take over the coordinates of DataArrays that were inputs, such as who measured a load."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..arrays import xarray_later as xr
from ..inputs.lexicon import lexicon_in
from ..inputs.vocabulary import BODIES
from ..specimen.foreign import plain


def with_coordinates(dataset: xr.Dataset, parameters: dict) -> tuple[xr.Dataset, list[str]]:
    """The results with the coordinates of the DataArrays among the parameters, and messages about omitted coordinates.

    A coordinate is left out if the results have its name, or if two parameters differ in it. The levels of a MultiIndex
    become coordinates along its dimension, which netCDF can hold; `set_xindex` makes an index of them.
    """
    arrays = {name: plain(value) for name, value in parameters.items() if hasattr(value, "dims")}
    arrays = {name: array for name, array in arrays.items() if len(getattr(array, "coords", ()))}
    coordinates, owners, reasons, ours = {}, {}, {}, {*lexicon_in(dataset).all_rows, *BODIES}
    stacked = {dim for array in arrays.values() for dim, index in array.indexes.items() if _is_stacked(dim, index)}
    for owner, name, variable in _candidates(arrays, stacked):
        if name.removesuffix("_spread") in ours or name in dataset.variables:
            if "long_name" not in variable.attrs:  # with one it comes from earlier results
                reasons[name] = f"{name} of {owner}: the results have something else of this name, rename it"
        elif name not in coordinates:
            coordinates[name], owners[name] = variable, owner
        elif not coordinates[name].equals(variable):
            reasons[name] = f"{name}: {owners[name]} and {owner} have other values of it"
    coordinates = {name: variable for name, variable in coordinates.items() if name not in reasons}
    dataset = dataset.drop_vars(stacked, errors="ignore") if stacked else dataset
    dataset = dataset.assign_coords(coordinates) if coordinates else dataset
    for name in coordinates:
        dataset.variables[name].encoding["_FillValue"] = None  # CF forbids it for coordinates
    for array in arrays.values():
        for dim in {*array.dims} & {*array.coords} - stacked - ours:
            dataset[dim].attrs |= array[dim].attrs
    return dataset, [f"a coordinate is left out, {text}" for text in reasons.values()]


def _candidates(arrays: dict[str, xr.DataArray], stacked: set) -> Iterator[tuple[str, str, xr.Variable]]:
    """(parameter, name, values) of each coordinate except those of dimensions; the values have no encoding."""
    for owner, array in arrays.items():
        for name, coordinate in array.coords.items():
            if name not in array.dims and name not in stacked:
                data = coordinate.data if isinstance(coordinate.data, np.ndarray) else np.asarray(coordinate.values)
                yield owner, str(name), xr.Variable(coordinate.dims, data, coordinate.attrs)


def _is_stacked(dim: str, index) -> bool:
    """Whether the index along a dimension is a MultiIndex, and not one of its levels."""
    return hasattr(index, "levels") and index.name == dim

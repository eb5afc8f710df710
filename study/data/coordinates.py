"""Coordinates of results: selection by texts with units, `sel(h="3 um")`, along a dimension of SI numbers; and those of
DataArrays that are inputs, such as who measured a load."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from xarray.indexes import PandasIndex

from ..inputs.lexicon import default, lexicon_in
from ..inputs.scene.scene import si
from ..inputs.vocabulary import BODIES
from ..specimen.foreign import plain
from ..specimen.quantities import has_unit


class _AsPandasIndex(type):
    """The class of UnitIndex, which counts as equal to PandasIndex.

    xarray aligns two arrays only if their indexes have equal classes. It must align results when they are reindexed, or
    when values that were measured at some of their loads are subtracted from them.
    """

    def __eq__(cls, other: Any) -> bool:
        return other is cls or other is PandasIndex

    def __hash__(cls) -> int:
        return hash(PandasIndex)


class UnitIndex(PandasIndex, metaclass=_AsPandasIndex):
    """An index of SI numbers in which `sel(h="3 um")`, and slices and lists of such texts, find 3e-6."""

    def sel(self, labels: dict, method=None, tolerance=None):
        """`sel` of other indexes of xarray. Raises ValueError for a text without a unit or with one of another kind."""
        (name, label), rows = next(iter(labels.items())), default().all_rows

        def number(value: Any) -> Any:
            text = isinstance(value, str) or has_unit(value)
            return si(name, value, lexicon=default()).value if text and name in rows else value

        if isinstance(label, slice):
            label = slice(number(label.start), number(label.stop), label.step)
        elif getattr(label, "dtype", None) is not None and label.dtype.kind in "OTU":  # an array of texts
            numbers = np.reshape([number(value) for value in np.asarray(label).ravel().tolist()], label.shape)
            label = label.copy(data=numbers) if isinstance(label, (xr.DataArray, xr.Variable)) else numbers
        else:
            label = [number(value) for value in label] if isinstance(label, (list, tuple)) else number(label)
        return super().sel({name: label}, method=method, tolerance=number(tolerance))

    def reindex_like(self, other, method=None, tolerance=None) -> dict:
        """`reindex_like` of other indexes of xarray. Raises ValueError for texts, which would become the coordinate."""
        texts = [label for label in other.index if isinstance(label, str)] if other.index.dtype.kind in "OTU" else ()
        if texts:
            raise ValueError(f'{other.dim}: give numbers in the SI unit here; texts such as "{texts[0]}" are for sel')
        return super().reindex_like(other, method=method, tolerance=tolerance)


def searchable(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with a UnitIndex along each dimension whose coordinate has a unit."""
    rows = lexicon_in(dataset).all_rows
    for name, variable in dataset.variables.items():
        unit = variable.attrs.get("units")
        if variable.dims == (name,) and name in rows and isinstance(unit, str) and unit == rows[name].unit != "1":
            dataset = dataset.drop_indexes(name, errors="ignore").set_xindex(name, UnitIndex)
    return dataset


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

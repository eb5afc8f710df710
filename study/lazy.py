"""A dataset of dask arrays: dask solves a chunk of the grid when its numbers are needed."""

from dataclasses import replace
from math import prod
from typing import Any, NamedTuple
from uuid import uuid4

import dask.array
import numpy as np
import xarray as xr
from dask.array.core import normalize_chunks

from .data.dataset import labelled, not_run, parts
from .data.si import dataset_of
from .inputs.definition import Definition, StudyError
from .inputs.grid import cut_out
from .terminal import shown
from .work.cases import compute, parcel
from .work.engine import blocks_of_grid


class Chunks(NamedTuple):
    """The argument of every task: the grid and its chunks.

    definition : of the whole grid
    ends : dimension of the grid -> where its chunks end, with 0 before them
    """

    definition: Definition
    ends: dict[str, np.ndarray]

    def within(self, number: int) -> Definition:
        """The definition of the cases in the chunk with this number."""
        place = np.unravel_index(number, [len(ends) - 1 for ends in self.ends.values()])
        window = {}
        for (dim, ends), at in zip(self.ends.items(), place, strict=True):
            window[dim] = slice(int(ends[at]), int(ends[at + 1]))
        scene = self.definition.scene and self.definition.scene.within(window)
        return replace(self.definition, grid=cut_out(self.definition.grid, window), scene=scene)


def lazily(definition: Definition, chunks: Any, command: str) -> xr.Dataset:
    """The dataset of a grid whose results are dask arrays. The solver has one task for each chunk.

    chunks : dimension of the results -> the length of its chunks, or a tuple of all lengths; -1, or no entry, makes one
        chunk of the dimension; "auto" makes chunks with as many cases as a block of a study. A single value holds for
        every dimension

    Raises StudyError for chunks that do not fit the grid.
    """
    from roughcoat.elsewhere import Packed  # imported here, since no other call needs it

    dims = definition.in_results({dim: dim for dim in definition.grid.sizes})
    lengths = _lengths(chunks, definition)
    ends = {dim: np.cumsum([0, *along]) for dim, along in zip(dims.values(), lengths, strict=True)}
    chunks_of_grid = Chunks(definition, ends)
    shape = tuple(map(len, lengths))
    numbers = dask.array.from_array(np.arange(prod(shape)).reshape(shape), chunks=1)
    # The grid is a separate item of dask, so that it goes to a worker once and not with every chunk. It is an array of
    # one element, since with query planning `map_blocks` loses a Delayed among its arguments (dask 2026.8).
    call = dask.array.from_array(_element(Packed(_solved, chunks_of_grid)), chunks=(), name=f"contacts-{uuid4().hex}")
    empty = np.empty((0,) * len(shape), dtype=object)
    solved = dask.array.map_blocks(_called_with, call, numbers, meta=empty, name=f"solve-{uuid4().hex}")
    # one unsolved case has the names, types, dimensions and attributes of all results
    first = chunks_of_grid._replace(ends={dim: np.array([0, 1]) for dim in ends}).within(0)
    first_case = _dataset(first, not_run(first, first.grid.size), command)
    variables = {}
    for name, array in first_case.data_vars.items():
        behind = [first_case.sizes[dim] for dim in array.dims if dim not in dims]
        more = {"new_axis": len(shape)} if behind else {}
        lengths_with_x = (*lengths, *((size,) for size in behind))
        more["meta"] = np.empty((0,) * array.ndim, array.dtype)
        values = solved.map_blocks(Packed(_values, name), chunks=lengths_with_x, name=f"{name}-{uuid4().hex}", **more)
        variables[name] = xr.Variable(array.dims, values, array.attrs)
    return dataset_of(definition, labelled(definition, {}, command).settings_as_attributes()).assign(variables)


def _lengths(chunks: Any, definition: Definition) -> tuple[tuple[int, ...], ...]:
    """The lengths of the chunks along each dimension of the results. Raises StudyError."""
    sizes = definition.in_results(definition.grid.sizes)
    if not isinstance(chunks, dict):
        if not _fits(chunks, 0) or isinstance(chunks, tuple):
            allowed = 'must be a dictionary such as {"P": 10}, one length for every dimension, or "auto"'
            raise StudyError([f"chunks = {shown(chunks)}: {allowed}"])
        chunks = dict.fromkeys(sizes, chunks)
    wrong, dims = [], ", ".join(sizes) or "the results have none"
    for name, length in chunks.items():
        if name not in sizes:
            wrong.append(f"chunks: {shown(name)} is not a dimension of the grid ({dims})")
        elif not _fits(length, sizes[name]):
            several = f"a tuple of lengths that together are {sizes[name]}"
            what = f'a whole number, 1 or more, -1 for all, or {several}, or "auto"'
            wrong.append(f"chunks: {name} = {shown(length)}: must be {what}")
    if wrong:
        raise StudyError(wrong)
    # "auto" makes chunks of about a block's number of cases; each case counts as one number
    of_block = {"limit": 8 * definition.block, "dtype": float}
    return normalize_chunks(tuple(chunks.get(name, -1) for name in sizes), tuple(sizes.values()), **of_block)


def _fits(length: object, size: int) -> bool:
    if isinstance(length, str):
        return length == "auto"
    parts = length if isinstance(length, tuple) else (length,)
    whole = all(type(part) is int and part > 0 for part in parts)
    return length == -1 or (whole and (parts is not length or sum(parts) == size))


def _element(value: object) -> np.ndarray:
    """An array without dimensions that has the value as its only element."""
    array = np.empty((), dtype=object)
    array[()] = value
    return array


def _called_with(call: np.ndarray, number: np.ndarray) -> np.ndarray:
    return call.item()(number)


def _solved(chunks_of_grid: Chunks, number: np.ndarray) -> np.ndarray:
    """The results of a chunk, name -> values, as the only element of an array with the shape of `number`."""
    definition = chunks_of_grid.within(number.item())
    blocks = [compute(parcel(definition, index)) for index in blocks_of_grid(definition)]
    arrays = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    results = np.empty(number.shape, dtype=object)
    results[...] = {name: array.values for name, array in _dataset(definition, arrays, "").data_vars.items()}
    return results


def _dataset(definition: Definition, arrays: dict[str, np.ndarray], command: str) -> xr.Dataset:
    return dataset_of(definition, parts(definition, arrays, command))


def _values(name: str, results: np.ndarray) -> np.ndarray:
    """The values of one result of a chunk."""
    return results.item()[name]

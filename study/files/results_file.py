"""Results files as datasets: written whole, opened."""

import os
from itertools import count
from pathlib import Path

import numpy as np
import xarray as xr
from xarray.conventions import encode_dataset_coordinates

from ..data.dataset import without_fill_values
from ..physical.index import searchable
from .atomic import replacing, target
from .checksums import ATTRIBUTE, NOT_SUMMED, Rows, head, text
from .examine import examine
from .netcdf import File, read, read_lazily
from .seal import seal


def encoding(array: xr.DataArray) -> dict:
    """How a variable is stored, in the words of netCDF4.

    All have checksums but single numbers, which netCDF stores without; the attribute `checksums` covers those.
    Profiles are nearly all of a file. Compressing them takes longer than the rest of the writing and gains little.
    """
    data, text = array.name not in array.coords, array.dtype.kind in "UO"
    options = {"fill_value": np.nan if data and array.dtype.kind == "f" else None}
    if not array.ndim and not text:
        return options
    options["fletcher32"] = True
    if not data or text or "x" in array.dims:
        return options
    return options | {"zlib": True, "complevel": 1, "shuffle": True}


def create(file: File, part: xr.Dataset, whole: xr.Dataset, chunk: dict[str, int]) -> None:
    """Dimensions, attributes and variables as in `part`, but of the sizes and with the coordinates of the `whole`.

    chunk : dimension -> its length in a chunk, where that is not all of it
    """
    variables, attributes = encode_dataset_coordinates(part)
    sizes = dict(whole.sizes)
    file.define(sizes, attributes)
    for name, variable in variables.items():
        options, values, more = encoding(part[name]), stored(whole[name]) if name in whole else None, {}
        dims, kind = variable.dims, variable.dtype
        if kind.kind in "UO":
            length = values.shape[-1]
            dims, kind, more = (*dims, f"string{length}"), "S1", {"_Encoding": "utf-8"}
            file.define({dims[-1]: length}, {})
        elif name in part.data_vars and dims:
            options["chunksizes"] = [chunk.get(dim, sizes[dim]) for dim in dims]
        file.add(name, kind, dims, variable.attrs | more, options)
        if name in part.coords:
            file.write(name, values)


def stored(array: xr.DataArray) -> np.ndarray:
    """The values as the file has them: texts as characters, along one more dimension.

    As netCDF's own strings they would have no checksum, and HDF5 2.2 ends the interpreter when a file with such strings
    is opened while it is open, as lazily opened results are.
    """
    if array.dtype.kind not in "UO":
        return array.values
    words = np.char.encode(array.values.astype(str), "utf-8")
    return words.astype(f"S{max(1, words.itemsize)}")[..., np.newaxis].view("S1")


def add_checksums(file: File, rows: Rows, cases: dict[str, str]) -> None:
    """The attribute, when all else is in the file; `rows` of the variables over the cases, and the line `=cases`."""
    whole = [name for name in file.variables if name not in rows.digests]
    attributes = [name for name in file.attributes() if name not in NOT_SUMMED]
    found = head(file, whole, list(rows.digests), attributes) | rows.lines() | cases
    file.define({}, {ATTRIBUTE: text(found)})


def write(dataset: xr.Dataset, path: Path) -> None:
    """Write a small dataset: `path` either is complete or does not exist."""
    with replacing(path) as temporary:
        with File(temporary, "w", path) as file:
            create(file, dataset, dataset, {})
            for name, array in dataset.data_vars.items():
                file.write(name, stored(array))
            add_checksums(file, Rows(0), {})
        seal(temporary)


def set_aside(path: Path) -> Path:
    """Give a damaged file that is about to be replaced a second name, NAME.nc.damaged, which keeps it; returns that.

    Of a symbolic link it is what the link leads to that is kept, beside it, for that is what will be replaced.
    """
    path = target(path)
    names = (f"{path.name}.damaged{f'-{number}' * (number > 1)}" for number in count(1))
    kept = next(path.with_name(name) for name in names if not path.with_name(name).exists())
    try:
        os.link(path, kept)
    except OSError:  # no hard links on this file system
        os.rename(path, kept)
    return kept


def open_results(path) -> xr.Dataset:
    """A results file, read into memory and closed, when nothing in it is damaged.

    Any thread may open, and read, while others run studies. A file without checksums, of an earlier version, is read
    unverified.

    Raises
    ------
    FileNotFoundError : there is none
    StudyError : it is damaged, or cannot be read; also an OSError
    """
    found = examine(path)
    if found.kind != "foreign":  # another netCDF file is read as it is
        found.raise_if_bad()
    return _shown(read(Path(path)))


def open_lazily(path) -> xr.Dataset:
    """A results file as dask arrays in its chunks: numbers are read when they are asked for, in any thread.

    Attributes and coordinates are verified, and each chunk when it is read (StudyError, an OSError).
    """
    examine(path, ()).raise_if_bad()
    return _shown(read_lazily(Path(path)))


def _shown(dataset: xr.Dataset) -> xr.Dataset:
    """Without the checksums: they are those of the file, not of what somebody makes of the dataset and writes."""
    dataset.attrs.pop(ATTRIBUTE, None)
    return searchable(without_fill_values(dataset))

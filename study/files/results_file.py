"""Results files as datasets: made, written and opened."""

import os
from itertools import count
from pathlib import Path

import numpy as np
import xarray as xr
from xarray.conventions import encode_dataset_coordinates

from ..data.dataset import without_fill_values
from ..physical.index import searchable
from ..spec.laws import recall
from .atomic import replacing, target
from .checksums import ATTRIBUTE, NOT_SUMMED, CaseDigests, as_text, lines_of_head
from .examine import examine
from .netcdf import File, read, read_lazily
from .seal import seal


def encoding(array: xr.DataArray) -> dict:
    """How a variable is stored: options of netCDF4's createVariable.

    All but single numbers have netCDF's own checksums; the attribute `checksums` covers single numbers as well.
    Profiles, which are nearly all of a file, are not compressed: that takes longer than all other writing and gains
    little.
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
    """Define all variables of a results file, and write its coordinates.

    part : a dataset of some cases, which has all variables; whole : one of all cases, which need not have results
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

    NetCDF's own strings would have no checksum. And HDF5 2.2 crashes the interpreter when a file that has them is
    opened a second time while it is open, as lazily opened results are.
    """
    if array.dtype.kind not in "UO":
        return array.values
    words = np.char.encode(array.values.astype(str), "utf-8")
    return words.astype(f"S{max(1, words.itemsize)}")[..., np.newaxis].view("S1")


def add_checksums(file: File, rows: CaseDigests, cases: dict[str, str]) -> None:
    """Write the attribute `checksums`, the last of all.

    rows : digests of the variables over the cases; cases : the line =cases
    """
    whole = [name for name in file.variables if name not in rows.digests]
    attributes = [name for name in file.attributes() if name not in NOT_SUMMED]
    found = lines_of_head(file, whole, list(rows.digests), attributes) | rows.lines() | cases
    file.define({}, {ATTRIBUTE: as_text(found)})


def write(dataset: xr.Dataset, path: Path) -> None:
    """Write a small dataset. The file is complete or does not exist."""
    with replacing(path) as temporary:
        with File(temporary, "w", path) as file:
            create(file, dataset, dataset, {})
            for name, array in dataset.data_vars.items():
                file.write(name, stored(array))
            add_checksums(file, CaseDigests(0), {})
        seal(temporary)


def set_aside(path: Path) -> Path:
    """Keep a damaged file, which is about to be replaced, under the name NAME.nc.damaged; returns its path.

    Behind a symbolic link it is the file to which the link leads, since that will be replaced.
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

    Raises FileNotFoundError: there is none; StudyError: it is damaged, or cannot be read; also an OSError.
    """
    found = examine(path)
    if found.kind != "foreign":  # a netCDF file of another program is read as it is
        found.raise_if_bad()
    try:
        return _for_users(read(Path(path)))
    except OSError:
        found.raise_if_bad()
        raise


def open_lazily(path) -> xr.Dataset:
    """A results file as dask arrays in its chunks: numbers are read when they are asked for, in any thread.

    Attributes and coordinates are verified, and each chunk when it is read (StudyError, an OSError).
    """
    examine(path, ()).raise_if_bad()
    return _for_users(read_lazily(Path(path)))


def _for_users(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset without the checksums: they would be wrong in a file that a user makes of it. Its laws are known."""
    dataset.attrs.pop(ATTRIBUTE, None)
    recall(dataset.attrs.get("micro_laws", ""))
    return searchable(without_fill_values(dataset))

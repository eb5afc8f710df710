"""Results files as datasets: made, written and opened."""

import hashlib
import os
from functools import partial
from itertools import count
from pathlib import Path

import numpy as np
import xarray as xr
from xarray.conventions import encode_dataset_coordinates

from ..data.dataset import without_fill_values
from ..data.index import searchable
from ..data.provenance import OF_THE_RUN
from ..inputs.definition import StudyError
from ..inputs.laws import recall
from ..terminal import on_one_line
from .access import Unusable
from .atomic import replacing
from .checksums import ATTRIBUTE, NOT_SUMMED, CaseDigests, as_text, lines_of_head, parsed
from .examine import Condition, examine, stamp
from .netcdf import File, check_regular, read, read_lazily, read_of_others
from .seal import seal

#: Bytes of all variables in memory; a larger file is opened lazily. Files are packed by up to a hundred times, so their
#: own size says little. Reading and verifying so much takes a second or two.
LAZY = 200_000_000


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


def write(dataset: xr.Dataset, path: Path, there: Condition | None = None) -> None:
    """Write a small dataset. The file is complete or does not exist.

    there : the file at `path` as it was when the dataset was begun, see `put`; None: whatever is there is replaced
    """
    place = partial(put, there, dataset.attrs["study_digest"]) if there else None
    with replacing(path, place=place) as temporary:
        with File(temporary, "w", path) as file:
            create(file, dataset, dataset, {})
            for name, array in dataset.data_vars.items():
                file.write(name, stored(array))
            add_checksums(file, CaseDigests(0), {})
        seal(temporary)


def put(there: Condition, digest: str, temporary: Path, path: Path) -> None:
    """Give a complete file its place, where `there` was found when its numbers were begun. A damaged file is set aside.

    A file that has appeared or changed meanwhile stays, unless it has the results of the same study, of this `digest`.
    Then StudyError says under which other name the complete file is.
    """
    now = stamp(path)
    if now and not (there.seen and now[:3] == there.seen[:3]) and not _is_of(path, digest):
        raise _kept(temporary, path, there.path)
    if now and there.kind == "damaged":
        set_aside(path)
    if not now:
        try:
            os.link(temporary, path)  # unlike a rename it replaces nothing that appears just now
        except FileExistsError:
            if not _is_of(path, digest):
                raise _kept(temporary, path, there.path) from None
        except OSError:
            pass  # no hard links on this file system
        else:
            temporary.unlink()
            return
    os.replace(temporary, path)


def _is_of(path: Path, digest: str) -> bool:
    found = examine(path, ())
    return found.good and found.digest == digest


def _kept(temporary: Path, path: Path, called: Path) -> StudyError:
    """The error to raise when the file at `path` must stay, after the complete file has got another name beside it."""
    kept = _named(temporary, path, "computed")
    what = f"{called}: has appeared or changed while its results were computed"
    return StudyError([f"{what}, and stays; they are in {kept}: move one of the two away"], code=1)


def set_aside(path: Path) -> Path:
    """Keep a damaged file, which is about to be replaced, under the name NAME.nc.damaged; returns its path."""
    return _named(path, path, "damaged")


def _named(file: Path, path: Path, word: str) -> Path:
    """Give a file the name of `path` and a word, such as NAME.nc.damaged-2; returns it. It replaces nothing."""
    names = (f"{path.name}.{word}{f'-{number}' * (number > 1)}" for number in count(1))
    while True:
        kept = path.with_name(next(names))
        if os.path.lexists(kept):
            continue
        try:
            os.link(file, kept)
        except FileExistsError:  # just now
            continue
        except OSError:  # no hard links on this file system
            os.rename(file, kept)
        return kept


def numbers_digest(path: Path) -> str:
    """sha256 of what a results file holds, but for OF_THE_RUN: of its checksums, of all its bytes if it has none."""
    check_regular(path)
    try:
        with File(path) as file:
            text = str(file.attribute(ATTRIBUTE)) if ATTRIBUTE in file.attributes() else ""
    except Unusable:
        text = ""
    if not text:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    left_out = ("=checksums", *(f"@{name}" for name in OF_THE_RUN))
    lines = [f"{name} {digits}\n" for name, digits in parsed(text).items() if name not in left_out]
    return hashlib.sha256("".join(sorted(lines)).encode()).hexdigest()


def open_results(path: str | os.PathLike) -> xr.Dataset:
    """A results file, read into memory and closed, when nothing in it is damaged. A large one is opened lazily.

    Any thread may open, and read, while others run studies. A file without checksums, of an earlier version, is read
    unverified. A netCDF file of another program is read as it is.

    Parameters
    ----------
    path : of the file, such as "results/mine.nc"

    Returns
    -------
    xarray.Dataset : as `study.solve` gives it

    Raises
    ------
    FileNotFoundError : there is none
    StudyError : it is damaged, or cannot be read; also an OSError
    """
    path = Path(os.path.expanduser(path))
    found = examine(path, most=LAZY)
    large = found.unpacked > LAZY
    if found.kind != "foreign":
        found.raise_if_bad()
        return open_lazily(path) if large else _for_users(read(path))
    try:
        return _for_users(read_of_others(path) if large else read(path))
    except OSError:
        found.raise_if_bad()
        raise
    except Exception as error:  # of xarray, which takes attributes of variables for units of time and so on
        reason = f"{found.reason}, which xarray cannot read: {on_one_line(str(error), 200)}"
        raise Unusable(path, "foreign", reason) from error


def open_lazily(path) -> xr.Dataset:
    """A results file as dask arrays in its chunks: numbers are read when they are asked for, in any thread.

    Attributes and coordinates are verified, and each chunk when it is read (StudyError, an OSError).
    """
    examine(path, ()).raise_if_bad()
    return _for_users(read_lazily(Path(path)))


def _for_users(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset without the checksums: they would be wrong in a file that a user makes of it. Its laws are known."""
    dataset.attrs.pop(ATTRIBUTE, None)
    laws = dataset.attrs.get("micro_laws", "")
    recall(laws if isinstance(laws, str) else "")
    return searchable(without_fill_values(dataset))

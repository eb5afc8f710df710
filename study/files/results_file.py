"""Results files as datasets: creation, writing and opening. They are exports: no case is read back from them."""

import hashlib
import json
import os
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr
from xarray.conventions import encode_dataset_coordinates

from ..data.coordinates import searchable
from ..data.dataset import without_fill_values
from ..inputs.definition import StudyError
from ..inputs.lexicon import KNOWN, lexicon_in
from ..terminal import on_one_line
from .access import Unusable
from .atomic import replacing
from .examine import ATTRIBUTE, FORMER, Condition, Sums, examine, stamp
from .netcdf import File, check_regular, read, read_lazily, read_of_others
from .parts_folder import open_parts
from .seal import seal

#: Bytes of all variables in memory above which a file is opened lazily. Files are compressed up to a hundred times, so
#: their size on disk says little. Reading and verifying this much takes a second or two.
LAZY = 200_000_000


def encoding(array: xr.DataArray) -> dict:
    """Options of netCDF4's createVariable for a variable.

    Every variable except single numbers has the checksums of netCDF; the digest of the file covers single numbers too.
    Profiles, which make up nearly all of a file, are not compressed: compression would take longer than all other
    writing and gain little.
    """
    data, text = array.name not in array.coords, array.dtype.kind in "UO"
    options = {"fill_value": np.nan if data and array.dtype.kind == "f" else None}
    if not array.ndim and not text:
        return options
    options["fletcher32"] = True
    if not data or text or "x" in array.dims:
        return options
    return options | {"zlib": True, "complevel": 1, "shuffle": True}


def create(file: File, part: xr.Dataset, whole: xr.Dataset, chunk: dict[str, int]) -> Sums:
    """Define all variables of a results file, and write its coordinates; returns their sums.

    part : a dataset of some cases, which has all variables
    whole : a dataset of all cases, which need not have results
    chunk : dimension -> length of a chunk, where a chunk does not have all of it
    """
    variables, attributes = encode_dataset_coordinates(part)
    sizes, sums = dict(whole.sizes), Sums()
    file.define(sizes, attributes)
    for name, variable in variables.items():
        options, values, more = encoding(part[name]), stored(whole[name]) if name in whole else None, {}
        dims, kind = variable.dims, variable.dtype
        if kind.kind in "UO":
            length = values.shape[-1]
            dims, kind, more = (*dims, f"string{length}"), "S1", {"_Encoding": "utf-8"}
            file.define({dims[-1]: length}, {})
        elif kind.kind == "b":  # the way in which xarray writes true and false
            kind, more = np.dtype(np.int8), {"dtype": "bool"}
        if name in part.data_vars and dims and kind != "S1":
            options["chunksizes"] = [chunk.get(dim, sizes[dim]) for dim in dims]
        file.add(name, kind, dims, variable.attrs | more, options)
        if name in part.coords:
            file.write(name, values)
            sums.add(name, values)
    return sums


def stored(array: xr.DataArray) -> np.ndarray:
    """The values as the file has them: texts as characters along one more dimension, true and false as 1 and 0.

    The strings of netCDF would have no checksum. Besides, HDF5 2.2 crashes the interpreter when a file with strings is
    opened while it is still open, as lazily opened results are.
    """
    if array.dtype.kind not in "UO":
        return array.values.astype(np.int8) if array.dtype.kind == "b" else array.values
    words = np.char.encode(array.values.astype(str), "utf-8")
    return words.astype(f"S{max(1, words.itemsize)}")[..., np.newaxis].view("S1")


def write(dataset: xr.Dataset, path: Path, before: Condition) -> None:
    """Write a small dataset. The file is complete or does not exist.

    before : the condition of the file at `path`, see `put`
    """
    place = partial(put, before, dataset.attrs["study_digest"])
    with replacing(path, place=place) as temporary:
        with File(temporary, "w", path) as file:
            sums = create(file, dataset, dataset, {})
            for name, array in dataset.data_vars.items():
                file.write(name, stored(array))
                sums.add(name, stored(array))
            finish(file, sums)
        seal(temporary)


def finish(file: File, sums: Sums) -> None:
    """Write the digest, after everything else."""
    file.define({}, {ATTRIBUTE: sums.digest(file)})


def put(before: Condition, digest: str, temporary: Path, path: Path) -> None:
    """Move a complete file to its place. A damaged file there is kept as NAME.nc.damaged.

    before : the condition of the file at `path` before the results were computed

    Raises StudyError when a file has appeared or changed meanwhile, unless it has the results of the study `digest`.
    """
    if os.path.lexists(path):
        if before.seen is None or stamp(path) != before.seen:
            now = examine(path)
            if not (now.good and now.digest == digest):
                what = "appeared or changed while its results were computed, and is left as it is"
                raise StudyError([f"{before.path}: {what}: move it away, and the same command writes them"], code=1)
        elif before.kind == "damaged":
            os.replace(path, f"{path}.damaged")
    os.replace(temporary, path)


def numbers_digest(path: Path) -> str:
    """The digest in a results file, or sha256 of all its bytes if it has none; for a folder the digest of its parts."""
    if path.is_dir():
        parts = [(part.name, numbers_digest(part)) for part in sorted(path.glob("*.nc"))]
        return hashlib.sha256(json.dumps(parts).encode()).hexdigest()
    check_regular(path)
    try:
        with File(path) as file:
            if ATTRIBUTE in file.attributes:
                return str(file.attributes[ATTRIBUTE])
    except Unusable:
        pass
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def open_results(path: str | os.PathLike) -> xr.Dataset:
    """A results file, read into memory and closed, if nothing in it is damaged. A large file is opened lazily.

    Any thread may open and read while others run studies. A file of an earlier version, without a digest, is read
    unverified. A netCDF file of another program is read as it is.

    Parameters
    ----------
    path : of the file, such as "results/mine.nc", or of the folder of parts, "results/mine"

    Returns
    -------
    xarray.Dataset : as `study.solve` gives it

    Raises
    ------
    FileNotFoundError : there is no such file
    StudyError : the file is damaged, or cannot be read; it is also an OSError

    Examples
    --------
    >>> import tempfile, study
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     report = study.load("reference_load", results=folder).run()
    ...     contacts = open_results(report.path)
    >>> contacts.attrs["study_name"]
    'reference_load'
    """
    path = Path(os.path.expanduser(path))
    if path.is_dir() and any(path.glob("*.nc")):
        return for_users(open_parts(path))
    condition = examine(path, most=LAZY)
    if condition.kind != "foreign":
        return opened(condition)
    try:
        return for_users(read_of_others(path) if condition.unpacked > LAZY else read(path))
    except OSError:
        condition.raise_if_bad()
        raise
    except MemoryError:
        raise
    except Exception as error:  # from xarray, which may take the attributes of variables as units of time and so on
        reason = f"{condition.reason}, which xarray cannot read: {on_one_line(str(error), 200)}"
        raise Unusable(path, "foreign", reason) from error


def opened(condition: Condition) -> xr.Dataset:
    """The dataset in a results file that has been examined.

    A large dataset has dask arrays in the chunks of the file: numbers are read when they are needed, in any thread, and
    netCDF verifies each chunk (StudyError, an OSError).
    """
    condition.raise_if_bad()
    return for_users(read_lazily(condition.path) if condition.unpacked > LAZY else read(condition.path))


def results_of(folder: Path, study: str) -> Path:
    """The results file of a study, or the folder of the parts of a large one."""
    file, parts = folder / f"{study}.nc", folder / study
    return parts if parts.is_dir() and not file.exists() else file


def for_users(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with its laws and without the digest, which would be wrong in a file that a user writes from it."""
    for name in (ATTRIBUTE, FORMER):
        dataset.attrs.pop(name, None)
    if "micro" in dataset.variables and not (known := lexicon_in(dataset).known).is_package:
        dataset.variables["micro"].encoding[KNOWN] = known
    return searchable(without_fill_values(dataset))

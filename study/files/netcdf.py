"""The only module that opens, reads and writes results files, always under the lock of `access`."""

import errno
import os
import stat
from contextlib import suppress
from math import prod
from pathlib import Path
from typing import NamedTuple

import netCDF4
import numpy as np
import xarray as xr

from .access import Access, Unusable, access, are_whole, memory_is_short
from .lock import locked

HDF5 = b"\x89HDF\r\n\x1a\n"
MOST_INDEXED = 1_000_000  # largest number of values of a coordinate with an index: an axis of a study has no more
END = {0: 40, 1: 44, 2: 28, 3: 28}
"""Version of an HDF5 file (its byte 8) -> place of the 8 bytes that hold the length of the file."""


class VariableHeader(NamedTuple):
    """A variable without its values.

    kind : type of the values, `str` for the strings of netCDF
    dims : names of the dimensions; our texts have one more dimension, along their characters
    """

    kind: np.dtype | type
    dims: tuple[str, ...]
    shape: tuple[int, ...]
    attributes: dict

    @property
    def unpacked(self) -> int:
        """Bytes in memory; a string of netCDF counts as eight."""
        return prod(self.shape) * int(getattr(self.kind, "itemsize", 8))


class File:
    """An open netCDF file. Its methods take the lock; as a context manager it is closed at the end."""

    def __init__(self, path: Path, mode: str = "r", called: Path | None = None):
        """Open a file for reading, or make a new one with mode "w". Messages call it `called`, by default its path.

        Raises FileNotFoundError, Unusable, and OSError when it is written.
        """
        self.path, self._writing = Path(called or path), Path(path) if mode == "w" else None
        if not self._writing:
            check_regular(path)
        with self._access():
            try:
                self._file = netCDF4.Dataset(path, mode)
            except OSError as error:
                raise error if self._writing else _cannot_be_opened(path, error) from error
            self._file.set_auto_maskandscale(False)

    def __enter__(self) -> "File":
        return self

    def __exit__(self, failed, *_) -> None:
        if failed is None:
            with self._access():
                self._file.close()
        else:
            with access(self.path), suppress(RuntimeError):  # from a full disk: the first error is raised
                self._file.close()

    def _access(self):
        return access(self.path, self._writing)

    @property
    def attributes(self) -> dict:
        """Attributes of the file."""
        with self._access():
            return _attributes(self._file)

    @property
    def variables(self) -> dict[str, VariableHeader]:
        """Name -> variable."""
        with self._access():
            variables = self._file.variables.items()
            return {
                name: VariableHeader(var.dtype, var.dimensions, var.shape, _attributes(var)) for name, var in variables
            }

    def read(self, name: str, window: dict[str, slice] | None = None, characters: bool = False) -> np.ndarray:
        """A variable, or its part within a window (a slice for each dimension); with `characters` texts stay arrays."""
        with self._access():
            variable, window = self._file[name], window or {}
            variable.set_auto_chartostring(not characters)
            return np.asarray(variable[tuple(window.get(dim, slice(None)) for dim in variable.dimensions)])

    def define(self, sizes: dict[str, int], attributes: dict) -> None:
        """Make the dimensions that do not exist yet, and attributes of the file."""
        with self._access():
            for name, size in sizes.items():
                if name not in self._file.dimensions:
                    self._file.createDimension(name, size)
            self._file.setncatts(_as_characters(attributes))

    def add(self, name: str, kind, dims: tuple[str, ...], attributes: dict, options: dict) -> None:
        """Make a variable without values.

        options : of netCDF4's createVariable
        """
        with self._access():
            variable = self._file.createVariable(name, kind, dims, **options)
            variable.set_auto_mask(False)
            variable.set_auto_chartostring(False)
            if "chunksizes" in options:
                variable.set_var_chunk_cache(size=1, nelems=1)  # each chunk is written once, whole: no cache of 64 MB
            variable.setncatts(_as_characters(attributes))

    def write(self, name: str, array: np.ndarray, window: dict[str, slice] | None = None) -> None:
        """Write the values of a variable, or of its part within a window."""
        with self._access():
            variable, window = self._file[name], window or {}
            variable[tuple(window.get(dim, slice(None)) for dim in variable.dimensions)] = array


def _as_characters(attributes: dict) -> dict:
    """Attributes with texts as characters in UTF-8 (NC_CHAR). netCDF4 writes a text that is not ASCII as an NC_STRING,
    which the netcdf package of Octave cannot read."""
    return {name: text.encode() if isinstance(text, str) and not text.isascii() else text
            for name, text in attributes.items()}  # fmt: skip


def _attributes(owner: netCDF4.Dataset | netCDF4.Variable) -> dict:
    """Attributes of a file or a variable. A text that is not UTF-8 is read as Latin-1."""
    attributes = {}
    for name in owner.ncattrs():
        try:
            attributes[name] = owner.getncattr(name)
        except UnicodeDecodeError:
            attributes[name] = owner.getncattr(name, encoding="latin-1")
    return attributes


def read(path: Path) -> xr.Dataset:
    """A file as a dataset in memory."""
    check_regular(path)
    with access(path), xr.open_dataset(path, engine="netcdf4", lock=Access(path)) as dataset:
        return dataset.load()


def read_lazily(path: Path) -> xr.Dataset:
    """A file as dask arrays in its chunks: numbers are read when they are needed, under the lock."""
    check_regular(path)
    with access(path):
        return xr.open_dataset(path, engine="netcdf4", chunks={}, lock=Access(path))


def read_together(paths: list, folder: Path, dims: list[str]) -> xr.Dataset:
    """Files that are parts of one dataset, opened lazily as in `read_lazily`.

    paths : nested lists, a level for each of the dimensions `dims`, along which the parts follow each other
    """
    options = {"combine": "nested", "data_vars": "minimal", "coords": "minimal", "compat": "override"}
    with access(folder):
        return xr.open_mfdataset(
            paths, concat_dim=dims, join="override", engine="netcdf4", chunks={}, lock=Access(folder), **options
        )


def read_of_others(path: Path) -> xr.Dataset:
    """A large file of another program: numbers are read when they are needed, under the lock.

    There are no dask arrays, since a file may have millions of chunks, most of which were never written. Coordinates of
    more than MOST_INDEXED values get no index, for which they would be read at once.
    """
    check_regular(path)
    with access(path):
        dataset = xr.open_dataset(path, engine="netcdf4", lock=Access(path), create_default_indexes=False)
    for name, size in dataset.sizes.items():
        if name in dataset.coords and dataset[name].dims == (name,) and size <= MOST_INDEXED:
            dataset = dataset.set_xindex(name)
    return dataset


def check_regular(path: Path) -> None:
    """Raise Unusable for a folder, or a FIFO, on which reading would wait; FileNotFoundError when there is nothing."""
    try:
        mode = Path(path).stat().st_mode
    except (FileNotFoundError, NotADirectoryError) as error:
        raise FileNotFoundError(2, "No such file", os.fspath(path)) from error
    except OSError as error:
        raise Unusable(path, "unreadable", f"cannot be read: {error.strerror}") from error
    if not stat.S_ISREG(mode):
        raise Unusable(path, "foreign", f"is not a file but a {'folder' if stat.S_ISDIR(mode) else 'pipe or device'}")


def _cannot_be_opened(path: Path, error: OSError) -> Exception:
    """The error to raise for a file that netCDF cannot open. Its own error is -101 whatever the reason."""
    try:
        with open(path, "rb") as file:
            head, size = file.read(64), os.fstat(file.fileno()).st_size
            free = locked(file.fileno(), shared=True, wait=False)  # HDF5 locks a file that it writes
    except FileNotFoundError as removed:  # it was there a moment ago
        return removed
    except OSError as reason:
        return Unusable(path, "unreadable", f"cannot be read: {reason.strerror}")
    if not free:
        return Unusable(path, "unreadable", "is open for writing in another program, which has locked it")
    if not head.startswith(HDF5):
        return Unusable(path, "foreign", "is empty" if not size else "is not a netCDF file")
    if error.errno == errno.ENOMEM or (memory_is_short() and are_whole(path)):
        return MemoryError(f"{path} cannot be opened: {error.strerror or error}")
    place = END.get(head[8] if len(head) > 8 else -1, 64)
    length = int.from_bytes(head[place : place + 8], "little")
    if len(head) < place + 8 or size < length:
        return Unusable(path, "damaged", f"is damaged: cut off, {size} bytes" + f" of {length}" * (length > size))
    return Unusable(path, "damaged", f"is damaged: cannot be opened ({error.strerror or error})")

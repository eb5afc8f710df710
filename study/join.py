"""The results file, written window by window: never more than a small part of a study is in memory.

netCDF is touched here and in `dataset` only, and must be by the main thread only: from several threads it crashes.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import netCDF4
import xarray as xr
from xarray.conventions import encode_dataset_coordinates

from .atomic import replacing
from .dataset import assembled, encoding, labelled
from .definition import Definition
from .grid import box, cut_out, windows
from .store import Inventory, Store, gather

CHUNK = 8192  # cases in a chunk of the file: 2 MB of a profile
AT_ONCE = 64_000_000  # bytes gathered at a time; less, and blocks in another order than the cases are read too often


def writing(store: Store, known: Inventory, path: Path, command: str) -> Iterator[None]:
    """Write the results file from the blocks, in steps, while other threads compute: each `next` is one step.

    Steps do nothing while the cases whose turn it is are missing. At the end of the iteration the file is at `path`.

    Raises
    ------
    Damaged : a block has been spoiled since the inventory was made
    OSError : the file cannot be written
    """
    with replacing(path, store.folder) as temporary:
        try:
            with netCDF4.Dataset(temporary, "w") as file:
                yield from _steps(file, store, known, command)
        except RuntimeError as error:  # of the HDF5 library, which does not say more
            raise OSError(f"{path} cannot be written ({error}): is the disk full?") from error


def _steps(file: netCDF4.Dataset, store: Store, known: Inventory, command: str) -> Iterator[None]:
    definition, start = store.definition, 0
    most = AT_ONCE * definition.grid.size // (8 * definition.numbers)
    for window in windows(definition.grid, most, CHUNK):
        grid = cut_out(definition.grid, window)
        while (known.file[start : start + grid.size] < 0).any():
            yield
        arrays = gather(store, known, start, start + grid.size)
        part = labelled(replace(definition, grid=grid), arrays, command)
        if not start:
            create(file, definition, part, command)
        for name, array in part.data_vars.items():
            file[name][tuple(window.get(dim, slice(None)) for dim in array.dims)] = array.values
            yield
        start += grid.size


def create(file: netCDF4.Dataset, definition: Definition, part: xr.Dataset, command: str) -> None:
    """Dimensions, attributes and variables as in `part`, the coordinates with the values of the whole study."""
    whole = assembled(definition, {}, "x", definition.x, command)
    variables, attributes = encode_dataset_coordinates(part)
    sizes = dict(whole.sizes)
    chunk = dict(zip(definition.grid.sizes, box(definition.grid.shape, CHUNK), strict=True))
    for dim, size in sizes.items():
        file.createDimension(dim, size)
    for name, variable in variables.items():
        options = encoding(part[name])
        if name in part.data_vars and variable.dims:
            options["chunksizes"] = [chunk.get(dim, sizes[dim]) for dim in variable.dims]
        kind = str if variable.dtype.kind in "UO" else variable.dtype
        made = file.createVariable(name, kind, variable.dims, **options)
        made.set_auto_maskandscale(False)
        if "chunksizes" in options:
            made.set_var_chunk_cache(size=1, nelems=1)  # whole chunks are written, once: 64 MB each would hold them
        made.setncatts(variable.attrs)
        if name in part.coords:
            made[...] = whole[name].values.astype(object if kind is str else kind)
    file.setncatts(attributes)

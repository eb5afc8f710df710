"""The results file, written window by window, so that only a small part of a study is in memory at a time."""

from dataclasses import replace
from functools import partial

from ..data.dataset import labelled, parts
from ..data.si import dataset_of
from ..files.atomic import replacing
from ..files.examine import CHUNK, Condition
from ..files.netcdf import File
from ..files.results_file import create, finish, put, stored
from ..files.seal import seal
from ..inputs.grid import box, cut_out, windows
from .blocks import Inventory, Store, forget_other_exports, gather, note_export

AT_ONCE = 64_000_000  # bytes gathered at a time; with less, blocks in another order than the cases are read too often


def export(store: Store, stock: Inventory, command: str, condition: Condition) -> None:
    """Write the results file, of blocks that hold all cases.

    condition : that of the results file that it replaces, see `put`

    Raises Damaged when a block has been spoiled since the inventory was made, OSError when the file cannot be written,
    StudyError when another file has come to its place.
    """
    note_export(store, stock)
    place = partial(put, condition, store.definition.digest)
    with replacing(store.path, store.folder, place) as temporary:
        with File(temporary, "w", store.path) as file:
            _write(file, store, stock, command)
        seal(temporary)
    forget_other_exports(store)


def _write(file: File, store: Store, stock: Inventory, command: str) -> None:
    definition, start = store.definition, 0
    whole_grid = definition.grid
    most = AT_ONCE * whole_grid.size // (8 * definition.numbers)
    chunk = definition.in_results(dict(zip(whole_grid.sizes, box(whole_grid.shape, CHUNK), strict=True)))
    for window in windows(whole_grid, most, CHUNK):
        grid = cut_out(definition.grid, window)
        arrays = gather(store, stock, start, start + grid.size)
        here = replace(definition, grid=grid, scene=definition.scene and definition.scene.within(window))
        part, place = dataset_of(here, parts(here, arrays, command)), definition.in_results(window)
        if not start:
            whole = dataset_of(definition, labelled(definition, {}, command))
            sums = create(file, part, whole, chunk)
        for name, array in part.data_vars.items():
            file.write(name, stored(array), place)
            sums.add(name, stored(array))
        start += grid.size
    finish(file, sums)

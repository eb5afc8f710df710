"""The results file, written window by window: never more than a small part of a study is in memory."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from solver import NUMERICS_VERSION

from ..data.dataset import labelled, parts
from ..data.si import dataset_of
from ..files.atomic import replacing
from ..files.checksums import CaseDigests, digest_of_cases
from ..files.examine import CHUNK, Condition
from ..files.netcdf import File
from ..files.results_file import add_checksums, create, put
from ..files.seal import seal
from ..inputs.grid import MOVED, Grid, box, cut_out, windows
from .blocks import Inventory, Store, gather

AT_ONCE = 64_000_000  # bytes gathered at a time; with less, blocks in another order than the cases are read too often


def writing(store: Store, known: Inventory, command: str, there: Condition) -> Iterator[None]:
    """Write the results file from the blocks, in steps, while other threads compute. Each `next` is one step.

    A step does nothing while the next cases are missing. When the iterator ends, the file is in its place.
    there : the results file that it replaces, see `put`

    Raises Damaged when a block has been spoiled since the inventory was made, OSError when the file cannot be written,
    StudyError when another file has come to its place.
    """
    place = partial(put, there, store.definition.digest)
    with replacing(store.path, store.folder, place) as temporary:
        with File(temporary, "w", store.path) as file:
            yield from _steps(file, store, known, command)
        seal(temporary)


def _steps(file: File, store: Store, known: Inventory, command: str) -> Iterator[None]:
    definition, start = store.definition, 0
    sizes = {dim: size for dim, size in definition.grid.sizes.items() if dim != MOVED}
    in_file = Grid(sizes, {})
    rows = CaseDigests(in_file.size)
    most = AT_ONCE * in_file.size // (8 * definition.numbers)
    chunk = definition.in_results(dict(zip(sizes, box(in_file.shape, CHUNK), strict=True)))
    for window in windows(in_file, most, CHUNK):
        window |= {MOVED: slice(None)} if MOVED in definition.grid.sizes else {}
        grid = cut_out(definition.grid, window)
        while (known.source[start : start + grid.size] < 0).any():
            yield
        arrays = gather(store, known, start, start + grid.size)
        here = replace(definition, grid=grid, scene=definition.scene and definition.scene.within(window))
        part, place = dataset_of(here, parts(here, arrays, command)), definition.in_results(window)
        if not start:
            whole = dataset_of(definition, labelled(definition, {}, command))
            create(file, part, whole, chunk)
        for name, array in part.data_vars.items():
            file.write(name, array.values, place)
            rows.add(name, array.values.reshape(-1, *array.shape[len(sizes) :]))
            yield
        start += grid.size
    add_checksums(file, rows, {"=cases": digest_of_cases(NUMERICS_VERSION, definition.x, known.keys)})

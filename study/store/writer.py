"""The results file, written window by window, so that only a small part of a study is in memory at a time.

It is begun while cases are still computed: a window is written when the last of its cases has come.
"""

from collections import deque
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import xarray as xr

from ..data.dataset import labelled, parts
from ..data.si import dataset_of
from ..files.atomic import replacing
from ..files.examine import CHUNK, Condition, Sums
from ..files.netcdf import File
from ..files.results_file import create, finish, put, stored
from ..files.seal import seal
from ..inputs.grid import Grid, box, cut_out, windows
from .blocks import Inventory, Store, forget_other_exports, gather, note_export

AT_ONCE = 64_000_000  # bytes gathered at a time; with less, blocks in another order than the cases are read too often


@dataclass(eq=False)
class Export:
    """A results file that is being written, under another name.

    opened : closes the file; windows, start : those that are not written yet, in order, and their first case
    file, sums : None before the first window
    """

    store: Store
    stock: Inventory
    command: str
    temporary: Path
    opened: ExitStack
    windows: deque = field(init=False)
    start: int = 0
    file: File | None = None
    sums: Sums | None = None

    def __post_init__(self):
        grid = self.store.definition.grid
        most = AT_ONCE * grid.size // (8 * self.store.definition.numbers)
        self.windows = deque(windows(grid, most, CHUNK))

    def advance(self) -> None:
        """Write the windows of which all cases are in blocks, up to the first of which one is missing.

        Raises Damaged when a block has been spoiled since it was written, OSError when the file cannot be written.
        """
        while self.windows:
            grid = cut_out(self.store.definition.grid, self.windows[0])
            stop = self.start + grid.size
            if (self.stock.source[self.start : stop] < 0).any():
                break
            self._write(grid, self.windows.popleft(), stop)

    def _write(self, grid: Grid, window: dict[str, slice], stop: int) -> None:
        definition = self.store.definition
        arrays = gather(self.store, self.stock, self.start, stop)
        here = replace(definition, grid=grid, scene=definition.scene and definition.scene.within(window))
        part, place = dataset_of(here, parts(here, arrays, self.command)), definition.in_results(window)
        if self.file is None:
            self._create(part)
        for name, array in part.data_vars.items():
            self.file.write(name, stored(array), place)
            self.sums.add(name, stored(array))
        self.start = stop

    def _create(self, part: xr.Dataset) -> None:
        definition = self.store.definition
        sizes = definition.grid.sizes
        chunk = definition.in_results(dict(zip(sizes, box(definition.grid.shape, CHUNK), strict=True)))
        self.file = self.opened.enter_context(File(self.temporary, "w", self.store.path))
        self.sums = create(self.file, part, dataset_of(definition, labelled(definition, {}, self.command)), chunk)


@contextmanager
def exporting(store: Store, stock: Inventory, command: str, condition: Condition) -> Iterator[Export]:
    """A results file to be written. It takes its place at the end of the `with` block, if no case is missing then.

    condition : that of the results file that it replaces, see `put`

    Raises OSError when the file cannot be written, StudyError when another file has come to its place.
    """
    with replacing(store.path, store.folder, partial(put, condition, store.definition.digest)) as temporary:
        with ExitStack() as opened:
            export = Export(store, stock, command, temporary, opened)
            yield export
            if not export.windows:
                finish(export.file, export.sums)
        if export.windows:
            temporary.unlink(missing_ok=True)
            return
        note_export(store, stock)
        seal(temporary)
    forget_other_exports(store)

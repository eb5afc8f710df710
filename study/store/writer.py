"""The results file of a window, written piece by piece, so that only a small part of it is in memory at a time.

Writing begins while cases are still computed: a piece is written when its last case is complete. The file of one of
many windows is a single piece.
"""

import time
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
from .blocks import Inventory, forget_other_exports, gather, note_export
from .windows import Store

AT_ONCE = 64_000_000  # bytes gathered at a time; with fewer, blocks whose order differs from the cases' are read often


@dataclass(eq=False)
class Export:
    """A results file that is being written under a temporary name.

    opened : closes the file
    since : time at which the file was begun, by time.monotonic
    chunk : number of cases in a chunk
    pieces, start : the pieces that are not written yet, in order, and their first case
    file, sums : None before the first piece
    """

    store: Store
    stock: Inventory
    command: str
    temporary: Path
    opened: ExitStack
    since: float = field(default_factory=time.monotonic, init=False)
    chunk: int = field(init=False)
    pieces: deque = field(init=False)
    start: int = 0
    file: File | None = None
    sums: Sums | None = None

    def __post_init__(self):
        grid = self.store.definition.grid
        self.chunk, most = CHUNK, AT_ONCE * grid.size // (8 * self.store.definition.numbers)
        if self.store.window:
            self.chunk = most = grid.size
        self.pieces = deque(windows(grid, most, self.chunk))

    def advance(self) -> None:
        """Write the pieces whose cases are all in blocks, up to the first piece that lacks a case.

        Raises Damaged when a block has been damaged since it was written, OSError when the file cannot be written.
        """
        while self.pieces:
            grid = cut_out(self.store.definition.grid, self.pieces[0])
            stop = self.start + grid.size
            if (self.stock.source[self.start : stop] < 0).any():
                break
            self._write(grid, self.pieces.popleft(), stop)

    def _write(self, grid: Grid, piece: dict[str, slice], stop: int) -> None:
        definition = self.store.definition
        arrays = gather(self.store, self.stock, self.start, stop)
        definition_of_piece = replace(definition, grid=grid, scene=definition.scene and definition.scene.within(piece))
        part, place = (
            dataset_of(definition_of_piece, parts(definition_of_piece, arrays, self.command)),
            definition.in_results(piece),
        )
        if self.file is None:
            self._create(part)
        for name, array in part.data_vars.items():
            self.file.write(name, stored(array), place)
            self.sums.add(name, stored(array))
        self.start = stop

    def _create(self, part: xr.Dataset) -> None:
        definition = self.store.definition
        sizes, part.attrs = definition.grid.sizes, part.attrs | self.store.attributes
        chunk = definition.in_results(dict(zip(sizes, box(definition.grid.shape, self.chunk), strict=True)))
        self.file = self.opened.enter_context(File(self.temporary, "w", self.store.path))
        self.sums = create(self.file, part, dataset_of(definition, labelled(definition, {}, self.command)), chunk)


@contextmanager
def exporting(store: Store, stock: Inventory, command: str, condition: Condition) -> Iterator[Export]:
    """A results file to be written. It gets its name at the end of the `with` block, if no case is missing then.

    condition : of the results file that it replaces, see `put`

    Raises OSError when the file cannot be written, StudyError when another file has taken its place.
    """
    folder = None if store.window else store.folder
    with replacing(store.path, folder, partial(put, condition, store.definition.digest)) as temporary:
        with ExitStack() as opened:
            export = Export(store, stock, command, temporary, opened)
            yield export
            if not export.pieces:
                finish(export.file, export.sums)
        if export.pieces:
            temporary.unlink(missing_ok=True)
            return
        if not store.window:
            note_export(store, stock)
        seal(temporary)
    if not store.window:
        forget_other_exports(store)
        return
    for path in stock.blocks:  # their cases are in the file
        path.unlink(missing_ok=True)

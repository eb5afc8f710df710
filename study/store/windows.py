"""The files of a study: its results, in one window of the grid or in many, and the blocks from which they are written.

A window is a range of consecutive cases. A study of ordinary size is one window, `results/NAME.nc`. A large study has
many, `results/NAME/*.nc`, so that memory does not grow with it; the file of a window is a results file of its cases.
The name of the file states its first case and the study. The file counts only if its digest of the study, its
coordinates and its first case agree with the name.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import prod
from pathlib import Path
from typing import NamedTuple

from ..data.si import axes_of
from ..files.atomic import remove_temporary
from ..files.examine import Identity
from ..files.parts_folder import DIVIDED, FIRST
from ..inputs.definition import LARGE, Definition, usual_block
from ..inputs.grid import cut_out, windows

#: A study with more cases has many windows, since one window takes some 100 bytes of memory a case for the keys. So has
#: a study with more numbers, whose single file would have more than 4 GB.
CASES, NUMBERS = 4_000_000, LARGE
#: Largest number of bytes in one of many windows: 1,000,000 cases without profiles, 194,000 with 33 points. 1e8 cases
#: without profiles are then 100 files, fewer than the 128 that xarray keeps open at a time.
PART = 128_000_000
#: Largest number of usual blocks in such a window: it has fewer cases if they take long.
BLOCKS = 64


class Window(NamedTuple):
    """Consecutive cases, their place in the grid, and the file of their results.

    prefix : of the names of the window's blocks, if there are many windows: other blocks need not be read
    """

    cases: range
    place: dict[str, slice]
    path: Path
    prefix: str


@dataclass(frozen=True, eq=False)
class Store:
    """The files of a study, or of one of its many windows.

    definition : of the cases in these files
    window : None for a whole study
    attributes : of the results file, in addition to those of the study
    """

    definition: Definition
    results: Path
    window: Window | None = None
    attributes: dict = field(default_factory=dict)

    @property
    def path(self) -> Path:
        """Path of the results file."""
        return self.window.path if self.window else self.results / f"{self.definition.name}.nc"

    @property
    def parts(self) -> Path:
        """Folder of the results files of many windows."""
        return self.results / self.definition.name

    @property
    def folder(self) -> Path:
        """Folder of the blocks."""
        return self.results / f".{self.definition.name}.blocks"

    @property
    def lock(self) -> Path:
        return self.folder / "lock"

    def record(self, digest: str) -> Path:
        """Path of the record of a results file: a block without columns, with the keys of the cases in the file.

        digest : of the study whose results the file has
        """
        return self.folder / f"{digest}.cases"

    def block_paths(self, window: Window | None = None) -> Iterator[Path]:
        """Paths of the blocks of a window. A whole study may have blocks from windows that it had when it was
        larger."""
        window = window or self.window
        return self.folder.glob(f"{window.prefix if window else ''}*.block")

    def remove_litter(self) -> None:
        """Remove temporary files of runs that were killed while they wrote."""
        remove_temporary(self.path)
        for folder in (self.folder, self.parts):
            for path in folder.glob(".*.tmp"):
                path.unlink(missing_ok=True)


def is_large(definition: Definition) -> bool:
    """Whether a study has many windows."""
    return definition.grid.size > CASES or definition.numbers > NUMBERS


def whole_window(store: Store) -> Window:
    """The window of all cases of a study."""
    grid = store.definition.grid
    return Window(range(grid.size), {dim: slice(0, size) for dim, size in grid.sizes.items()}, store.path, "")


def windows_of(store: Store) -> list[Window]:
    """The windows of a large study, in the order of the cases. They depend only on its grid and its output."""
    definition, cut, first = store.definition, [], 0
    grid = definition.grid
    most = max(1, min(PART * grid.size // (8 * definition.numbers), BLOCKS * usual_block(grid)))
    for place in windows(grid, most, most):
        size = prod(len(range(length)[place[dim]]) for dim, length in grid.sizes.items())
        name = f"{first:012d}-{definition.digest[:16]}"
        cut.append(Window(range(first, first + size), place, store.parts / f"{name}.nc", f"{name}-"))
        first += size
    return cut


def divisions(definition: Definition, windows: list[Window]) -> str:
    """Number of windows along each dimension of the results that is cut: "h 5, n 2"."""
    starts = {dim: len({window.place[dim].start for window in windows}) for dim in definition.grid.sizes}
    return ", ".join(f"{dim} {count}" for dim, count in definition.in_results(starts).items() if count > 1)


def identities(store: Store, windows: list[Window]) -> list[Identity]:
    """The identity of the file of each of many windows. A file without the number of its first case is of an earlier
    version."""
    definition, axes, divided = store.definition, axes_of(store.definition), divisions(store.definition, windows)
    expected = []
    for window in windows:
        place = definition.in_results(window.place)
        coordinates = {dim: values[place[dim]] for dim, values in axes.items()}
        expected.append(Identity(definition.digest, coordinates, {DIVIDED: divided, FIRST: window.cases.start}))
    return expected


def within(store: Store, window: Window, divided: str) -> Store:
    """The store of one of the windows of a study, which is the store itself where there is only one.

    divided : see `divisions`
    """
    if window.path == store.path:
        return store
    definition = store.definition
    scene = definition.scene and definition.scene.within(window.place)
    definition_of_window = replace(definition, grid=cut_out(definition.grid, window.place), scene=scene)
    return Store(definition_of_window, store.results, window, {DIVIDED: divided, FIRST: window.cases.start})

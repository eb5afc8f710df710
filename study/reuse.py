"""What the results file of an earlier version of a study is worth to this one, and what would be lost with it."""

from dataclasses import dataclass
from pathlib import Path

import netCDF4
import numpy as np

from solver import NUMERICS_VERSION

from .block_file import Block
from .case_key import case_keys, find
from .dataset import not_run
from .definition import Definition, StudyError
from .grid import Grid, columns, windows
from .store import Inventory, Store, facts, put, usable
from .vocabulary import PARAMETERS

AT_ONCE = 50_000  # cases read at a time


@dataclass(frozen=True, eq=False)
class Earlier:
    """A results file. digest, numerics : as it says, "" if it is none of ours; keys : (N, 2), of the cases that this
    study can use; cases : how many it holds."""

    path: Path
    digest: str = ""
    numerics: str = ""
    keys: np.ndarray | None = None
    cases: int = 0


def earlier(definition: Definition, path: Path) -> Earlier | None:
    """The results file at `path`; None when there is none."""
    if not path.exists():
        return None
    try:
        with netCDF4.Dataset(path) as file:
            return _described(definition, path, file)
    except (OSError, RuntimeError, AttributeError, KeyError, IndexError):  # no netCDF file, or another one
        return Earlier(path)


def _described(definition: Definition, path: Path, file: netCDF4.Dataset) -> Earlier:
    digest, numerics = str(file.study_digest), str(file.numerics_version)
    if "status" not in file.variables:  # a micro law
        return Earlier(path, digest, numerics)
    grid = _grid_in(file)
    given = facts(np.asarray(file["x"][:])) | {"numerics_version": numerics}
    first = _rows(definition, file, grid, {dim: slice(0, 1) for dim in grid.sizes}, 0, 1)
    keys = case_keys(grid) if usable(definition, given, first) else None
    return Earlier(path, digest, numerics, keys, grid.size)


def statuses(path: Path) -> np.ndarray:
    """The statuses in a results file of a contact study, an array over its grid."""
    with netCDF4.Dataset(path) as file:
        return np.ma.getdata(file["status"][...])


def at_hand(known: Inventory, found: Earlier | None) -> np.ndarray:
    """Status (B,) of every case that a run would not compute, in blocks or an earlier results file; else NOT_RUN."""
    if not found or found.keys is None:
        return known.status
    where = find(known.keys, found.keys, np.zeros(len(found.keys)))
    return np.where((known.file < 0) & (where >= 0), statuses(found.path).ravel()[where], known.status)


def check_replaceable(store: Store, found: Earlier, keys: np.ndarray) -> None:
    """Raise StudyError when a results file holds cases that those of `keys` (B, 2), written in its place, are not."""
    digest, choice = store.definition.digest, "--force replaces them, --results DIR writes elsewhere"
    if not found.digest:
        raise StudyError([f"{found.path}: holds results of no study known here: {choice}"])
    if found.digest == digest:
        return
    if found.numerics != NUMERICS_VERSION:
        owner = f"version {found.numerics} of the numerics, this is {NUMERICS_VERSION}"
        raise StudyError(
            [f"{found.path}: holds results of {owner}: --force computes them again, --results DIR elsewhere"]
        )
    kept = 0 if found.keys is None else np.count_nonzero(find(found.keys, keys, np.zeros(len(keys))) >= 0)
    if not found.cases or kept < found.cases:
        owner = f"another definition (digest {found.digest[:8]}, here {digest[:8]})"
        lost = f"{found.cases - kept} of its {found.cases} cases are not in this one"
        raise StudyError([f"{found.path}: holds results of {owner}, {lost}: {choice}"])


def adopt(store: Store, known: Inventory, found: Earlier, retry: tuple[int, ...]) -> None:
    """Make blocks of the cases in the results file that are missing, but for those of a status in `retry`."""
    if found.keys is None:
        return
    where = find(known.keys, found.keys, np.zeros(len(found.keys)))
    useful = np.zeros(found.cases, dtype=bool)
    useful[where[(where >= 0) & (known.file < 0)]] = True
    with netCDF4.Dataset(found.path) as file:
        grid, start = _grid_in(file), 0
        given = facts(np.asarray(file["x"][:]))
        for window in windows(grid, AT_ONCE, 1):
            stop = start + int(np.prod([s.stop - s.start for s in window.values()]))
            if useful[start:stop].any():
                arrays = _rows(store.definition, file, grid, window, start, stop)
                rows = np.flatnonzero(useful[start:stop] & ~np.isin(arrays["status"], retry))
                if len(rows):
                    put(store, Block(given, found.keys[start + rows], {n: a[rows] for n, a in arrays.items()}))
            start = stop


def _grid_in(file: netCDF4.Dataset) -> Grid:
    """The grid that a results file was computed on, from its coordinates."""
    status = file["status"]
    coordinates = {*status.dimensions, *getattr(status, "coordinates", "").split()}
    values = {}
    for name in PARAMETERS:
        if name in coordinates and name in file.variables:
            array = np.ma.getdata(file[name][...])
            values[name] = file[name].dimensions, array.astype(str) if file[name].dtype is str else array
    return Grid({dim: len(file.dimensions[dim]) for dim in status.dimensions}, values)


def _rows(definition: Definition, file: netCDF4.Dataset, grid: Grid, window: dict, start: int, stop: int) -> dict:
    """The columns that the study wants and the file has, for the cases of a window: name -> (stop - start, ...)."""
    given, found = columns(grid, start, stop), {}
    for name in not_run(definition, 0):
        if name in grid.values:
            found[name] = given[name]
        elif name in file.variables:
            box = tuple(window.get(dim, slice(None)) for dim in file[name].dimensions)
            array = np.ma.getdata(file[name][box])
            found[name] = array.reshape(stop - start, *array.shape[len(grid.sizes) :])
    return found

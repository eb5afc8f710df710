"""What the results file of an earlier version of a study is worth to this one, and what would be lost with it."""

from dataclasses import dataclass, replace
from pathlib import Path

import netCDF4
import numpy as np

from solver import NUMERICS_VERSION
from solver.laws import identity as law_identity

from ..data.dataset import not_run
from ..files.checksums import ATTRIBUTE, attribute, identity, parsed
from ..files.examine import BROKEN, CHUNK, Condition, cut_from
from ..files.netcdf import Unusable, access, closing, opened
from ..spec.definition import Definition, StudyError
from ..spec.grid import Grid, columns, windows
from ..spec.vocabulary import PARAMETERS
from .block_file import Block
from .blocks import Inventory, Store, facts, put, usable
from .keys import case_keys, find, first_keys

AT_ONCE = CHUNK  # cases read at a time: what can be read and what cannot is told apart by chunks
MEND = "run the study as it was (its text is the attribute study), which mends it, or use --results DIR"


@dataclass(frozen=True, eq=False)
class Earlier:
    """A results file and its condition.

    cases : how many it holds; grid : that they are on, None when they cannot be told; numerics : their version;
    keys : (N, 2), of the cases that this study can use, or None
    """

    condition: Condition
    cases: int = 0
    grid: Grid | None = None
    numerics: str = ""
    x: np.ndarray | None = None
    keys: np.ndarray | None = None


def earlier(definition: Definition, found: Condition) -> Earlier | None:
    """What is in a results file that was examined; None when there is none."""
    if found.kind == "missing":
        return None
    if found.kind in ("foreign", "unreadable") or not found.digest and not found.damage:
        return Earlier(found)
    try:
        with closing(opened(found.path), found.path) as file:
            return _described(definition, found, file)
    except Unusable:
        return Earlier(found)
    except BROKEN as error:
        return Earlier(replace(found, kind="foreign", reason=f"is laid out as no results of ours ({error!r})"))


def _described(definition: Definition, found: Condition, file: netCDF4.Dataset) -> Earlier:
    with access(found.path):
        if "status" not in file.variables:  # a micro law
            return Earlier(found, numerics=found.numerics)
        told = _told(definition, found, file)
        columns = {name: np.empty(0, file[name].dtype) for name in not_run(definition, 0) if name in file.variables}
    if told is None:
        return Earlier(found, Grid(found.sizes, {}).size)
    grid, x, numerics = told
    columns |= {name: array[:0] for name, (_, array) in grid.values.items() if array.ndim}
    serves = usable(definition, facts(x) | {"numerics_version": numerics}, columns)
    return Earlier(found, grid.size, grid, numerics, x, case_keys(grid) if serves else None)


def _told(definition: Definition, found: Condition, file: netCDF4.Dataset) -> tuple | None:
    """Grid, points x and numerics of the cases in a file: its own, or of the definition where those are damaged."""
    if not {*PARAMETERS, "x", "=structure", "@numerics_version"} & set(found.damage):
        return _grid_in(file), np.asarray(file["x"][:]), found.numerics
    lines = parsed(str(attribute(file, ATTRIBUTE))) if ATTRIBUTE in file.ncattrs() else {}
    grid, x = definition.grid, definition.x
    same = list(grid.sizes.items()) == list(found.sizes.items())
    if same and lines.get("=cases") in [identity(NUMERICS_VERSION, x, keys(grid)) for keys in (case_keys, first_keys)]:
        return grid, x, NUMERICS_VERSION
    return None


def statuses(path: Path) -> np.ndarray:
    """The statuses in a results file of a contact study, an array over its grid."""
    with closing(opened(path), path) as file, access(path):
        return np.asarray(file["status"][...])


def at_hand(known: Inventory, found: Earlier | None) -> np.ndarray:
    """Status (B,) of every case that a run would not compute, in blocks or an earlier results file; else NOT_RUN."""
    if not found or found.keys is None:
        return known.status
    where = find(known.keys, found.keys, np.zeros(len(found.keys)))
    there = (known.file < 0) & (where >= 0)
    if found.condition.intact is not None:
        there &= found.condition.intact[where]
    return np.where(there, statuses(found.condition.path).ravel()[where], known.status)


def check_replaceable(store: Store, found: Earlier, keys: np.ndarray, force: bool = False) -> None:
    """Raise StudyError when a results file holds cases that those of `keys` (B, 2), written in its place, are not.

    force : they may be lost. What is none of our results is never replaced.
    """
    digest, file = store.definition.digest, found.condition
    damaged = file.kind == "damaged"
    if file.kind in ("foreign", "unreadable"):
        raise Unusable(file.path, file.kind, f"{file.reason}; move it away, or use --results DIR")
    if force or file.digest == digest or damaged and not (file.digest or found.cases):  # cut off: nothing can be told
        return
    if damaged and found.grid is None:
        raise StudyError([f"{file.path}: {file.reason}; which cases it holds cannot be told: {MEND}"])
    if found.numerics != NUMERICS_VERSION:
        owner = f"version {found.numerics} of the numerics, this is {NUMERICS_VERSION}"
        raise StudyError(
            [f"{file.path}: holds results of {owner}: --force computes them again, --results DIR elsewhere"]
        )
    kept = 0 if found.keys is None else np.count_nonzero(find(found.keys, keys, np.zeros(len(keys))) >= 0)
    if not found.cases or kept < found.cases:
        lost = f"{found.cases - kept} of its {found.cases} cases are not in this one"
        if damaged:
            raise StudyError([f"{file.path}: {file.reason}; {lost}: {MEND}"])
        owner = f"another definition (digest {file.digest[:8]}, here {digest[:8]})"
        choice = "--force replaces them, --results DIR writes elsewhere"
        raise StudyError([f"{file.path}: holds results of {owner}, {lost}: {choice}"])


def adopt(store: Store, known: Inventory, found: Earlier, retry: tuple[int, ...]) -> None:
    """Make blocks of the intact cases in the results file that are missing, but for those of a status in `retry`."""
    if found.keys is None:
        return
    where = find(known.keys, found.keys, np.zeros(len(found.keys)))
    useful = np.zeros(found.cases, dtype=bool)
    useful[where[(where >= 0) & (known.file < 0)]] = True
    useful &= found.condition.intact
    given, path, start = facts(found.x), found.condition.path, 0
    with closing(opened(path), path) as file:
        for window in windows(found.grid, AT_ONCE, 1):
            stop = start + int(np.prod([s.stop - s.start for s in window.values()]))
            if useful[start:stop].any():
                arrays = _rows(store.definition, path, file, found.grid, window, start, stop)
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
            array = np.asarray(file[name][...])  # texts without the dimension of their characters
            values[name] = file[name].dimensions[: array.ndim], array.astype(str) if array.dtype.kind in "OU" else array
    versions = str(attribute(file, "micro_laws")).split("\n") if "micro_laws" in file.ncattrs() else []
    if "micro" in values:  # a law of another version than the registered one is another law
        dims, words = values["micro"]
        old = {text.split()[0]: text for text in versions if law_identity(text.split()[0]) != text}
        values["micro"] = dims, np.array([old.get(word, word) for word in words.ravel().tolist()]).reshape(words.shape)
    return Grid({dim: len(file.dimensions[dim]) for dim in status.dimensions}, values)


def _rows(
    definition: Definition, path: Path, file: netCDF4.Dataset, grid: Grid, window: dict, start: int, stop: int
) -> dict[str, np.ndarray]:
    """The columns that the study wants and the file has, for the cases of a window: name -> (stop - start, ...)."""
    given, found = columns(grid, start, stop), {}
    for name, wanted in not_run(definition, 0).items():
        if name in grid.values:
            found[name] = given[name].astype(wanted.dtype, copy=False)
        elif name in file.variables:
            array = cut_from(path, file, name, window).astype(wanted.dtype, copy=False)
            found[name] = array.reshape(stop - start, *array.shape[len(grid.sizes) :])
    return found

"""The condition of a results file: sound, damaged and where, of an earlier version, or of another program."""

import math
import os
import pickle
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import lru_cache
from math import inf
from pathlib import Path

import numpy as np

from ..inputs.grid import Grid, windows
from ..inputs.vocabulary import names
from .access import Unusable
from .checksums import ATTRIBUTE, DIGITS, CaseDigests, lines_of_head, parsed
from .child import python_command
from .netcdf import File, check_regular
from .seal import LARGE, is_whole

CHUNK = 8192  # cases in a chunk of the file: 2 MB of a profile
BROKEN = (KeyError, IndexError, ValueError, TypeError, AttributeError, OverflowError, MemoryError)
"""Exceptions while a file is read that is not laid out like our results."""
OURS = ("study_digest", "numerics_version", ATTRIBUTE)
"""Attributes by which our results are known. Every results file has the first two."""
SHOWN = 3  # most damaged things that a message names
PATIENCE, SLOWEST = 60.0, 5e6  # seconds, and bytes per second, that reading may take: of a damaged file it may not end
CHANGED = "is damaged, or another program has changed it: "


@dataclass(frozen=True, eq=False)
class Condition:
    """The condition of a results file.

    kind : "sound"; "unverified": it seems right, but has no checksums, since an earlier version wrote it; "damaged";
        "foreign": not written by roughcoat; "unreadable"; "missing"
    reason : what is wrong; it follows the path in a message
    digest, numerics, title : of the study, of the solver, and of the study, as the file says
    sizes : of the dimensions of the cases, in order
    damage : names of the checksums that do not fit, see `checksums`
    intact : (N,) whether the numbers of each case can be trusted; None if not all variables were examined
    seen : its `stamp` before it was examined, None where there was no file
    unpacked : bytes of its variables in memory
    """

    path: Path
    kind: str
    reason: str = ""
    digest: str = ""
    numerics: str = ""
    title: str = ""
    sizes: dict[str, int] = field(default_factory=dict)
    damage: tuple[str, ...] = ()
    intact: np.ndarray | None = None
    seen: tuple | None = None
    unpacked: int = 0

    @property
    def good(self) -> bool:
        return self.kind in ("sound", "unverified")

    def raise_if_bad(self) -> None:
        """Raise FileNotFoundError or Unusable unless the file can be used."""
        if self.kind == "missing":
            raise FileNotFoundError(2, "No such file", os.fspath(self.path))
        if not self.good:
            raise Unusable(self.path, self.kind, self.reason)


def examine(path, columns: tuple[str, ...] | None = None, most: float = inf) -> Condition:
    """The condition of a results file.

    columns : the variables over the cases to be examined; None: all. Attributes, coordinates and one column take
        milliseconds, all of the file as long as reading and summing it twice
    most : of a file of more unpacked bytes attributes and coordinates alone are examined

    A file whose seal is broken or missing (see `seal`) is examined in a child process, which takes a second more.
    """
    path = Path(path)
    seen = stamp(path)
    try:
        check_regular(path)
        columns = () if path.stat().st_size > most else columns
        if not is_whole(path, LARGE if columns is not None else inf):
            return replace(examined_in_child(path, columns, most, seen), seen=seen)
    except (FileNotFoundError, Unusable):
        pass  # `examined` finds the same, and says it
    except OSError as error:
        return Condition(path, "unreadable", f"cannot be read: {error.strerror}", seen=seen)
    return replace(examined(path, columns, most), seen=seen)


def stamp(path: Path) -> tuple | None:
    """What changes when a file is replaced or written to; None when there is none."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_ino, found.st_size, found.st_mtime_ns, found.st_ctime_ns


@lru_cache(maxsize=16)
def examined_in_child(path: Path, columns: tuple[str, ...] | None, most: float, _) -> Condition:
    """`examine` in a child process: a file with a broken seal may crash the interpreter that reads it."""
    statement = "import pickle, sys; from study.files import examine; given = pickle.load(sys.stdin.buffer)\n"
    statement += "sys.stdout.buffer.write(pickle.dumps(examine.examined(*given)))"
    command, environment = python_command(statement)
    options = {"input": pickle.dumps((path, columns, most)), "env": environment, "capture_output": True}
    patience = PATIENCE + path.stat().st_size / SLOWEST
    try:
        child = subprocess.run(command, **options, timeout=patience)
        return pickle.loads(child.stdout)
    except (subprocess.TimeoutExpired, EOFError, pickle.UnpicklingError):
        return Condition(path, "damaged", "is damaged: a program that reads it breaks down")


def examined(path: Path, columns: tuple[str, ...] | None = None, most: float = inf) -> Condition:
    """`examine` in this process."""
    try:
        with File(path) as file:
            unpacked = file.unpacked
            return replace(_examined(file, () if unpacked > most else columns), unpacked=unpacked)
    except FileNotFoundError:
        return Condition(path, "missing")
    except Unusable as error:
        return Condition(path, error.kind, error.reason)
    except BROKEN as error:
        return Condition(path, "damaged", f"is damaged: no results are laid out like this ({error})")


def _examined(file: File, columns: tuple[str, ...] | None) -> Condition:
    about = {name: str(file.attribute(name)) for name in file.attributes() if name in OURS}
    lines = parsed(about.pop(ATTRIBUTE)) if ATTRIBUTE in about else {}
    if not lines and len(about) < 2:
        return Condition(file.path, "foreign", "is a netCDF file of another program")
    whole, over = _split(file, lines)
    dims = file.variables
    sizes = {dim: file.sizes[dim] for dim in dims["status"]} if over else {}
    places = tuple(sizes), (*sizes, "x")
    strange = [] if lines else [name for name in over if dims[name] not in places]
    if strange:
        reason = f"another program has changed it: its dimensions are {dims[strange[0]]} in {strange[0]}"
        return Condition(file.path, "foreign", reason)
    found = lines_of_head(file, whole, over, [line[1:] for line in lines if line.startswith("@")])
    rows, lost = _read(file, [name for name in over if columns is None or name in columns], sizes)
    damage = [f"#{name}" for name in lost]
    if lines:
        found |= rows.lines(runs=columns is None)
        damage = [name for name in [*found, "=checksums"] if lines.get(name) != found.get(name, "right")]
    intact = _intact(rows, lines, lost) if columns is None and over else None
    kind = "damaged" if damage else "sound" if lines else "unverified"
    reason = CHANGED + _in_words(damage, intact) if damage else ""
    title = str(file.attribute("title")) if "title" in file.attributes() else ""
    about = [*(about.get(name, "") for name in OURS[:2]), title]
    return Condition(file.path, kind, reason, *about, sizes, tuple(damage), intact)


def _split(file: File, lines: dict[str, str]) -> tuple[list[str], list[str]]:
    """Names of the variables that are read whole, and of those over the cases."""
    if lines:
        over = [line[1:] for line in lines if line.startswith("#")]
        return [line for line in lines if line[0] not in "#@="], over
    there = file.variables
    if "status" not in there:
        return list(there), []
    coordinates = coordinates_of(file)
    known = names("control", "result", "profile", "flag", "count")
    over = [name for name in known if name in there and name not in coordinates]
    return [name for name in coordinates if name in there], over


def coordinates_of(file: File) -> set[str]:
    """Names of the dimensions and coordinates of the cases."""
    named = str(file.attribute("coordinates", "status")) if "coordinates" in file.attributes("status") else ""
    return {*file.variables["status"], *named.split()}


def _read(file: File, over: list[str], sizes: dict[str, int]) -> tuple[CaseDigests, dict]:
    """Digests of the variables `over` the cases, and name -> [(start, stop)] of the cases that cannot be read."""
    grid, lost = Grid(sizes, {}), {}
    rows = CaseDigests(grid.size)
    for name in over:
        for start, stop, window in runs(grid):
            try:
                piece = file.read(name, window).reshape(stop - start, -1)
            except (Unusable, *BROKEN):
                lost.setdefault(name, []).append((start, stop))
                # random numbers in place of the lost ones: their checksum is wrong
                piece = np.frombuffer(os.urandom(stop - start), np.uint8)
            rows.add(name, piece)
    return rows, lost


def runs(grid: Grid) -> Iterator[tuple[int, int, dict[str, slice]]]:
    """(start, stop, window) of consecutive cases that are read together. If reading fails, all of them are lost."""
    start = 0
    for window in windows(grid, CHUNK, CHUNK):
        stop = start + math.prod(part.stop - part.start for part in window.values())
        yield start, stop, window
        start = stop


def _intact(rows: CaseDigests, lines: dict[str, str], lost: dict) -> np.ndarray:
    """(N,) whether the numbers of a case can be read and, if there are checksums, are those that were written."""
    found = np.ones(rows.size, dtype=bool)
    for start, stop in (part for parts in lost.values() for part in parts):
        found[start:stop] = False
    if lines:
        given, there = lines.get("=runs", ""), rows.lines()["=runs"]
        for number, start in enumerate(range(0, len(there), DIGITS)):
            if given[start : start + DIGITS] != there[start : start + DIGITS]:
                found[number * rows.run : (number + 1) * rows.run] = False
    return found


def _in_words(damage: list[str], intact: np.ndarray | None) -> str:
    """What is damaged, and in which cases, in words."""
    words = {
        "=structure": "types, dimensions or attributes of its variables",
        "=runs": "",
        "=checksums": "its checksums",
    }
    found = [words.get(name, f"the attribute {name[1:]}" if name[0] == "@" else name.lstrip("#")) for name in damage]
    shown = [word for word in found if word] or ["its checksums"]
    more = f" and {len(shown) - SHOWN} more" if len(shown) > SHOWN else ""
    bad = np.flatnonzero(~intact) if intact is not None else ()
    where = f" in {len(bad)} of {len(intact)} cases, {bad[0]} to {bad[-1]}" if len(bad) else ""
    return ", ".join(shown[:SHOWN]) + more + where

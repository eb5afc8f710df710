"""The blocks of a study on disk, and which of its cases they hold. What is on disk is the progress.

Cases are found by their keys, so it does not matter by which version of the study, in which order or in blocks of which
size they were computed.
"""

import hashlib
import json
import logging
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import count
from pathlib import Path

import numpy as np

from solver import NUMERICS_VERSION

from ..data.dataset import not_run
from ..spec.definition import Definition, StudyError
from ..spec.vocabulary import NOT_RUN
from .block_file import Block, Damaged, read_block, write_block
from .keys import VERSION, case_keys, find, renewed

log = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class Store:
    """The folder of the blocks of one study."""

    definition: Definition
    results: Path

    @property
    def folder(self) -> Path:
        return self.results / f".{self.definition.name}.blocks"

    @property
    def lock(self) -> Path:
        return self.folder / "lock"


@dataclass(eq=False)
class Inventory:
    """Where each of the B cases is.

    keys : (B, 2); files : the block files; file, row : (B,) int32, number of the file (-1: missing) and row in it;
    status : (B,) int8, NOT_RUN for a missing case; blocks : every block -> how many cases, -1: it is not whole;
        inside : those of which the results of this study will hold everything
    """

    keys: np.ndarray
    files: list[Path]
    file: np.ndarray
    row: np.ndarray
    status: np.ndarray
    blocks: dict[Path, int] = field(default_factory=dict)
    inside: set[Path] = field(default_factory=set)

    @property
    def missing(self) -> np.ndarray:
        """Numbers of the missing cases."""
        return np.flatnonzero(self.file < 0)


def count_statuses(status: np.ndarray) -> dict[int, int]:
    """status -> number of cases."""
    values, numbers = np.unique(status, return_counts=True)
    return dict(zip(values.tolist(), numbers.tolist(), strict=True))


def facts(x: np.ndarray) -> dict:
    """What stored numbers depend on besides the cases: the numerics, and the points x of the profiles; and the version
    of the keys."""
    return {"numerics_version": NUMERICS_VERSION, "x": x.tolist(), "keys": VERSION}


def usable(definition: Definition, given: dict, arrays: dict[str, np.ndarray]) -> bool:
    """Whether numbers computed under the facts `given` hold all that the study wants, at least as exactly."""
    wanted = not_run(definition, 0)
    here = all(name in arrays and arrays[name].dtype.itemsize >= wanted[name].dtype.itemsize for name in wanted)
    same_points = not definition.profiles or given.get("x") == definition.x.tolist()
    return here and same_points and given.get("numerics_version") == NUMERICS_VERSION


def blocks_on_disk(store: Store) -> Iterator[tuple[Path, Block | None]]:
    """Every block, None for one that is not whole: its cases are missing, so they are computed again."""
    for path in sorted(store.folder.glob("*.block")):
        try:
            yield path, _read(store, path)
        except FileNotFoundError:  # the run that it belongs to has just ended
            continue
        except OSError as error:
            log.warning("%s", error)
            yield path, None


def _read(store: Store, path: Path) -> Block:
    """A block; one that was written with keys of version 1 has those of today."""
    block = read_block(path)
    return block if "keys" in block.facts else replace(block, keys=renewed(block.keys, store.definition.grid))


def inventory(store: Store, retry: tuple[int, ...] = (), force: bool = False) -> Inventory:
    """What the blocks on disk hold of the study.

    retry : cases of these statuses count as missing; force : do without blocks of another version of the numerics

    Raises
    ------
    StudyError : there are blocks of another version of the numerics, and no `force`
    """
    files, parts, blocks, inside = [], [], {}, set()
    keys = case_keys(store.definition.grid)
    first = np.sort(keys[:, 0])
    for path, block in blocks_on_disk(store):
        blocks[path] = -1 if block is None else len(block.keys)
        if block is None:
            continue
        near = np.searchsorted(first, block.keys[:, 0])
        if (first[np.minimum(near, len(first) - 1)] == block.keys[:, 0]).all() and _is_kept(store.definition, block):
            inside.add(path)
        if block.facts["numerics_version"] != NUMERICS_VERSION:
            if not force:
                raise StudyError([_of_other_numerics(store, block.facts)])
        elif usable(store.definition, block.facts, block.arrays):
            status = block.arrays["status"]
            row = np.flatnonzero(~np.isin(status, retry)).astype(np.int32)
            parts.append((block.keys[row], np.full(len(row), len(files), np.int32), row, status[row]))
            files.append(path)
    nothing = (np.empty((0, 2), np.uint64), np.empty(0, np.int32), np.empty(0, np.int32), np.empty(0, np.int8))
    known, file, row, status = (np.concatenate(column) for column in zip(nothing, *parts, strict=True))
    where = find(keys, known, status)
    at = [np.append(array, array.dtype.type(none))[where] for array, none in ((file, -1), (row, -1), (status, NOT_RUN))]
    return Inventory(keys, files, *at, blocks, inside)


def _is_kept(definition: Definition, block: Block) -> bool:
    """Whether the results of a study hold all the numbers that a block holds of its cases."""
    wanted, arrays = not_run(definition, 0), block.arrays
    same_points = block.facts.get("x") == definition.x.tolist() or not any(array.ndim > 1 for array in arrays.values())
    kept = all(name in wanted and array.dtype.itemsize <= wanted[name].dtype.itemsize for name, array in arrays.items())
    return same_points and kept and block.facts.get("numerics_version") == NUMERICS_VERSION


def _of_other_numerics(store: Store, given: dict) -> str:
    version = f"version {given['numerics_version']} of the numerics, this is {NUMERICS_VERSION}"
    choice = "--force computes it again, --results DIR writes elsewhere"
    return f"{store.folder}: holds unfinished work of {version}: {choice}"


def add(store: Store, known: Inventory, index: np.ndarray, arrays: dict[str, np.ndarray]) -> None:
    """Write the block of the cases at `index` (n,), with the digits that the study keeps, and note it."""
    kept = {name: array.dtype for name, array in not_run(store.definition, 0).items()}
    arrays = {name: array.astype(kept[name], copy=False) for name, array in arrays.items()}
    path = put(store, Block(facts(store.definition.x), known.keys[index], arrays))
    known.file[index], known.row[index] = len(known.files), np.arange(len(index))
    known.status[index] = arrays["status"]
    known.files.append(path)
    known.blocks[path] = len(index)
    known.inside.add(path)


def put(store: Store, block: Block) -> Path:
    """Write a block under a name that says what is in it: a second run writes the same file again, not another.

    A whole block of other cases that somebody has given this name stays: the new one takes the next name.
    """
    content = [block.keys.tobytes(), json.dumps(block.facts).encode(), json.dumps(list(block.arrays)).encode()]
    name = hashlib.sha256(b"".join(content)).hexdigest()[:32]
    paths = (store.folder / f"{name}{f'-{number}' * (number > 1)}.block" for number in count(1))
    path = next(path for path in paths if not _is_another(path, block))
    write_block(path, block)
    return path


def _is_another(path: Path, block: Block) -> bool:
    """Whether there is a whole block of other cases, or something that is no file."""
    try:
        there = read_block(path)
    except FileNotFoundError:
        return False
    except Damaged as error:
        return not error.is_file
    return not np.array_equal(there.keys, block.keys) or there.facts != block.facts


def gather(store: Store, known: Inventory, start: int, stop: int) -> dict[str, np.ndarray]:
    """Columns of the cases start <= i < stop, name -> (stop - start, ...); missing ones as `not_run` has them.

    Raises
    ------
    Damaged : a block that was whole when the inventory was made
    """
    found = not_run(store.definition, stop - start)
    file = known.file[start:stop]
    for number in np.unique(file[file >= 0]):
        block, path = _read(store, known.files[number]), known.files[number]
        here = np.flatnonzero(file == number)
        row = known.row[start + here]
        if len(block.keys) <= row.max() or (block.keys[row] != known.keys[start + here]).any():
            raise Damaged(f"{path}: has become a block of other cases; the same command finds out of which")
        for name, array in found.items():
            array[here] = block.arrays[name][row]
    return found


def remove_litter(store: Store) -> None:
    """Remove what runs that were killed while they wrote have left."""
    for path in store.folder.glob(".*.tmp"):
        path.unlink(missing_ok=True)

"""The blocks of a window on disk, and which of its cases they hold. There is no other record of the progress.

Cases are found by their keys. So it does not matter from which version of the study they are, in which order they were
computed, or how large the blocks are. The blocks of a study of one window are added and stay, until `clean` is asked to
remove those that no case of the study needs; the results file is an export of them. Those of one of many windows are
removed when its results file is there, so that a large study is not on disk twice, and one that is soon whole is never
on disk: to write its blocks takes a tenth of the time in which they are computed.
"""

import hashlib
import json
import logging
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path

import numpy as np

from solver import NUMERICS_VERSION

from ..data.dataset import not_run
from ..files.access import Unusable
from ..inputs.definition import Definition
from ..inputs.identity import case_keys, find
from ..inputs.vocabulary import BY_INPUT, NOT_RUN
from ..terminal import short_of_memory
from .block_file import Block, Damaged, read_block, write_block
from .windows import Store

log = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class Source:
    """The file of a block.

    keys : (N, 2), of its cases; status : (N,) int8
    facts, columns : as of `Block`, of the columns the names
    inputs : the inputs of the study's derivatives, by their places among those of the block
    """

    path: Path
    keys: np.ndarray
    status: np.ndarray
    facts: dict
    columns: list[str]
    inputs: list[int]

    def read(self, rows: np.ndarray) -> dict[str, np.ndarray]:
        """Columns of the cases at `rows` (n,): name -> (n, ...). Raises Damaged if the file has other cases now."""
        block = read_block(self.path)
        if not np.array_equal(block.keys, self.keys) or block.facts != self.facts or {*self.columns} - {*block.arrays}:
            raise Damaged(f"{self.path}: now holds other cases; the same command reads it again")
        rows_of = {name: array[rows] for name, array in block.arrays.items()}
        return {name: a[:, self.inputs] if name.endswith(BY_INPUT) else a for name, a in rows_of.items()}


@dataclass(frozen=True, eq=False)
class InMemory:
    """A block that is in memory.

    index : (N,), its cases; arrays : its columns
    """

    index: np.ndarray
    arrays: dict[str, np.ndarray]

    def read(self, rows: np.ndarray) -> dict[str, np.ndarray]:
        """As `Source.read`."""
        return {name: array[rows] for name, array in self.arrays.items()}


@dataclass(eq=False)
class Inventory:
    """Where each of the B cases is.

    keys : (B, 2), None until a block of a window needs them
    sources : the blocks that hold usable cases
    source, row : (B,) int32, index of the source of each case (-1: missing), and the row of the case there
    status : (B,) int8, NOT_RUN for a missing case
    blocks : path of every block -> number of its cases, -1 for a damaged one
    unwritten : indices of the sources that are in memory alone
    """

    keys: np.ndarray | None
    sources: list[Source | InMemory]
    source: np.ndarray
    row: np.ndarray
    status: np.ndarray
    blocks: dict[Path, int]
    unwritten: list[int] = field(default_factory=list)

    @property
    def missing(self) -> np.ndarray:
        """Numbers of the missing cases."""
        return np.flatnonzero(self.source < 0)


def count_statuses(status: np.ndarray) -> dict[int, int]:
    """status -> number of cases."""
    values, numbers = np.unique(status, return_counts=True)
    return dict(zip(values.tolist(), numbers.tolist(), strict=True))


def facts(x: np.ndarray, inputs: tuple[str, ...] = ()) -> dict:
    """The facts on which stored numbers depend besides parameters: the version of the numerics, the points of profiles,
    and the inputs of derivatives."""
    about = {"numerics_version": NUMERICS_VERSION, "x": x.tolist()}
    return about | ({"inputs": list(inputs)} if inputs else {})


def usable(definition: Definition, block: Block) -> bool:
    """Whether a block holds all that the study wants: columns with enough digits, profile points, derivatives."""
    columns, wanted = not_run(definition, 0), facts(definition.x, definition.inputs)
    sizes = {name: array.dtype.itemsize for name, array in block.arrays.items()}
    digits = all(sizes.get(name, 0) >= array.dtype.itemsize for name, array in columns.items())
    points = block.facts.get("x") == wanted["x"] or not definition.profiles
    derivatives = {*definition.inputs} <= {*block.facts.get("inputs", ())}
    return digits and points and derivatives and block.facts.get("numerics_version") == wanted["numerics_version"]


def inventory(store: Store, retry: tuple = ()) -> Inventory:
    """Which cases of a window are in its blocks. Those of the statuses `retry` count as missing."""
    sources, blocks = [], {}
    for path in sorted(store.block_paths()):
        try:
            block = read_block(path)
        except FileNotFoundError:  # removed just now
            continue
        except OSError as error:  # its cases are computed again
            if short_of_memory(error):
                raise
            log.warning("%s", error)
            if isinstance(error, (Damaged, Unusable)):  # what cannot be read now is perhaps read later, so it stays
                blocks[path] = -1
            continue
        blocks[path] = len(block.keys)
        if usable(store.definition, block):
            places = [block.facts["inputs"].index(name) for name in store.definition.inputs]
            sources.append(Source(path, block.keys, block.arrays["status"], block.facts, [*block.arrays], places))
    if store.window and not sources:
        size = store.definition.grid.size
        nowhere = np.full(size, -1, np.int32), np.full(size, -1, np.int32), np.full(size, NOT_RUN, np.int8)
        return Inventory(None, [], *nowhere, blocks)
    keys = keys_of(store)
    return Inventory(keys, sources, *_places(keys, sources, retry), blocks)


def keys_of(store: Store) -> np.ndarray:
    """(B, 2), the keys of the cases of a window. They are of no other window and take half a microsecond a case."""
    return case_keys(store.definition.grid, bool(store.definition.stresses))


def _places(keys: np.ndarray, sources: list[Source], retry: tuple[int, ...]) -> tuple[np.ndarray, ...]:
    """Source, row and status of each case, (B,) each. A case in several places has the one of lowest status."""
    parts = [(np.empty((0, 2), np.uint64), np.empty(0, np.int32), np.empty(0, np.int32), np.empty(0, np.int8))]
    for number, source in enumerate(sources):
        row = np.flatnonzero(~np.isin(source.status, (NOT_RUN, *retry))).astype(np.int32)
        parts.append((source.keys[row], np.full(len(row), number, np.int32), row, source.status[row]))
    stored, source_numbers, row, status = (np.concatenate(column) for column in zip(*parts, strict=True))
    place = find(keys, stored, status)
    columns = ((source_numbers, -1), (row, -1), (status, NOT_RUN))
    # the place -1 of a missing case is the last, where the value for it is appended
    return tuple(np.append(array, array.dtype.type(fill))[place] for array, fill in columns)


def add(store: Store, stock: Inventory, index: np.ndarray, arrays: dict[str, np.ndarray]) -> None:
    """Write a block of the cases at `index` (n,), in the types that the study keeps, and put it into the inventory."""
    put_in_memory(store, stock, index, arrays)
    write_rest(store, stock)


def put_in_memory(store: Store, stock: Inventory, index: np.ndarray, arrays: dict[str, np.ndarray]) -> None:
    """Put a block into the inventory without writing it."""
    types = {name: array.dtype for name, array in not_run(store.definition, 0).items()}
    arrays = {name: array.astype(types[name], copy=False) for name, array in arrays.items()}
    stock.source[index], stock.row[index] = len(stock.sources), np.arange(len(index))
    stock.status[index] = arrays["status"]
    stock.unwritten.append(len(stock.sources))
    stock.sources.append(InMemory(index, arrays))


def write_rest(store: Store, stock: Inventory) -> None:
    """Write the blocks that are in memory alone.

    Those of one of many windows are in memory too until it is written: without locks another run may write it before,
    and remove its blocks.
    """
    about, places = facts(store.definition.x, store.definition.inputs), list(range(len(store.definition.inputs)))
    while stock.unwritten:
        number = stock.unwritten[0]
        index, arrays = stock.sources[number].index, stock.sources[number].arrays
        stock.keys = keys_of(store) if stock.keys is None else stock.keys
        block = Block(about, stock.keys[index], arrays)
        path = put(store, block)
        if not store.window:
            stock.sources[number] = Source(path, block.keys, arrays["status"], about, [*arrays], places)
        stock.blocks[path] = len(index)
        del stock.unwritten[0]


def put(store: Store, block: Block) -> Path:
    """Write a block under a name that follows from its content, so that a second run writes the same file again.

    If something else has this name, a block of other cases or a folder, it stays, and the block gets the next name.
    """
    content = [block.keys.tobytes(), json.dumps(block.facts).encode(), json.dumps(list(block.arrays)).encode()]
    name = hashlib.sha256(b"".join(content)).hexdigest()[:32]
    name = f"{store.window.prefix if store.window else ''}{name}"
    paths = (store.folder / f"{name}{f'-{number}' * (number > 1)}.block" for number in count(1))
    path = next(path for path in paths if not _is_another(path, block))
    write_block(path, block)
    return path


def _is_another(path: Path, block: Block) -> bool:
    """Whether the path holds a block of other cases, or something that is no file."""
    try:
        other = read_block(path)
    except (FileNotFoundError, Damaged):
        return False
    except Unusable:  # a folder, a pipe or a device
        return True
    return not np.array_equal(other.keys, block.keys) or other.facts != block.facts


def gather(store: Store, stock: Inventory, start: int, stop: int) -> dict[str, np.ndarray]:
    """Columns of the cases start <= i < stop, name -> (stop - start, ...). Missing cases are as in `not_run`.

    Raises Damaged when a source has changed since the inventory was made.
    """
    columns = not_run(store.definition, stop - start)
    source = stock.source[start:stop]
    for number in np.unique(source[source >= 0]):
        places = np.flatnonzero(source == number)
        arrays = stock.sources[number].read(stock.row[start + places])
        for name, array in columns.items():
            array[places] = arrays[name]
    return columns


def note_export(store: Store, stock: Inventory) -> None:
    """Write the record of the results file that is about to be written."""
    definition = store.definition
    about = facts(definition.x, definition.inputs) | {"study_digest": definition.digest}
    write_block(store.record(definition.digest), Block(about, stock.keys, {}))


def forget_other_exports(store: Store) -> None:
    """Remove the records of results files that have been replaced."""
    for path in store.folder.glob("*.cases"):
        if path != store.record(store.definition.digest):
            path.unlink(missing_ok=True)


def lost_cases(store: Store, digest: str) -> tuple[int, int] | None:
    """How many cases of the results of this digest are not in the study as it is, and how many cases the results have.

    None if no record says which cases these are. A record of an earlier version does not say of which study it is.
    """
    try:
        record = read_block(store.record(digest))
    except OSError:
        return None
    if record.facts.get("study_digest", digest) != digest:  # a copy of another
        return None
    rows = find(record.keys, keys_of(store), np.zeros(store.definition.grid.size))
    return int(np.count_nonzero(rows < 0)), len(record.keys)

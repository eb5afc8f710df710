"""The blocks of a window on disk, and the cases that they hold. There is no other record of the progress.

Cases are identified by keys. So it does not matter which version of the study computed them, in which order they were
computed, or how large the blocks are.

In a study of one window the blocks accumulate, and the results file is an export of them; `clean` removes those that no
case of the study needs. In a study of many windows the blocks of a window are removed once its results file exists, so
that a large study is not on disk twice. The blocks of a window that is soon complete are never written: writing them
takes a tenth of the time in which they are computed.
"""

import hashlib
import json
import logging
from contextlib import suppress
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
from .block_file import Block, Damaged, read_block, read_facts, write_block
from .windows import Store

log = logging.getLogger(__name__)
#: The fact of a block with the laws of scans.
_LAWS = "laws_of_scans"


@dataclass(frozen=True, eq=False)
class Source:
    """The file of a block.

    keys, status : of the cases, (N, 2) and (N,) int8
    facts, columns : the facts and the names of the columns, as in `Block`
    inputs : places of the inputs of the study's derivatives among those of the block
    """

    path: Path
    keys: np.ndarray
    status: np.ndarray
    facts: dict
    columns: list[str]
    inputs: list[int]

    def read(self, rows: np.ndarray) -> dict[str, np.ndarray]:
        """Columns of the cases at `rows` (n,): name -> (n, ...). Raises Damaged if the file now has other cases."""
        block = read_block(self.path)
        if not np.array_equal(block.keys, self.keys) or block.facts != self.facts or {*self.columns} - {*block.arrays}:
            raise Damaged(f"{self.path}: now holds other cases; the same command reads it again")
        rows_of = {name: array[rows] for name, array in block.arrays.items()}
        return {name: a[:, self.inputs] if name.endswith(BY_INPUT) else a for name, a in rows_of.items()}


@dataclass(frozen=True, eq=False)
class InMemory:
    """A block in memory.

    index : numbers of the cases, (N,)
    arrays : columns, name -> (N, ...)
    """

    index: np.ndarray
    arrays: dict[str, np.ndarray]

    def read(self, rows: np.ndarray) -> dict[str, np.ndarray]:
        """As `Source.read`."""
        return {name: array[rows] for name, array in self.arrays.items()}


@dataclass(eq=False)
class Inventory:
    """The place of each of the B cases.

    keys : (B, 2); None until a block of a window needs them
    sources : the blocks that hold usable cases
    source, row : index of the source of each case (-1: missing), and row of the case in that source, (B,) int32
    status : (B,) int8, NOT_RUN for a missing case
    blocks : path of every block -> number of its cases, -1 for a damaged block
    unwritten : indices of the sources that are only in memory
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


def laws_in(store: Store) -> dict[str, str]:
    """version -> table of each law of a scan with which cases in the blocks of a study were computed."""
    laws = {}
    for path in store.block_paths() if store.definition.scans else ():
        with suppress(OSError):  # the law is computed again
            laws |= read_facts(path).get(_LAWS, {})
    return laws


def _about(definition: Definition) -> dict:
    """The facts of a block, which has the laws of scans too: they take seconds to compute, and the scan may be gone
    when somebody opens the blocks."""
    known, tables = definition.grid.lexicon.known.laws, definition.tables
    laws = {known[name].version: text for name, text in tables.items()}
    return facts(definition.x, definition.inputs) | ({_LAWS: laws} if laws else {})


def facts(x: np.ndarray, inputs: tuple[str, ...] = ()) -> dict:
    """Everything besides the parameters on which stored numbers depend: the version of the numerics, the points of
    profiles, and the inputs of derivatives."""
    about = {"numerics_version": NUMERICS_VERSION, "x": x.tolist()}
    return about | ({"inputs": list(inputs)} if inputs else {})


def usable(definition: Definition, block: Block) -> bool:
    """Whether a block has everything that the study needs: columns with enough digits, profile points, derivatives."""
    columns, wanted = not_run(definition, 0), facts(definition.x, definition.inputs)
    sizes = {name: array.dtype.itemsize for name, array in block.arrays.items()}
    digits = all(sizes.get(name, 0) >= array.dtype.itemsize for name, array in columns.items())
    points = block.facts.get("x") == wanted["x"] or not definition.profiles
    derivatives = {*definition.inputs} <= {*block.facts.get("inputs", ())}
    return digits and points and derivatives and block.facts.get("numerics_version") == wanted["numerics_version"]


def inventory(store: Store, retry: tuple = ()) -> Inventory:
    """The cases of a window that are in its blocks. Cases with a status in `retry` count as missing."""
    sources, blocks = [], {}
    for path in sorted(store.block_paths()):
        try:
            block = read_block(path)
        except FileNotFoundError:  # it has just been removed
            continue
        except OSError as error:  # its cases are computed again
            if short_of_memory(error):
                raise
            log.warning("%s", error)
            if isinstance(error, (Damaged, Unusable)):  # any other file may be readable later, so it stays
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
    """The keys of the cases of a window, (B, 2). No other window has them. They take half a microsecond a case."""
    return case_keys(store.definition.grid, bool(store.definition.stresses))


def _places(keys: np.ndarray, sources: list[Source], retry: tuple[int, ...]) -> tuple[np.ndarray, ...]:
    """Source, row and status of each case, (B,) each. Of a case in several places the lowest status counts."""
    parts = [(np.empty((0, 2), np.uint64), np.empty(0, np.int32), np.empty(0, np.int32), np.empty(0, np.int8))]
    for number, source in enumerate(sources):
        row = np.flatnonzero(~np.isin(source.status, (NOT_RUN, *retry))).astype(np.int32)
        parts.append((source.keys[row], np.full(len(row), number, np.int32), row, source.status[row]))
    stored, source_numbers, row, status = (np.concatenate(column) for column in zip(*parts, strict=True))
    place = find(keys, stored, status)
    columns = ((source_numbers, -1), (row, -1), (status, NOT_RUN))
    # a missing case has the place -1, the last, where the value of missing cases is appended
    return tuple(np.append(array, array.dtype.type(fill))[place] for array, fill in columns)


def add(store: Store, stock: Inventory, index: np.ndarray, arrays: dict[str, np.ndarray]) -> None:
    """Write a block of the cases at `index` (n,), in the types of the study, and put it into the inventory."""
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
    """Write the blocks that are only in memory.

    In a study of many windows they also stay in memory until the window is written: without locks another run may write
    the window before, and remove its blocks.
    """
    about, places = _about(store.definition), list(range(len(store.definition.inputs)))
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

    If a block of other cases, or a folder, has this name, it stays, and the block gets the next name.
    """
    content = [block.keys.tobytes(), json.dumps(block.facts).encode(), json.dumps(list(block.arrays)).encode()]
    name = hashlib.sha256(b"".join(content)).hexdigest()[:32]
    name = f"{store.window.prefix if store.window else ''}{name}"
    paths = (store.folder / f"{name}{f'-{number}' * (number > 1)}.block" for number in count(1))
    path = next(path for path in paths if not _is_another(path, block))
    write_block(path, block)
    return path


def _is_another(path: Path, block: Block) -> bool:
    """Whether the path is that of a block with other cases, or of something that is not a file."""
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
    """Number of cases in the results of this digest that the study no longer has, and number of all their cases.

    None if no record lists the cases of these results. A record of an earlier version does not name its study.
    """
    try:
        record = read_block(store.record(digest))
    except OSError:
        return None
    if record.facts.get("study_digest", digest) != digest:  # a copy of another record
        return None
    rows = find(record.keys, keys_of(store), np.zeros(store.definition.grid.size))
    return int(np.count_nonzero(rows < 0)), len(record.keys)

"""One block on disk: arrays as `numpy.save` writes them, one after another, and a checksum of the whole file.

The first array is a text in JSON: the facts and the names of the columns. The keys of the cases and the columns follow.
The file is not netCDF, because any thread must be able to read and write it. No array holds Python objects, so reading
it executes nothing. It is not an archive of `numpy.savez`, which takes twice as long: 14 ms to write and 18 ms to read
8,000 cases, against 8 and 8.
"""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..files.access import has_room
from ..files.atomic import replacing
from ..files.netcdf import check_regular
from ..files.seal import is_whole, seal
from ..terminal import short_of_memory


class Damaged(OSError):
    """A file that is not a block, or has changed since it was written."""


@dataclass(frozen=True, eq=False)
class Block:
    """Columns of n cases.

    facts : everything besides the cases on which the numbers depend (JSON)
    keys : of the cases, (n, 2) uint64
    arrays : name -> (n, ...)
    """

    facts: dict
    keys: np.ndarray
    arrays: dict[str, np.ndarray]


def write_block(path: Path, block: Block) -> None:
    """Write a block, completely or not at all. May raise OSError."""
    head = np.array(json.dumps({"facts": block.facts, "columns": list(block.arrays)}))
    with replacing(path) as temporary:
        with open(temporary, "wb") as file:
            try:
                for array in (head, block.keys, *block.arrays.values()):
                    np.save(file, array, allow_pickle=False)
            except OSError as error:
                if error.errno is None and has_room(temporary):
                    raise MemoryError(f"{path} cannot be written, though the disk has room: {error}") from error
                if error.errno is None:  # numpy says how much of an array was written, but not why
                    raise OSError(f"{path} cannot be written ({error}): is the disk full?") from error
                raise
        seal(temporary)


def read_facts(path: Path) -> dict:
    """The facts of a block alone. Raises as `read_block`."""
    check_regular(path)
    try:
        if not is_whole(path):
            raise ValueError("it was not written completely")
        with open(path, "rb") as file:
            return dict(json.loads(str(np.load(file, allow_pickle=False)))["facts"])
    except (ValueError, KeyError, TypeError, EOFError) as error:
        raise Damaged(f"{path}: is not a complete block: {error}") from error


def read_block(path: Path) -> Block:
    """The block in a file. Raises Damaged, Unusable for a folder or a pipe, OSError when it cannot be read, or
    MemoryError."""
    check_regular(path)
    remedy = "the same command computes its cases again"
    if not is_whole(path):
        raise Damaged(f"{path}: is not a complete block; {remedy}")
    try:
        with open(path, "rb") as file:
            head = json.loads(str(np.load(file, allow_pickle=False)))
            keys, *arrays = (np.load(file, allow_pickle=False) for _ in range(1 + len(head["columns"])))
        block = Block(head["facts"], keys, dict(zip(head["columns"], arrays, strict=True)))
        if keys.dtype != np.uint64 or keys.shape[1:] != (2,) or {len(keys), *map(len, arrays)} != {len(keys)}:
            raise ValueError("its columns are not as long as its keys")
        return block
    except Exception as error:
        if short_of_memory(error) or getattr(error, "errno", None):
            raise
        # the checksum fits, but the content does not: another program wrote the file
        raise Damaged(f"{path}: is not a complete block; {remedy}") from error

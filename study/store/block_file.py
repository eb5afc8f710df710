"""One block on disk: a line of JSON, the keys of its cases, its columns as raw numbers, and a checksum of all that.

Not netCDF: this may be read and written by any thread, and a checksum covers all of it. Nothing in it is executable.
"""

import hashlib
import json
import math
import stat
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..files.atomic import replacing

MAGIC = b"roughcoat block 1\n"
CHECK = hashlib.sha256().digest_size


class Damaged(OSError):
    """What is no block, or no longer the one that was written. is_file : it is a file, of whatever content."""

    is_file = True


@dataclass(frozen=True, eq=False)
class Block:
    """facts : what the numbers depend on besides the cases (JSON); keys : (n, 2) uint64; arrays : name -> (n, ...)."""

    facts: dict
    keys: np.ndarray
    arrays: dict[str, np.ndarray]


class NoFile(Damaged):
    """A folder, a pipe or a device."""

    is_file = False


def write_block(path: Path, block: Block) -> None:
    """Write a block: whole, or not at all. May raise OSError."""
    columns = [[name, array.dtype.str, array.shape] for name, array in block.arrays.items()]
    head = json.dumps({"facts": block.facts, "cases": len(block.keys), "columns": columns}).encode() + b"\n"
    arrays = [np.ascontiguousarray(array).data.cast("B") for array in (block.keys, *block.arrays.values())]
    checksum = hashlib.sha256()
    with replacing(path) as temporary, open(temporary, "wb") as file:
        for piece in (MAGIC, head, *arrays):
            checksum.update(piece)
            file.write(piece)
        file.write(checksum.digest())


def read_block(path: Path) -> Block:
    """The block in a file. Raises Damaged, or OSError when it cannot be read."""
    if not stat.S_ISREG(path.stat().st_mode):  # a pipe would be waited for
        raise NoFile(f"{path}: is no file, so no block")
    data = path.read_bytes()
    try:
        if not data.startswith(MAGIC) or checksum_of(memoryview(data)[:-CHECK]) != data[-CHECK:]:
            raise ValueError
        end = data.index(b"\n", len(MAGIC)) + 1
        head = json.loads(data[len(MAGIC) : end])
        arrays, place = {}, end
        for name, dtype, shape in [["", "<u8", (head["cases"], 2)], *head["columns"]]:
            arrays[name] = np.frombuffer(data, dtype, math.prod(shape), place).reshape(shape)
            place += arrays[name].nbytes
        return Block(head["facts"], arrays.pop(""), arrays)
    except (ValueError, KeyError, TypeError) as error:
        raise Damaged(f"{path}: is no whole block; the same command computes its cases again") from error


def checksum_of(data) -> bytes:
    return hashlib.sha256(data).digest()

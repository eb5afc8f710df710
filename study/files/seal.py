"""A checksum of a whole results file, which stands behind what HDF5 reads of it.

HDF5 trusts what a file says of itself, and a flipped bit there may end the interpreter. So a file whose seal is broken
or missing is first examined in another process (`examine`). If that process survives, this one reads the intact cases.
"""

import os
import zlib
from pathlib import Path

MARK = b"\nroughcoat crc32 "
LENGTH = len(MARK) + 8  # and the checksum in hexadecimal digits
PIECE = 1 << 20
LARGE = 256_000_000  # bytes, summed in some tenths of a second; more are not read where no number is asked for


def seal(path: Path) -> None:
    """Append the checksum to a file that is complete. Other programs read it as before; HDF5 knows where it ends."""
    with open(path, "rb+") as file:
        found = _checksum(file, os.fstat(file.fileno()).st_size)
        file.write(MARK + b"%08x" % found)


def is_whole(path: Path, most: float = float("inf")) -> bool:
    """Whether a file has its seal, unbroken. Of a file of more than `most` bytes, whether it has one."""
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size - LENGTH
        if size < 0:
            return False
        file.seek(size)
        end = file.read(LENGTH)
        if size > most:
            return end.startswith(MARK)
        file.seek(0)
        return end == MARK + b"%08x" % _checksum(file, size)


def _checksum(file, size: int) -> int:
    """CRC-32 of the next `size` bytes."""
    found = 0
    while size > 0:
        piece = file.read(min(size, PIECE))
        if not piece:
            break
        found, size = zlib.crc32(piece, found), size - len(piece)
    return found

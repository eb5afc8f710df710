"""The seal: a checksum of a whole results file, behind the end of its HDF5 data.

HDF5 trusts what a file says of itself, so a flipped bit may crash the interpreter. A file whose seal is broken or
missing is therefore examined in a child process first (`examine`). If that survives, this process reads the intact
cases.
"""

import os
import zlib
from pathlib import Path

MARK = b"\nroughcoat crc32 "
LENGTH = len(MARK) + 8  # and the checksum in hexadecimal digits
PIECE = 1 << 20
LARGE = 256_000_000  # bytes, summed in some tenths of a second; larger files are summed only with all their numbers


def seal(path: Path) -> None:
    """Append the seal to a complete file. Other programs read it as before, since HDF5 data tell their own length."""
    with open(path, "rb+") as file:
        found = _checksum(file, os.fstat(file.fileno()).st_size)
        file.write(MARK + b"%08x" % found)


def is_whole(path: Path, most: float = float("inf")) -> bool:
    """Whether the seal of a file is there and right. In a file of more than `most` bytes, whether it is there."""
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
    while piece := file.read(min(size, PIECE)):
        found, size = zlib.crc32(piece, found), size - len(piece)
    return found

"""The seal: a checksum of all bytes of a block or a results file, appended to it.

HDF5 trusts the content of a file, so a flipped bit may crash the interpreter, or make HDF5 run for ever. A results file
with a broken seal is therefore never opened by HDF5.
"""

import os
import zlib
from pathlib import Path

MARK = b"\nroughcoat crc32 "
LENGTH = len(MARK) + 8  # of the mark and the checksum in hexadecimal digits
PIECE = 1 << 20


def seal(path: Path) -> None:
    """Append the seal to a complete file. Other programs can still read the file: HDF5 data state their own length."""
    with open(path, "rb+") as file:
        checksum = _checksum(file, os.fstat(file.fileno()).st_size)
        file.write(MARK + b"%08x" % checksum)


def is_whole(path: Path) -> bool | None:
    """Whether the seal of a file is right; None without a seal, as after another program has written the file."""
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size - LENGTH
        if size < 0:
            return None
        file.seek(size)
        end = file.read(LENGTH)
        if not end.startswith(MARK):
            return None
        file.seek(0)
        return end == MARK + b"%08x" % _checksum(file, size)


def _checksum(file, size: int) -> int:
    """CRC-32 of the next `size` bytes."""
    checksum = 0
    while piece := file.read(min(size, PIECE)):
        checksum, size = zlib.crc32(piece, checksum), size - len(piece)
    return checksum

"""The one door through which a file of a user is opened: a pipe is not waited for, nothing endless fills the memory.

Tables, curves, scans, lists of materials and study files come through it (tests/repository/test_user_files.py).
"""

import errno
import gzip
import io
import os
import stat
import zipfile
import zlib
from pathlib import Path

#: Most bytes of a text, unpacked. Its rows take some ten times as much memory while they are read.
LARGEST_TEXT = 200_000_000
#: Most bytes of a file of an instrument, and of all that is packed in it.
LARGEST = 2_000_000_000
_GZIP, _ZIP = b"\x1f\x8b", b"PK\x03\x04"


class NoFile(ValueError):
    """A path leads to a pipe or a device."""


class TooLarge(ValueError):
    """A file has more bytes than its reader takes."""


def opened(path, most=LARGEST):
    """The file, open for reading bytes.

    Raises :class:`NoFile` for a pipe, which would be waited for, and for a device, which may have no end;
    :class:`TooLarge` for more than `most` bytes; OSError where it cannot be opened, a folder among them. The messages
    do not name the file.
    """
    _check(Path(path).stat(), most)  # before it is opened: to open a device may do something
    number = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    try:
        _check(os.fstat(number), most)  # it may have become a pipe
    except (OSError, ValueError):
        os.close(number)
        raise
    return open(number, "rb")


def content(path, most=LARGEST):
    """The bytes of a file. Raises as `opened`."""
    with opened(path, most) as file:
        # no more than its size: files of /proc, some of which have no end, have the size 0
        return file.read(os.fstat(file.fileno()).st_size)


def begins(path, most=LARGEST, size=65_536):
    """The first bytes of a file, unpacked where gzip has packed them. Raises as `opened`."""
    with opened(path, most) as file:
        raw = file.read(size)
    if raw.startswith(_GZIP):
        try:
            return gzip.GzipFile(fileobj=io.BytesIO(raw)).read1(size)
        except (OSError, EOFError, zlib.error):  # who reads it all says so
            return b""
    return raw


def unpacked(raw, most=LARGEST):
    """The bytes of a file, unpacked where gzip has packed them. Raises ValueError for a damaged packing, and
    :class:`TooLarge` for more than `most` bytes, of which no more are unpacked."""
    if raw.startswith(_GZIP):
        try:
            raw = gzip.GzipFile(fileobj=io.BytesIO(raw)).read(most + 1)
        except (OSError, EOFError, zlib.error) as error:
            raise ValueError(f"the packed file is damaged: {error}") from error
    if len(raw) > most:
        raise TooLarge(f"has more than {most} bytes once unpacked: must have at most that")
    return raw


def checked(path, most=LARGEST):
    """The path of a file that a library may open. Raises as `opened`, :class:`TooLarge` also for a file in a zip."""
    with opened(path, most) as file:
        begins = file.read(len(_ZIP))
        file.seek(0)
        if begins == _ZIP:
            try:
                with zipfile.ZipFile(file) as archive:
                    size = sum(member.file_size for member in archive.infolist())
            except (OSError, ValueError, NotImplementedError, zipfile.BadZipFile):
                size = 0  # the library says what is wrong
            if size > most:
                raise TooLarge(f"has {size} bytes once unpacked: must have at most {most}")
    return Path(path)


def _check(status, most):
    """Raise for the `os.stat_result` of no plain file, or of one that is too large."""
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not stat.S_ISREG(status.st_mode):
        raise NoFile("is not a file but a pipe or device")
    if status.st_size > most:
        raise TooLarge(f"has {status.st_size} bytes: must have at most {most}")

"""The only place where a user's file is opened: the program never waits for a pipe, and nothing endless fills the
memory.

Tables, curves, scans, lists of materials and study files are opened here (tests/repository/test_user_files.py).
"""

import contextlib
import errno
import gzip
import io
import os
import stat
import zipfile
import zlib
from contextvars import ContextVar
from pathlib import Path

#: Most bytes of a text, unpacked. Its rows take some ten times as much memory while they are read.
LARGEST_TEXT = 200_000_000
#: Most bytes of a file of an instrument, and of everything packed in it.
LARGEST = 2_000_000_000
_GZIP, _ZIP = b"\x1f\x8b", b"PK\x03\x04"
#: The folder of the study file that this thread is reading.
_folder: ContextVar[Path | None] = ContextVar("folder", default=None)


class NoFile(ValueError):
    """A path leads to a pipe or a device."""


class TooLarge(ValueError):
    """A file has more bytes than its reader takes."""


@contextlib.contextmanager
def in_folder_of(study_file):
    """Inside it `place` looks for the files that words name in the folder of a study file first."""
    token = _folder.set(Path(study_file).parent)
    try:
        yield
    finally:
        _folder.reset(token)


def place(file):
    """The path of a file that a word such as "table:FILE" names: in the folder of the study file that is being read, if
    it is there; otherwise from the working folder. Raises ValueError for ~name/ of a user who does not exist."""
    folder = _folder.get()
    try:
        path = Path(file).expanduser()
    except RuntimeError as error:
        raise ValueError(str(error)) from None
    return folder / path if folder is not None and (folder / path).exists() else path


def opened(path, most=LARGEST):
    """The file, open for reading bytes.

    Raises :class:`NoFile` for a pipe, for which the program would wait, and for a device, which may have no end;
    :class:`TooLarge` for more than `most` bytes; OSError for a path that cannot be opened, or that leads to a folder.
    The messages do not name the file.
    """
    _check(Path(path).stat(), most)  # first, because opening a device may have an effect
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
        # reads no more than the size: files of /proc, some of which have no end, have the size 0
        return file.read(os.fstat(file.fileno()).st_size)


def begins(path, most=LARGEST, size=65_536):
    """The first bytes of a file, unpacked if gzip has packed them. Raises as `opened`."""
    with opened(path, most) as file:
        raw = file.read(size)
    if raw.startswith(_GZIP):
        try:
            return gzip.GzipFile(fileobj=io.BytesIO(raw)).read1(size)
        except (OSError, EOFError, zlib.error):  # `unpacked`, which reads the whole file, reports the damage
            return b""
    return raw


def unpacked(raw, most=LARGEST):
    """The bytes of a file, unpacked if gzip has packed them. Raises ValueError for a damaged archive, and
    :class:`TooLarge` for more than `most` bytes; no more than these are unpacked."""
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
        magic = file.read(len(_ZIP))
        file.seek(0)
        if magic == _ZIP:
            try:
                with zipfile.ZipFile(file) as archive:
                    size = sum(member.file_size for member in archive.infolist())
            except (OSError, ValueError, NotImplementedError, zipfile.BadZipFile):
                size = 0  # the library will report what is wrong
            if size > most:
                raise TooLarge(f"has {size} bytes once unpacked: must have at most {most}")
    return Path(path)


def _check(status, most):
    """Raise if `status`, an `os.stat_result`, is not that of a plain file, or if the file is too large."""
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not stat.S_ISREG(status.st_mode):
        raise NoFile("is not a file but a pipe or device")
    if status.st_size > most:
        raise TooLarge(f"has {status.st_size} bytes: must have at most {most}")

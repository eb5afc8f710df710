"""The only room that touches netCDF: one thread at a time, whichever thread it is.

Neither netCDF nor HDF5 bears two threads at once, even on different files: the interpreter crashes, or a good file
seems damaged. All that is done here is done under the lock that xarray takes for the datasets it opens, so a program
may run studies, ask for their state, open results and read lazily opened ones in any threads. Worker processes and the
threads that solve never come here: they return arrays.
"""

import os
import signal
import stat
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import netCDF4
import xarray as xr
from xarray.backends.netCDF4_ import NETCDF4_PYTHON_LOCK

from ..spec.definition import StudyError

try:
    import fcntl
except ImportError:  # not POSIX
    fcntl = None

HDF5 = b"\x89HDF\r\n\x1a\n"
END = {0: 40, 1: 44, 2: 28, 3: 28}
"""Version of the superblock, byte 8 of a file of HDF5 -> place of the 8 bytes that say how long the file is."""


class Unusable(StudyError, OSError):
    """A results file that cannot be used. `kind`: "damaged", "foreign" (none of ours) or "unreadable"."""

    code = 1

    def __init__(self, path: Path, kind: str, reason: str):
        self.kind, self.reason = kind, reason
        super().__init__([f"{path}: {reason}"])


class Access:
    """The lock, for what is done with the file `path`. A thread that holds it may take it again.

    Errors of the library leave it as `Unusable`, or as OSError when the file is being written. xarray takes it as the
    lock of a dataset, which may go to another process.
    """

    _mine = threading.RLock()  # xarray's lock blocks a thread that holds it; always taken in this order
    _depth = 0

    def __init__(self, path, writing: bool = False):
        self.path, self.writing = Path(path), writing

    def acquire(self, blocking: bool = True) -> bool:
        if not Access._mine.acquire(blocking):
            return False
        try:
            again = Access._depth and blocking  # xarray does not block when it closes what is garbage, at any moment
            taken = again or NETCDF4_PYTHON_LOCK.acquire(blocking)
        except BaseException:
            Access._mine.release()
            raise
        if not taken:
            Access._mine.release()
            return False
        Access._depth += 1
        return True

    def release(self) -> None:
        Access._depth -= 1
        if not Access._depth:
            NETCDF4_PYTHON_LOCK.release()
        Access._mine.release()

    def locked(self) -> bool:
        return NETCDF4_PYTHON_LOCK.locked()

    def __enter__(self) -> None:
        self.acquire()

    def __exit__(self, _, error, __) -> None:
        self.release()
        if isinstance(error, (RuntimeError, AttributeError)) and str(error).startswith("NetCDF: "):
            if self.writing:
                raise OSError(f"{self.path} cannot be written ({error}): is the disk full?") from error
            raise Unusable(self.path, "damaged", f"is damaged: a part of it cannot be read ({error})") from error


@contextmanager
def access(path, writing: bool = False) -> Iterator[None]:
    """Hold the lock, and SIGINT and SIGTERM back: an exception while locks are taken would leave one locked."""
    with interrupts_wait(), Access(path, writing):
        yield


@contextmanager
def interrupts_wait() -> Iterator[None]:
    """Hold SIGINT and SIGTERM back until the block is left."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    pending = []
    kinds = (signal.SIGINT, signal.SIGTERM)
    previous = {kind: signal.signal(kind, lambda number, _: pending.append(number)) for kind in kinds}
    try:
        yield
    finally:
        for kind, handler in previous.items():
            signal.signal(kind, handler or signal.SIG_DFL)
        if pending:
            signal.raise_signal(pending[0])


if hasattr(os, "register_at_fork"):  # a child has the lock of no thread that is not there, and no half-done work
    _forking = Access("")
    os.register_at_fork(before=_forking.acquire, after_in_parent=_forking.release, after_in_child=_forking.release)


def opened(path: Path) -> netCDF4.Dataset:
    """A file to be read, open; reading and closing it want `access`. Raises FileNotFoundError, Unusable."""
    check_regular(path)
    with access(path):
        try:
            found = netCDF4.Dataset(path)
        except OSError as error:
            raise _cannot_be_opened(path, error) from error
        found.set_auto_maskandscale(False)
        return found


def created(path: Path) -> netCDF4.Dataset:
    """A new file, open; writing and closing it want `access`."""
    with access(path, writing=True):
        return netCDF4.Dataset(path, "w")


@contextmanager
def closing(file: netCDF4.Dataset, path: Path, writing: bool = False) -> Iterator[netCDF4.Dataset]:
    """Close the file at the end, under the lock."""
    try:
        yield file
    except BaseException:
        with access(path), suppress(RuntimeError):  # of a full disk; the first error is the one to tell
            file.close()
        raise
    with access(path, writing):
        file.close()


def read(path: Path) -> xr.Dataset:
    """All of a file, in memory."""
    check_regular(path)
    with access(path), xr.open_dataset(path, engine="netcdf4", lock=Access(path)) as dataset:
        return dataset.load()


def read_lazily(path: Path) -> xr.Dataset:
    """A file as dask arrays in its chunks: numbers are read when they are asked for, under the lock."""
    check_regular(path)
    with access(path):
        return xr.open_dataset(path, engine="netcdf4", chunks={}, lock=Access(path))


def check_regular(path: Path) -> None:
    """Raise Unusable for a FIFO, which would be waited for, or a folder; FileNotFoundError when there is nothing."""
    try:
        mode = Path(path).stat().st_mode
    except (FileNotFoundError, NotADirectoryError) as error:
        raise FileNotFoundError(2, "No such file", os.fspath(path)) from error
    except OSError as error:
        raise Unusable(path, "unreadable", f"cannot be read: {error.strerror}") from error
    if not stat.S_ISREG(mode):
        raise Unusable(path, "foreign", f"is no file but a {'folder' if stat.S_ISDIR(mode) else 'pipe or device'}")


def _cannot_be_opened(path: Path, error: OSError) -> Exception:
    """What is the matter with a file that the library does not open; it says -101 to most of it."""
    try:
        with open(path, "rb") as file:
            head, size = file.read(64), os.fstat(file.fileno()).st_size
            locked = _is_locked(file)
    except OSError as reason:
        return Unusable(path, "unreadable", f"cannot be read: {reason.strerror}")
    if locked:
        return Unusable(path, "unreadable", "is open for writing in another program, which has locked it")
    if not head.startswith(HDF5):
        return Unusable(path, "foreign", "is empty" if not size else "is no netCDF file")
    place = END.get(head[8] if len(head) > 8 else -1, 64)
    length = int.from_bytes(head[place : place + 8], "little")
    if len(head) < place + 8 or size < length:
        return Unusable(path, "damaged", f"is damaged: cut off, {size} bytes" + f" of {length}" * (length > size))
    return Unusable(path, "damaged", f"is damaged: cannot be opened ({error.strerror or error})")


def _is_locked(file) -> bool:
    """Whether another program holds the lock that HDF5 takes on a file it writes."""
    if fcntl is None:
        return False
    try:
        fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:  # no locks on this file system
        pass
    return False

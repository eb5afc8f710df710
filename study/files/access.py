"""The lock that lets one thread at a time use netCDF.

With two threads in netCDF or HDF5, even on different files, the interpreter crashes, or a good file seems damaged. The
module `netcdf` does everything under the lock that xarray takes for the datasets that it opens. So any thread of a
program may run studies, ask for their state, open results and read lazily opened results. Worker processes, and threads
that solve, do not use netCDF: they return arrays.
"""

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from xarray.backends.netCDF4_ import NETCDF4_PYTHON_LOCK

from ..inputs.definition import StudyError
from ..terminal import short_of_memory
from .seal import is_whole

NEEDED = 256_000_000  # bytes; memory that was in use when the error came is free by now


class Unusable(StudyError, OSError):
    """A results file that cannot be used. `kind`: "damaged", "foreign" (not written by roughcoat) or "unreadable"."""

    def __init__(self, path: Path, kind: str, reason: str):
        self.kind, self.reason = kind, reason
        super().__init__([f"{path}: {reason}"], code=1)


class Access:
    """The lock of xarray for netCDF, for work on the file `path`. A thread that holds it may take it again.

    As a context manager it turns errors of netCDF into `Unusable`, or into OSError while the file `writing` is written.
    NetCDF has one error for a damaged file, a full disk, and a lack of memory. It becomes MemoryError where memory is
    short and the file is whole, or the disk has room. The class has the methods of a lock because xarray uses it as
    one; it can be sent to another process with a dataset.
    """

    _mine = threading.RLock()  # taken first: the lock of xarray would block a thread that already holds it
    _depth = 0  # number of times that the holder has taken the lock

    def __init__(self, path, writing: Path | None = None):
        self.path, self.writing = Path(path), writing

    def acquire(self, blocking: bool = True) -> bool:
        if not Access._mine.acquire(blocking):
            return False
        is_taken = False
        try:
            # Without `blocking`, xarray closes a dataset that nobody uses. That may happen in the middle of other work
            # of this thread in netCDF, and must fail then.
            holds_already = Access._depth > 0 and blocking
            is_taken = holds_already or NETCDF4_PYTHON_LOCK.acquire(blocking)
        finally:
            Access._depth += is_taken
            if not is_taken:
                Access._mine.release()
        return is_taken

    def release(self) -> None:
        Access._depth -= 1
        if not Access._depth:
            NETCDF4_PYTHON_LOCK.release()
        Access._mine.release()

    def __enter__(self) -> None:
        self.acquire()

    def __exit__(self, _, error, __) -> None:
        self.release()
        if isinstance(error, (RuntimeError, AttributeError)) and str(error).startswith("NetCDF: "):
            what = "written" if self.writing else "read"
            if memory_is_short() and (has_room(self.writing) if self.writing else are_whole(self.path)):
                raise MemoryError(f"{self.path} cannot be {what}: {error}") from error
            if self.writing:
                why = "" if has_room(self.writing) else ": is the disk full?"
                raise OSError(f"{self.path} cannot be written ({error}){why}") from error
            raise Unusable(self.path, "damaged", f"is damaged: a part of it cannot be read ({error})") from error


def memory_is_short() -> bool:
    """Whether memory is too short for netCDF, which needs chunks of some megabytes."""
    try:
        np.empty(NEEDED, np.uint8)
    except MemoryError:
        return True
    return False


def has_room(path: Path) -> bool:
    """Whether a file that could not be written can grow by a megabyte."""
    try:
        with open(path, "ab") as file:
            file.write(bytes(1 << 20))
    except (OSError, MemoryError) as error:
        return short_of_memory(error)
    return True


def are_whole(path: Path) -> bool:
    """Whether the seal of a file is right, or the seals of all parts in a folder: then nothing in it is damaged."""
    try:
        files = sorted(path.glob("*.nc")) if path.is_dir() else [path]
        return bool(files) and all(file.is_file() and is_whole(file) for file in files)
    except OSError:
        return False


@contextmanager
def access(path, writing: Path | None = None) -> Iterator[None]:
    """Hold the lock, and delay SIGINT and SIGTERM: their exception could leave a lock locked."""
    with interrupts_wait(), Access(path, writing):
        yield


@contextmanager
def interrupts_wait() -> Iterator[None]:
    """Delay SIGINT and SIGTERM until the end of the `with` block."""
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


if hasattr(os, "register_at_fork"):  # a forked child must not inherit a lock from a thread that it lacks
    _forking = Access("")
    os.register_at_fork(before=_forking.acquire, after_in_parent=_forking.release, after_in_child=_forking.release)

"""One thread at a time in netCDF, whichever thread it is.

Neither netCDF nor HDF5 bears two threads at once, even on different files: the interpreter crashes, or a good file
seems damaged. All that is done in `netcdf` is done under the lock that xarray takes for the datasets it opens, so a
program may run studies, ask for their state, open results and read lazily opened ones in any threads. Worker processes
and the threads that solve never come here: they return arrays.
"""

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from xarray.backends.netCDF4_ import NETCDF4_PYTHON_LOCK

from ..spec.definition import StudyError


class Unusable(StudyError, OSError):
    """A results file that cannot be used. `kind`: "damaged", "foreign" (none of ours) or "unreadable"."""

    code = 1

    def __init__(self, path: Path, kind: str, reason: str):
        self.kind, self.reason = kind, reason
        super().__init__([f"{path}: {reason}"])


class Access:
    """The lock, taken for some work on the file `path`. A thread that holds it may take it again.

    As a context manager it turns errors of netCDF into `Unusable`, or into OSError when the file is written. It has the
    methods of a lock because xarray takes it for one, and may send it to another process with a dataset.
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

"""Advisory locks: one run at a time in a folder. The system releases a lock when its holder dies, however it dies."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .atomic import make_folder

try:
    import fcntl
except ImportError:  # not POSIX: two runs at once compute the same blocks twice, which harms nothing
    fcntl = None


@contextmanager
def lock_file(
    path: Path, *, shared: bool = False, wait: bool = True, waiting: Callable = lambda: None
) -> Iterator[bool]:
    """Hold the lock file `path`, whose folder is made if it is missing; yields whether the lock is held.

    shared : whether other processes may hold the lock shared at the same time
    wait : whether to call `waiting` and wait for a lock that is not free; otherwise False is yielded at once

    On a file system without locks it counts as held: every file is written under a unique name and then renamed.
    """
    file = _opened(path)
    try:
        mine = locked(file, shared, wait, waiting)
        while mine and not _is_at(file, path):  # the last holder removed the folder while this one waited
            os.close(file)
            file = _opened(path)
            mine = locked(file, shared, wait, waiting)
        yield mine
    finally:
        os.close(file)  # releases it


def _opened(path: Path) -> int:
    while True:
        make_folder(path.parent)
        with suppress(FileNotFoundError):  # the folder has just been removed
            return os.open(path, os.O_RDWR | os.O_CREAT, 0o666)


def locked(file: int, shared: bool, wait: bool, waiting: Callable = lambda: None) -> bool:
    """Take the lock of an open file, until it is closed; see `lock_file`. Returns whether it is held."""
    if fcntl is None:
        return True
    kind = fcntl.LOCK_SH if shared else fcntl.LOCK_EX
    try:
        fcntl.flock(file, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        if not wait:
            return False
        waiting()
        fcntl.flock(file, kind)
    except OSError:  # no locks on this file system
        return True
    return True


def _is_at(file: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(file), path.stat())
    except FileNotFoundError:
        return False

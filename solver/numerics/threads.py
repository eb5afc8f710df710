"""One BLAS thread while the solver computes.

Its matrices are small: threads that share them gain nothing, and spin while other processes keep the processors busy
(docs/threads.md).
"""

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from threading import Lock

from threadpoolctl import LibController, ThreadpoolController


class _OfTheProcess:
    """For libraries with one number of threads for the whole process: it is 1 from the first entry to the last exit.

    Calls of several threads overlap. If each call restored the number that it had read, 1 could stay for ever: a second
    call reads the 1 that the first has set, and restores it after the first has ended.
    """

    def __init__(self, libraries: list[LibController]):
        self._libraries, self._lock, self._inside, self._before = libraries, Lock(), 0, {}
        if hasattr(os, "register_at_fork"):
            os.register_at_fork(after_in_child=self._forked)

    def __enter__(self) -> None:
        with self._lock:
            self._inside += 1
            for library in self._libraries:
                if library.num_threads != 1:  # the first call, or the user has just set it
                    self._before[library] = library.num_threads
                    _set(library, 1)

    def __exit__(self, *_) -> None:
        with self._lock:
            self._inside -= 1
            if not self._inside:
                self._restore()

    def _restore(self) -> None:
        for library, count in self._before.items():
            if library.num_threads == 1:  # else the user has set it meanwhile
                _set(library, count)
        self._before.clear()

    def _forked(self) -> None:
        """Start anew in a forked process, which has none of the threads that were computing."""
        self._lock, self._inside = Lock(), 0
        self._restore()


def _set(library: LibController, count: int) -> None:
    """Set the number of threads of a library, whichever thread calls.

    From version 3.8 on, threadpoolctl obeys only the thread that was the first to set the number of a whole process.
    Here this is switched off: the lock and the count of :class:`_OfTheProcess` take its place.
    """
    let_go = getattr(library, "clear_controlling_thread", lambda force: None)
    let_go(force=True)
    library.set_num_threads(count)
    let_go(force=True)


@lru_cache(maxsize=1)
def _blas() -> tuple[_OfTheProcess, ThreadpoolController]:
    """The loaded BLAS libraries: those with one number of threads for the process, and those with one for each
    thread."""
    with warnings.catch_warnings():  # they are about OpenMP libraries of the user's program, which is not our affair
        warnings.simplefilter("ignore")
        blas = ThreadpoolController().select(user_api="blas")
    of_threads = blas.select(threading_layer="openmp")
    of_process = [library for library in blas.lib_controllers if library not in of_threads.lib_controllers]
    return _OfTheProcess(of_process), of_threads


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """BLAS on one thread inside a ``with`` block or a decorated function; then as before, whatever happened inside.

    Blocks may be nested, and may overlap in several threads. Most BLAS libraries have one number for the process, so
    other threads of the program meanwhile have one BLAS thread too. A number that the program sets stays.
    """
    of_process, of_threads = _blas()
    with of_process, of_threads.limit(limits=1):
        yield

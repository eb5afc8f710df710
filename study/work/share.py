"""A grid that is solved in one call: block by block in the calling thread, and where much is left by processes as well.

The blocks depend on the grid alone, and a block has the same numbers wherever it is computed: those of one worker are
those of many, bit for bit. The processes are those of `study.work.processes`. They import this package and not the
program that calls, so that a script needs no guard, and they wait for the next call for a while.
"""

import atexit
import logging
import multiprocessing
import os
import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import numpy as np

from ..spec.block_size import USUAL, usual_block
from ..spec.definition import Definition
from .cases import Failure, Parcel, compute, guarded, parcel
from .processes import Processes
from .workers import available_workers

log = logging.getLogger(__name__)
#: Cases of a block, about: 60,000 layered cases take within 5 % of the processor time of a single batch from 8000 cases
#: a block on, 15 % more at 4000. And of cases of which one may take some milliseconds.
BLOCK, OF_SLOW = 10_000, 2000
#: Seconds of work in the calling thread for which it pays to start a process: it answers after 1 to 2 s.
START = 2.0


class _Kept:
    """Processes that wait for the next call, each with a thread that feeds it; those of this process only."""

    def __init__(self):
        self.count, self._threads, self._processes, self._owner = 0, None, None, 0

    def reuse(self, most: int) -> int:
        """How many there are to begin with, `most` at most."""
        if self._owner != os.getpid():  # none, or those of the process that this one was forked from
            self.count = 0
        return min(self.count, most)

    def feed(self, feeder: Callable, count: int) -> list[Future]:
        """So many threads that call feeder(call); call(function, given) computes in a process."""
        if self.reuse(count) < count:
            self.end()
            self.count, self._owner, self._processes = count, os.getpid(), Processes()
            self._threads = ThreadPoolExecutor(count)
        return [self._threads.submit(feeder, self._processes.call) for _ in range(count)]

    def end(self) -> None:
        """End them, whatever they compute."""
        if self.reuse(1):
            self._threads.shutdown(wait=False, cancel_futures=True)
            self._processes.end()
        self.count = 0


_kept, _in_use = _Kept(), threading.Lock()
atexit.register(_kept.end)


def solved(definition: Definition, workers: int | None = None) -> dict[str, np.ndarray]:
    """The columns of all cases of a grid: name -> (B, ...).

    workers : most processors to be used; 1: the calling thread alone; None: all, where `_beside` finds nothing against
    """
    blocks = cut(definition)
    if len(blocks) == 1:
        return compute(parcel(definition, blocks[0]))
    most = min(_beside(definition, workers), len(blocks) - 1)
    if not most or not _in_use.acquire(blocking=False):  # another thread is using them
        return _together(definition, blocks, 0)
    try:
        return _together(definition, blocks, most)
    except BaseException:
        _kept.end()
        raise
    finally:
        _in_use.release()


def cut(definition: Definition) -> list[np.ndarray]:
    """The numbers of the cases of each block: of about equal sizes."""
    size = definition.grid.size
    slow = size > OF_SLOW and usual_block(definition.grid) < USUAL
    return np.array_split(np.arange(size), max(1, round(size / (OF_SLOW if slow else BLOCK))))


def _beside(definition: Definition, workers: int | None) -> int:
    """How many processes there may be beside the calling thread.

    None, if nothing is said, in a thread or process of something that divides work itself, such as dask or
    multiprocessing; and never where Python cannot start another Python, or for a law that only this program knows.
    """
    own = parcel(definition, np.arange(1)).laws
    parts = [part for law in own for part in vars(law).values() if callable(part)]
    if not _is_python() or any(getattr(part, "__module__", "") == "__main__" for part in parts):
        return 0
    if workers is not None:
        return workers - 1
    divided = multiprocessing.parent_process() or threading.current_thread() is not threading.main_thread()
    return 0 if divided else available_workers() - 1


def _is_python() -> bool:
    """Whether `sys.executable` is Python, and not a program that has it inside and would start itself anew."""
    return "python" in Path(sys.executable or "").name.lower() and not getattr(sys, "frozen", False)


def _together(definition: Definition, blocks: list[np.ndarray], most: int) -> dict[str, np.ndarray]:
    """All blocks by this thread, and by at most so many processes if what is left after some blocks is worth it."""
    waiting, done, columns = deque(blocks), deque(), {}

    def feeder(call: Callable) -> None:
        while index := _next(waiting):
            done.append((index[0], _apart(call, parcel(definition, index[0]))))

    begun, feeders = time.perf_counter(), []
    if ready := _kept.reuse(most):
        feeders = _kept.feed(feeder, ready)
    while index := _next(waiting):
        _place(columns, definition, index[0], compute(parcel(definition, index[0])))
        if most and not feeders:
            left = (time.perf_counter() - begun) / (len(blocks) - len(waiting)) * len(waiting)
            feeders = _kept.feed(feeder, min(most, int(left / START)))
        while ended := _next(done):
            _place(columns, definition, *ended[0])
    for one in feeders:
        one.result()  # what a feeder fails of is raised here: its cases would be missing
    while ended := _next(done):
        _place(columns, definition, *ended[0])
    return columns


def _next(queue: deque) -> list:
    """[what comes next], [] if nothing does: several threads ask."""
    try:
        return [queue.popleft()]
    except IndexError:
        return []


def _apart(call: Callable, wanted: Parcel) -> dict[str, np.ndarray] | Failure:
    """The columns of a block, computed in a process."""
    try:
        return call(guarded, wanted)
    except Exception as error:  # a law, say, that cannot be sent
        return Failure(str(error), "")


def _place(columns: dict, definition: Definition, index: np.ndarray, found: dict | Failure) -> None:
    """Write those of a block into the columns of the grid; what no process could compute is computed here."""
    if isinstance(found, Failure):
        log.debug("cases %d to %d: %s", index[0], index[-1], found.message)
        found = compute(parcel(definition, index))
    for name, array in found.items():
        if name not in columns:
            columns[name] = np.empty((definition.grid.size, *array.shape[1:]), array.dtype)
        columns[name][index[0] : index[-1] + 1] = array

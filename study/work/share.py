"""`solved`: a whole grid in one call, in the calling thread and, if that takes long, in processes as well.

The blocks depend on the grid alone, and a block has the same numbers wherever it is computed, so one worker and many
give the same bits. The processes are those of `study.work.processes`. They import this package and not the program that
calls, so a script needs no `if __name__ == "__main__"`. They stay for a while, ready for the next call.
"""

import atexit
import logging
import multiprocessing
import os
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import TextIO

import numpy as np

from ..data.dataset import failed_cases
from ..inputs.definition import Definition
from ..inputs.grid import USUAL, usual_block
from ..terminal import counted
from .cases import Failure, can_travel, compute, guarded, parcel
from .processes import Processes
from .progress import Progress
from .workers import available_workers

log = logging.getLogger(__name__)
#: About how many cases a block has. In blocks of 8000 or more, 60,000 layered cases take at most 5 % more processor
#: time than in a single batch; in blocks of 4000 they take 15 % more.
BLOCK = 10_000
SLOW_BLOCK = 2000  # the same where a case may take some milliseconds
#: Seconds of work that must be left for each process that is started. It answers after up to 2 s (`processes.py`), and
#: meanwhile the calling thread goes on.
START = 1.0


class _Pool:
    """Worker processes that stay between calls, with a thread for each that feeds it. A fork does not inherit them."""

    def __init__(self):
        self.count, self._threads, self._processes, self._owner = 0, None, None, 0

    def reuse(self, most: int) -> int:
        """How many processes are there already, `most` at most."""
        if self._owner != os.getpid():  # there are none, or they belong to the process from which this one was forked
            self.count = 0
        return min(self.count, most)

    def feed(self, feeder: Callable, count: int) -> list[Future]:
        """Start feeder(call) in `count` threads; call(function, given) computes in the process of the thread."""
        if self.reuse(count) < count:
            self.end()
            self.count, self._owner, self._processes = count, os.getpid(), Processes()
            self._threads = ThreadPoolExecutor(count)
        return [self._threads.submit(feeder, self._processes.call) for _ in range(count)]

    def end(self) -> None:
        """End all processes, whatever they compute."""
        if self.reuse(1):
            self._threads.shutdown(wait=False, cancel_futures=True)
            self._processes.end()
        self.count = 0


_pool, _in_use = _Pool(), threading.Lock()
atexit.register(_pool.end)


def solved(
    definition: Definition, workers: int | None = None, stream: TextIO | None = None, begun: float | None = None
) -> dict[str, np.ndarray]:
    """The columns of all cases of a grid: name -> (B, ...).

    workers : most processors to be used; 1: the calling thread alone; None: all, or one, see `_processes_allowed`
    stream : where a call of more than two seconds says how far it is; begun : when it began, by time.monotonic, if
        that was before: reading what was given may take a second of the two
    """
    size, times = definition.grid.size, definition.times
    moved = f", {'each ' * (size > times)}{times} times for the spreads" * (times > 1)
    name = f"solving {counted(size // times, 'contact')}{moved}"
    begun = time.monotonic() if begun is None else begun
    with Progress(name, size, stream, begun=begun, passing=True) as shown:
        return _of_blocks(definition, workers, shown)


def _of_blocks(definition: Definition, workers: int | None, shown: Progress) -> dict[str, np.ndarray]:
    """`solved`, which tells `shown` of each block if there are several."""
    blocks = blocks_of_grid(definition)
    if len(blocks) == 1:
        return compute(parcel(definition, blocks[0]))
    most = min(_processes_allowed(definition, workers), len(blocks) - 1)
    if not most or not _in_use.acquire(blocking=False):  # another thread is using the processes
        return _solve(definition, blocks, 0, shown)
    try:
        return _solve(definition, blocks, most, shown)
    except BaseException:
        _pool.end()
        raise
    finally:
        _in_use.release()


def blocks_of_grid(definition: Definition) -> list[np.ndarray]:
    """The numbers of the cases of each block; the blocks are of about equal sizes."""
    size = definition.grid.size
    slow = size > SLOW_BLOCK and usual_block(definition.grid) < USUAL
    return np.array_split(np.arange(size), max(1, round(size / (SLOW_BLOCK if slow else BLOCK))))


def _processes_allowed(definition: Definition, workers: int | None) -> int:
    """How many processes may compute beside the calling thread.

    It is 0 where Python cannot start another Python, and for a micro law that it cannot have. If the user does
    not say `workers`, it is 0 in threads and processes of programs that divide work themselves, such as dask.
    """
    # a program that has Python inside would start itself anew
    python = "python" in Path(sys.executable or "").name.lower() and not getattr(sys, "frozen", False)
    if not python or not can_travel(definition):
        return 0
    if workers is not None:
        return workers - 1
    divided = multiprocessing.parent_process() or threading.current_thread() is not threading.main_thread()
    return 0 if divided else available_workers() - 1


def _solve(definition: Definition, blocks: list[np.ndarray], most: int, shown: Progress) -> dict[str, np.ndarray]:
    """Solve all blocks, in this thread and in at most `most` processes. More are started only if much work is left."""
    waiting, failed, columns = deque(blocks), [], {}

    def place(index: np.ndarray, found: dict) -> None:
        """Write the columns of a block into those of the grid; threads write different parts of them."""
        for name, array in found.items():
            whole = columns.setdefault(name, np.empty((definition.grid.size, *array.shape[1:]), array.dtype))
            whole[index[0] : index[-1] + 1] = array
        shown.update(len(index), len(failed_cases(found["status"])))

    def feeder(call: Callable) -> None:
        for index in _taken(waiting):
            wanted = parcel(definition, index)
            try:
                found = call(guarded, wanted)
            except Exception as error:
                found = Failure(str(error), "")
            if isinstance(found, Failure):  # the calling thread then computes the block
                log.debug("cases %d to %d: %s", wanted.first, wanted.last, found.message)
                failed.append(index)
            else:
                place(index, found)

    begun, feeders = time.perf_counter(), []
    if ready := _pool.reuse(most):
        feeders = _pool.feed(feeder, ready)
    for index in _taken(waiting):
        place(index, compute(parcel(definition, index)))
        if most and not feeders:
            left = (time.perf_counter() - begun) / (len(blocks) - len(waiting)) * len(waiting)
            feeders = _pool.feed(feeder, min(most, int(left / START)))
    for one in feeders:
        one.result()  # raises the error of a feeder, whose cases would be missing
    for index in failed:
        place(index, compute(parcel(definition, index)))
    return columns


def _taken(queue: deque) -> Iterator:
    """Take items off a queue until it is empty. Other threads take items too, so one cannot look first."""
    with suppress(IndexError):
        while True:
            yield queue.popleft()

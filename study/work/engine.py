"""The engine: the calling thread solves blocks of cases with the help of threads or processes, or a cluster solves
them.

It serves `study.solve`, the `run` of a study, and `study.fit`, whose blocks are curves. A block has the same numbers
wherever it is computed, so one worker and many give the same bits. Cases that the compiled core can solve are solved in
threads (docs/threads.md), all others in the processes of `study.work.processes`. These import this package and not the
calling program, so a script needs no `if __name__ == "__main__"`. They stay for a while, for the next call.
"""

import atexit
import logging
import multiprocessing
import os
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import closing
from functools import partial
from pathlib import Path
from queue import SimpleQueue
from typing import Any, TextIO

import numpy as np

from solver.compiled.library import core
from solver.compiled.newton_in_c import BASES, TAKEN

from ..data.dataset import failed_cases
from ..inputs.definition import USUAL, Definition, usual_block
from ..inputs.grid import along
from ..inputs.punch.micro_laws import many_bodies
from ..terminal import counted
from . import cases
from .cases import Failure, can_travel, guarded, parcel
from .cluster import computed_on_cluster
from .processes import Processes, Threads
from .progress import Progress

log = logging.getLogger(__name__)
#: Approximate number of cases in a block of a call. In blocks of 8000 or more, 60,000 layered cases take at most 5 %
#: more processor time than in a single batch; in blocks of 4000 they take 15 % more.
BLOCK = 10_000
SLOW_BLOCK = 2000  # the same where a case may take some milliseconds
#: Seconds of work that must remain for each process that is started. A process answers after up to 2 s
#: (`processes.py`); meanwhile the calling thread goes on.
START = 1.0
MANY = 8  # number of blocks in a run from which on processes compute all of them
#: Number of results for each process that may wait for the calling thread, which has its own block to solve.
AHEAD = 4


def available_workers() -> int:
    """The number of processors, by dask, which knows the limit of a container and takes a while to import."""
    from dask.system import cpu_count

    return cpu_count()


class _Pool:
    """Worker processes that stay between calls, each fed by a thread. A forked process does not inherit them."""

    def __init__(self):
        self.count, self._threads, self._processes, self._owner = 0, None, None, 0

    def reuse(self, most: int) -> int:
        """Number of existing processes, at most `most`."""
        if self._owner != os.getpid():  # there are none, or they belong to the parent of this process
            self.count = 0
        return min(self.count, most)

    def feed(self, feeder: Callable, count: int) -> list[Future]:
        """Start feeder(call) in `count` threads. There, call(function, task) computes in the thread's process."""
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
if hasattr(os, "register_at_fork"):  # no thread of a forked process uses the pool
    os.register_at_fork(after_in_child=lambda: _in_use.locked() and _in_use.release())
atexit.register(_pool.end)


def computed(
    definition: Definition,
    blocks: Sequence,
    workers: int | None = None,
    scheduler: str | None = None,
    storing: bool = False,
) -> Iterator[tuple[int, dict[str, np.ndarray] | Failure]]:
    """(number of the block, its columns or Failure) for each block, in the order in which they end.

    workers : largest number of processors, or of threads of a cluster; 1: only the calling thread; None: all, or one,
        see `_processors_allowed`
    scheduler : address of the scheduler of a dask cluster, whose workers compute in place of this machine
    storing : whether the calling thread stores the blocks. If there are MANY, processes solve all of them: while the
        calling thread solved one, finished blocks would wait

    When the iterator is closed, waiting blocks are not computed, and processes end. Raises StudyError when no scheduler
    answers, `cluster.Lost` when it is gone.
    """
    if scheduler is not None:
        yield from computed_on_cluster(scheduler, workers, guarded, (parcel(definition, index) for index in blocks))
        return
    allowed = 1 if len(blocks) == 1 else _processors_allowed(definition, workers)
    caller_solves = not (storing and len(blocks) >= MANY and allowed > 1)
    pool = Threads() if core_takes(definition) else _pool
    yield from _by_caller_and_pool(pool, guarded, partial(parcel, definition), blocks, allowed, caller_solves)


def computed_tasks(
    function: Callable, tasks: list, can_leave: bool, workers: int | None = None
) -> Iterator[tuple[int, Any]]:
    """(number, function(task)) for each task, in the order in which they end; Failure where a process raised.

    The calling thread computes, and so do processes if much work remains and tasks `can_leave` this process. An
    exception of the function in the calling thread is raised.
    """
    allowed = _processors_allowed(None, workers) if can_leave and len(tasks) > 1 else 1
    yield from _by_caller_and_pool(_pool, function, lambda task: task, tasks, allowed, caller_solves=True)


def _by_caller_and_pool(
    pool: "_Pool | Threads", function: Callable, packed: Callable, blocks: Sequence, allowed: int, caller_solves: bool
) -> Iterator[tuple[int, Any]]:
    """(number, function(packed(block))) for each block, by at most `allowed` processors."""
    most = number_of_helpers(allowed, len(blocks), caller_solves)
    if not most or not _in_use.acquire(blocking=False):  # another thread is using the processes
        for number, block in enumerate(blocks):
            yield number, function(packed(block))
        return
    try:
        yield from _shared(pool, function, packed, blocks, most, caller_solves)
    except BaseException:
        pool.end()
        raise
    finally:
        _in_use.release()


def _shared(
    pool: "_Pool | Threads", function: Callable, packed: Callable, blocks: Sequence, most: int, caller_solves: bool
) -> Iterator[tuple[int, Any]]:
    """`_by_caller_and_pool` with at most `most` helpers of a pool and, if `caller_solves`, in this thread too.

    With `caller_solves` processes are started only if much work remains.
    """
    waiting, ended, room = deque(enumerate(blocks)), SimpleQueue(), threading.Semaphore(AHEAD * most)

    def feeder(call: Callable) -> None:
        while room.acquire() and (block := _next(waiting)):
            number, content = block
            try:
                result = call(function, packed(content))
            except Exception as error:
                result = Failure(str(error), "")
            ended.put((number, result))

    begun, feeders = time.perf_counter(), 0
    if ready := pool.reuse(most) if caller_solves else most:
        feeders = len(pool.feed(feeder, ready))
    try:
        for _ in blocks:
            block = _next(waiting) if caller_solves and ended.empty() else None
            if block is None:  # a process has a result, or processes solve the last blocks
                result = ended.get()
                room.release()
            else:
                number, content = block
                result = number, function(packed(content))
                if not feeders:
                    seconds = (time.perf_counter() - begun) / (len(blocks) - len(waiting)) * len(waiting)
                    feeders = len(pool.feed(feeder, min(most, int(seconds / START))))
            yield result
    finally:
        waiting.clear()
        room.release(most)


def _next(waiting: deque) -> tuple[int, Any] | None:
    """The next block; None if there is none. A check beforehand would not help, since other threads take blocks too."""
    try:
        return waiting.popleft()
    except IndexError:
        return None


def solved(
    definition: Definition, workers: int | None = None, stream: TextIO | None = None, begun: float | None = None
) -> dict[str, np.ndarray]:
    """The columns of all cases of a grid: name -> (B, ...).

    workers : see `computed`
    stream : for the progress of a call of more than two seconds
    begun : time at which the call began, by time.monotonic; reading the inputs may have taken one of the two seconds
    """
    size, blocks = definition.grid.size, blocks_of_grid(definition)
    name = f"solving {counted(size, 'contact')}"
    begun = time.monotonic() if begun is None else begun
    with Progress(name, size, stream, begun=begun, passing=True) as shown:
        columns = {}
        with closing(computed(definition, blocks, workers)) as results:
            for number, result in results:
                index = blocks[number]
                if isinstance(result, Failure):  # a process was killed, or the solver raised: then it raises again here
                    log.debug("cases %d to %d: %s", index[0], index[-1], result.message)
                    result = cases.compute(parcel(definition, index))
                for column, array in result.items():
                    whole = columns.setdefault(column, np.empty((size, *array.shape[1:]), array.dtype))
                    whole[index[0] : index[-1] + 1] = array
                shown.update(len(index), len(failed_cases(result["status"])))
        return columns


def blocks_of_grid(definition: Definition) -> list[np.ndarray]:
    """The numbers of the cases of each block of a call. All blocks have about the same size."""
    size = definition.grid.size
    slow = size > SLOW_BLOCK and usual_block(definition.grid) < USUAL
    return np.array_split(np.arange(size), max(1, round(size / (SLOW_BLOCK if slow else BLOCK))))


def number_of_helpers(workers: int, blocks: int, caller_solves: bool) -> int:
    """Number of threads or processes that compute so many blocks, in addition to the caller if `caller_solves`."""
    return max(0, min(workers, blocks) - caller_solves)


def core_takes(definition: Definition) -> bool:
    """Whether the compiled core solves nearly all cases of a study, and they need nothing else that takes long."""
    if core() is None or definition.inputs or definition.stresses or many_bodies(definition.grid):
        return False
    names = ("micro", "base", "scheme", "model_check")
    words = {name: {*along(definition.grid, name).ravel().tolist()} for name in names}
    for name, usual in (("shape", "paraboloid"), ("w_adhesion", 0.0)):
        if name in definition.grid.values and (definition.grid.values[name][1] != usual).any():
            return False
    if ("smooth" in words["micro"] and "half_space" in words["base"]) or "first_order" in words["model_check"]:
        return False  # numpy computes a closed form, or an error that takes longer than the contact
    return words["micro"] <= {*TAKEN} and words["base"] <= {*BASES} and words["scheme"] == {"newton"}


def _processors_allowed(definition: Definition | None, workers: int | None) -> int:
    """The number of processors that may be used.

    It is 1 if this program cannot start another Python, or if the micro law of the definition cannot be sent to it.
    Without `workers` it is also 1 in threads and processes of programs that divide work themselves, such as dask.
    """
    # in a program that embeds Python, sys.executable is that program
    python = "python" in Path(sys.executable or "").name.lower() and not getattr(sys, "frozen", False)
    if not python or not (definition is None or can_travel(definition)):
        return 1
    divided = multiprocessing.parent_process() or threading.current_thread() is not threading.main_thread()
    return workers or (1 if divided else available_workers())

"""The engine: blocks of cases are solved by the calling thread and others beside it, or by the workers of a cluster.

`study.solve` and the `run` of a study are served alike, and `study.fit`, whose blocks are curves. A block has the same
numbers wherever it is computed, so one worker and many give the same bits. Cases that the compiled core takes are
solved in threads (docs/threads.md), all others in the processes of `study.work.processes`. They import this package and
not the program that calls, so a script needs no `if __name__ == "__main__"`. They stay for a while, for the next call.
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
from .cluster import computed_there
from .processes import Processes, Threads
from .progress import Progress

log = logging.getLogger(__name__)
#: Cases in a block of a call, about. In blocks of 8000 or more, 60,000 layered cases take at most 5 % more
#: processor time than in a single batch; in blocks of 4000 they take 15 % more.
BLOCK = 10_000
SLOW_BLOCK = 2000  # the same where a case may take some milliseconds
#: Seconds of work that must be left for each process that is started. It answers after up to 2 s (`processes.py`), and
#: meanwhile the calling thread goes on.
START = 1.0
MANY = 8  # blocks of a run from which on processes compute all of them
#: Results of each process that may wait until the calling thread takes them: it has a block of its own to solve.
AHEAD = 4


def available_workers() -> int:
    """How many processors there are, by dask, which knows the limit of a container and takes a while to import."""
    from dask.system import cpu_count

    return cpu_count()


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
        """Start feeder(call) in `count` threads; call(function, task) computes in the process of the thread."""
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
if hasattr(os, "register_at_fork"):  # no thread of a forked process uses them
    os.register_at_fork(after_in_child=lambda: _in_use.locked() and _in_use.release())
atexit.register(_pool.end)


def computed(
    definition: Definition,
    blocks: Sequence,
    workers: int | None = None,
    scheduler: str | None = None,
    storing: bool = False,
) -> Iterator[tuple[int, dict[str, np.ndarray] | Failure]]:
    """(number of a block, its columns or why it failed) for each block, in the order in which they end.

    workers : most processors to be used, or threads of a cluster; 1: the calling thread alone; None: all, or one, see
        `_processors_allowed`
    scheduler : the address of the scheduler of a dask cluster, whose workers compute in place of this machine
    storing : whether the calling thread stores the blocks. If there are MANY, it solves none itself, as those that are
        ready would wait meanwhile: processes solve all of them

    When the iterator is closed, blocks that wait are not computed, and processes end. Raises StudyError when no
    scheduler answers, `cluster.Lost` when it is gone.
    """
    if scheduler is not None:
        yield from computed_there(scheduler, workers, guarded, (parcel(definition, index) for index in blocks))
        return
    allowed = 1 if len(blocks) == 1 else _processors_allowed(definition, workers)
    here = not (storing and len(blocks) >= MANY and allowed > 1)
    pool = Threads() if core_takes(definition) else _pool
    yield from _here_and_apart(pool, guarded, partial(parcel, definition), blocks, allowed, here)


def computed_tasks(
    function: Callable, tasks: list, can_leave: bool, workers: int | None = None
) -> Iterator[tuple[int, Any]]:
    """(number, function(task)) for each task, in the order in which they end; Failure where a process has none.

    The calling thread computes, and processes beside it if much work is left and tasks `can_leave` this process. What
    a function raises in the calling thread is raised.
    """
    allowed = _processors_allowed(None, workers) if can_leave and len(tasks) > 1 else 1
    yield from _here_and_apart(_pool, function, lambda task: task, tasks, allowed, here=True)


def _here_and_apart(
    pool: "_Pool | Threads", function: Callable, packed: Callable, blocks: Sequence, allowed: int, here: bool
) -> Iterator[tuple[int, Any]]:
    """(number, function(packed(block))) for each block, by at most `allowed` processors."""
    most = others_beside(allowed, len(blocks), here)
    if not most or not _in_use.acquire(blocking=False):  # another thread is using the processes
        for number, block in enumerate(blocks):
            yield number, function(packed(block))
        return
    try:
        yield from _shared(pool, function, packed, blocks, most, here)
    except BaseException:
        pool.end()
        raise
    finally:
        _in_use.release()


def _shared(
    pool: "_Pool | Threads", function: Callable, packed: Callable, blocks: Sequence, most: int, here: bool
) -> Iterator[tuple[int, Any]]:
    """`_here_and_apart` in at most `most` others of a pool and, if `here`, in this thread too.

    With `here` processes are started only if much work is left.
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
    if ready := pool.reuse(most) if here else most:
        feeders = len(pool.feed(feeder, ready))
    try:
        for _ in blocks:
            block = _next(waiting) if here and ended.empty() else None
            if block is None:  # a result of a process is there, or processes solve the last blocks
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
    """The next block, None if there is none. Other threads take blocks too, so it would not help to look first."""
    try:
        return waiting.popleft()
    except IndexError:
        return None


def solved(
    definition: Definition, workers: int | None = None, stream: TextIO | None = None, begun: float | None = None
) -> dict[str, np.ndarray]:
    """The columns of all cases of a grid: name -> (B, ...).

    workers : see `computed`
    stream : where a call of more than two seconds says how far it is
    begun : when the call began, by time.monotonic; reading the inputs may have taken a second of the two
    """
    size, blocks = definition.grid.size, blocks_of_grid(definition)
    name = f"solving {counted(size, 'contact')}"
    begun = time.monotonic() if begun is None else begun
    with Progress(name, size, stream, begun=begun, passing=True) as shown:
        columns = {}
        with closing(computed(definition, blocks, workers)) as results:
            for number, result in results:
                index = blocks[number]
                if isinstance(result, Failure):  # of a process that was killed, or of the solver: then it is raised
                    log.debug("cases %d to %d: %s", index[0], index[-1], result.message)
                    result = cases.compute(parcel(definition, index))
                for column, array in result.items():
                    whole = columns.setdefault(column, np.empty((size, *array.shape[1:]), array.dtype))
                    whole[index[0] : index[-1] + 1] = array
                shown.update(len(index), len(failed_cases(result["status"])))
        return columns


def blocks_of_grid(definition: Definition) -> list[np.ndarray]:
    """The numbers of the cases of each block of a call; the blocks are of about equal sizes."""
    size = definition.grid.size
    slow = size > SLOW_BLOCK and usual_block(definition.grid) < USUAL
    return np.array_split(np.arange(size), max(1, round(size / (SLOW_BLOCK if slow else BLOCK))))


def others_beside(workers: int, blocks: int, here: bool) -> int:
    """How many threads or processes compute so many blocks; `here`: beside the calling thread."""
    return max(0, min(workers, blocks) - here)


def core_takes(definition: Definition) -> bool:
    """Whether the compiled core solves nearly all cases of a study, and nothing else takes long for them."""
    if core() is None or definition.inputs or definition.stresses or many_bodies(definition.grid):
        return False
    names = ("micro", "base", "scheme", "model_check")
    words = {name: {*along(definition.grid, name).ravel().tolist()} for name in names}
    for name, usual in (("shape", "paraboloid"), ("w_adhesion", 0.0)):
        if name in definition.grid.values and (definition.grid.values[name][1] != usual).any():
            return False
    if ("smooth" in words["micro"] and "half_space" in words["base"]) or "first_order" in words["model_check"]:
        return False  # a closed form, or an error that takes longer than the contact: by numpy
    return words["micro"] <= {*TAKEN} and words["base"] <= {*BASES} and words["scheme"] == {"newton"}


def _processors_allowed(definition: Definition | None, workers: int | None) -> int:
    """How many processors may be used.

    It is 1 if Python cannot start another Python, or if that cannot have the micro law of a definition. Without
    `workers` it is also 1 in threads and processes of programs that divide work themselves, such as dask.
    """
    # sys.executable of a program that embeds Python is that program
    python = "python" in Path(sys.executable or "").name.lower() and not getattr(sys, "frozen", False)
    if not python or not (definition is None or can_travel(definition)):
        return 1
    divided = multiprocessing.parent_process() or threading.current_thread() is not threading.main_thread()
    return workers or (1 if divided else available_workers())

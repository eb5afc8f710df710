"""Where blocks are computed: threads or processes of this machine, or the workers of a dask cluster. One way to use
any."""

import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context, parent_process
from threading import Thread

from .cases import Failure
from .scheduler import connected

CONNECT = 10  # seconds
AHEAD = 4  # blocks submitted for each worker: it goes on while this thread writes
_KILLED = "a process that computed has been killed, perhaps for want of memory"
MANY = 8  # blocks from which on it pays to start processes: threads wait for each other's Python


class Lost(ConnectionError):
    """The scheduler is gone, or a process that computed."""

    def __init__(self, what: str = "the scheduler is gone"):
        super().__init__(what)


@dataclass(frozen=True, eq=False)
class Engine:
    """executor : takes the tasks; width : how many of them it should have at a time, which may change."""

    executor: Executor
    width: Callable[[], int]


@contextmanager
def engine(workers: int | None, scheduler: str | None, blocks: int = 0) -> Iterator[Engine]:
    """Threads, for many `blocks` processes (default one for each processor), or with the address of a `scheduler` its
    workers (at most so many).

    What has been submitted and not begun is cancelled at the end; what has begun is left to end by itself.
    """
    if scheduler is not None:
        with _cluster(workers, scheduler) as found:
            yield found
        return
    count = workers or available_workers()
    own = processes_for(count, blocks)
    executor = _processes(own) if own else ThreadPoolExecutor(count)
    try:
        yield Engine(executor, lambda: AHEAD * count)
    finally:
        executor.shutdown(wait=False, cancel_futures=True)


def processes_for(workers: int, blocks: int) -> int:
    """How many processes compute so many blocks; 0: as many threads as workers do."""
    return min(workers, blocks) if workers > 1 and blocks >= MANY else 0


def _processes(count: int) -> Executor:
    _start_tracker()
    with _blocked():
        executor = ProcessPoolExecutor(count, get_context("spawn"), _live_with_parent)
        for _ in range(count):
            executor.submit(int)  # starts one
    return executor


def _start_tracker() -> None:
    """Start the process that removes the semaphores of the others from /dev/shm, should the run not come to it.

    It must outlive an interrupt, and says nothing then: that an interrupted run has left them is no news.
    """
    if os.name == "nt":  # needs none
        return
    from multiprocessing.resource_tracker import ensure_running

    before = os.environ.get("PYTHONWARNINGS")
    quiet = "ignore::UserWarning:multiprocessing.resource_tracker"
    os.environ["PYTHONWARNINGS"] = f"{before},{quiet}" if before else quiet
    try:
        with _blocked():
            ensure_running()  # before others start: it lets the interrupt through again
    finally:
        os.environ.pop("PYTHONWARNINGS")
        if before is not None:
            os.environ["PYTHONWARNINGS"] = before


@contextmanager
def _blocked() -> Iterator[None]:
    """Processes that start here inherit this: Ctrl-C, and the end of the terminal, are for the one that runs the study.

    The workers end when that ends.
    """
    if not hasattr(signal, "pthread_sigmask"):  # not POSIX
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGHUP})
    yield
    signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _live_with_parent() -> None:
    """Begin a worker process: it ends with the process that runs the study, however that ends."""

    def end() -> None:
        parent_process().join()
        os._exit(1)

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # where it cannot be blocked
    Thread(target=end, daemon=True).start()


@contextmanager
def _cluster(workers: int | None, scheduler: str) -> Iterator[Engine]:
    client = connected(scheduler, CONNECT)

    def width() -> int:
        try:
            threads = sum(client.nthreads().values())  # workers come and go
        except OSError:
            raise Lost from None
        return AHEAD * max(1, min(threads, workers or threads))

    try:
        yield Engine(client.get_executor(pure=False), width)
    finally:
        client.close(timeout=1)


def available_workers() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def as_they_come(engine: Engine, function: Callable, tasks: Iterable) -> Iterator[tuple[int, object]]:
    """(number of the task, function(task)) in the order in which they end, in this thread.

    A task is made when there is room for it, and forgotten when its result has been taken: memory stays bounded.

    Raises
    ------
    Lost : the scheduler is gone, or a process that computed
    """
    pending: dict[Future, int] = {}
    for number, task in enumerate(tasks):
        try:
            pending[engine.executor.submit(function, task)] = number
        except BrokenExecutor:
            raise Lost(_KILLED) from None
        while len(pending) >= engine.width():
            yield _next(pending)
    while pending:
        yield _next(pending)


def _next(pending: dict[Future, int]) -> tuple[int, object]:
    done, _ = wait(pending, return_when=FIRST_COMPLETED)
    future = min(done, key=pending.get)
    number = pending.pop(future)
    try:
        return number, future.result()
    except CancelledError:
        raise Lost from None
    except BrokenExecutor:
        raise Lost(_KILLED) from None
    except Exception as error:  # of the cluster, such as a block that killed its workers
        return number, Failure(f"{type(error).__name__}: {error}", "")

"""Where blocks are computed: threads or processes of this machine, or workers of a dask cluster; one interface."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

from dask.system import cpu_count as available_workers  # no more than the limit of a container is worth

from .cases import Failure
from .cluster import Cluster, Lost
from .processes import Processes
from .scheduler import connected

CONNECT = 10  # seconds in which something must listen at the address of a scheduler
ANSWER = 60  # seconds that a scheduler which listens has to answer: it may be busy
AHEAD = 4  # blocks submitted for each worker, which goes on with them while this thread writes
AGAIN = 5  # seconds after which a run that waits looks which workers of a cluster are there: it is one short message
MANY = 8  # blocks from which on it pays to start processes, which do not share a lock of Python as threads do


@dataclass(frozen=True, eq=False)
class Engine:
    """submit(function, task) -> Future; width() : how many tasks it should have at a time, which may change.

    again : seconds after which a wait for results asks for the width again; None: never
    """

    submit: Callable[..., Future]
    width: Callable[[], int]
    again: float | None = None


@contextmanager
def engine(workers: int | None, scheduler: str | None, blocks: int = 0) -> Iterator[Engine]:
    """The engine that computes so many `blocks`: threads for few, processes for many, or the workers of a cluster.

    workers : how many, by default one for each processor; at most so many of a cluster
    scheduler : the address of the scheduler of a cluster

    At the end tasks that wait are cancelled. A thread finishes its task, a process is killed.
    """
    if scheduler is not None:
        with _cluster(workers, scheduler) as found:
            yield found
        return
    count = workers or available_workers()
    own = processes_for(count, blocks)
    threads, processes = ThreadPoolExecutor(own or count), Processes()
    try:
        yield Engine(partial(threads.submit, processes.call) if own else threads.submit, lambda: AHEAD * count)
    finally:
        threads.shutdown(wait=False, cancel_futures=True)
        processes.end()


def processes_for(workers: int, blocks: int) -> int:
    """How many processes compute so many blocks; 0: threads compute them."""
    return min(workers, blocks) if workers > 1 and blocks >= MANY else 0


@contextmanager
def _cluster(workers: int | None, scheduler: str) -> Iterator[Engine]:
    cluster = Cluster(connected(scheduler, CONNECT, ANSWER))

    def width() -> int:
        threads = cluster.threads()
        return AHEAD * max(1, min(threads, workers or threads))

    try:
        yield Engine(cluster.submit, width, AGAIN)
    finally:
        cluster.leave(CONNECT)


def as_they_come(engine: Engine, function: Callable, tasks: Iterable) -> Iterator[tuple[int, object]]:
    """(number of the task, function(task)) in the order in which they end, in this thread.

    A task is made when there is room for it, and dropped when its result has been taken, so that memory is bounded.
    Raises Lost when the scheduler of a cluster is gone.
    """
    pending: dict[Future, int] = {}
    for number, task in enumerate(tasks):
        pending[engine.submit(function, task)] = number
        while len(pending) >= engine.width():
            yield _next(pending, engine)
    while pending:
        yield _next(pending, engine)


def _next(pending: dict[Future, int], engine: Engine) -> tuple[int, object]:
    while not (done := wait(pending, engine.again, FIRST_COMPLETED).done):
        engine.width()
    future = min(done, key=pending.get)
    number = pending.pop(future)
    try:
        return number, future.result()
    except Lost:
        raise
    except Exception as error:  # of the cluster: a block has killed its workers, say
        return number, Failure(f"{type(error).__name__}: {error}", "")

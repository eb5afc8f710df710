"""Blocks on the workers of a dask cluster. Workers that have other numerics are left out."""

import logging
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial

from .cases import NUMERICS_VERSION, Failure
from .scheduler import connected

log = logging.getLogger(__name__)
CONNECT = 10  # seconds in which something must listen at the address of a scheduler
ANSWER = 60  # seconds that a scheduler which listens has to answer: it may be busy
AHEAD = 4  # blocks submitted for each thread, which goes on with them while the process of the run writes
AGAIN = 5  # seconds after which a run that waits looks which workers are there: it is one short message


class Lost(ConnectionError):
    """The scheduler is gone."""

    def __init__(self):
        super().__init__("the scheduler is gone")


@dataclass(frozen=True, eq=False)
class Block:
    """function(task), to be computed by one of the `workers` (addresses; None: any), and what takes its result."""

    answer: Future
    function: Callable
    task: object
    workers: tuple[str, ...] | None = None


class Cluster:
    """The workers of a client of dask.

    A worker that refuses a block is asked for its numerics. If they are others, it gets no more blocks, and those that
    it has refused go to the other workers. If no worker has these numerics, blocks fail as the worker says.
    """

    def __init__(self, client):
        self._client = client
        self._under_way: dict[Block, object] = {}  # the future of dask of each
        self._asked: set[str] = set()
        self._left_out: set[str] = set()
        self._handing, self._ended = threading.Lock(), threading.Event()

    def submit(self, function: Callable, task: object) -> Future:
        """The future of function(task)."""
        block = Block(Future(), function, task)
        with self._handing:
            known = bool(self._left_out)
        self._place(replace(block, workers=tuple(self._fitting()) or None) if known else block)
        return block.answer

    def threads(self) -> int:
        """How many threads the workers have that are not left out, which come and go.

        Blocks that wait for workers which have gone are given to those that are there. Raises Lost.
        """
        there = self._fitting()
        with self._handing:
            waiting = [block for block in self._under_way if block.workers and not there.keys() & {*block.workers}]
            futures = [self._under_way.pop(block) for block in waiting] if there else []
        for block, future in zip(waiting, futures, strict=False):
            future.cancel()
            self._place(replace(block, workers=tuple(there)))
        return sum((there or self._there()).values())

    def leave(self, patience: float) -> None:
        """End. Of a client that is closed dask's thread waits for a result for ever: so long it may wait for it."""
        self._ended.set()
        if self._handing.acquire(timeout=patience):
            self._handing.release()
        self._client.close(timeout=1)

    def _there(self) -> dict[str, int]:
        """Address of each worker -> its threads."""
        try:
            return self._client.nthreads()
        except OSError:
            raise Lost from None

    def _fitting(self) -> dict[str, int]:
        """The same without the workers that are left out."""
        return {address: threads for address, threads in self._there().items() if address not in self._left_out}

    def _place(self, block: Block) -> None:
        from roughcoat.elsewhere import Packed  # no other call needs it

        where = {"workers": list(block.workers)} if block.workers else {}
        future = self._client.submit(Packed(block.function, block.task), pure=False, **where)
        self._under_way[block] = future
        future.add_done_callback(partial(self._hand_over, block))

    def _hand_over(self, block: Block, computed) -> None:
        """Give the answer of a block the result of a future of dask, or the exception, or place the block again.

        Dask's own executor reads the state of the future once more when it has the result. If the worker is lost in
        between, it takes the result for an exception, and a block that has been computed fails.
        """
        with self._handing:
            if self._ended.is_set() or self._under_way.pop(block, None) is None:  # it has been placed anew
                return
            try:
                found = computed.result()
            except BaseException as error:
                found = Lost() if computed.cancelled() else error
            try:
                others = self._others(block) if isinstance(found, Failure) else ()
                if others:
                    self._place(replace(block, workers=others))
            except BaseException as error:
                others, found = (), error
            if others:
                return
            if isinstance(found, BaseException):
                block.answer.set_exception(found)
            else:
                block.answer.set_result(found)

    def _others(self, block: Block) -> tuple[str, ...]:
        """The workers that may compute a block that has failed, if one that is left out may have refused it."""
        self._ask()
        refusing = self._left_out & {*block.workers} if block.workers else self._left_out
        return tuple(self._fitting()) if refusing else ()

    def _ask(self) -> None:
        """Ask the workers that have not been asked yet, and leave out those of other numerics."""
        new = [address for address in self._there() if address not in self._asked]
        try:
            answers = self._client.run(_question(), workers=new, on_error="ignore") if new else {}
        except OSError:
            raise Lost from None
        for address, version in answers.items():
            self._asked.add(address)
            if version != NUMERICS_VERSION:
                has = f"has version {version} of the numerics, not {NUMERICS_VERSION}"
                log.warning("the worker %s %s: it is left out", address, has)
                self._left_out.add(address)


def _question() -> Callable[[], str]:
    """A function that gives the version of the numerics of a worker.

    It is sent as code, as a worker of another version may not have this module: a function within a function has no
    name by which it could be found there.
    """

    def version() -> str:
        import roughcoat  # noqa: F401, so that `study` is ours
        from study.work import cases

        return cases.NUMERICS_VERSION

    return version


def computed_there(
    scheduler: str, workers: int | None, function: Callable, tasks: Iterable
) -> Iterator[tuple[int, object]]:
    """(number of the task, function(task)) by the workers of a cluster, in the order in which they end.

    scheduler : its address; workers : most threads that are used at a time

    Raises StudyError when no scheduler answers, Lost when it is gone.
    """
    with cluster_at(scheduler, workers) as (submit, width):
        yield from as_they_come(submit, width, function, tasks)


@contextmanager
def cluster_at(scheduler: str, workers: int | None) -> Iterator[tuple[Callable[..., Future], Callable[[], int]]]:
    """What `as_they_come` needs of a cluster, which is left at the end."""
    cluster = Cluster(connected(scheduler, CONNECT, ANSWER))

    def width() -> int:
        threads = cluster.threads()
        return AHEAD * max(1, min(threads, workers or threads))

    try:
        yield cluster.submit, width
    finally:
        cluster.leave(CONNECT)


def as_they_come(
    submit: Callable[..., Future], width: Callable[[], int], function: Callable, tasks: Iterable
) -> Iterator[tuple[int, object]]:
    """(number of the task, function(task)) in the order in which they end, in this thread.

    submit(function, task) gives a Future; width() : how many tasks there should be at a time, which may change. A task
    is made when there is room for it, and dropped when its result has been taken, so that memory is bounded.
    """
    pending: dict[Future, int] = {}
    for number, task in enumerate(tasks):
        pending[submit(function, task)] = number
        while len(pending) >= width():
            yield _first(pending, width)
    while pending:
        yield _first(pending, width)


def _first(pending: dict[Future, int], width: Callable[[], int]) -> tuple[int, object]:
    while not (done := wait(pending, AGAIN, FIRST_COMPLETED).done):
        width()
    future = min(done, key=pending.get)
    number = pending.pop(future)
    try:
        return number, future.result()
    except Lost:
        raise
    except Exception as error:  # of the cluster: a block has killed its workers, say
        return number, Failure(f"{type(error).__name__}: {error}", "")

"""Blocks on the workers of a dask cluster. Workers with another version of the numerics are left out."""

import logging
from collections.abc import Callable, Iterable, Iterator
from queue import Empty, SimpleQueue

from .cases import NUMERICS_VERSION, Failure
from .scheduler import connected

log = logging.getLogger(__name__)
CONNECT = 10  # seconds within which something must listen at the address of a scheduler
ANSWER = 60  # seconds within which a listening scheduler must answer; it may be busy
AHEAD = 4  # blocks submitted for each thread, so that it has work while the process of the run writes
CHECK_INTERVAL = 5  # seconds between checks of the workers while a run waits; a check is one short message


class Lost(ConnectionError):
    """The scheduler is gone."""

    def __init__(self):
        super().__init__("the scheduler is gone")


def computed_on_cluster(
    scheduler: str, workers: int | None, function: Callable, tasks: Iterable
) -> Iterator[tuple[int, object]]:
    """(number of the task, function(task)) by the workers of a cluster, in the order in which the tasks end.

    scheduler : address of the scheduler
    workers : largest number of threads that are used at a time

    A task is made when there is room for it, and dropped when its result has been taken, so that memory is bounded.
    Raises StudyError when no scheduler answers, Lost when the scheduler is gone.
    """
    from roughcoat.elsewhere import Packed  # no other call needs it

    client = connected(scheduler, CONNECT, ANSWER)
    try:
        cluster = Cluster(client)
        for number, task in enumerate(tasks):
            cluster.submit(number, Packed(function, task))
            while len(cluster.under_way) >= cluster.room(workers):
                yield cluster.first()
        while cluster.under_way:
            yield cluster.first()
    finally:
        client.close(timeout=1)


class Cluster:
    """The workers of a client of dask.

    under_way : key of dask -> future, number and call of the block, addresses of the workers that may compute it (none:
        any)

    If a block fails, each worker is asked once for its version of the numerics. A worker with another version is left
    out, and blocks that it has refused go to other workers. If no worker has the right version, the blocks fail.
    """

    def __init__(self, client):
        self.client = client
        self.under_way: dict[str, tuple] = {}
        self._ended = SimpleQueue()
        self._workers_asked, self._left_out = set(), set()

    def submit(self, number: int, call: Callable, workers: Iterable[str] = ()) -> None:
        """Give the call of a block to one of the `workers`, or without these to any worker that is not left out."""
        chosen = tuple(workers or (self._fitting() if self._left_out else ()))
        future = self.client.submit(call, pure=False, **({"workers": list(chosen)} if chosen else {}))
        self.under_way[future.key] = future, number, call, chosen
        future.add_done_callback(self._ended.put)

    def room(self, workers: int | None) -> int:
        """Number of blocks that should be under way, on at most `workers` of the cluster's threads."""
        threads = sum((self._fitting() or self._threads()).values())
        return AHEAD * max(1, min(threads, workers or threads))

    def first(self) -> tuple[int, object]:
        """(number, result) of the block that ends next. An exception, such as one from killed workers, is a Failure."""
        while True:
            try:
                key = self._ended.get(timeout=CHECK_INTERVAL).key
            except Empty:
                self._place_anew()
                continue
            if key not in self.under_way:  # the block has been given to other workers
                continue
            future, number, call, workers = self.under_way.pop(key)
            try:
                result = future.result()
            except Exception as error:
                if future.status != "error":  # the call did not raise it
                    raise Lost from None
                result = Failure(f"{type(error).__name__}: {error}", "")
            if isinstance(result, Failure) and (fitting := self._for_another_try(workers)):
                self.submit(number, call, fitting)
                continue
            return number, result

    def _threads(self) -> dict[str, int]:
        """Address of each worker -> its threads. Raises Lost."""
        try:
            return self.client.nthreads()
        except OSError:
            raise Lost from None

    def _fitting(self) -> dict[str, int]:
        """Address of each worker that is not left out -> its threads. Raises Lost."""
        return {address: threads for address, threads in self._threads().items() if address not in self._left_out}

    def _place_anew(self) -> None:
        """Give blocks that wait for workers that have gone to the remaining workers."""
        threads = self._fitting()
        for key, (future, number, call, workers) in [*self.under_way.items()]:
            if threads and workers and not threads.keys() & {*workers}:
                del self.under_way[key]
                future.cancel()
                self.submit(number, call, threads)

    def _for_another_try(self, workers: tuple[str, ...]) -> tuple[str, ...]:
        """The workers for another try of a failed block; () unless a worker that is left out may have refused it."""
        self._ask()
        refusing = self._left_out & {*workers} if workers else self._left_out
        return tuple(self._fitting()) if refusing else ()

    def _ask(self) -> None:
        """Ask the workers that have not been asked yet, and leave out those with other numerics."""

        def version() -> str:  # it is sent as code, since a worker cannot import it by name
            import roughcoat  # noqa: F401, so that `study` is this package
            from study.work import cases

            return cases.NUMERICS_VERSION

        new = [address for address in self._threads() if address not in self._workers_asked]
        try:
            answers = self.client.run(version, workers=new, on_error="ignore") if new else {}
        except OSError:
            raise Lost from None
        for address, version_of_worker in answers.items():
            self._workers_asked.add(address)
            if version_of_worker != NUMERICS_VERSION:
                has = f"has version {version_of_worker} of the numerics, not {NUMERICS_VERSION}"
                log.warning("the worker %s %s: it is left out", address, has)
                self._left_out.add(address)

"""What computes, and how much of it at a time; a cluster is played by the test."""

import io
import os
import pickle
import socket
import sys
import threading
from concurrent.futures import CancelledError, Executor, Future
from types import SimpleNamespace

import dask.system
import numpy as np
import pytest
from children import PATIENCE
from line_study import load

from study import StudyError
from study.work import cluster
from study.work.cases import Failure, parcel
from study.work.cluster import AHEAD, Lost, as_they_come, cluster_at
from study.work.engine import available_workers


class AtOnce(Executor):
    """Computes there and then: no worker can be faster."""

    def submit(self, function, *arguments):
        future = Future()
        try:
            future.set_result(function(*arguments))
        except Exception as error:
            future.set_exception(error)
        return future


@pytest.mark.parametrize("width", [1, 3, 100])
def test_a_task_is_made_when_there_is_room_and_results_come_in_order(width):
    made, under_way = [], []

    def tasks():
        for number in range(10):
            made.append(number)
            yield number

    for number, result in as_they_come(AtOnce().submit, lambda: width, lambda task: task**2, tasks()):
        assert result == number**2 and number == len(under_way)
        under_way.append(len(made) - number)
    assert len(under_way) == 10 and max(under_way) == min(width, 10)


def test_the_width_is_asked_again_and_again():
    """As workers come and go."""
    widths, made = iter([3, 2, 2, 1, 1, 1, 1, 1, 1]), []
    found = as_they_come(AtOnce().submit, lambda: next(widths), int, (made.append(i) or i for i in range(4)))
    assert [(number, len(made)) for number, _ in found] == [(0, 2), (1, 3), (2, 3), (3, 4)]


def test_a_task_that_raises_is_a_failure():
    found = dict(as_they_come(AtOnce().submit, lambda: 2, lambda task: [1][1 - task], [1, 0, 1]))
    assert found == {0: 1, 1: Failure("IndexError: list index out of range", ""), 2: 1}


def test_a_cluster_is_left_when_no_thread_waits_for_it(monkeypatch):
    """A run on a cluster did not end: dask's thread asked a client that was closed for a result, and waits for ever."""
    asked, go, callbacks, threads = threading.Event(), threading.Event(), [], []

    class Client:
        closed = False

        def submit(self, call, pure):
            return SimpleNamespace(add_done_callback=callbacks.append)

        def close(self, timeout):
            self.closed = True
            go.set()

    def result():
        asked.set()
        go.wait(0.3)  # the result comes after a while
        assert not client.closed
        return "here"

    def of_dask(callback):
        done.append(callback(SimpleNamespace(result=result, cancelled=lambda: False)))

    client, done = Client(), []
    monkeypatch.setattr(cluster, "connected", lambda *_: client)
    with cluster_at("tcp://there", 2) as (submit, width):
        first, second = (submit(int, task) for task in (1, 2))
        threads = [threading.Thread(target=of_dask, args=(callback,)) for callback in callbacks]
        threads[0].start()
        assert asked.wait(PATIENCE)
    asked.clear()
    threads[1].start()
    for thread in threads:
        thread.join(PATIENCE)
    assert first.result(0) == "here" and client.closed
    assert len(done) == 2 and not asked.is_set() and not second.done(), "the second is not asked for any more"


@pytest.mark.skipif(sys.platform != "linux", reason="containers")
def test_a_container_uses_no_more_processors_than_its_limit(monkeypatch):
    """One of 64 processors that is given 1.5 of them (docker run --cpus=1.5): 64 processes would fill its memory."""
    files = {"/proc/self/cgroup": "0::/\n", "/sys/fs/cgroup/cpu.max": "150000 100000\n"}
    monkeypatch.setattr(dask.system, "psutil", None)
    monkeypatch.setattr(dask.system, "open", lambda path: io.StringIO(files[path]), raising=False)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(64)))
    for count in ("cpu_count", "process_cpu_count"):  # of older and newer versions of dask and Python
        monkeypatch.setattr(os, count, lambda: 64, raising=False)
    assert available_workers() == 2
    files["/sys/fs/cgroup/cpu.max"] = "max 100000\n"
    assert available_workers() == 64


class Computed:
    """A future of dask that ends at once; None for a task: the scheduler is gone."""

    def __init__(self, call):
        self.call = pickle.loads(pickle.dumps(call))  # as it travels
        _, (self.task,) = pickle.loads(self.call.__getstate__())

    def add_done_callback(self, called):
        called(self)

    def cancelled(self):
        return self.task is None

    def result(self):
        if self.cancelled():
            raise CancelledError("the scheduler is gone")
        return self.call()


@pytest.fixture
def client(monkeypatch):
    """A cluster of two machines with 2 and 3 threads; what is done to it is in `done`."""
    done = []

    class Client:
        threads = {"one": 2, "two": 3}

        def __init__(self, address, timeout, set_as_default):
            done.append((address, timeout, set_as_default))

        def nthreads(self):
            if self.threads is None:
                raise OSError("closed")
            return self.threads

        def submit(self, call, pure):
            assert pure is False, "the same block twice is computed twice"
            return Computed(call)

        def close(self, timeout):
            done.append("closed")

    monkeypatch.setitem(sys.modules, "dask.distributed", SimpleNamespace(Client=Client))
    Client.done = done
    return Client


def test_as_much_for_a_cluster_as_it_has_threads(client, monkeypatch):
    with cluster_at("tcp://127.0.0.1:1", None) as (submit, width):
        assert width() == AHEAD * 5
        client.threads = {"one": 2}
        assert width() == AHEAD * 2, "a machine has left"
        client.threads = {}
        assert width() == AHEAD, "there may come another"
        assert client.done == [("tcp://127.0.0.1:1", cluster.CONNECT, False)]
        client.threads = None
        with pytest.raises(Lost, match="^the scheduler is gone$"):
            width()
    assert client.done[1:] == ["closed"]


def test_a_scheduler_that_listens_may_be_busy(client):
    with socket.create_server(("127.0.0.1", 0)) as scheduler:
        address = f"ws://127.0.0.1:{scheduler.getsockname()[1]}"
        with cluster_at(address, None):
            assert client.done == [(address, cluster.ANSWER, False)]


def test_workers_bound_the_threads_of_a_cluster(client):
    for count, expected in ((3, 3), (9, 5)):
        with cluster_at("tcp://127.0.0.1:1", count) as (submit, width):
            assert width() == AHEAD * expected


def test_what_comes_of_the_blocks_of_a_cluster(client):
    """A result; a block that raises fails alone; blocks that a lost scheduler has cancelled have not failed."""
    with cluster_at("tcp://127.0.0.1:1", None) as (submit, width):
        (_, number), (_, failure) = as_they_come(submit, width, float, ["2.5", "many"])
        assert number == 2.5 and failure.message == "ValueError: could not convert string to float: 'many'"
        with pytest.raises(Lost, match="^the scheduler is gone$"):
            list(as_they_come(submit, width, float, [None]))


def test_a_cluster_needs_its_package(monkeypatch):
    monkeypatch.setitem(sys.modules, "dask.distributed", None)
    with pytest.raises(StudyError) as caught, cluster_at("tcp://127.0.0.1:1", None):
        pass
    assert caught.value.messages == ("--scheduler needs the package distributed: pip install 'roughcoat[cluster]'",)


def test_a_parcel_holds_once_what_all_its_cases_share(file):
    found = parcel(load(file).definition, np.array([2, 3, 7]))
    assert {name: array.shape for name, array in found.parameters.items() if array.shape != (1,)} == {"P": (3,)}
    assert (found.first, found.last) == (2, 7) and found.profiles == ("p", "lam")

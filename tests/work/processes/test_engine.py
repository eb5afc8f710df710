"""What computes, and how much of it at a time; a cluster is played by the test."""

import io
import operator
import os
import pickle
import socket
import sys
from concurrent.futures import CancelledError
from types import SimpleNamespace

import dask.system
import numpy as np
import pytest
from line_study import load

from roughcoat.elsewhere import Packed
from study import StudyError
from study.work import cluster
from study.work.cases import NUMERICS_VERSION, Failure, parcel
from study.work.cluster import AHEAD, Lost, computed_on_cluster
from study.work.engine import available_workers


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
        self.key, self.status, self.call = object(), "finished", pickle.loads(pickle.dumps(call))  # as it travels
        _, (task,) = pickle.loads(self.call.__getstate__())
        if task is None:
            self.status = "cancelled"

    def add_done_callback(self, called):
        called(self)

    def result(self):
        if self.status == "cancelled":
            raise CancelledError("the scheduler is gone")
        try:
            return self.call()
        except Exception:
            self.status = "error"
            raise


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

        def run(self, function, workers, on_error):
            return dict.fromkeys(workers, NUMERICS_VERSION)

        def submit(self, call, pure):
            assert pure is False, "the same block twice is computed twice"
            return Computed(call)

        def close(self, timeout):
            done.append("closed")

    monkeypatch.setitem(sys.modules, "dask.distributed", SimpleNamespace(Client=Client))
    Client.done = done
    return Client


ADDRESS = "tcp://127.0.0.1:1"


@pytest.mark.parametrize("threads", [1, 3, 100])
def test_a_task_is_made_when_there_is_room_and_results_come_in_order(client, threads, monkeypatch):
    monkeypatch.setattr(cluster, "AHEAD", 1)
    client.threads = {"one": threads}
    made, under_way = [], []

    def tasks():
        for number in range(10):
            made.append(number)
            yield number

    for number, result in computed_on_cluster(ADDRESS, None, operator.neg, tasks()):
        assert result == -number and number == len(under_way)
        under_way.append(len(made) - number)
    assert len(under_way) == 10 and max(under_way) == min(threads, 10)
    assert client.done == [(ADDRESS, cluster.CONNECT, False), "closed"]


def test_the_width_is_asked_again_and_again(client, monkeypatch):
    """As workers come and go."""
    widths, made = iter([3, 2, 2, 1, 1, 1, 1, 1, 1]), []
    monkeypatch.setattr(cluster.Cluster, "room", lambda *_: next(widths))
    found = computed_on_cluster(ADDRESS, None, int, (made.append(i) or i for i in range(4)))
    assert [(number, len(made)) for number, _ in found] == [(0, 2), (1, 3), (2, 3), (3, 4)]


def test_a_task_that_raises_is_a_failure(client):
    found = dict(computed_on_cluster(ADDRESS, None, [1].__getitem__, [0, 1, 0]))
    assert found == {0: 1, 1: Failure("IndexError: list index out of range", ""), 2: 1}


def test_as_much_for_a_cluster_as_it_has_threads(client):
    there = cluster.Cluster(client("there", 1, False))
    assert there.room(None) == AHEAD * 5
    client.threads = {"one": 2}
    assert there.room(None) == AHEAD * 2, "a machine has left"
    client.threads = {}
    assert there.room(None) == AHEAD, "there may come another"
    client.threads = None
    with pytest.raises(Lost, match="^the scheduler is gone$"):
        there.room(None)


def test_a_cluster_is_left_when_the_run_ends_early(client):
    results = computed_on_cluster(ADDRESS, None, int, range(100))
    next(results)
    results.close()
    assert client.done[1:] == ["closed"]


def test_a_scheduler_that_listens_may_be_busy(client):
    with socket.create_server(("127.0.0.1", 0)) as scheduler:
        address = f"ws://127.0.0.1:{scheduler.getsockname()[1]}"
        assert list(computed_on_cluster(address, None, int, [])) == []
        assert client.done[0] == (address, cluster.ANSWER, False)


def test_workers_bound_the_threads_of_a_cluster(client):
    for count, expected in ((3, 3), (9, 5)):
        assert cluster.Cluster(client("there", 1, False)).room(count) == AHEAD * expected


def test_what_comes_of_the_blocks_of_a_cluster(client):
    """A result; a block that raises fails alone; blocks that a lost scheduler has cancelled have not failed."""
    (_, number), (_, failure) = computed_on_cluster(ADDRESS, None, float, ["2.5", "many"])
    assert number == 2.5 and failure.message == "ValueError: could not convert string to float: 'many'"
    with pytest.raises(Lost, match="^the scheduler is gone$"):
        list(computed_on_cluster(ADDRESS, None, float, [None]))


class Waiting(Computed):
    """A future of dask that does not end."""

    def add_done_callback(self, called): ...

    def cancel(self):
        self.status = "cancelled"


def test_only_blocks_whose_workers_have_all_gone_are_placed_anew(client, monkeypatch):
    monkeypatch.setattr(client, "submit", lambda self, call, **options: Waiting(call), raising=True)
    there = cluster.Cluster(client("there", 1, False))
    for number, workers in enumerate([("one", "gone"), ("gone",), ()]):
        there.submit(number, Packed(float, number), workers)
    futures = [future for future, *_ in there.under_way.values()]
    for threads, places in (({}, ("gone",)), ({"one": 2, "two": 3}, ("one", "two"))):
        client.threads = threads
        there._place_anew()
        blocks = {number: workers for _, number, _, workers in there.under_way.values()}
        assert blocks == {0: ("one", "gone"), 1: places, 2: ()}
        assert [future.status == "cancelled" for future in futures] == [False, bool(threads), False]


def test_a_cluster_needs_its_package(monkeypatch):
    monkeypatch.setitem(sys.modules, "dask.distributed", None)
    with pytest.raises(StudyError) as caught:
        list(computed_on_cluster(ADDRESS, None, float, []))
    assert caught.value.messages == ("--scheduler needs the package distributed: pip install 'roughcoat[cluster]'",)


def test_a_parcel_holds_once_what_all_its_cases_share(file):
    found = parcel(load(file).definition, np.array([2, 3, 7]))
    assert {name: array.shape for name, array in found.parameters.items() if array.shape != (1,)} == {"P": (3,)}
    assert (found.first, found.last) == (2, 7) and found.profiles == ("p", "lam")

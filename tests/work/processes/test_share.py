"""A large grid in one call: in blocks, by this thread and by processes, with the same numbers wherever."""

import multiprocessing
import subprocess
import sys
import threading
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import replace

import numpy as np
import pytest
from children import PATIENCE

import study
from solver import laws
from study.files.child import python_command
from study.inputs.definition import StudyError
from study.inputs.reading import from_call
from study.work import share
from study.work.cases import guarded

SMOOTH = {"micro": "smooth", "base": "half_space"}


def definition(size=30, **parameters):
    """A grid of so many loads."""
    loads = {"P": np.geomspace(1e-6, 1e-4, size).tolist()}
    return from_call(loads | parameters, [], False, {"title": "", "output": {"x": 3, "profiles": True}})


@pytest.mark.parametrize(
    ("size", "scheme", "expected"),
    [
        (1, "newton", [1]),
        (14_999, "newton", [14_999]),
        (20_001, "newton", [10_001, 10_000]),
        (4000, "picard", [2000] * 2),
    ],
)
def test_blocks_follow_from_the_grid_alone(size, scheme, expected):
    blocks = share.blocks_of_grid(definition(size, base="half_space", Nbar=250000.0, Ra=0.004, scheme=scheme))
    assert [len(block) for block in blocks] == expected
    np.testing.assert_array_equal(np.concatenate(blocks), np.arange(size))


class Threads:
    """In place of the processes: threads, whose `call` is given."""

    def __init__(self, call):
        self.call, self.asked, self.ended = call, [], False

    def reuse(self, most):
        return 0

    def feed(self, feeder, count):
        self.asked.append(count)
        found = Future()
        for _ in range(count):
            feeder(self.call)  # all that waits
        found.set_result(None)
        return [found] * count

    def end(self):
        self.ended = True


@pytest.fixture
def threads(monkeypatch):
    """Blocks of ten cases, which it always pays to compute apart."""
    kept = Threads(lambda function, given: function(given))
    for name, value in {"BLOCK": 10, "START": 1e-9, "_pool": kept}.items():
        monkeypatch.setattr(share, name, value)
    return kept


def assert_same_bits(found, expected):
    assert list(found) == list(expected)
    for name, array in expected.items():
        assert found[name].dtype == array.dtype and found[name].tobytes() == array.tobytes(), name


def test_what_is_computed_apart_is_put_in_its_place(threads):
    expected = share.solved(definition(**SMOOTH), 1)
    assert not threads.asked
    assert_same_bits(share.solved(definition(**SMOOTH), 2), expected)
    assert threads.asked == [1]


def fails(*_):
    raise AttributeError("there is no such law")


@pytest.mark.parametrize("call", [fails, lambda function, given: guarded(replace(given, numerics="0"))])
def test_what_no_process_can_compute_is_computed_here(threads, call):
    threads.call = call
    assert_same_bits(share.solved(definition(**SMOOTH), 2), share.solved(definition(**SMOOTH), 1))
    assert threads.asked == [1]


def test_a_feeder_that_fails_leaves_no_gaps(monkeypatch):
    """Its block would be what the memory held before."""
    here, apart = share.parcel, ThreadPoolExecutor(1)
    monkeypatch.setattr(share, "BLOCK", 10)
    monkeypatch.setattr(share, "START", 1e-9)

    def parcel(*given):
        if threading.current_thread() is threading.main_thread():
            return here(*given)
        raise MemoryError("no room for a block")

    class Pool(Threads):
        def feed(self, feeder, count):
            if not count or self.asked:
                return []
            self.asked.append(count)
            found = apart.submit(feeder, self.call)
            wait([found])
            return [found]

    monkeypatch.setattr(share, "_pool", kept := Pool(None))
    monkeypatch.setattr(share, "parcel", parcel)
    with pytest.raises(MemoryError, match="no room"):
        share.solved(definition(**SMOOTH), 2)
    assert kept.ended


def test_no_more_processes_than_have_work_for_their_start(threads, monkeypatch):
    monkeypatch.setattr(share, "START", 1e9)
    share.solved(definition(**SMOOTH), 2)
    assert set(threads.asked) == {0}
    monkeypatch.setattr(share, "START", 1e-9)
    share.solved(definition(**SMOOTH), 64)
    assert threads.asked[-1] == 2, "a block each, of the three"


def test_an_interrupt_ends_the_processes(threads, monkeypatch):
    def interrupted(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(share, "compute", interrupted)
    with pytest.raises(KeyboardInterrupt):
        share.solved(definition(**SMOOTH), 2)
    assert threads.ended and not share._in_use.locked()


def test_where_there_are_no_processes(monkeypatch):
    """With one worker, in threads (those of dask among them) and in processes of multiprocessing, which divide work
    themselves, in a program that is not Python, and for laws that only this program knows."""
    ordinary = definition(**SMOOTH)
    monkeypatch.setattr(share, "available_workers", lambda: 4)
    assert [share._processes_allowed(ordinary, workers) for workers in (None, 1, 2)] == [3, 0, 1]
    found = []
    thread = threading.Thread(target=lambda: found.extend(share._processes_allowed(ordinary, n) for n in (None, 2)))
    thread.start()
    thread.join()
    assert found == [0, 1]
    with monkeypatch.context() as patch:
        patch.setattr(multiprocessing, "parent_process", lambda: "a process")
        assert share._processes_allowed(ordinary, None) == 0
    for name, value in {"executable": "/usr/bin/blender", "frozen": True}.items():
        with monkeypatch.context() as patch:
            patch.setattr(sys, name, value, raising=False)
            assert share._processes_allowed(ordinary, 2) == 0
    named = {"curve": own_curve, "edge": own_edge, "area": own_area}
    mine = replace(laws.LAWS["disc_cell"], name="mine_alone", version="1", **named)
    rough = definition(micro=mine, base="half_space", Nbar=250000.0, Ra=0.004)
    assert share._processes_allowed(rough, 2) == 1
    monkeypatch.setattr(own_curve, "__module__", "__main__")
    monkeypatch.setattr(sys.modules["__main__"], "own_curve", own_curve, raising=False)  # so it can be sent
    assert share._processes_allowed(rough, 2) == 0


def own_curve(y):
    return laws.disc_cell.spot_curve(y)


def own_edge():  # those of the disc cell are `lambda`, and cannot be sent
    return laws.LAWS["disc_cell"].edge()


def own_area(y, q):
    return laws.disc_cell.spot_area(y)


SCRIPT = """
import numpy as np
import study
from study.work import share

print("begun")
share.BLOCK, share.START = 10, 1e-9
grid = {"P": np.geomspace(1e-6, 1e-4, 40), "micro": "smooth", "base": "thin_layer", "h": 0.02, "n": 0.5}
here, found = (study.solve(**grid, workers=count) for count in (1, 2))
assert share._pool.count == 1
assert share._pool.feed(lambda call: call(str, 1), 1)[0].result() == "1"
for name in here.variables:
    assert here[name].values.tobytes() == found[name].values.tobytes(), name
print("ended")
"""


def test_a_script_needs_no_guard(tmp_path):
    """It runs once, in whatever folder; its processes compute, and none of them holds it up at its end."""
    path = tmp_path / "script.py"
    path.write_text(SCRIPT)
    _, environment = python_command("")
    ended = subprocess.run(
        [sys.executable, path], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=PATIENCE
    )
    assert (ended.stdout, ended.stderr) == ("begun\nended\n", "")


def test_a_process_that_nobody_asks_ends():
    command, environment = python_command("from study.work import processes; processes.IDLE = 0.01; processes.serve()")
    with subprocess.Popen(command, env=environment, stdin=subprocess.PIPE) as process:
        assert process.wait(PATIENCE) == 0


@pytest.mark.parametrize("workers", [0, -1, 1.0, "2", True])
def test_workers_are_counted(workers):
    with pytest.raises(StudyError, match=r"^workers = .*: must be a whole number, 1 or more$"):
        study.solve(P=1e-5, **SMOOTH, workers=workers)


class Recorder:
    """In place of threads or processes of a pool: whether they were ended."""

    def __init__(self):
        self.ended = False

    def shutdown(self, **_):
        self.ended = True

    end = shutdown


def test_a_forked_process_has_no_workers_and_leaves_those_of_its_parent_alone(monkeypatch):
    """It would write into the pipes of its parent's workers, or kill them when it ends."""
    pool, mine = share._Pool(), share.os.getpid()
    pool.count, pool._owner, pool._threads, pool._processes = 3, mine, Recorder(), Recorder()
    assert [pool.reuse(most) for most in (2, 5)] == [2, 3]
    with monkeypatch.context() as forked:
        forked.setattr(share.os, "getpid", lambda: mine + 1)
        pool.end()
        assert not (pool._threads.ended or pool._processes.ended) and pool.reuse(5) == 0
    pool.count = 3
    pool.end()
    assert pool._threads.ended and pool._processes.ended and pool.reuse(5) == 0

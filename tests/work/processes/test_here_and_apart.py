"""A large grid in one call: in blocks, by this thread and by processes, with the same numbers wherever."""

import multiprocessing
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from children import PATIENCE

import study
from solver import laws
from solver.compiled.library import core
from study.inputs.definition import StudyError, from_call
from study.work import engine
from study.work.cases import guarded
from study.work.processes import python_command

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
    blocks = engine.blocks_of_grid(definition(size, base="half_space", Nbar=250000.0, Ra=0.004, scheme=scheme))
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
        for _ in range(count):
            feeder(self.call)  # all that waits
        return [None] * count

    def end(self):
        self.ended = True


@pytest.fixture
def threads(monkeypatch):
    """Blocks of ten cases, which it always pays to compute apart."""
    kept = Threads(lambda function, given: function(given))
    for name, value in {"BLOCK": 10, "START": 1e-9, "_pool": kept}.items():
        monkeypatch.setattr(engine, name, value)
    return kept


def assert_same_bits(found, expected):
    assert list(found) == list(expected)
    for name, array in expected.items():
        assert found[name].dtype == array.dtype and found[name].tobytes() == array.tobytes(), name


def test_what_is_computed_apart_is_put_in_its_place(threads):
    expected = engine.solved(definition(**SMOOTH), 1)
    assert not threads.asked
    assert_same_bits(engine.solved(definition(**SMOOTH), 2), expected)
    assert threads.asked == [1]


@pytest.mark.skipif(not core(), reason="no compiled core here")
def test_what_the_core_takes_is_solved_by_threads(threads, monkeypatch):
    """With the same bits, and no process is asked; stresses, spreads and other schemes take numpy."""
    rough = {"Nbar": 250000.0, "Ra": 0.004, "n": 0.5, "h": 0.02}
    who, real = set(), engine.guarded
    monkeypatch.setattr(engine, "guarded", lambda task: who.add(threading.current_thread()) or real(task))
    assert_same_bits(engine.solved(definition(60, **rough), 2), engine.solved(definition(60, **rough), 1))
    assert len(who) == 2 and not threads.asked
    assert not engine.core_takes(definition(scheme="picard", **rough)) and not engine.core_takes(definition(**SMOOTH))
    assert not engine.core_takes(replace(definition(**rough), inputs=("h",)))
    monkeypatch.setenv("ROUGHCOAT_CORE", "numpy")
    assert not engine.core_takes(definition(**rough))


def fails(*_):
    raise AttributeError("there is no such law")


@pytest.mark.parametrize("call", [fails, lambda function, given: guarded(replace(given, numerics="0"))])
def test_what_no_process_can_compute_is_computed_here(threads, call):
    threads.call = call
    assert_same_bits(engine.solved(definition(**SMOOTH), 2), engine.solved(definition(**SMOOTH), 1))
    assert threads.asked == [1]


def test_results_do_not_wait_in_great_number(monkeypatch):
    """The calling thread is in its first block; the process has solved AHEAD others, and then waits too."""
    monkeypatch.setattr(engine, "BLOCK", 1)
    solved, begun, go, apart, real = [], threading.Event(), threading.Event(), ThreadPoolExecutor(1), guarded

    def here(wanted):
        begun.set()
        go.wait(PATIENCE)
        time.sleep(0.3)  # meanwhile a process that does not wait would solve all others
        return real(wanted)

    def call(function, wanted):
        begun.wait(PATIENCE)
        solved.append(wanted.first)
        if len(solved) == engine.AHEAD:
            go.set()
        return real(wanted)

    class Pool(Threads):
        def reuse(self, most):
            return 1

        def feed(self, feeder, count):
            return [apart.submit(feeder, call)]

    monkeypatch.setattr(engine, "_pool", Pool(None))
    monkeypatch.setattr(engine, "guarded", here)
    results = engine.computed(definition(**SMOOTH), engine.blocks_of_grid(definition(**SMOOTH)), 2)
    next(results)
    assert engine.AHEAD <= len(solved) <= engine.AHEAD + 1
    assert sorted(number for number, _ in results) != [] and len(solved) < 30
    apart.shutdown()


def test_no_more_processes_than_have_work_for_their_start(threads, monkeypatch):
    monkeypatch.setattr(engine, "START", 1e9)
    engine.solved(definition(**SMOOTH), 2)
    assert set(threads.asked) == {0}
    monkeypatch.setattr(engine, "START", 1e-9)
    engine.solved(definition(**SMOOTH), 64)
    assert threads.asked[-1] == 2, "a block each, of the three"


def test_processes_compute_all_of_many_blocks_that_are_stored(threads, monkeypatch):
    """Of a run; of few blocks, and without processors for two, the calling thread computes."""
    monkeypatch.setattr(engine, "MANY", 3)
    monkeypatch.setattr(engine, "available_workers", lambda: 4)
    wanted = definition(**SMOOTH)
    for size, workers, asked in ((10, None, [3]), (10, 2, [2]), (15, None, [1]), (10, 1, []), (30, 1, [])):
        threads.asked.clear()
        blocks = np.array_split(np.arange(30), 30 // size)
        found = dict(engine.computed(wanted, blocks, workers, storing=True))
        assert sorted(found) == list(range(len(blocks))) and threads.asked == asked
        assert all((result["status"] == 0).all() for result in found.values())


def test_an_interrupt_ends_the_processes(threads, monkeypatch):
    def interrupted(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(engine, "guarded", interrupted)
    with pytest.raises(KeyboardInterrupt):
        engine.solved(definition(**SMOOTH), 2)
    assert threads.ended and not engine._in_use.locked()


def test_where_there_are_no_processes(monkeypatch):
    """With one worker, in threads (those of dask among them) and in processes of multiprocessing, which divide work
    themselves, in a program that is not Python, and for laws that only this program knows."""
    ordinary = definition(**SMOOTH)
    monkeypatch.setattr(engine, "available_workers", lambda: 4)
    assert [engine._processors_allowed(ordinary, workers) for workers in (None, 1, 2)] == [4, 1, 2]
    found = []
    thread = threading.Thread(target=lambda: found.extend(engine._processors_allowed(ordinary, n) for n in (None, 2)))
    thread.start()
    thread.join()
    assert found == [1, 2]
    with monkeypatch.context() as patch:
        patch.setattr(multiprocessing, "parent_process", lambda: "a process")
        assert engine._processors_allowed(ordinary, None) == 1
    for name, value in {"executable": "/usr/bin/blender", "frozen": True}.items():
        with monkeypatch.context() as patch:
            patch.setattr(sys, name, value, raising=False)
            assert engine._processors_allowed(ordinary, 2) == 1
    named = {"curve": own_curve, "edge": own_edge, "area": own_area}
    mine = replace(laws.LAWS["disc_cell"], name="mine_alone", version="1", **named)
    rough = definition(micro=mine, base="half_space", Nbar=250000.0, Ra=0.004)
    assert engine._processors_allowed(rough, 2) == 2
    monkeypatch.setattr(own_curve, "__module__", "__main__")
    monkeypatch.setattr(sys.modules["__main__"], "own_curve", own_curve, raising=False)  # so it can be sent
    assert engine._processors_allowed(rough, 2) == 1


def own_curve(y):
    return laws.disc_cell.spot_curve(y)


def own_edge():  # those of the disc cell are `lambda`, and cannot be sent
    return laws.LAWS["disc_cell"].edge()


def own_area(y, q):
    return laws.disc_cell.spot_area(y)


SCRIPT = """
import numpy as np
import study
from study.work import engine

print("begun")
engine.BLOCK, engine.START = 10, 1e-9
grid = {"P": np.geomspace(1e-6, 1e-4, 40), "micro": "smooth", "base": "thin_layer", "h": 0.02, "n": 0.5}
here, found = (study.solve(**grid, workers=count) for count in (1, 2))
assert engine._pool.count == 1
assert engine._pool.feed(lambda call: call(str, 1), 1)[0].result() == "1"
for name in here.variables:
    assert here[name].values.tobytes() == found[name].values.tobytes(), name
print("ended")
"""


def test_a_script_needs_no_guard(tmp_path):
    """It runs once, in whatever folder; its processes compute, and none of them holds it up at its end."""
    path = tmp_path / "script.py"
    path.write_text(SCRIPT)
    environment = python_command("")[1] | {"ROUGHCOAT_CORE": "numpy"}  # what the core takes is left to threads
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

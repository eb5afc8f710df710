"""Runs from the command line compute many blocks in processes: what happens to one is no harm to results or machine."""

import os
import signal
import sys
import threading
from multiprocessing.process import BaseProcess as Run
from pathlib import Path
from types import SimpleNamespace

import pytest
from children import PATIENCE, command, held, lines, stored, wait_for
from line_study import load, present
from same import assert_same
from tasks import note_and_die, note_and_wait

from study.work import engine
from study.work.cases import Failure
from study.work.engine import number_of_helpers
from study.work.processes import ATTEMPTS, KILLED, Processes

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
BEFORE, CASES = 5, 40  # cases in blocks of one; those from BEFORE on are held


@pytest.fixture
def opened(file):
    return load(file, **{"num = 23": f"num = {CASES}", "block = 5": "block = 1"})


def started(opened) -> Run:
    """A run from the command line in a session of its own."""
    return command(opened.results.parent, BEFORE, "run", "line.toml", "--workers", "2", prepared=alone)


def alone() -> None:
    """Lead a session, and end at what closes its terminal, which background jobs and nohup ignore."""
    os.setsid()
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def ended(process: Run, opened) -> tuple[int, str]:
    """Exit code of a run, and what it has said, once it has ended."""
    process.join(PATIENCE)
    return process.exitcode, (opened.results.parent / "errors").read_text()


def workers_of(process: Run) -> list[int]:
    """Processes that compute for a run, those that have ended and not been waited for left out."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, session = stat.read_text().rpartition(")")[2].split()[:4]
            if int(session) == process.pid and state != "Z" and b"serve()" in (stat.parent / "cmdline").read_bytes():
                found.append(int(stat.parent.name))
        except OSError:  # it has ended
            continue
    return found


def at_work(opened) -> bool:
    """Whether what is before the held cases is on disk, and both workers hold one."""
    folder = opened.results.parent
    return stored(folder) == BEFORE and len(held(folder)) == 2


def assert_ends_well(opened, done: int) -> None:
    """So many cases are on disk, and the next run computes the others."""
    assert present(opened) == done
    report = opened.run()
    assert report.complete and report.computed == CASES - done


def test_processes_compute_what_threads_compute(opened, tmp_path):
    process = started(opened)
    wait_for(lambda: at_work(opened))
    assert {*map(str, workers_of(process))} == held(tmp_path)
    (tmp_path / "go").touch()
    assert ended(process, opened)[0] == 0
    (tmp_path / "threads").mkdir()
    threads = load(tmp_path / "threads" / "line.toml", **{"num = 23": f"num = {CASES}", "block = 5": "block = 1"})
    threads.run()
    assert_same(opened.open(), threads.open())


def test_how_many_processes():
    """None for a single worker, and never more than there are blocks."""
    alone = [number_of_helpers(*each, caller_solves=False) for each in ((2, 8), (16, 9))]
    beside = [number_of_helpers(*each, caller_solves=True) for each in ((2, 7), (1, 100), (16, 9))]
    assert (alone, beside) == ([2, 9], [1, 0, 8])


@pytest.fixture
def processes():
    found = Processes()
    yield found
    found.end()


def test_what_a_task_prints_is_no_answer(processes):
    assert [processes.call(print, word) for word in ("one", "two")] == [None, None]


def test_what_a_process_does_not_know_is_said(processes, monkeypatch):
    monkeypatch.delenv("PYTHONPATH", raising=False)
    assert processes.call(note_and_die, Path()).message == "ModuleNotFoundError: No module named 'tasks'"
    assert processes.call(abs, -1) == 1


@pytest.fixture
def importable(monkeypatch):
    """Worker processes can import the files beside conftest.py."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))


def test_a_task_that_kills_its_process_is_given_up_and_others_are_not(importable, processes, tmp_path):
    """Its process is started again each time, and once more for the next task."""
    log = tmp_path / "log"
    assert processes.call(note_and_die, log) == Failure(KILLED, "")
    assert len(lines(log)) == ATTEMPTS
    assert processes.call(abs, -1) == 1


def test_a_process_does_not_end_what_nobody_waits_for(importable, processes, tmp_path):
    caller = threading.Thread(target=processes.call, args=(note_and_wait, tmp_path / "log"))
    caller.start()
    wait_for(lambda: lines(tmp_path / "log"))
    processes.end()
    caller.join(PATIENCE)
    (process,) = lines(tmp_path / "log")
    assert not Path("/proc", process).exists()


def test_a_killed_worker_costs_the_blocks_it_computed_only(opened, tmp_path):
    """Another process computes them, in the same run."""
    process = started(opened)
    wait_for(lambda: at_work(opened))
    os.kill(workers_of(process)[0], signal.SIGKILL)
    wait_for(lambda: len(held(tmp_path)) == 3)
    (tmp_path / "go").touch()
    code, errors = ended(process, opened)
    assert code == 0 and "Traceback" not in errors
    assert opened.status()["counts"] == {0: CASES} and len(lines(tmp_path / "go.log")) < CASES


@pytest.mark.parametrize(("number", "whom"), [(signal.SIGKILL, os.kill), (signal.SIGHUP, os.killpg)])
def test_nothing_is_left_of_a_killed_run_and_of_one_whose_terminal_is_closed(opened, number, whom):
    """Its workers end, in the middle of their work; on the disk are the finished blocks."""
    process = started(opened)
    wait_for(lambda: at_work(opened))
    whom(process.pid, number)
    assert ended(process, opened) == (-number, "")
    wait_for(lambda: not workers_of(process))
    assert_ends_well(opened, BEFORE)


@pytest.mark.parametrize("moment", ["as they start", "at work"])
def test_an_interrupt_of_all_processes_is_the_runs_alone(opened, moment):
    """As Ctrl-C in a terminal."""
    process = started(opened)
    wait_for(lambda: workers_of(process) if moment == "as they start" else at_work(opened))
    os.killpg(process.pid, signal.SIGINT)
    code, errors = ended(process, opened)
    assert code == 130
    text = errors.removeprefix("\n")  # of a line of progress, if there was one
    assert text in ("", "interrupted; finished blocks are kept, and the same command continues from there\n"), (
        "or it began"
    )
    wait_for(lambda: not workers_of(process))
    assert_ends_well(opened, BEFORE if moment == "at work" else present(opened))


class Recorder:
    """In place of threads or processes of a pool: whether they were ended."""

    def __init__(self):
        self.ended = False

    def shutdown(self, **_):
        self.ended = True

    end = shutdown


def test_a_pool_does_not_wait_for_what_its_processes_compute():
    """They are ended, which ends the threads that feed them."""
    pool, ended = engine._Pool(), threading.Event()
    pool.count, pool._owner, pool._processes = 1, engine.os.getpid(), SimpleNamespace(end=ended.set)
    pool._threads = engine.ThreadPoolExecutor(1)
    feeder = pool._threads.submit(ended.wait, 5)
    pool.end()
    assert feeder.result() and pool.count == 0


def test_a_forked_process_has_no_workers_and_leaves_those_of_its_parent_alone(monkeypatch):
    """It would write into the pipes of its parent's workers, or kill them when it ends."""
    pool, mine = engine._Pool(), engine.os.getpid()
    pool.count, pool._owner, pool._threads, pool._processes = 3, mine, Recorder(), Recorder()
    assert [pool.reuse(most) for most in (2, 5)] == [2, 3]
    with monkeypatch.context() as forked:
        forked.setattr(engine.os, "getpid", lambda: mine + 1)
        pool.end()
        assert not (pool._threads.ended or pool._processes.ended) and pool.reuse(5) == 0
    pool.count = 3
    pool.end()
    assert pool._threads.ended and pool._processes.ended and pool.reuse(5) == 0

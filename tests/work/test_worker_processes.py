"""Runs from the command line compute many blocks in processes: what happens to one is no harm to results or machine."""

import os
import re
import signal
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import pytest
from children import PATIENCE, held, holding, stored, wait_for
from conftest import ROOT
from line_study import load, present
from same import assert_same

from study.work import workers
from study.work.workers import engine, processes_for

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
BEFORE, CASES = 5, 40  # cases in blocks of one; those from BEFORE on are held


@pytest.fixture
def opened(file):
    return load(file, **{"num = 23": f"num = {CASES}", "block = 5": "block = 1"})


def started(opened, *options: str) -> subprocess.Popen:
    """A run from the command line in a session of its own."""
    folder = opened.results.parent
    command = [sys.executable, ROOT / "tests" / "hold.py", "run", "line.toml", "--workers", "2", *options]

    def listen():  # what background jobs and nohup ignore
        for number in (signal.SIGINT, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)

    where = {"cwd": folder, "env": holding(folder, BEFORE), "start_new_session": True}
    return subprocess.Popen(command, **where, preexec_fn=listen, stderr=subprocess.PIPE, text=True)


def workers_of(process: subprocess.Popen) -> list[int]:
    """Processes that compute for a run, those that have ended and not been waited for left out."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, session = stat.read_text().rpartition(")")[2].split()[:4]
            if int(session) == process.pid and state != "Z" and b"spawn_main" in (stat.parent / "cmdline").read_bytes():
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
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, errors
    (tmp_path / "threads").mkdir()
    threads = load(tmp_path / "threads" / "line.toml", **{"num = 23": f"num = {CASES}", "block = 5": "block = 1"})
    threads.run()
    assert_same(opened.open(), threads.open())


def test_how_many_processes():
    """None for few blocks or a single worker, and never more than there are blocks."""
    assert [processes_for(*each) for each in ((2, 7), (2, 8), (1, 100), (16, 9))] == [0, 2, 0, 9]


@pytest.mark.parametrize(("blocks", "kind"), [(100, ProcessPoolExecutor), (7, ThreadPoolExecutor)])
def test_which_executor(monkeypatch, blocks, kind):
    asked = []
    monkeypatch.setattr(workers, "_processes", lambda count: asked.append(count) or ProcessPoolExecutor(count))
    with engine(3, None, blocks) as found:
        assert isinstance(found.executor, kind) and found.width() == 12
        assert asked == ([3] if kind is ProcessPoolExecutor else [])


def test_a_killed_worker_ends_the_run_and_costs_the_blocks_in_work(opened):
    process = started(opened)
    wait_for(lambda: at_work(opened))
    os.kill(workers_of(process)[0], signal.SIGKILL)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 1
    assert "a process that computed has been killed, perhaps for want of memory; finished blocks are kept" in errors
    assert "Traceback" not in errors
    assert_ends_well(opened, BEFORE)


def semaphores_of(process: int) -> set[Path]:
    """The files of the semaphores that a process has."""
    return {Path(found) for found in re.findall(r"/dev/shm/sem\.\S+", Path(f"/proc/{process}/maps").read_text())}


@pytest.mark.parametrize(("number", "whom"), [(signal.SIGKILL, os.kill), (signal.SIGHUP, os.killpg)])
def test_nothing_is_left_of_a_killed_run_and_of_one_whose_terminal_is_closed(opened, number, whom):
    """Its workers end, and their semaphores are removed; on the disk are the finished blocks."""
    process = started(opened)
    wait_for(lambda: at_work(opened))
    semaphores = semaphores_of(workers_of(process)[0])
    assert len(semaphores) == 5 and all(path.exists() for path in semaphores)
    whom(process.pid, number)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == -number and errors == ""
    wait_for(lambda: not workers_of(process))
    wait_for(lambda: not any(path.exists() for path in semaphores))
    assert_ends_well(opened, BEFORE)


@pytest.mark.parametrize("moment", ["as they start", "at work"])
def test_an_interrupt_of_all_processes_is_the_runs_alone(opened, moment):
    """As Ctrl-C in a terminal."""
    process = started(opened)
    wait_for(lambda: workers_of(process) if moment == "as they start" else at_work(opened))
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    text = errors.removeprefix("\n")  # of a line of progress, if there was one
    assert text in ("", "interrupted; finished blocks are kept, the same command goes on from there\n"), "or it began"
    wait_for(lambda: not workers_of(process))
    assert_ends_well(opened, BEFORE if moment == "at work" else present(opened))

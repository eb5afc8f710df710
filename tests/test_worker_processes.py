"""Runs from the command line compute many blocks in processes: what happens to one is no harm to results or machine."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from children import wait_for
from line_study import present
from same import assert_same

import study
from study.cluster import processes_for

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")

CASES = 200
TEXT = f"""
[model]
micro = "disc_cell"
Nbar = 250000
Ra = 0.004
n = 0.5
h = 0.02
[axes]
P = {{start = 1e-6, stop = 1e-4, num = {CASES}}}
[numerics]
block = 1
[output]
x = 3
"""


@pytest.fixture
def opened(tmp_path) -> study.Study:
    (tmp_path / "line.toml").write_text(TEXT, encoding="utf-8")
    return study.load(tmp_path / "line.toml", tmp_path / "results")


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("undisturbed")
    (folder / "line.toml").write_text(TEXT, encoding="utf-8")
    opened = study.load(folder / "line.toml", folder / "results")
    opened.run()
    return opened.open()


def started(opened, *options) -> subprocess.Popen:
    """A run from the command line in a session of its own."""
    command = [sys.executable, "-m", "study", "run", "line.toml", "--workers", "2", *options]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(path or os.getcwd() for path in sys.path)}
    listening = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)}  # ignored in background jobs
    where = {"cwd": opened.results.parent, "env": environment, "start_new_session": True}
    return subprocess.Popen(command, **where, **listening, stderr=subprocess.PIPE, text=True)


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


def some_blocks(opened) -> bool:
    return any(opened.results.rglob("*.block"))


def assert_ends_well(opened, undisturbed) -> None:
    computed = CASES - present(opened)
    report = opened.run()
    assert report.complete and report.computed == computed
    assert_same(opened.open(), undisturbed)


def test_processes_compute_what_threads_compute(opened, undisturbed):
    process = started(opened)
    wait_for(lambda: len(workers_of(process)) == 2)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 0, errors
    assert_same(opened.open(), undisturbed)


def test_how_many_processes():
    """None for few blocks or a single worker, and never more than there are blocks."""
    assert [processes_for(*each) for each in ((2, 7), (2, 8), (1, 100), (16, 9))] == [0, 2, 0, 9]


def test_one_worker_computes_in_the_process_itself(opened):
    process = started(opened, "--workers", "1")
    wait_for(lambda: some_blocks(opened))
    assert not workers_of(process)
    process.kill()
    process.communicate()


def test_a_killed_worker_ends_the_run_and_costs_the_blocks_in_work(opened, undisturbed):
    process = started(opened)
    wait_for(lambda: some_blocks(opened))
    os.kill(workers_of(process)[0], signal.SIGKILL)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "a process that computed has been killed, perhaps for want of memory; finished blocks are kept" in errors
    assert "Traceback" not in errors
    assert 0 < present(opened) < CASES
    assert_ends_well(opened, undisturbed)


def test_workers_end_with_a_killed_run(opened, undisturbed):
    process = started(opened)
    wait_for(lambda: some_blocks(opened))
    process.kill()
    process.communicate()
    wait_for(lambda: not workers_of(process), 10)
    assert_ends_well(opened, undisturbed)


@pytest.mark.parametrize("moment", ["as they start", "at work"])
def test_an_interrupt_of_all_processes_is_the_runs_alone(opened, undisturbed, moment):
    """As Ctrl-C in a terminal."""
    process = started(opened)
    wait_for(lambda: workers_of(process) if moment == "as they start" else some_blocks(opened))
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert "finished blocks are kept" in errors
    wait_for(lambda: not workers_of(process), 10)
    assert_ends_well(opened, undisturbed)

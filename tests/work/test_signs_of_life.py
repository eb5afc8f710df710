"""Calls that take more than two seconds say that they go on, where somebody may look; others do not say a word."""

import io
import sys
import threading
import time
import types

import numpy as np
import pytest
from screens import CONTACT, PATIENCE, Screen, as_stderr, lines, nobody_speaks, slowly

import study
from solver import Status
from study import solving
from study.work import cases, engine, progress
from study.work.progress import ERASE, Progress


def test_a_call_that_lasts_says_so_and_leaves_the_terminal_as_it_was(monkeypatch, capsys, stderr):
    slowly(monkeypatch, lambda: stderr.written.wait(PATIENCE))
    study.solve(**CONTACT)
    assert {*lines(stderr.getvalue())} == {"solving 1 contact: 0 s"}
    assert stderr.getvalue().startswith(ERASE) and stderr.getvalue().endswith(ERASE)
    assert capsys.readouterr().out == "" and nobody_speaks()


def test_the_two_seconds_begin_with_the_call(monkeypatch, stderr):
    """Not with the solver: what was given may take a second to read. The call begins 100 s ago here."""
    monkeypatch.setattr(progress, "SILENT", 50)
    monkeypatch.setattr(solving, "time", types.SimpleNamespace(monotonic=lambda: time.monotonic() - 100))
    slowly(monkeypatch, lambda: stderr.written.wait(PATIENCE))
    study.solve(**CONTACT)
    assert lines(stderr.getvalue()) == ["solving 1 contact: 1 min 40 s"]


def test_a_quick_call_says_nothing(monkeypatch, stderr):
    """As long as SILENT is: no block of several changes that."""
    monkeypatch.setattr(progress, "SILENT", PATIENCE)
    monkeypatch.setattr(engine, "BLOCK", 10)
    study.solve(progress=True, **CONTACT)
    study.solve(progress=True, workers=1, **CONTACT | {"P": np.geomspace(1e-6, 1e-5, 100)})
    assert stderr.getvalue() == "" and nobody_speaks()


def test_of_several_blocks_it_says_how_far_it_is(monkeypatch, stderr):
    monkeypatch.setattr(engine, "BLOCK", 10)
    monkeypatch.setattr(progress, "BLINK", 0)

    def wait() -> None:
        stderr.written.clear()
        stderr.written.wait(PATIENCE)

    slowly(monkeypatch, wait)
    study.solve(workers=1, **CONTACT | {"P": np.geomspace(1e-6, 1e-5, 30)})
    said = [line.partition(", ")[0] for line in lines(stderr.getvalue())]
    assert list(dict.fromkeys(said)) == [
        "solving 30 contacts: 0 s",
        "solving 30 contacts: 10 of 30 cases",
        "solving 30 contacts: 20 of 30 cases",
    ]
    assert stderr.getvalue().endswith(ERASE)


def test_the_time_left_counts_down_between_blocks(monkeypatch):
    now, shown = [1000.0], Screen()
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    call = Progress("solving", 100, shown, begun=1000.0, passing=True)
    now[0] += 10
    call.update(10, failed=0)
    for seconds in (0, 20, 80):
        now[0] += seconds
        call.tell()
    assert [line.rpartition(", ")[2] for line in lines(shown.getvalue())] == [
        "1 min 30 s left",
        "1 min 10 s left",
        "0 s left",
    ]


@pytest.mark.parametrize("value", [None, False])
def test_nothing_is_said_in_a_file_unless_it_is_wanted(monkeypatch, impatient, capfd, value):
    slowly(monkeypatch, lambda: time.sleep(0.1))
    study.solve(progress=value, **CONTACT)
    assert capfd.readouterr() == ("", "")


def test_it_is_said_in_a_file_if_it_is_wanted(monkeypatch, impatient):
    stderr = as_stderr(monkeypatch, Screen())
    stderr.isatty = lambda: False
    slowly(monkeypatch, lambda: (stderr.written.wait(PATIENCE), time.sleep(0.1)))
    study.solve(progress=True, **CONTACT)
    assert lines(stderr.getvalue()) == ["solving 1 contact: 0 s\n"]  # the next one in ten seconds


def test_it_is_not_said_on_a_terminal_if_it_is_not_wanted(monkeypatch, stderr):
    slowly(monkeypatch, lambda: time.sleep(0.1))
    study.solve(progress=False, **CONTACT)
    assert stderr.getvalue() == ""


def test_threads_of_a_program_that_divides_its_work_say_nothing_by_themselves(stderr):
    with_a_thread = []
    for value in (None, True):
        thread = threading.Thread(target=lambda value=value: with_a_thread.append(progress.screen_of(value)))
        thread.start()
        thread.join()
    assert with_a_thread == [None, stderr]


@pytest.mark.parametrize("value", ["no", 1, [True]])
def test_what_is_neither_true_nor_false_is_refused(value):
    with pytest.raises(study.StudyError, match="progress = .*: must be True, False or None"):
        study.solve(progress=value, **CONTACT)


def test_numpys_true_is_true(stderr):
    assert study.solve(progress=np.True_, **CONTACT).status == 0


@pytest.mark.parametrize("kind", ["none", "closed"])
def test_a_program_without_stderr_computes(monkeypatch, impatient, kind):
    stream = io.StringIO()
    stream.close()
    as_stderr(monkeypatch, None if kind == "none" else stream)
    slowly(monkeypatch, lambda: time.sleep(0.1))
    assert study.solve(progress=True, **CONTACT).status == 0


def test_a_terminal_that_goes_away_does_not_end_the_call(monkeypatch, stderr):
    def write(_: str) -> int:
        stderr.written.set()
        raise OSError("it is gone")

    stderr.write = write
    slowly(monkeypatch, lambda: stderr.written.wait(PATIENCE))
    assert study.solve(**CONTACT).status == 0 and stderr.written.is_set()


class Handle:
    """What IPython gives for an output that can be changed; `cell` is what stands there now."""

    def __init__(self, cell: list):
        self.cell, self.written = cell, threading.Event()

    def display(self, data: dict, raw: bool, display_id: bool) -> "Handle":
        assert raw and display_id
        self.update(data, raw)
        return self

    def update(self, data: dict, raw: bool) -> None:
        assert raw
        self.cell.append(data)
        self.written.set()


def a_notebook(monkeypatch, handle: Handle) -> None:
    """Let this process be that of a notebook."""
    shell = types.SimpleNamespace(kernel=object())
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setitem(sys.modules, "IPython.display", types.SimpleNamespace(display=handle.display))


def test_a_notebook_has_the_line_in_its_cell_and_nothing_in_the_end(monkeypatch, impatient, capfd):
    handle = Handle([])
    a_notebook(monkeypatch, handle)
    slowly(monkeypatch, lambda: handle.written.wait(PATIENCE))
    study.solve(**CONTACT)
    assert lines(handle.cell[0]["text/plain"]) == ["solving 1 contact: 0 s"]
    assert handle.cell[-1] == {"text/plain": "", "text/html": ""}
    assert capfd.readouterr() == ("", "")
    study.solve(progress=False, **CONTACT)
    assert handle.cell[-1] == {"text/plain": "", "text/html": ""}


def test_a_notebook_that_goes_away_does_not_end_the_call(monkeypatch, impatient):
    class Gone(Exception):
        pass

    handle = Handle([])

    def display(*_, **__):
        handle.written.set()
        raise Gone

    handle.display = display
    a_notebook(monkeypatch, handle)
    slowly(monkeypatch, lambda: handle.written.wait(PATIENCE))
    assert study.solve(**CONTACT).status == 0 and handle.written.is_set()


LINE = '[model]\nmicro = "smooth"\nbase = "half_space"\n[axes]\nP = [1e-6, 2e-6, 3e-6]\n[numerics]\nblock = 1\n'


@pytest.mark.parametrize(("value", "said"), [(None, True), (True, True), (False, False)])
def test_runs_from_python_say_it_as_calls_do(tmp_path, monkeypatch, stderr, value, said):
    (tmp_path / "line.toml").write_text(LINE, encoding="utf-8")
    real = engine.guarded
    monkeypatch.setattr(
        engine, "guarded", lambda wanted: (stderr.written.wait(PATIENCE if said else 0.1), real(wanted))[1]
    )
    report = study.load(tmp_path / "line.toml", tmp_path / "results").run(workers=1, progress=value)
    assert report.complete and bool(lines(stderr.getvalue())) == said
    if said:
        assert lines(stderr.getvalue())[0] == "line: 0 s" and stderr.getvalue().endswith(ERASE)


def test_a_run_whose_first_block_lasts_says_that_it_goes_on(impatient):
    """What was computed before is named, and the last line stays."""
    shown = Screen()
    with Progress("line", 20, shown, done=5) as going:
        assert shown.written.wait(PATIENCE)
        going.update(15, failed=0)
    assert lines(shown.getvalue())[0] == "line: 0 s, 5 of 20 cases are there"
    assert lines(shown.getvalue())[-1].startswith("line: 20 of 20 cases, 0 failed") and shown.getvalue().endswith("\n")


def test_status_of_a_failed_case_is_counted(monkeypatch, stderr):
    """Cases that failed are named; one without a solution has not."""
    monkeypatch.setattr(engine, "BLOCK", 4)
    real = cases.compute

    def compute(wanted):
        stderr.written.clear()
        stderr.written.wait(PATIENCE)
        found = real(wanted)
        found["status"][:3] = Status.DIVERGED, Status.DIVERGED, Status.LIFT_OFF
        return found

    monkeypatch.setattr(cases, "compute", compute)
    monkeypatch.setattr(progress, "BLINK", 0)
    study.solve(workers=1, **CONTACT | {"P": np.geomspace(1e-6, 1e-5, 12)})
    said = [line for line in lines(stderr.getvalue()) if "failed" in line]
    assert [line.split(", ")[1] for line in (said[0], said[-1])] == ["2 failed", "4 failed"]

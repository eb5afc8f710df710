"""What a call that is interrupted leaves on the terminal, and what `point` says there and in a pipe."""

import os
import signal
import subprocess
import sys
import threading

import pytest
from conftest import ROOT
from screens import CONTACT, PATIENCE, lines, nobody_speaks, slowly

import study
from study.work.progress import ERASE, SPEAKER


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError])
def test_an_interrupted_call_leaves_no_line_and_no_thread(monkeypatch, stderr, error):
    def wait() -> None:
        stderr.written.wait(PATIENCE)
        raise error

    slowly(monkeypatch, wait)
    with pytest.raises(error):
        study.solve(**CONTACT)
    assert lines(stderr.getvalue()) and stderr.getvalue().endswith(ERASE) and nobody_speaks()


@pytest.mark.parametrize("moment", ["start", "join"])
def test_an_interrupt_while_the_line_begins_or_ends_leaves_no_line(monkeypatch, stderr, moment):
    """The thread that writes it is started or waited for in this moment, and has written."""
    real = getattr(threading.Thread, moment)

    def interrupted(thread: threading.Thread) -> None:
        if moment == "start":
            real(thread)
        assert stderr.written.wait(PATIENCE)
        raise KeyboardInterrupt

    slowly(monkeypatch, lambda: stderr.written.wait(PATIENCE))
    monkeypatch.setattr(threading.Thread, moment, interrupted)
    with pytest.raises(KeyboardInterrupt):
        study.solve(**CONTACT)
    monkeypatch.undo()
    for thread in threading.enumerate():
        if thread.name == SPEAKER:
            thread.join(PATIENCE)
    assert lines(stderr.getvalue()) and stderr.getvalue().endswith(ERASE) and nobody_speaks()


# Who runs the tests in the background may have Ctrl-C ignored, which processes inherit.
SLOW_POINT = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)
from study.work import cases, progress
progress.SILENT = 0.05
real = cases.compute
cases.compute = lambda wanted: (time.sleep({seconds}), real(wanted))[1]
sys.argv = ["roughcoat", "point", "P=1e-5", "micro=smooth", "base=half_space"]
from study.__main__ import main
sys.exit(main())
"""


def point(seconds: float, **streams) -> subprocess.Popen:
    """`roughcoat point` of a contact that takes so many seconds; two seconds without a word are 0.05 s here."""
    environment = os.environ | {"TERM": "xterm", "PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "error"}
    code = SLOW_POINT.format(seconds=seconds)
    return subprocess.Popen([sys.executable, "-c", code], env=environment, stdout=subprocess.PIPE, **streams)


def test_point_says_nothing_beside_its_answer_in_a_pipe():
    process = point(0.3, stderr=subprocess.PIPE)
    answer, said = process.communicate(timeout=100)
    assert process.returncode == 0 and said == b"" and answer.startswith(b"Given:")


@pytest.mark.skipif(os.name == "nt", reason="POSIX terminals")
@pytest.mark.parametrize("interrupted", [False, True])
def test_point_says_on_a_terminal_that_it_goes_on(interrupted):
    inside, outside = os.openpty()
    process = point(PATIENCE if interrupted else 0.3, stderr=outside)
    os.close(outside)
    said = os.read(inside, 10_000)
    if interrupted:
        process.send_signal(signal.SIGINT)
    answer, _ = process.communicate(timeout=100)
    with pytest.raises(OSError, match="."):  # the other end is closed
        while True:
            if not (more := os.read(inside, 10_000)):
                raise OSError("the end")
            said += more
    os.close(inside)
    text = said.decode()
    assert text.startswith(ERASE) and lines(text)[0] == "solving 1 contact: 0 s" and ERASE in text[len(ERASE) :]
    if interrupted:
        assert process.returncode == 130 and answer == b"" and "Traceback" not in text
    else:
        assert process.returncode == 0 and text.endswith(ERASE) and answer.startswith(b"Given:")

"""Signals: the first ends a run in good order, the second at once, and those that the parent ignores are ignored.

At whatever moment one comes, there is no traceback, and exit code 0 means that the results are complete.
"""

import hashlib
import logging
import os
import subprocess
import sys
from contextlib import suppress
from functools import partial
from signal import SIGINT, SIGTERM, raise_signal

import pytest
from children import PATIENCE, command, stored, wait_for
from conftest import ROOT
from line_study import leftovers, load, present

from study import terminal
from study.work import run

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
RUN = ("run", "line.toml", "--workers", "1")


@pytest.fixture
def opened(file):
    return load(file, **{"num = 23": "num = 60"})


@pytest.mark.parametrize("number", [SIGINT, SIGTERM])
def test_the_first_ends_in_good_order_without_waiting_for_the_block_in_work(opened, tmp_path, number):
    process = command(tmp_path, 15, *RUN)
    wait_for(lambda: stored(tmp_path) == 3)
    os.kill(process.pid, number)
    process.join(PATIENCE)
    assert process.exitcode == 130
    said = (tmp_path / "errors").read_text()
    assert said.endswith("\ninterrupted; finished blocks are kept, and the same command continues from there\n")
    assert "Traceback" not in said
    assert not list(tmp_path.rglob("*.tmp")) and present(opened) == 15
    assert opened.run().computed == 45


@pytest.mark.parametrize(("first", "second"), [(SIGINT, SIGINT), (SIGTERM, SIGINT), (SIGINT, SIGTERM)])
def test_the_second_ends_at_once(opened, tmp_path, first, second):
    process = command(tmp_path, 15, *RUN, stuck=True)
    wait_for(lambda: stored(tmp_path) == 3)
    os.kill(process.pid, first)
    wait_for((tmp_path / "ending").exists)
    os.kill(process.pid, second)
    process.join(PATIENCE)
    assert process.exitcode == 130
    assert "interrupted" not in (tmp_path / "errors").read_text()
    assert opened.run().computed == 45, "what was stored is kept"


@pytest.mark.parametrize("number", [SIGINT, SIGTERM])
def test_a_signal_that_the_parent_ignores_is_ignored(opened, tmp_path, number):
    """As that of a closed terminal's Ctrl-C, when a shell starts a run in the background."""
    process = command(tmp_path, 15, *RUN, ignoring=(number,))
    wait_for(lambda: stored(tmp_path) == 3)
    os.kill(process.pid, number)
    (tmp_path / "go").touch()
    process.join(PATIENCE)
    assert process.exitcode == 0
    assert opened.status()["state"] == "done"


INTERRUPTED = "\ninterrupted; finished blocks are kept, and the same command continues from there\n"


class Destroyed:
    def __del__(self):
        raise_signal(SIGINT)


def while_it_starts() -> None:
    logging.basicConfig = lambda **_: raise_signal(SIGINT)


def in_a_destructor() -> None:
    """Where Python does not raise KeyboardInterrupt, but shows and forgets it."""
    _before_a_block_is_stored(Destroyed)


def taken_for(error: Exception) -> None:
    """As a library does that reports whatever has happened as an error of its own."""

    def signalled():
        try:
            raise_signal(SIGINT)
        except KeyboardInterrupt:
            raise error from None

    _before_a_block_is_stored(signalled)


def lost() -> None:
    """As in numpy, which forgets what is raised while it looks for attributes. The next block is not computed."""

    def signalled():
        with suppress(KeyboardInterrupt):
            raise_signal(SIGINT)

    _before_a_block_is_stored(signalled)


def _before_a_block_is_stored(function) -> None:
    real = run.add

    def add(*given):
        function()
        real(*given)

    run.add = add


@pytest.mark.parametrize(
    ("moment", "said"),
    [
        (while_it_starts, ""),
        (in_a_destructor, ""),
        (lost, INTERRUPTED),
        (partial(taken_for, OSError("HDF error")), INTERRUPTED),
        (partial(taken_for, RuntimeError("HDF error")), INTERRUPTED),
    ],
    ids=["while it starts", "in a destructor", "lost", "taken for an error of a file", "taken for any error"],
)
def test_an_interrupt_at_an_odd_moment(opened, tmp_path, moment, said):
    process = command(tmp_path, 60, *RUN, prepared=moment)
    process.join(PATIENCE)
    assert process.exitcode == 130
    text = (tmp_path / "errors").read_text()
    assert "Traceback" not in text and "HDF" not in text and "Exception" not in text
    assert text.endswith(said)
    assert opened.run().complete


def in_a_long_call(number: int) -> None:
    """Of C, which has no Python between its instructions; it takes a quarter of an hour."""
    _before_a_block_is_stored(lambda: _long(number))


def _long(number: int) -> None:
    os.kill(os.getpid(), number)
    # time.sleep would hear of the signal; hashes of a gigabyte do not, and other threads go on meanwhile
    hashlib.pbkdf2_hmac("sha256", b"word", b"salt", 2_000_000_000)


def in_a_loop_that_loses_it(number: int) -> None:
    """As libraries that take KeyboardInterrupt for an error of one of many items."""

    def loop():
        os.kill(os.getpid(), number)
        while True:
            with suppress(BaseException):
                sum(range(1000))

    _before_a_block_is_stored(loop)


@pytest.mark.parametrize("number", [SIGINT, SIGTERM])
@pytest.mark.parametrize("moment", [in_a_long_call, in_a_loop_that_loses_it], ids=["a call", "a loop"])
def test_the_first_ends_a_command_that_computes_on(opened, tmp_path, moment, number):
    """Each would go on for a quarter of an hour, or for ever."""
    process = command(tmp_path, 60, *RUN, prepared=partial(moment, number))
    process.join(PATIENCE)
    assert process.exitcode == 130
    assert (tmp_path / "errors").read_text().endswith(INTERRUPTED)
    assert opened.run().complete and leftovers(tmp_path / "results") == []


def when_all_is_done(number: int) -> None:
    real = terminal.empty_buffers

    def empty_buffers():
        raise_signal(number)
        real()

    terminal.empty_buffers = empty_buffers


@pytest.mark.parametrize("number", [SIGINT, SIGTERM])
def test_one_that_comes_too_late_changes_nothing(opened, tmp_path, number):
    process = command(tmp_path, 60, *RUN, prepared=partial(when_all_is_done, number))
    process.join(PATIENCE)
    assert process.exitcode == 0
    assert "Traceback" not in (tmp_path / "errors").read_text()
    assert opened.status()["state"] == "done" and leftovers(tmp_path / "results") == []


AT_EXIT = """
import atexit, os, runpy, signal, sys
from study.commands import signals

class Last:
    def __del__(self, write=os.write):
        write(2, b"torn down")

number, real = int(sys.argv.pop(1)), signals.listen

def start():
    real()
    if number:
        atexit.register(signal.raise_signal, number)

signals.listen, last = start, Last()
runpy.run_module("study", run_name="__main__", alter_sys=True)
"""


@pytest.mark.parametrize(
    ("number", "arguments", "code"),
    [(SIGINT, ["check", "line.toml"], 0), (SIGTERM, ["check", "none.toml"], 2), (0, ["--help"], 0)],
)
def test_one_that_comes_as_the_interpreter_ends_changes_nothing(opened, tmp_path, number, arguments, code):
    """While it calls what is to be called at exit; and it does not come to where signals get their default action."""
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    python = [sys.executable, "-c", AT_EXIT, str(int(number))]
    done = subprocess.run([*python, *arguments], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == code
    assert not any(word in done.stderr for word in ("Traceback", "Exception", "torn down"))

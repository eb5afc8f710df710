"""Runs of a study in processes of their own, which tests kill. What they compute is written down, block by block."""

import importlib
import io
import multiprocessing
import os
import runpy
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

PROCESSES = multiprocessing.get_context("forkserver")  # forks from a process that has imported everything
PROCESSES.set_forkserver_preload(["study.api", "distributed"])
PATIENCE = 300  # seconds for what takes one or two: a busy machine makes a test slow, not red
SLOW = 0.01  # seconds that a block takes at least: moments to kill it in

# Nothing waits for the disk, here and in the processes below: a run of 60 blocks flushes 124 times, and waited for that
# as long as it computed on a busy machine. tests/store/parts/test_power_cuts.py has a disk of its own.
os.fsync = lambda file: None


def child(file: Path, log: Path, at: str = "", locks: bool = True, **options) -> multiprocessing.Process:
    """A started process that runs the study of a file into the folder beside it, and logs to `log`.

    at : "room.module.name" of a function of `study` at whose first call the process kills itself; locks : whether the
        file system has them; options : of `Study.run`
    """
    return started(_run, file, log, at, locks, options)


def started(function, *arguments) -> multiprocessing.Process:
    process = PROCESSES.Process(target=function, args=arguments)
    process.start()
    return process


def _run(file: Path, log: Path, at: str, locks: bool, options: dict) -> None:
    import study
    from study.files import lock
    from study.work import cases, engine

    real = cases.compute
    engine.START = engine.MANY = float("inf")  # worker processes would not know what follows

    def compute(wanted):
        time.sleep(SLOW)
        note(log, f"{wanted.first} {wanted.last}")
        return real(wanted)

    cases.compute = compute
    if not locks:
        lock.fcntl = None
    if at:
        module, _, name = at.rpartition(".")
        setattr(importlib.import_module(f"study.{module}"), name, lambda *_, **__: os.kill(os.getpid(), signal.SIGKILL))
    note(log, "begun")
    report = study.load(file, file.parent / "results").run(**options)
    note(log, "ended" if report.counts else "nothing to do")


def holding(folder: Path, first: int) -> dict[str, str]:
    """Environment of a process that holds its blocks from case `first` on until folder/go is there, see `hold`."""
    path = os.pathsep.join(path or os.getcwd() for path in sys.path)
    hold = {"HOLD_FROM": str(first), "HOLD_UNTIL": str(folder / "go")}
    return os.environ | hold | {"PYTHONPATH": path, "OPENBLAS_NUM_THREADS": "1"}


def held(folder: Path) -> set[str]:
    """Ids of the processes that wait for folder/go."""
    return set(lines(folder / "go.log"))


def command(
    folder: Path, first: int, *arguments: str, ignoring=(), stuck: bool = False, prepared=None
) -> multiprocessing.Process:
    """A started process that does in `folder` what `python -m study ...` does, stderr to folder/errors, and holds its
    blocks from case `first` on.

    ignoring : signals that its parent ignores; stuck : an interrupted run writes folder/ending and does not end;
    prepared : is called in the process before it begins
    """
    return started(_command, folder, first, arguments, ignoring, stuck, prepared)


def _command(folder: Path, first: int, arguments, ignoring, stuck: bool, prepared) -> None:
    os.chdir(folder)
    os.dup2(os.open("errors", os.O_WRONLY | os.O_CREAT), sys.stderr.fileno())
    for number, handler in {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}.items():
        signal.signal(number, signal.SIG_IGN if number in ignoring else handler)
    os.environ |= holding(folder, first)
    import hold  # noqa: F401

    if stuck:
        from study.commands import signals
        from study.work.progress import Progress

        signals.BUSY = PATIENCE

        def close(_):
            note(folder / "ending", "")
            time.sleep(PATIENCE)

        Progress.close = close
    if prepared:
        prepared()
    sys.argv = ["study", *arguments]
    runpy.run_module("study", run_name="__main__", alter_sys=True)


def run_forked(command: list[str], *, input: bytes, timeout: float, **_) -> SimpleNamespace:
    """`subprocess.run` of `python -c STATEMENT` in a forked process, which has little to import any more; `stdout` is
    what it has written, nothing if it broke down."""
    ours, its = PROCESSES.Pipe(duplex=False)
    process = started(_execute, command[-1], input, its)
    its.close()
    try:
        if not ours.poll(timeout):
            raise subprocess.TimeoutExpired(command, timeout)
        return SimpleNamespace(stdout=ours.recv_bytes())
    except EOFError:
        return SimpleNamespace(stdout=b"")
    finally:
        process.kill()
        process.join()
        ours.close()


def _execute(statement: str, given: bytes, answer) -> None:
    sys.stdin, sys.stdout = io.TextIOWrapper(io.BytesIO(given)), io.TextIOWrapper(io.BytesIO())
    exec(statement, {})
    sys.stdout.flush()
    answer.send_bytes(sys.stdout.buffer.getvalue())


def note(log: Path, line: str) -> None:
    """Append a line at once: the process may be killed in the next moment."""
    file = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    os.write(file, f"{line}\n".encode())
    os.close(file)


def lines(log: Path) -> list[str]:
    return log.read_text().splitlines() if log.exists() else []


def computed_in(log: Path) -> list[int]:
    """The cases whose computing was begun, as often as it was."""
    blocks = [line.split() for line in lines(log) if line[0].isdigit()]
    return [case for first, last in blocks for case in range(int(first), int(last) + 1)]


def joined(process: multiprocessing.Process) -> None:
    """Wait until the process of a run has ended, not only said its answer."""
    process.join(PATIENCE)
    assert not process.is_alive(), "a thread of it still waits for something"


def stored(folder: Path) -> int:
    """How many blocks are on disk."""
    return len(list(folder.rglob("*.block")))


def wait_for(condition, seconds: float = PATIENCE) -> None:
    """Wait until the condition holds; fail after `seconds`."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.002)

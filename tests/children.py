"""Runs of a study in processes of their own, which tests kill. What they compute is written down, block by block."""

import multiprocessing
import os
import signal
import time
from pathlib import Path

PROCESSES = multiprocessing.get_context("forkserver")  # forks from a process that has imported everything
PROCESSES.set_forkserver_preload(["study.api"])
SLOW = 0.01  # seconds that a block takes at least: moments to kill it in


def child(file: Path, log: Path, at: str = "", locks: bool = True, **options) -> multiprocessing.Process:
    """A started process that runs the study of a file into the folder beside it, and logs to `log`.

    at : "module.name" of a function of `study` at whose first call the process kills itself; locks : whether the file
        system has them; options : of `Study.run`
    """
    process = PROCESSES.Process(target=_run, args=(file, log, at, locks, options))
    process.start()
    return process


def _run(file: Path, log: Path, at: str, locks: bool, options: dict) -> None:
    import study
    from study import blocks, lock

    real = blocks.compute

    def compute(wanted):
        time.sleep(SLOW)
        note(log, f"{wanted.first} {wanted.last}")
        return real(wanted)

    blocks.compute = compute
    if not locks:
        lock.fcntl = None
    if at:
        module, name = at.split(".")
        setattr(getattr(study, module), name, lambda *_, **__: os.kill(os.getpid(), signal.SIGKILL))
    note(log, "begun")
    report = study.load(file, file.parent / "results").run(**options)
    note(log, "ended" if report.counts else "nothing to do")


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


def wait_for(condition, seconds: float = 60) -> None:
    """Wait until the condition holds; fail after `seconds`."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.002)

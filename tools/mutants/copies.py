"""Copies of the tree, in each of which a child of this process does one task after another."""

import compileall
import json
import os
import resource
import shutil
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType

# .git is not copied either: in a worktree it is a pointer, and an interrupted test would lock the real repository.
NOT_COPIED = {"results", "figures", "tables", "build", "dist", ".git", ".venv", ".hypothesis", ".pytest_cache"}
NIGHT = 40_000.0  # seconds for a task without a known duration
MEMORY = 8_000_000_000  # bytes that a mutant may write to; a browser reserves more addresses than that


@dataclass(frozen=True)
class Task:
    """A task of a child: `action(folder)` gives its answer (JSON). `change`: files and their bytes while it runs."""

    key: object
    action: Callable[[Path], object]
    seconds: float = NIGHT
    change: dict[str, bytes] = field(default_factory=dict)


def answers(tasks: list[Task], folders: list[Path]) -> Iterator[tuple[Task, object]]:
    """Tasks and their answers as they come, one child in each folder at a time; a text if a child gave no answer."""
    free, running, left, clock, last = list(folders), {}, tasks[::-1], 0.0, time.monotonic()
    try:
        while left or running:
            while left and free:
                task, folder = left.pop(), free.pop()
                running[_begun(task, folder)] = task, folder, clock + task.seconds
            time.sleep(0.01)
            last, before = time.monotonic(), last
            clock += min(last - before, 1.0)  # the clock stands while this process is stopped or the machine asleep
            for child, (task, folder, end) in list(running.items()):
                late = clock > end
                if late or os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT):
                    _swept(child)
                    del running[child]
                    yield task, "takes too long" if late else _answer(folder)
                    for number, name in enumerate(task.change):
                        os.replace(folder.with_suffix(f".kept{number}"), folder / name)
                    free.append(folder)
    finally:
        for child in running:
            _swept(child)


def _begun(task: Task, folder: Path) -> int:
    """Fork the child of a task; returns its process id."""
    answer = folder.with_suffix(".json")
    answer.unlink(missing_ok=True)
    for number, (name, content) in enumerate(task.change.items()):
        path = folder / name
        shutil.copy2(
            path, folder.with_suffix(f".kept{number}")
        )  # outside the tree, since tests list the files of a package
        path.write_bytes(content)
        os.utime(
            path, (315_619_200,) * 2
        )  # 1980, the first year of zip; otherwise a compiled form of this second may be used
    child = os.fork()
    if child:
        return child
    try:
        os.setsid()
        resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        log = os.open(folder.with_suffix(".log"), os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(log, 1), os.dup2(log, 2)
        os.chdir(folder)
        tests = folder / "tests"
        # The first entry was the folder of this file.
        sys.path[:] = [str(folder), *(str(tests / name) for name in ("", "shared", "suite")), *sys.path[1:]]
        sys.modules["__main__"] = ModuleType("__main__")  # which worker processes import
        for name in ("kept", "mutate", "trials", "operators", "copies"):  # tests import those in the folder
            sys.modules.pop(name, None)
        sys.dont_write_bytecode = True  # nor may a compiled form of the mutant before be used
        os.environ |= {"PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
        answer.write_text(json.dumps(task.action(folder)))
    except BaseException:
        answer.write_text(json.dumps(traceback.format_exc()))
    finally:
        os._exit(0)


def _swept(child: int) -> None:
    """End a child and the processes that it has started."""
    for kill in (os.killpg, os.kill):  # it may not lead its group yet
        with suppress(ProcessLookupError):
            kill(child, signal.SIGKILL)
    os.waitpid(child, 0)


def _answer(folder: Path) -> object:
    try:
        return json.loads(folder.with_suffix(".json").read_text())
    except (OSError, ValueError):
        return "ends the process of the tests"


def copy(root: Path, folder: Path) -> None:
    """Copy the part of a tree that the tests need."""
    shutil.copytree(root, folder, ignore=lambda at, names: NOT_COPIED & set(names) if Path(at) == root else [])
    for package in ("solver", "study", "studies"):
        compileall.compile_dir(folder / package, quiet=1)

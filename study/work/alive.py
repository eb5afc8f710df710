"""A sign of life of a call that lasts: a line on a terminal or in a notebook, which is gone when the call has ended."""

import contextvars
import multiprocessing
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, TextIO

from ..spec.definition import Definition, StudyError
from ..terminal import counted, shown
from .progress import EVERY, columns, describe, duration, erases

SILENT = 2.0  # seconds that a call may last without a word: after some three people wonder whether it has stopped
AGAIN = 0.5  # seconds between lines that replace each other; the seconds in them go up by one


@dataclass
class Alive:
    """What is known of a call that computes.

    name : the first word of the line; note : what stands at its end
    cases : how many contacts there are; times : how often each is solved; done, failed, computed : as of `Progress`,
        of cases times `times`
    """

    name: str
    cases: int = 0
    times: int = 1
    done: int = 0
    failed: int = 0
    computed: int = 0
    note: str = ""
    begun: float = field(default_factory=time.monotonic)
    _changing: Any = field(default_factory=threading.Lock)

    def expect(self, definition: Definition, done: int = 0) -> None:
        """Say what is computed, of which so many cases are there already."""
        self.times = definition.times
        self.cases, self.done = definition.grid.size // self.times, done

    def count(self, cases: int, failed: int) -> None:
        """Add a block that is computed; any thread may."""
        with self._changing:
            self.done, self.computed, self.failed = self.done + cases, self.computed + cases, self.failed + failed

    def line(self) -> str:
        """ "solving 1 contact, 15 times for ±: 4 s", or how many cases are done as soon as some are."""
        seconds = time.monotonic() - self.begun
        if self.computed:
            text = describe(self.name, self.done, self.cases * self.times, self.failed, self.computed, seconds)
        else:
            what = f" {counted(self.cases, 'contact')}" * bool(self.cases)
            what += f", {'each ' * (self.cases > 1)}{self.times} times for ±" * (self.times > 1)
            text = f"{self.name}{what}: {duration(seconds)}"
        return text + self.note


@dataclass
class Terminal:
    """One line that is rewritten, and erased at the end."""

    stream: TextIO
    every: float = AGAIN

    def write(self, line: str) -> None:
        self.stream.write(f"\r\x1b[K{line[: columns(self.stream) - 1]}")  # in the last column it may wrap
        self.stream.flush()

    def clear(self) -> None:
        self.write("")


@dataclass
class Log:
    """Plain lines, one below the other, that stay."""

    stream: TextIO
    every: float = EVERY

    def write(self, line: str) -> None:
        self.stream.write(f"{line}\n")
        self.stream.flush()

    def clear(self) -> None:
        pass


@dataclass
class Notebook:
    """A line in the output of the cell that is rewritten, and empty at the end."""

    handle: Any = None
    every: float = AGAIN

    def write(self, line: str) -> None:
        data = {"text/plain": line} if line else {"text/plain": "", "text/html": ""}
        if self.handle:
            self.handle.update(data, raw=True)
        else:
            self.handle = import_module("IPython.display").display(data, raw=True, display_id=True)

    def clear(self) -> None:
        self.write("")


def screen_of(progress: bool | None) -> Terminal | Log | Notebook | None:
    """Where a call shows that it lives; None: nowhere.

    progress : False: nowhere; True: at least on stderr, whatever that is; None: in a notebook or on a terminal, but not
        in threads and processes of a program that divides its work itself
    """
    if progress is not None and type(progress) is not bool:
        raise StudyError([f"progress = {shown(progress)}: must be True, False or None"])
    divided = multiprocessing.parent_process() or threading.current_thread() is not threading.main_thread()
    if progress is False or (progress is None and divided):
        return None
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if hasattr(shell, "kernel"):  # that of a terminal has none
        return Notebook()
    if sys.stderr is None or sys.stderr.closed:
        return None
    if erases(sys.stderr):
        return Terminal(sys.stderr)
    return Log(sys.stderr) if progress or sys.stderr.isatty() else None


@contextmanager
def alive(name: str, progress: bool | None) -> Iterator[Alive]:
    """Show that a call goes on after SILENT seconds: the :class:`Alive` that it may tell what it does.

    progress : see `screen_of`. Raises StudyError if it is none of these
    """
    known, screen, ended = Alive(name), screen_of(progress), threading.Event()
    if screen is None:
        yield known
        return

    def tell() -> None:
        begun = False
        try:
            while not ended.wait(screen.every if begun else SILENT):
                begun = True
                screen.write(known.line())
            if begun:
                screen.clear()
        except Exception:  # the terminal has gone, say: the call goes on without a word
            return

    # in the context of the call, by which a notebook knows the cell that it belongs to
    thread = threading.Thread(target=contextvars.copy_context().run, args=(tell,), daemon=True)
    thread.start()
    try:
        yield known
    finally:
        ended.set()
        thread.join()

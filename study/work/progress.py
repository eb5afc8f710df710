"""Progress of a run or a call: a line that is rewritten on a terminal, or a plain line now and then elsewhere."""

import contextvars
import io
import multiprocessing
import os
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib import import_module
from typing import TextIO

from ..inputs.definition import StudyError
from ..terminal import shown

EVERY = 10.0  # seconds between plain lines
BLINK = 0.1  # seconds between rewritten lines
SILENT = 2.0  # seconds without output; after about three, people wonder whether the program has stopped
UPDATE_INTERVAL = 0.5  # seconds between updates of the line, in which seconds are counted
SPEAKER = "roughcoat progress"  # the name of the thread
ERASE = "\r\x1b[K"  # go to the beginning of the terminal's line, and erase it


@dataclass
class Progress:
    """The progress of a run: it counts cases and writes their number.

    As a context manager it also shows every second, after SILENT seconds, that the run goes on, and ends the line.

    done : number of cases on disk when the run began, and of those computed since
    computed : number of cases computed since, for the rate
    failed : number of cases that have failed; a case without a solution has not
    passing : whether this is the progress of a call, which writes nothing in the first SILENT seconds and leaves
        nothing on a terminal

    Until cases are computed it writes the seconds: "fig04: 8 s". A call of one block writes nothing else.
    """

    name: str
    total: int
    stream: TextIO | None
    done: int = 0
    failed: int = 0
    computed: int = 0
    begun: float = field(default_factory=time.monotonic)
    written: float = field(default_factory=time.monotonic)
    passing: bool = False

    def __post_init__(self):
        self._shown, self._writing, self._ended, self._thread = False, threading.RLock(), threading.Event(), None
        self._updated = self.begun
        if self.passing:
            self.written = -EVERY  # its first line does not wait

    def __enter__(self) -> "Progress":
        if self.stream is not None:
            # from the context of the caller a notebook knows the cell to which the line belongs
            run = contextvars.copy_context().run
            self._thread = threading.Thread(target=run, args=(self._go_on,), name=SPEAKER, daemon=True)
            try:
                self._thread.start()
            except BaseException:  # an interrupt: the thread may have written, and __exit__ is not called
                self.close()
                raise
        return self

    def __exit__(self, *_) -> None:
        self.close()
        if self._thread is not None:
            self._thread.join()

    def _go_on(self) -> None:
        wait = max(SILENT - (time.monotonic() - self.begun), 0.0)
        while not self._ended.wait(wait):
            self.tell()
            wait = UPDATE_INTERVAL

    def tell(self) -> None:
        """Write the progress, unless it was written just now."""
        if self.done < self.total:
            self._write(self._line)

    def update(self, cases: int, failed: int) -> None:
        """Add a finished block. Any thread may call this."""
        with self._writing:
            self.done += cases
            self.computed += cases
            self.failed += failed
            self._updated = time.monotonic()
        if not self.passing:
            self._write(self._line)

    def close(self) -> None:
        """End the rewritten line, or erase the line of a call. Nothing is written afterwards, not even by the
        thread."""
        end = ERASE if self.passing else "\n"
        with self._writing:
            self._write(lambda terminal: end if terminal and self._shown else "")
            self.stream = None
        self._ended.set()

    def _write(self, text: Callable[[bool], str]) -> None:
        """Write text(whether the stream is a terminal that can erase a line), if there is a stream.

        A stream that fails is no longer used, and the run goes on.
        """
        with self._writing:
            try:
                if self.stream is not None and (line := text(erases(self.stream))):
                    self.stream.write(line)
                    self.stream.flush()
                    self._shown = True
            except (OSError, ValueError):  # the stream has lost its reader or been closed, or the disk is full
                self.stream = None

    def _line(self, terminal: bool) -> str:
        """The line on the progress; "" if the last line was written just now."""
        now = time.monotonic()
        if now - self.written < (BLINK if terminal else EVERY) and self.done < self.total:
            return ""
        self.written = now
        width = columns(self.stream) - 1 if terminal else None  # a line that fills the last column may wrap
        if self.computed:
            counts = (self.name, self.done, self.total, self.failed, self.computed, self._updated - self.begun)
            line = describe(*counts, since=now - self._updated, width=width)
        else:
            done = f", {self.done} of {self.total} cases are there" * bool(self.done)
            line = f"{self.name}: {duration(now - self.begun)}{done}"[:width]
        return f"{ERASE}{line}" if terminal else f"{line}\n"


def erases(stream: TextIO) -> bool:
    """Whether a stream is a terminal that can erase a line."""
    return stream.isatty() and os.environ.get("TERM") != "dumb"


def columns(terminal: TextIO) -> int:
    """Width of a terminal; 80 if it is not known."""
    try:
        return os.get_terminal_size(terminal.fileno()).columns or 80
    except OSError:
        return 80


def describe(
    name: str, done: int, total: int, failed: int, computed: int, seconds: float, since=0.0, *, width: int | None = None
) -> str:
    """The line "fig04: 1200 of 2000 cases, 3 failed, 410/s, 2 s left", shortened to at most `width` characters.

    seconds : from the beginning to the last block, which ended `since` seconds ago
    """
    rate = computed / seconds if seconds > 0 else 0.0
    left = f", {duration(max((total - done) / rate - since, 0.0))} left" if rate and done < total else ""
    share = f"{100 * done // total} %"
    lines = (
        f"{name}: {done} of {total} cases, {failed} failed, {rate:.3g}/s{left}",
        f"{name}: {done} of {total} cases, {failed} failed{left}",
        f"{name}: {share}, {failed} failed{left}",
        f"{name}: {share}{left}",
        f"{name[: (width or 0) - len(share) - 2]}: {share}",
    )
    return next((line for line in lines if width is None or len(line) <= width), share)


def duration(seconds: float) -> str:
    """Seconds as "8 s", "3 min 20 s" or "2 h 5 min"."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


class NotebookCell(io.TextIOBase):
    """The output of a cell in a notebook, as a terminal of one line, which can be rewritten and erased."""

    def __init__(self):
        self._handle = None

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        """Show the line in place of the last one. Raises OSError if the notebook has gone."""
        line = text.removeprefix(ERASE).rstrip("\n")
        data = {"text/plain": line} if line else {"text/plain": "", "text/html": ""}  # empty HTML leaves no empty line
        try:
            if self._handle:
                self._handle.update(data, raw=True)
            else:
                self._handle = import_module("IPython.display").display(data, raw=True, display_id=True)
        except Exception as error:  # from whatever connects to the notebook
            raise OSError(str(error)) from None
        return len(text)


def screen_of(progress: bool | None) -> TextIO | None:
    """The stream for the progress of a call of `study.solve`; None for no progress.

    progress : False: none; True: in the notebook, otherwise on stderr, even if that is not a terminal; None: in a
        notebook or on a terminal, except in threads and processes of a program that divides its work itself

    Raises StudyError for any other value.
    """
    if progress is not None and type(progress) is not bool:
        raise StudyError([f"progress = {shown(progress)}: must be True, False or None"])
    divided = multiprocessing.parent_process() or threading.current_thread() is not threading.main_thread()
    if progress is False or (progress is None and divided):
        return None
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if hasattr(shell, "kernel"):  # IPython in a terminal has none
        return NotebookCell()
    if sys.stderr is None or sys.stderr.closed:
        return None
    return sys.stderr if progress or sys.stderr.isatty() else None

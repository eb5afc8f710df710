"""Progress of a run: one line that is rewritten on a terminal, a plain line now and then elsewhere."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TextIO

EVERY = 10.0  # seconds between plain lines
BLINK = 0.1  # seconds between rewritten lines


@dataclass
class Progress:
    """Counts cases and writes how far a run is.

    done : cases on disk when the run began, and those computed since; computed : the latter alone, for the rate
    failed : cases that have failed; a case without a solution has not
    """

    name: str
    total: int
    stream: TextIO | None
    done: int = 0
    failed: int = 0
    computed: int = 0
    begun: float = field(default_factory=time.monotonic)
    written: float = field(default_factory=time.monotonic)

    def update(self, cases: int, failed: int) -> None:
        """Add a finished block."""
        self.done += cases
        self.computed += cases
        self.failed += failed
        self._write(self._line)

    def close(self) -> None:
        """End the rewritten line."""
        self._write(lambda terminal: "\n" if terminal and self.computed else "")

    def _write(self, text: Callable[[bool], str]) -> None:
        """Write text(whether it is for a terminal that can erase a line), if there is a stream. When that fails, go on
        without it: a run must not end because of it."""
        try:
            if self.stream is not None and (shown := text(erases(self.stream))):
                self.stream.write(shown)
                self.stream.flush()
        except (OSError, ValueError):  # its reader has left, its disk is full, or it has been closed
            self.stream = None

    def _line(self, terminal: bool) -> str:
        """How far the run is; "" as long as the last line is young."""
        now = time.monotonic()
        if now - self.written < (BLINK if terminal else EVERY) and self.done < self.total:
            return ""
        self.written = now
        counts = (self.name, self.done, self.total, self.failed, self.computed, now - self.begun)
        if terminal:  # a line that fills the last column may wrap
            return f"\r\x1b[K{describe(*counts, width=columns(self.stream) - 1)}"
        return f"{describe(*counts)}\n"


def erases(stream: TextIO) -> bool:
    """Whether a stream is a terminal that can erase a line."""
    return stream.isatty() and os.environ.get("TERM") != "dumb"


def columns(terminal: TextIO) -> int:
    """Width of a terminal; 80 when it does not say."""
    try:
        return os.get_terminal_size(terminal.fileno()).columns or 80
    except OSError:
        return 80


def describe(
    name: str, done: int, total: int, failed: int, computed: int, seconds: float, *, width: int | None = None
) -> str:
    """The line "fig04: 1200 of 2000 cases, 3 failed, 410/s, 2 s left", shortened to at most `width` characters."""
    rate = computed / seconds if seconds > 0 else 0.0
    left = f", {duration((total - done) / rate)} left" if rate and done < total else ""
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

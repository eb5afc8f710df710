"""Terminals that stand in for stderr, and calls that take long enough to be told of there."""

import io
import re
import sys
import threading
import types

import pytest

from study.work import cases, progress
from study.work.progress import ERASE

PATIENCE = 20  # seconds that a test waits for a line at most
CONTACT = {"P": 1e-5, "micro": "smooth", "base": "half_space"}


class Screen(io.StringIO):
    """A terminal, which knows when something was written."""

    def __init__(self):
        super().__init__()
        self.written = threading.Event()

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        self.written.set()
        return super().write(text)


@pytest.fixture
def impatient(monkeypatch):
    """What takes two seconds for people takes a hundredth here."""
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(progress, "SILENT", 0.01)
    monkeypatch.setattr(progress, "UPDATE_INTERVAL", 0.01)


@pytest.fixture
def stderr(monkeypatch, impatient) -> Screen:
    """A terminal in place of stderr."""
    return as_stderr(monkeypatch, Screen())


def as_stderr(monkeypatch, stream):
    """Let a stream be stderr for calls, but not for pytest, which replaces it before each test."""
    monkeypatch.setattr(progress, "sys", types.SimpleNamespace(stderr=stream, modules=sys.modules))
    return stream


def slowly(monkeypatch, wait) -> None:
    """Every block takes as long as wait() takes."""
    real = cases.compute
    monkeypatch.setattr(cases, "compute", lambda wanted: (wait(), real(wanted))[1])


def nobody_speaks() -> bool:
    """Whether no thread of a call is left that says how far it is; those of other tests may be."""
    return all(thread.name != progress.SPEAKER for thread in threading.enumerate())


def lines(text: str) -> list[str]:
    """What was on the screen, one after another; a few seconds are "0 s", since reading may take some."""
    return [re.sub(r": \d s\b", ": 0 s", line) for line in text.split(ERASE) if line]

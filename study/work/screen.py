"""Where a call shows that it goes on: a terminal, the output of a notebook's cell, or the stderr that was asked for."""

import io
import multiprocessing
import sys
import threading
from importlib import import_module
from typing import TextIO

from ..inputs.definition import StudyError
from ..terminal import shown
from .progress import ERASE


class Cell(io.TextIOBase):
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
        except Exception as error:  # of the connection to the notebook, whatever that is
            raise OSError(str(error)) from None
        return len(text)


def screen_of(progress: bool | None) -> TextIO | None:
    """Where a call of `study.solve` writes its progress; None: nowhere.

    progress : False: nowhere; True: in the notebook, else on stderr, even if that is no terminal; None: in a notebook
        or on a terminal, but not in threads and processes of a program that divides its work itself

    Raises StudyError if it is none of these.
    """
    if progress is not None and type(progress) is not bool:
        raise StudyError([f"progress = {shown(progress)}: must be True, False or None"])
    divided = multiprocessing.parent_process() or threading.current_thread() is not threading.main_thread()
    if progress is False or (progress is None and divided):
        return None
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if hasattr(shell, "kernel"):  # that of IPython in a terminal has none
        return Cell()
    if sys.stderr is None or sys.stderr.closed:
        return None
    return sys.stderr if progress or sys.stderr.isatty() else None

"""How a command ends when a signal comes, at whatever moment.

While it starts: at once. While it works: in good order, by KeyboardInterrupt, and at once by a second signal. When it
is done: at once, with the exit code of what it has done. A signal that the parent process ignores is ignored.
"""

import atexit
import os
import signal
import sys

from ..terminal import empty_buffers

INTERRUPTED = 130  # exit code
SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Moment:
    """working : the command has begun; came : a signal has; code : the exit code, once it is known."""

    def __init__(self):
        self.working, self.came, self.code = False, False, None


now = Moment()


def start() -> None:
    """Begin the process of a command: listen to signals, and let its code be the last thing that is decided."""
    atexit.register(_last)  # first to be registered, last to be called
    sys.unraisablehook = _lost
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _first)


def _first(*_) -> None:
    for number in SIGNALS:
        if signal.getsignal(number) is _first:
            signal.signal(number, _second)
    now.came = True
    if now.code is None and now.working:
        raise KeyboardInterrupt
    _second()


def _second(*_) -> None:
    """End at once: the blocks in work are lost, and no more."""
    os._exit(INTERRUPTED if now.code is None else now.code)


def _lost(unraisable) -> None:
    """An exception where none can be raised, such as in the destructor of an object."""
    if unraisable.exc_type is KeyboardInterrupt:
        _second()
    sys.__unraisablehook__(unraisable)


def _last() -> None:
    """Python, as it ends, gives signals back their default action, which would be another exit code."""
    empty_buffers()
    os._exit(1 if now.code is None else now.code)

"""How a command ends when a signal comes, at whatever moment.

While it starts, it ends at once. While it works, KeyboardInterrupt ends it in good order, and a second signal at once.
When it is done, it ends at once with the exit code of its work. A signal that the parent process ignores is ignored.
"""

import atexit
import os
import signal
import sys
from types import SimpleNamespace

from ..terminal import empty_buffers, interrupt

INTERRUPTED = 130  # exit code
SIGNALS = (signal.SIGINT, signal.SIGTERM)


state = SimpleNamespace(working=False, code=None)
"""working : the command has begun; code : the exit code, once it is known."""


def listen() -> None:
    """Handle signals, and make `state.code` the exit code of this process."""
    atexit.register(_exit_with_code)  # the first that is registered is called last
    sys.unraisablehook = _unraisable
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _first_signal)


def _first_signal(*_) -> None:
    for number in SIGNALS:
        if signal.getsignal(number) is _first_signal:
            signal.signal(number, _end_at_once)
    interrupt.came = True
    if state.code is None and state.working:
        raise KeyboardInterrupt
    _end_at_once()


def _end_at_once(*_) -> None:
    """End the process; only the blocks in work are lost."""
    os._exit(INTERRUPTED if state.code is None else state.code)


def _unraisable(unraisable) -> None:
    """What Python calls with an exception that it cannot raise, such as one in the destructor of an object."""
    if unraisable.exc_type is KeyboardInterrupt:
        _end_at_once()
    sys.__unraisablehook__(unraisable)


def _exit_with_code() -> None:
    """End the process here: later Python gives signals their default action, which has another exit code."""
    empty_buffers()
    os._exit(1 if state.code is None else state.code)

"""The end of a command when a signal comes, at whatever moment.

While the command starts, it ends at once. While it works, KeyboardInterrupt ends it in good order, and a second signal
at once. When it is done, it ends at once with the exit code of its work. A signal that the parent process ignores is
ignored.

Python raises KeyboardInterrupt between two of its own instructions. A long call of numpy, or of the compiled core, has
no such instructions, and a library may swallow the exception. So a thread receives the signal too, and ends the process
if the main thread goes on. All files are written completely, so only the work since the last file is lost.
"""

import atexit
import os
import signal
import sys
import threading
import time
from types import SimpleNamespace

from ..terminal import empty_buffers, interrupt, say

INTERRUPTED = 130  # exit code
SIGNALS = (signal.SIGINT, signal.SIGTERM)
#: Seconds that a command has to end in good order, which takes some hundredths; the processor time of its main thread
#: from which on it is known to compute; and the longer time for a command that gets no processor, on a busy machine.
ORDERLY, COMPUTING, BUSY = 0.6, 0.2, 2.0


state = SimpleNamespace(working=False, code=None, remark="", elsewhere=False)
"""working : whether the command has begun; code : the exit code, once it is known; remark : the work that survives an
interrupt, in words; elsewhere : whether another program has the terminal, such as a pager, which gets the signals."""


def listen() -> None:
    """Handle signals, and make `state.code` the exit code of this process."""
    atexit.register(_exit_with_code)  # the function that is registered first is called last
    sys.unraisablehook = _unraisable
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _first_signal)
    told, tell = os.pipe()
    os.set_blocking(tell, False)
    signal.set_wakeup_fd(tell, warn_on_full_buffer=False)  # Python writes to it at once, whatever the main thread does
    if hasattr(os, "register_at_fork"):  # signals of a forked child do not concern this process
        os.register_at_fork(after_in_child=lambda: signal.set_wakeup_fd(-1))
    threading.Thread(target=_watch, args=(told,), daemon=True).start()


def _watch(told: int) -> None:
    """Wait for a signal, and end the process if it does not end by itself."""
    while not {*os.read(told, 64)} & {*map(int, SIGNALS)} or state.elsewhere:
        pass
    begun, used = time.monotonic(), _used()
    while True:
        time.sleep(0.02)
        passed = time.monotonic() - begun
        if passed > BUSY or (passed > ORDERLY and _used() - used > COMPUTING):
            if state.code is None and state.working:
                say(f"\ninterrupted{state.kept}", sys.stderr)
            _end_at_once()


def _used() -> float:
    """Processor time of the main thread, or of the process where threads have no clock, s."""
    if hasattr(time, "pthread_getcpuclockid"):
        return time.clock_gettime(time.pthread_getcpuclockid(threading.main_thread().ident))
    return time.process_time()


def _first_signal(*_) -> None:
    for number in SIGNALS:
        if signal.getsignal(number) is _first_signal:
            signal.signal(number, _end_at_once)
    interrupt.came = True
    if state.code is None and state.working:
        raise KeyboardInterrupt
    _end_at_once()


def _end_at_once(*_) -> None:
    """End the process; only the blocks that are being computed are lost."""
    os._exit(INTERRUPTED if state.code is None else state.code)


def _unraisable(unraisable) -> None:
    """Python calls this with an exception that it cannot raise, such as one in the destructor of an object."""
    if unraisable.exc_type is KeyboardInterrupt:
        _end_at_once()
    sys.__unraisablehook__(unraisable)


def _exit_with_code() -> None:
    """End the process here: afterwards Python gives signals their default action, which has another exit code."""
    empty_buffers()
    os._exit(1 if state.code is None else state.code)

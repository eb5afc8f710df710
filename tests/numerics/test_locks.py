"""What threads share does not hang a process that is forked while one of them computes."""

import os
import signal
import threading

import pytest

from solver.numerics.caches import Cache, once, shared_lock

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")


def ends(work) -> bool:
    """Whether a forked process comes to the end of `work`."""
    child = os.fork()
    if not child:
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.alarm(5)
        try:
            work()
        finally:
            os._exit(0)
    return os.waitpid(child, 0)[1] == 0


@pytest.mark.filterwarnings("ignore:.*multi-threaded.*fork:DeprecationWarning")
def test_a_property_that_another_thread_computes():
    """functools.cached_property has one lock for all objects until Python 3.12, which the child cannot take."""
    begun, may_end = threading.Event(), threading.Event()

    class Thing:
        def __init__(self, waits):
            self.waits = waits

        @once
        def number(self):
            if self.waits:
                begun.set()
                may_end.wait(10)
            return 7

    thread = threading.Thread(target=lambda: Thing(True).number)
    thread.start()
    begun.wait(10)
    try:
        assert ends(lambda: Thing(False).number)
    finally:
        may_end.set()
        thread.join()


@pytest.mark.filterwarnings("ignore:.*multi-threaded.*fork:DeprecationWarning")
@pytest.mark.parametrize("lock", [shared_lock(), Cache._lock], ids=["new", "of a cache"])
def test_a_lock_that_another_thread_holds(lock):
    """The fork waits until it is free."""
    begun = threading.Event()

    def hold():
        with lock:
            begun.set()
            threading.Event().wait(0.05)

    thread = threading.Thread(target=hold)
    thread.start()
    begun.wait(10)
    assert ends(lambda: lock.acquire() and lock.release())
    thread.join()


def test_it_is_computed_once():
    made = []

    class Thing:
        @once
        def number(self):
            """A number."""
            made.append(1)
            return 7

    thing = Thing()
    assert thing.number == thing.number == 7 and made == [1] and Thing.number.__doc__ == "A number."

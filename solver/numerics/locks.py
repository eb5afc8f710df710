"""What threads share, in a form that a forked process can go on with."""

import os
from threading import RLock

__all__ = ["once", "shared_lock"]


def shared_lock():
    """A lock that a forked process can take whichever thread held it: the fork waits until it is free.

    For locks that live as long as the process and are held for moments.
    """
    lock = RLock()
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(before=lock.acquire, after_in_parent=lock.release, after_in_child=lock.release)
    return lock


class once:
    """A property that is computed when it is first asked for, and kept with its object.

    Until Python 3.12 `functools.cached_property` has one lock for all objects of a class. Threads that compute wait
    there for each other, and a process that is forked meanwhile waits for good (4 of 25 did).
    """

    def __init__(self, make):
        self.make, self.__doc__ = make, make.__doc__

    def __set_name__(self, owner, name):
        self.name = name

    def __get__(self, thing, owner=None):
        if thing is None:
            return self
        value = thing.__dict__[self.name] = self.make(thing)
        return value

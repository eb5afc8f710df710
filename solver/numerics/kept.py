"""Values that take long to make and are kept: in a cache, or with their object; and the lock that threads share.

A process that is forked while threads compute can go on with all of it.
"""

import os
from collections import Counter, OrderedDict
from threading import RLock

import numpy as np


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


class Kept:
    """A cache of values by their keys. The latest used are kept, as many as have arrays of at most `most` bytes
    together, but at least one. An array that several values share counts once. Several threads may use it at the same
    time."""

    _lock = shared_lock()  # of all of them: it is held for microseconds

    def __init__(self, most):
        self.most, self.nbytes = most, 0
        self._values, self._uses = OrderedDict(), Counter()

    def get(self, key, make):
        """The value of `key`, from ``make()`` if it is not kept: an array, or a tuple or list of such values."""
        with self._lock:
            if key in self._values:
                self._values.move_to_end(key)
                return self._values[key]
        made = make()
        with self._lock:
            if key not in self._values:  # else another thread has made it meanwhile
                self._values[key] = made
                self._count(made, 1)
            while self.nbytes > self.most and len(self._values) > 1:
                self._count(self._values.popitem(last=False)[1], -1)
        return made

    def find(self, key):
        """The value of `key`; None if it is not kept."""
        with self._lock:
            if key in self._values:
                self._values.move_to_end(key)
            return self._values.get(key)

    def values(self):
        """All that are kept, the latest used last."""
        with self._lock:
            return list(self._values.values())

    def _count(self, value, uses):
        for array in _arrays(value):
            before, now = self._uses[id(array)], self._uses[id(array)] + uses
            self._uses[id(array)] = now
            if not now:
                del self._uses[id(array)]  # another array may get this id
            if not before or not now:
                self.nbytes += uses * array.nbytes


def _arrays(value):
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, (tuple, list)):
        for part in value:
            yield from _arrays(part)

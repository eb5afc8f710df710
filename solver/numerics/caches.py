"""Caches for values that take long to make, a property that is computed once, and the lock that threads share.

All of them still work in a process that is forked while threads compute.
"""

import os
from collections import Counter, OrderedDict
from threading import RLock

import numpy as np


def shared_lock():
    """A lock that a forked process can always take: the fork waits until no thread holds it.

    It is meant for locks that live as long as the process and are held only for moments.
    """
    lock = RLock()
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(before=lock.acquire, after_in_parent=lock.release, after_in_child=lock.release)
    return lock


class once:
    """A property that is computed when it is first read, and then stored in its object.

    Until Python 3.12 `functools.cached_property` has one lock for all objects of a class. Threads wait there for each
    other, and a process that is forked meanwhile waits for ever (4 of 25 did).
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


class Cache:
    """A cache: key -> value. It keeps the values used last, as long as their arrays together take at most `most` bytes,
    and always at least one value. An array that several values share counts once. Several threads may use a cache at
    the same time."""

    _lock = shared_lock()  # one lock for all caches: it is held for microseconds

    def __init__(self, most):
        self.most, self.nbytes = most, 0
        self._values, self._uses = OrderedDict(), Counter()

    def get(self, key, make):
        """The value of `key`, from the cache or else from ``make()``: an array, or a tuple or list of such values."""
        return self.several([key], lambda _: [make()])[0]

    def several(self, keys, make):
        """The values of different `keys`, in their order; ``make(missing)`` returns those of the keys that are not
        in the cache."""
        with self._lock:
            values = {key: self._values[key] for key in keys if key in self._values}
            for key in values:
                self._values.move_to_end(key)
        missing = [key for key in keys if key not in values]
        if missing:
            values.update(zip(missing, make(missing), strict=True))
            with self._lock:
                for key in missing:
                    self._keep(key, values[key])
        return [values[key] for key in keys]

    def _keep(self, key, value):
        if key not in self._values:  # else another thread has made it meanwhile
            self._values[key] = value
            self._count(value, 1)
        while self.nbytes > self.most and len(self._values) > 1:
            self._count(self._values.popitem(last=False)[1], -1)

    def find(self, key):
        """The value of `key`; None if it is not kept."""
        with self._lock:
            if key in self._values:
                self._values.move_to_end(key)
            return self._values.get(key)

    def values(self):
        """All values in the cache, the one used last at the end."""
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

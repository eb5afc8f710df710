"""A cache: values that take long to make are kept, the latest used of them, up to a number of bytes."""

from collections import Counter, OrderedDict

import numpy as np

from .locks import shared_lock


class Kept:
    """Values by their keys. The latest used are kept, as many as have arrays of at most `most` bytes together, but at
    least one. An array that several values share counts once. Several threads may use it at the same time."""

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

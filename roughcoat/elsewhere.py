"""A call that may travel to a process which somebody else has started, such as a worker of dask.

A function arrives there as the name of its module. Python may look for `study` in the working folder of the worker
first, and would run a study.py that is there. So the call travels as bytes, which are read when `roughcoat` has been
imported.
"""

import pickle
from collections.abc import Callable
from typing import Any

import cloudpickle  # of dask: it also packs functions that a script defines


class Packed:
    """function(*arguments, *more), when it is called with `more`. In the process that made it nothing is packed."""

    def __init__(self, function: Callable, *arguments: Any):
        self._call, self._bytes = (function, arguments), b""

    def __call__(self, *more: Any) -> Any:
        function, arguments = pickle.loads(self._bytes) if self._bytes else self._call
        return function(*arguments, *more)

    def __getstate__(self) -> bytes:
        """The bytes; also those that came and were never read, as in a scheduler that passes the call on."""
        return self._bytes or cloudpickle.dumps(self._call)

    def __setstate__(self, state: bytes) -> None:
        self._bytes = state

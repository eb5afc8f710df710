"""A call that travels to a process which somebody else has started, such as a worker of dask.

A function arrives there as the name of its module. Python may look for `study` in the working folder of the worker
first, and would run a study.py that is there. So the call travels as bytes, which are read when `roughcoat` has been
imported.
"""

import pickle
from collections.abc import Callable
from typing import Any

import cloudpickle  # of dask: it also packs functions that a script defines


def packed(function: Callable, *arguments: Any) -> tuple[Callable, bytes]:
    """What computes function(*arguments) there, and its argument."""
    return perform, cloudpickle.dumps((function, arguments))


def perform(call: bytes) -> Any:
    """The result of a call that has been packed."""
    function, arguments = pickle.loads(call)
    return function(*arguments)

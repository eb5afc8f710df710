"""Sums over waves at single points by the compiled core. The numpy path is in solver/fields/points/wave_points.py."""

from ctypes import byref
from typing import Any

import numpy as np

from .library import CSums, pointer, sums_core

#: Length of a jet, and the kind in batch.h of sums whose states come from Python.
_JET, STATES = 6, 3
_INTEGERS = ("orders", "cases", "ends", "window")


def sums_in_c(numbers: dict[str, int], arrays: dict[str, Any]) -> np.ndarray | None:
    """The sums (JET, fields, P) that `solver.fields.points.wave_points.sums` returns; None where numpy is to compute.

    numbers, arrays : the fields of the structure Sums of batch.h, without those that follow from the shapes of others
    """
    if (function := sums_core()) is None:
        return None
    arrays = {
        name: np.ascontiguousarray(array, complex if name == "f" else np.int64 if name in _INTEGERS else float)
        for name, array in arrays.items()
    }
    fields, points = len(arrays["orders"]), len(arrays["r"])
    sums = np.empty((_JET, fields, points))
    shapes = {"points": points, "fields": fields, "waves": len(arrays["k"]), "most": int(arrays["orders"].max())}
    pointers = {name: pointer(array) for name, array in arrays.items()}
    function(byref(CSums(**shapes, **numbers, **pointers, sums=pointer(sums))))
    return sums

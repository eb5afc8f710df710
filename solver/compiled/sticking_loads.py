"""Loads of curves that stick, by the compiled core. The numpy path is in study/inverse/fits/tables/branch.py."""

from ctypes import byref
from typing import Any

import numpy as np

from .library import CLoads, CSticking, pointer, sticking_core

#: MOST_LENGTH of batch.h.
_LONGEST = 256


def loads_in_c(rows: np.ndarray, depth: np.ndarray, step: float) -> tuple[Any, Any, np.ndarray, np.ndarray] | None:
    """What `study.inverse.fits.tables.branch.branch` returns of rows (1 + others, B, 8, L) on a lattice with this step,
    at depths (B, n): the numbers of loads that stick and of those that do not, and two depths (B,). Of loads these are
    P and slope (B, n), and derivatives (others, B, n) and (4, B, n). None where numpy is to compute."""
    function = sticking_core()
    if function is None or rows.shape[3] > _LONGEST:
        return None
    shape, others = depth.shape, len(rows) - 1
    rows, depth = (np.ascontiguousarray(array, float) for array in (rows, depth))
    sizes = shape, shape, (others, *shape), (4, *shape)
    loads = [tuple(np.empty(size) for size in sizes) for _ in ("sticks", "free")]
    ends = np.empty((2, len(depth)))
    sticks, free = (CLoads(*map(pointer, arrays)) for arrays in loads)
    numbers = {"curves": shape[0], "points": shape[1], "length": rows.shape[3], "others": others, "step": step}
    arrays = {"rows": pointer(rows), "depth": pointer(depth), "D_off": pointer(ends, 0), "D_least": pointer(ends, 1)}
    function(byref(CSticking(**numbers, **arrays, sticks=sticks, free=free)))
    return *loads, *ends

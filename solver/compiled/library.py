"""The library of the compiled core: if it was built it lies beside this file, and it is loaded with the first cases.

The environment variable ROUGHCOAT_CORE selects numpy, "numpy", or the core with the vectors "sse2", "avx2" or "avx512".
Without the variable the core with the widest vectors of the processor is used, or numpy if no core was built.
"""

import os
from collections.abc import Callable
from ctypes import CDLL, CFUNCTYPE, POINTER, Structure, c_double, c_int, c_int32, c_int64, c_void_p, sizeof
from functools import lru_cache
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import Any

import numpy as np

#: Name of the file, the same for every version of Python (setup.py): what was built last is found.
FILE = "_core" + EXTENSION_SUFFIXES[-1]

#: Names of the variants of the core, the one with the widest vectors first; and the environment variable that chooses.
VARIANTS, VARIABLE = ("avx512", "avx2", "sse2"), "ROUGHCOAT_CORE"

#: LAYOUT of batch.h. A core that was built with another layout would read the numbers of this one at wrong places.
LAYOUT = 6

_LAYERED = ("h", "m", "n", "bonded", "c1", "c2", "one_c1", "one_c2", "plus_c1", "one_c1c2")


class CPoints(Structure):
    """As in batch.h."""

    _fields_ = [("m", c_int64), *((name, c_void_p) for name in ("s", "w", "kappa", "basis", "half_space"))]


class CMesh(Structure):
    """As in batch.h."""

    _fields_ = [
        ("n", c_int64),
        *((name, c_void_p) for name in ("s", "w", "K", "kappa", "at_edge", "fine_s", "fine_w", "fine_K")),
        *((name, CPoints) for name in ("fine", "more", "between", "profile")),
    ]


class CRows(Structure):
    """As in batch.h."""

    _fields_ = [(name, c_void_p) for name in ("product", "J_rows", "J", "phi", "phi_columns")]


class CTable(Structure):
    """As in batch.h."""

    _fields_ = [
        *(("few", c_int64), ("all", c_int64), ("k", c_void_p), ("spread", c_void_p), ("own", CRows), ("fine", CRows)),
        *((name, c_void_p) for name in ("J_fine", "J_more", "J_profile")),
    ]


OF_MESH, OF_TABLE = CFUNCTYPE(c_void_p, c_int64), CFUNCTYPE(c_void_p, c_int64, c_int64, c_int64)


class CBatch(Structure):
    """As in batch.h."""

    _fields_ = [
        *((name, c_int64) for name in ("size", "stride", "points", "rungs")),
        *((name, c_int32) for name in ("control", "law", "layered", "octaves", "first_octave", "steps")),
        *((name, c_void_p) for name in ("ladder", "value", "rtol", "p_star", "A_star", "beta", "ratio", "E", "C")),
        ("cells", c_void_p),
        *((name, c_void_p) for name in (*_LAYERED, "fixed", "shrink", "place")),
        *(("columns", c_int64), ("scalars", c_void_p), ("p", c_void_p), ("lam", c_void_p)),
        *(("nodes", c_void_p), ("iterations", c_void_p), ("mesh", OF_MESH), ("table", OF_TABLE)),
    ]


class CLoads(Structure):
    """As in batch.h."""

    _fields_ = [(name, c_void_p) for name in ("P", "slope", "by_rows", "by_parts")]


class CSticking(Structure):
    """As in batch.h."""

    _fields_ = [
        *((name, c_int64) for name in ("curves", "points", "length", "others")),
        *(("step", c_double), ("rows", c_void_p), ("depth", c_void_p), ("sticks", CLoads), ("free", CLoads)),
        *(("D_off", c_void_p), ("D_least", c_void_p)),
    ]


class CSums(Structure):
    """As in batch.h."""

    _fields_ = [
        *((name, c_int64) for name in ("points", "size", "waves", "thin", "columns", "fields", "most", "kind")),
        *(("S", c_double), ("T", c_double)),
        *(
            (name, c_void_p)
            for name in ("orders", "cases", "ends", "window", "r", "z", "h", "nu", "returned", "passed")
        ),
        *((name, c_void_p) for name in ("k", "p", "surface", "down", "up", "base", "states", "f", "windows", "sums")),
    ]


class CBoxes(Structure):
    """As in batch.h."""

    _fields_ = [
        *(("tasks", c_int64), ("functions", c_void_p)),
        *((name, c_void_p) for name in ("models", "centre", "low", "high", "places", "values")),
    ]


def pointer(array: np.ndarray, start: int = 0) -> int:
    """The address of a contiguous array, from its row `start` on."""
    return array.ctypes.data + start * (array.strides[0] if array.ndim else 0)


def layout() -> int:
    """The number that `roughcoat_layout` returns in a core built of these sources: it combines LAYOUT and the sizes of
    the structures."""
    number = LAYOUT
    for structure in (CBatch, CMesh, CTable, CSticking, CSums, CBoxes):
        number = number * 512 + sizeof(structure)
    return number


def _fits(library: Any) -> bool:
    """Whether a core was built with the :func:`layout` of these sources."""
    of = getattr(library, "roughcoat_layout", None)
    if of is None:
        return False
    of.argtypes, of.restype = [], c_int64
    return of() == layout()


@lru_cache(maxsize=1)
def _library() -> Any:
    """The library; None if it was not built, cannot be loaded, or has another :func:`layout`."""
    try:
        library = CDLL(str(Path(__file__).with_name(FILE)))
    except OSError:
        return None
    return library if _fits(library) else None


@lru_cache(maxsize=len(VARIANTS))
def _variant(name: str) -> Callable | None:
    """The function of a variant; None if the library does not contain it or this processor lacks its vectors."""
    has = getattr(_library(), f"roughcoat_has_{name}", None)
    if has is None or not has():
        return None
    function = getattr(_library(), f"roughcoat_{name}")
    function.argtypes, function.restype = [POINTER(CBatch), c_int64], c_int
    return function


def available() -> tuple[str, ...]:
    """Names of the variants that can be used here, the widest vectors first; empty if no core was built."""
    return tuple(name for name in VARIANTS if _variant(name))


def core() -> Callable | None:
    """The function ``core(batch, most)`` of the chosen variant; None selects the numpy code.

    Raises ValueError for a choice that does not exist or is not available here.
    """
    name = _chosen()
    return _variant(name) if name else None


def sticking_core() -> Callable | None:
    """The function ``sticking(curves)`` of the variant that is chosen, of a :class:`CSticking`; as :func:`core`."""
    return _chosen_of("sticking", CSticking)


def sums_core() -> Callable | None:
    """The function ``sums(waves)`` of the variant that is chosen, of a :class:`CSums`; as :func:`core`."""
    return _chosen_of("sums", CSums)


def boxes_core() -> Callable | None:
    """The function ``boxes(tasks)`` of the variant that is chosen, of a :class:`CBoxes`; as :func:`core`."""
    return _chosen_of("boxes", CBoxes)


def _chosen_of(work: str, structure: Any) -> Callable | None:
    if not (name := _chosen()):
        return None
    function = getattr(_library(), f"roughcoat_{work}_{name}")
    function.argtypes, function.restype = [POINTER(structure)], None
    return function


def _chosen() -> str | None:
    """The name of the variant that is chosen, None for numpy."""
    choice = os.environ.get(VARIABLE, "")
    if choice == "numpy":
        return None
    if not choice:
        return next((name for name in VARIANTS if _variant(name)), None)
    if choice not in VARIANTS or not _variant(choice):
        allowed = ", ".join(("numpy", *available()))
        raise ValueError(f"{VARIABLE} = {choice}: must be one of {allowed} here, or not set")
    return choice

"""Functions of scipy.special, which is imported when one of them is first used: ``special.j0(x)``.

Importing it takes as long as solving some thousand contacts (`make start`). Only tables of layers, stresses and meshes
beyond the ladder need it. K and the Radau nodes of the ladder are available here without it.
"""

import math
import sys
from functools import lru_cache
from importlib import import_module
from importlib.resources import files
from types import ModuleType
from typing import Any

import numpy as np

#: Coefficients, the highest powers first, of Cephes' approximation of K, K = P(x) - log(x) Q(x), which scipy uses too.
_P = (
    *(1.37982864606273237150e-4, 2.28025724005875567385e-3, 7.97404013220415179367e-3, 9.85821379021226008714e-3),
    *(6.87489687449949877925e-3, 6.18901033637687613229e-3, 8.79078273952743772254e-3, 1.49380448916805252718e-2),
    *(3.08851465246711995998e-2, 9.65735902811690126535e-2, 1.38629436111989062502e0),
)
_Q = (
    *(2.94078955048598507511e-5, 9.14184723865917226571e-4, 5.94058303753167793257e-3, 1.54850516649762399335e-2),
    *(2.39089602715924892727e-2, 3.01204715227604046988e-2, 3.73774314173823228969e-2, 4.88280347570998239232e-2),
    *(7.03124996963957469739e-2, 1.24999999999870820058e-1, 4.99999999999999999821e-1),
)
#: Below this x, K is log(4) - log(x)/2 to the last digit.
_LEAST = 1.11022302462515654042e-16
FILE = files(__package__) / "radau.csv"  # which may be in a zip file
#: For more numbers than this, scipy's K is quicker, its import included: this one takes 0.2 µs a number, scipy's
#: 0.02 µs.
_MOST = 100_000


def __getattr__(name: str) -> Any:
    if name.startswith("__"):  # Python asks for __path__ when something is imported from here
        raise AttributeError(name)
    value = getattr(_scipy_special(), name)
    globals()[name] = value
    return value


def _scipy_special() -> ModuleType:
    """scipy.special. Its import copies all public names of numpy, and so imports numpy.f2py and numpy.testing: 60 and
    25 of 420 ms of processor time (busy machine, 2026-11-30). Meanwhile another value has these names, which nobody
    uses."""
    if "scipy.special" in sys.modules:
        return import_module("scipy.special")
    names = vars(np)
    hidden = [name for name in ("f2py", "testing") if name not in names]
    names.update(dict.fromkeys(hidden))
    try:
        return import_module("scipy.special")
    finally:
        for name in hidden:
            if names.get(name, np) is None:  # otherwise another thread has imported it, or ended this already
                names.pop(name, None)


def ellipkm1(x: np.ndarray, many: bool = False) -> np.ndarray:
    """The complete elliptic integral of the first kind K, of the complementary parameter x in (0, 1], any shape.

    The result equals that of `scipy.special.ellipkm1` bit for bit, so it does not matter which one is used. Hence the
    logarithm of the C library: numpy's own may be rounded differently. `many`: other calls follow, with more than _MOST
    numbers in all.
    """
    if many or x.size > _MOST:
        return _scipy_special().ellipkm1(x)
    log = np.fromiter(map(math.log, x.ravel().tolist()), float, x.size).reshape(x.shape)
    large = _polynomial(_P, x) - log * _polynomial(_Q, x)
    return np.where(x > _LEAST, large, _P[-1] - 0.5 * log)


def _polynomial(coefficients, x):
    value = np.full_like(x, coefficients[0])
    for coefficient in coefficients[1:]:
        value *= x
        value += coefficient
    return value


def radau_points(n: int) -> np.ndarray:
    """The Gauss-Radau nodes except the last one, (n - 1,) in (-1, 1): the roots of a Jacobi polynomial. Those of meshes
    of the ladder stand in radau.csv, which tools/make_radau.py writes."""
    points = _of_ladder().get(n)
    return _scipy_special().roots_jacobi(n - 1, 1.0, 0.0)[0] if points is None else points


@lru_cache(maxsize=1)
def _of_ladder() -> dict[int, np.ndarray]:
    lines = FILE.read_text(encoding="utf-8").splitlines()
    rows = [np.array([float(text) for text in line.split(",")]) for line in lines if not line.startswith("#")]
    return {len(row) + 1: row for row in rows}

"""Between SI numbers and dimensionless ones.

The solver works in units R = 1 and E2* = E2/(1 - nu2²) = 1; on a rigid base, where E2* is infinite, in E1* = 1. All is
done number by number, so that a case has the same dimensionless numbers, and key, in any grid.
"""

from typing import Any

import numpy as np
import xarray as xr

from ..data.units import reduced_modulus, without_unit
from ..spec.vocabulary import VOCABULARY
from .names import SCENE
from .scene import Scene

#: Poisson ratio of a punch of which none is given: as of the other bodies.
_POISSON = VOCABULARY["nu1"].own.default


def make_dimensionless(scene: Scene) -> None:
    """Add to a scene what follows from its SI values: effective radius, unit of moduli, parameters of the solver."""
    given = scene.given
    if "R1" in given:
        given["R"] = 1 / (1 / given["R1"] + 1 / given["R2"])
    scene.R, scene.unit, layer, body = given["R"], *moduli(given, scene.parameters)
    if "E1" in given:
        scene.parameters["n"] = layer / body
    if "E_punch" in given:
        given.setdefault("nu_punch", _POISSON)  # results say which it was
        base = over_dimensions(scene.parameters.get("base", "layered"), "base")
        surface = _where(base == "half_space", body, layer)
        scene.parameters["m"] = surface / _reduced(given, "E_punch", "nu_punch")
    for name, value in given.items():
        if name not in SCENE:
            scene.parameters[name] = without_unit(value, VOCABULARY[name].powers, scene.unit, scene.R)


def moduli(given: dict, parameters: dict) -> tuple:
    """The unit of moduli, E1* and E2*, in Pa. Without E1 and n, on a half-space, E1* is E2*."""
    body = _reduced(given, "E2", "nu2")
    n = over_dimensions(given["n"] if "n" in given else parameters.get("n", 1.0), "n")
    layer = _reduced(given, "E1", "nu1") if "E1" in given else n * body
    return _where(np.isinf(body), layer, body), layer, body


def _where(condition: Any, yes: Any, no: Any) -> Any:
    """xr.where for arrays. For single numbers plain Python, as xr.where takes a millisecond."""
    return xr.where(condition, yes, no) if np.ndim(condition) else yes if condition else no


def _reduced(given: dict, name: str, nu: str) -> Any:
    return reduced_modulus(given[name], given.get(nu, _POISSON))


def over_dimensions(given: Any, name: str) -> Any:
    """Values of a parameter without a unit, as an array over the dimension of its name where they are several."""
    return xr.DataArray(list(given), dims=name) if isinstance(given, (list, tuple, range, np.ndarray)) else given

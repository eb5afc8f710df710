"""From SI numbers to dimensionless ones.

The solver works in units R = 1 and E2* = E2/(1 - nu2²) = 1; on a rigid base, where E2* is infinite, in E1* = 1. Each
case is computed by itself, so that it has the same dimensionless numbers, and the same key, in any grid.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from solver.bases import is_bare
from solver.laws.own_table import LAW_UNIT

from ...arrays import xarray_later as xr
from ..lexicon import PACKAGE
from ..punch.tables import in_metres
from ..vocabulary import SCENE
from .scene import Scene
from .stacks import moduli_of

#: Default of the Poisson ratio of a punch, equal to that of the other bodies.
_POISSON = PACKAGE.parameter("nu1").default
#: The unit of length, in m, for a punch without any given length.
_MICROMETRE = 1e-6


def make_dimensionless(scene: Scene) -> None:
    """Add the numbers that follow from a scene's SI values: effective radius, unit of moduli, solver's parameters."""
    values = scene.values
    if "R1" in values:
        values["R"] = 1 / (1 / values["R1"] + 1 / values["R2"])
    if scene.scale:
        values["R"] = abs(values.get(scene.scale, _MICROMETRE))  # a thickness below 0 is refused in its own words
    scene.R, scene.unit, layer, body = values["R"], *moduli(values, scene.parameters)
    if "E1" in values:
        scene.parameters["n"] = layer / body
    for modulus, nu, ratio in moduli_of(values):
        scene.parameters[ratio] = _reduced(values, modulus, nu) / scene.unit
    if "E_punch" in values:
        values.setdefault("nu_punch", _POISSON)  # for the results to show it
        base = scene.parameters.get("base", "layered")
        surface = _where(is_bare(base), body, layer)
        scene.parameters["m"] = surface / _reduced(values, "E_punch", "nu_punch")
    for name, value in values.items():
        if name not in SCENE:
            scene.parameters[name] = without_unit(value, scene.lexicon.rows[name].powers, scene.unit, scene.R)
    if np.any(scene.metres):
        scene.parameters["table_unit"] = _where(scene.metres, 1 / scene.R, 1.0)
    if in_metres(scene.parameters.get("micro", ""), scene.lexicon):
        scene.parameters[LAW_UNIT] = 1 / scene.R


def moduli(values: dict, parameters: dict) -> tuple:
    """The unit of moduli, E1* and E2*, in Pa. Without E1 and n, on a half-space, E1* is E2*."""
    body = _reduced(values, "E2", "nu2")
    n = values["n"] if "n" in values else parameters.get("n", 1.0)
    layer = _reduced(values, "E1", "nu1") if "E1" in values else n * body
    return _where(np.isinf(body), layer, body), layer, body


def _where(condition: Any, yes: Any, no: Any) -> Any:
    """xr.where for arrays. For single numbers plain Python, as xr.where takes a millisecond."""
    return xr.where(condition, yes, no) if np.ndim(condition) else yes if condition else no


def _reduced(values: dict, name: str, nu: str) -> Any:
    return reduced(values[name], values.get(nu, _POISSON))


def reduced(E: Any, nu: Any) -> Any:
    """E* = E/(1 - ν²). Raises ValueError where nu is outside (-1, 0.5]."""
    if np.any((nu <= -1) | (nu > 0.5)):
        raise ValueError("nu must be in (-1, 0.5], and comes after E")
    return E / (1 - nu * nu)  # nu**2 of a number and of an array may differ in the last bit


def without_unit(value: Any, powers: tuple[int, int], unit: Any, R: Any) -> Any:
    """An SI value over unit^i R^j, (i, j) = `powers`."""
    return with_unit(value, (-powers[0], -powers[1]), unit, R)


def with_unit(value: Any, powers: tuple[int, int], unit: Any, R: Any) -> Any:
    """A dimensionless value times unit^i R^j."""
    for factor, power in ((unit, powers[0]), (R, powers[1])):
        for _ in range(abs(power)):
            value = value * factor if power > 0 else value / factor
    return value

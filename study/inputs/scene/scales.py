"""Between SI numbers and dimensionless ones.

The solver works in units R = 1 and E2* = E2/(1 - nu2²) = 1; on a rigid base, where E2* is infinite, in E1* = 1. All is
done number by number, so that a case has the same dimensionless numbers, and key, in any grid. Results in SI units are
scaled back to the numbers that were solved: so cases in a file are found again.
"""

from typing import Any

import numpy as np
import xarray as xr

from ..definition import Definition
from ..grid import MOVED, Grid
from ..vocabulary import SCENE, VOCABULARY
from .scene import Scene

Values = dict[str, tuple[tuple[str, ...], np.ndarray]]
"""Name -> dimensions and numbers over them."""
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
        base = scene.parameters.get("base", "layered")
        surface = _where(base == "half_space", body, layer)
        scene.parameters["m"] = surface / _reduced(given, "E_punch", "nu_punch")
    for name, value in given.items():
        if name not in SCENE:
            scene.parameters[name] = without_unit(value, VOCABULARY[name].powers, scene.unit, scene.R)


def moduli(given: dict, parameters: dict) -> tuple:
    """The unit of moduli, E1* and E2*, in Pa. Without E1 and n, on a half-space, E1* is E2*."""
    body = _reduced(given, "E2", "nu2")
    n = given["n"] if "n" in given else parameters.get("n", 1.0)
    layer = _reduced(given, "E1", "nu1") if "E1" in given else n * body
    return _where(np.isinf(body), layer, body), layer, body


def _where(condition: Any, yes: Any, no: Any) -> Any:
    """xr.where for arrays. For single numbers plain Python, as xr.where takes a millisecond."""
    return xr.where(condition, yes, no) if np.ndim(condition) else yes if condition else no


def _reduced(given: dict, name: str, nu: str) -> Any:
    return reduced(given[name], given.get(nu, _POISSON))


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


def parameters_from_si(given: Values) -> tuple[Values, Values]:
    """The dimensionless parameters that follow from coordinates in SI units, and the scales: R and the unit of moduli.

    They follow from the same SI numbers by the same operations as when the cases were solved, so they are the same to
    the last bit, and so are the keys of the cases.
    """
    arrays = {name: xr.DataArray(array, dims=dims) for name, (dims, array) in given.items()}
    unit, _, _ = moduli(arrays, arrays)
    found = {}
    for name, array in arrays.items():
        if name not in SCENE:
            powers = VOCABULARY[name].powers
            found[name] = array if powers == (0, 0) else without_unit(array, powers, unit, arrays["R"])
    return _plain(found), _plain({"R": arrays["R"], "unit": unit})


def scales_of(definition: Definition) -> Grid | None:
    """R and the unit of moduli of a study over the dimensions of its results; None for a study without units."""
    scene = definition.scene
    if not scene:
        return None
    scales = {name: xr.DataArray(value) for name, value in (("R", scene.R), ("unit", scene.unit))}
    return grid_of_results(definition, Grid(definition.grid.sizes, _plain(scales)))


def grid_of_results(definition: Definition, grid: Grid) -> Grid:
    """A grid of a study over the dimensions of its results: MOVED is left out, and with it the moved inputs."""
    named = definition.in_results

    def over(table: Values) -> Values:
        as_given = {
            name: (dims, array.take(0, dims.index(MOVED)) if MOVED in dims else array)
            for name, (dims, array) in table.items()
        }
        return {name: (tuple(named(dict.fromkeys(dims))), array) for name, (dims, array) in as_given.items()}

    return Grid(named(grid.sizes), over(grid.values), over(grid.labels))


def result_from_si(name: str, array: np.ndarray, scales: dict[str, np.ndarray]) -> np.ndarray:
    """A result (n, ...) in SI units as a dimensionless one, to rounding; scales : R and the unit of moduli, (n,)."""
    powers = VOCABULARY[name].powers
    if powers == (0, 0):
        return array
    unit, R = (scales[key].reshape(-1, *[1] * (array.ndim - 1)) for key in ("unit", "R"))
    return without_unit(array, powers, unit, R).astype(array.dtype)


def _plain(arrays: dict[str, xr.DataArray]) -> Values:
    return {name: (tuple(map(str, array.dims)), array.values) for name, array in arrays.items()}

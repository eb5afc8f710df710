"""From the parameters of `study.solve`, with units, to a scene and its dimensionless parameters.

The scene has the radius R of the punch, Young's moduli E1 of the layer, E2 of the body below and E_punch of the punch,
with Poisson ratios nu1, nu2 and nu_punch. The solver works in units R = 1 and E2* = E2/(1 - nu2²) = 1.
"""

from typing import Any

import numpy as np
import xarray as xr

from ..data.units import reduced_modulus
from ..scene.quantities import READABLE, has_unit, quantity
from ..spec.definition import StudyError
from ..spec.laws import is_parameter
from ..spec.vocabulary import PARAMETERS, VOCABULARY, suggest
from .names import SCENE, unit_of
from .scene import MOVED, STEP, Scene

_POSITIVE, _POISSON = (0.0, np.inf, "must be > 0"), (-1.0, 0.5, "must be in (-1, 0.5]")
#: What must hold of the scene before anything is derived from it: above, up to, and the words for it.
_LIMITS = dict.fromkeys(("R", "E1", "E2", "E_punch"), _POSITIVE) | dict.fromkeys(("nu1", "nu2", "nu_punch"), _POISSON)
_PARTS = ("value", "spread")  # of a Quantity


def is_physical(parameters: dict) -> bool:
    """Whether parameters of `study.solve` describe a physical scene: one has a unit, or is only in such a scene."""
    return any(name in SCENE or _has_unit(given) for name, given in parameters.items())


def _has_unit(given: Any) -> bool:
    """Whether a parameter, or one of its values, has a unit or a spread."""
    if isinstance(given, xr.DataArray):
        return given.attrs.get("units", "1") != "1"
    return any(map(has_unit, given)) if isinstance(given, (list, tuple)) else has_unit(given)


class Row(list):
    """The values of a parameter over the dimension `case`."""


def read(parameters: dict, cases: list | None = None) -> Scene | None:
    """The scene of physical parameters of `study.solve`; None if they are dimensionless.

    cases : rows of parameters, which become values over the dimension `case`

    Raises StudyError with a message for each number that cannot be used: no unit, a unit of something else, an unknown
    name, a missing R or modulus.
    """
    rows = cases if isinstance(cases, list) and all(isinstance(row, dict) for row in cases) else []
    if not any(is_physical(given) for given in (parameters, *rows)):
        return None
    scene, errors = Scene(), []
    for name in dict.fromkeys(name for row in rows for name in row):
        lacking = [i for i, row in enumerate(rows) if name not in row]
        if name in parameters or lacking:
            errors.append(f"{name} must be given in every case, or once for all")
        else:
            parameters = parameters | {name: Row([row[name] for row in rows])}
    for name, given in parameters.items():
        if name == "label" and isinstance(given, Row):
            scene.labels = list(map(str, given))
        elif name not in SCENE and not is_parameter(name):
            errors.append(f'"{name}" is not a parameter{suggest(name, [*PARAMETERS, *SCENE])}')
        elif name in SCENE or name in _LIMITS or VOCABULARY[name].powers != (0, 0) or _has_unit(given):
            try:
                _add(scene, name, given)
            except ValueError as error:
                errors.append(str(error))
        else:
            scene.parameters[name] = xr.DataArray(list(given), dims="case") if isinstance(given, Row) else given
    errors += _missing(scene, parameters)
    if errors:
        raise StudyError(errors)
    _move(scene)
    _make_dimensionless(scene)
    return scene


def _add(scene: Scene, name: str, given: Any) -> None:
    """Put SI values and spreads of a parameter into the scene."""
    unit = unit_of(name)
    if isinstance(given, xr.DataArray):
        value, spread = _of_array(name, given, unit), 0.0
    else:
        given = given.tolist() if isinstance(given, np.ndarray) else given
        given = list(given) if hasattr(given, "magnitude") and np.ndim(given.magnitude) == 1 else given
        if isinstance(given, (list, tuple, range)):
            if not len(given):
                raise ValueError(f"{name} is empty: must have at least one value")
            found = [quantity(f"{name}[{i}]", one, unit) for i, one in enumerate(given)]
            dim = "case" if isinstance(given, Row) else name if unit == "1" else f"{name} in SI"
            scene.dims |= {} if dim == "case" else {dim: name}
            value, spread = (xr.DataArray([getattr(one, part) for one in found], dims=dim) for part in _PARTS)
        else:
            found = quantity(name, given, unit)
            value, spread = found.value, found.spread
    low, high, limits = _LIMITS.get(name, (-np.inf, np.inf, ""))
    reach = STEP * np.asarray(spread)
    if not np.all((np.asarray(value) > low) & (np.asarray(value) <= high)):
        raise ValueError(f"{name} = {given}: {limits}")
    if not np.all((np.asarray(value) - reach > low) & (np.asarray(value) + reach <= high)):
        raise ValueError(f"{name} = {given}: with its spread it {limits}; at the limit itself give no spread")
    scene.given[name] = value
    if np.any(np.asarray(spread) > 0):
        scene.spreads[name] = spread


def _of_array(name: str, given: xr.DataArray, unit: str) -> xr.DataArray:
    """SI values of a DataArray, by its attribute `units`."""
    if unit == "1":
        return given.drop_attrs()
    if "units" not in given.attrs:
        raise ValueError(f'{name}: the DataArray has no attribute "units"; {READABLE[unit][0]} needs one')
    return given.drop_attrs() * quantity(name, f"1 {given.attrs['units']}", unit).value


def _missing(scene: Scene, parameters: dict) -> list[str]:
    """Messages for what a physical scene cannot do without."""
    asked = {"R": "the radius of the punch", "E2": "Young's modulus of the body (under the layer, if there is one)"}
    messages = [f"{name} is missing: {what}" for name, what in asked.items() if name not in parameters]
    layered = not isinstance(parameters.get("base"), str) or parameters["base"] != "half_space"
    if layered and "E1" not in parameters and "n" not in parameters:
        messages.append('E1 is missing: Young\'s modulus of the layer (without a layer: base = "half_space")')
    if "E1" in parameters and "n" in parameters:
        messages.append("E1 and n are both given: one follows from the other")
    if "E_punch" in parameters and "m" in parameters:
        messages.append("E_punch and m are both given: one follows from the other")
    if "nu_punch" in parameters and "E_punch" not in parameters:
        messages.append("nu_punch is given without E_punch: a punch without a modulus is rigid")
    return messages


def _move(scene: Scene) -> None:
    """Give inputs with spreads the dimension along which they are moved: as given, then each up and down."""
    count = len(scene.spreads)
    for i, (name, spread) in enumerate(scene.spreads.items()):
        steps = np.zeros(1 + 2 * count)
        steps[1 + 2 * i : 3 + 2 * i] = STEP, -STEP
        scene.given[name] = scene.given[name] + spread * xr.DataArray(steps, dims=MOVED)


def _make_dimensionless(scene: Scene) -> None:
    """The parameters of the solver, in R and E2*."""
    given = scene.given

    def modulus(name: str, nu: str) -> Any:
        return reduced_modulus(given[name], given.get(nu, 0.3))

    scene.R, scene.E2_star = given["R"], modulus("E2", "nu2")
    if "E1" in given:
        scene.parameters["n"] = modulus("E1", "nu1") / scene.E2_star
    if "E_punch" in given:
        n = given["n"] if "n" in given else _along(scene.parameters.get("n", 1.0), "n")
        surface = xr.where(_along(scene.parameters.get("base", "layered"), "base") == "half_space", 1.0, n)
        scene.parameters["m"] = surface * scene.E2_star / modulus("E_punch", "nu_punch")
    for name, value in given.items():
        if name not in SCENE:
            i, j = VOCABULARY[name].powers
            scene.parameters[name] = value / (scene.E2_star**i * scene.R**j)


def _along(given: Any, name: str) -> Any:
    """Values of a parameter without a unit, as an array over the dimension of its name where they are several."""
    return xr.DataArray(list(given), dims=name) if isinstance(given, (list, tuple, range, np.ndarray)) else given

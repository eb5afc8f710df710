"""From a physical scene to dimensionless parameters and back: SI numbers with units in, SI numbers with units out.

The scene has the radius R of the punch, Young's moduli E1 of the layer, E2 of the body below and E_punch of the punch,
with Poisson ratios nu1, nu2 and nu_punch. The solver works in units R = 1 and E2* = E2/(1 - nu2²) = 1.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from xarray.indexes import PandasIndex

from .data.units import reduced_modulus
from .scene.quantities import READABLE, Quantity, has_unit, quantity
from .spec.definition import StudyError
from .spec.vocabulary import PARAMETERS, VOCABULARY, suggest

#: What a scene has besides the parameters of the solver: SI unit and long name.
SCENE = {
    "R": ("m", "radius of the punch"),
    "E1": ("Pa", "Young's modulus of the layer"),
    "E2": ("Pa", "Young's modulus of the body under the layer"),
    "E_punch": ("Pa", "Young's modulus of the punch"),
    "nu_punch": ("1", "Poisson ratio of the punch"),
}
_POSITIVE, _POISSON = (0.0, np.inf, "must be > 0"), (-1.0, 0.5, "must be in (-1, 0.5]")
#: What must hold of the scene before anything is derived from it: above, up to, and the words for it.
_LIMITS = dict.fromkeys(("R", "E1", "E2", "E_punch"), _POSITIVE) | dict.fromkeys(("nu1", "nu2", "nu_punch"), _POISSON)
#: Powers of E2* and R -> SI unit.
UNITS = {(0, 0): "1", (0, 1): "m", (0, 2): "m^2", (0, -2): "1/m^2", (1, 0): "Pa", (1, 1): "N/m", (1, 2): "N"}
#: Part of a spread by which an input is moved for its derivative: small against what is not linear, large against rtol.
_STEP = 0.1
#: The dimension along which inputs are moved, while the cases are solved.
_MOVED = "moved input"


def unit_of(name: str) -> str:
    """SI unit of a parameter or result, as in READABLE; "1" for pure numbers and texts."""
    return SCENE[name][0] if name in SCENE else UNITS[VOCABULARY[name].powers]


def is_physical(parameters: dict) -> bool:
    """Whether parameters of `study.solve` describe a physical scene: one has a unit, or is only in such a scene."""
    return any(name in SCENE or has_unit(_first(given)) for name, given in parameters.items())


def _first(given: Any) -> Any:
    """What shows whether a parameter has a unit."""
    if isinstance(given, xr.DataArray):
        return "1 unit" if given.attrs.get("units", "1") != "1" else None
    return given[0] if isinstance(given, (list, tuple)) and len(given) else given


class Row(list):
    """The values of a parameter over the dimension `case`."""


@dataclass
class Scene:
    """A physical scene: `parameters` are dimensionless, for the solver; `dressed` gives its results in SI units.

    given : name -> SI values, a float or a DataArray; spreads : the same of the inputs that have spreads;
    dims : dimension while solving -> name of the parameter; labels : of the dimension `case`
    """

    given: dict = field(default_factory=dict)
    spreads: dict = field(default_factory=dict)
    dims: dict = field(default_factory=dict)
    labels: list = field(default_factory=list)
    parameters: dict = field(default_factory=dict)
    R: Any = 1.0
    E2_star: Any = 1.0

    def dressed(self, dataset: xr.Dataset) -> xr.Dataset:
        """The dimensionless results of `parameters` in SI units, the inputs as given, with spreads of the results."""
        moved = dataset.sizes.get(_MOVED, 1)
        changed = {}
        for name in dataset.variables:
            if name in VOCABULARY and VOCABULARY[name].powers != (0, 0):
                i, j = VOCABULARY[name].powers
                changed[name] = dataset[name].variable * _variable(self.E2_star**i * self.R**j)
                attributes = {key: text for key, text in dataset[name].attrs.items() if key != "scale"}
                changed[name].attrs = attributes | {"units": unit_of(name)}
        coords = {name: array for name, array in changed.items() if name in dataset.coords}
        found = dataset.assign_coords(coords)
        found = found.assign({name: array for name, array in changed.items() if name in dataset.data_vars})
        if _MOVED in dataset.dims:
            found = _with_spreads(found, moved)
        return self._named(found)

    def _named(self, found: xr.Dataset) -> xr.Dataset:
        """With the inputs as coordinates in SI, under their own names."""
        inputs = {name for name in found.variables if name in self.given}
        found = found.drop_vars(inputs).rename_dims({dim: name for dim, name in self.dims.items() if dim in found.dims})
        for name, given in self.given.items():
            long_name = SCENE[name][1] if name in SCENE else VOCABULARY[name].long_name
            variable = _variable(given).copy()
            variable = variable.isel({_MOVED: 0}) if _MOVED in variable.dims else variable
            variable = xr.Variable([self.dims.get(dim, dim) for dim in variable.dims], variable.data)
            variable.attrs = {"long_name": long_name, "units": unit_of(name)}
            found = found.assign_coords({name: variable})
        if self.labels:
            found = found.assign_coords(label=("case", self.labels))
        for name in self.dims.values():
            if name in found.dims and unit_of(name) != "1":
                found = found.drop_indexes(name).set_xindex(name, UnitIndex)
        return found


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
        elif name not in SCENE and name not in PARAMETERS:
            errors.append(f'"{name}" is not a parameter{suggest(name, [*PARAMETERS, *SCENE])}')
        elif name in SCENE or name in _LIMITS or VOCABULARY[name].powers != (0, 0) or _is_uncertain(given):
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


def _is_uncertain(given: Any) -> bool:
    return isinstance(_first(given), str) and "±" in _first(given)


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
            value, spread = (xr.DataArray([pick(one) for one in found], dims=dim) for pick in (_value, _spread))
        else:
            found = quantity(name, given, unit)
            value, spread = found.value, found.spread
    low, high, limits = _LIMITS.get(name, (-np.inf, np.inf, ""))
    if not np.all((np.asarray(value) > low) & (np.asarray(value) <= high)):
        raise ValueError(f"{name} = {given}: {limits}")
    scene.given[name] = value
    if np.any(np.asarray(spread) > 0):
        scene.spreads[name] = spread


def _value(found: Quantity) -> float:
    return found.value


def _spread(found: Quantity) -> float:
    return found.spread


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
    return messages


def _move(scene: Scene) -> None:
    """Give inputs with spreads the dimension along which they are moved: as given, then each up and down."""
    count = len(scene.spreads)
    for i, (name, spread) in enumerate(scene.spreads.items()):
        steps = np.zeros(1 + 2 * count)
        steps[1 + 2 * i : 3 + 2 * i] = _STEP, -_STEP
        scene.given[name] = scene.given[name] + spread * xr.DataArray(steps, dims=_MOVED)


def _make_dimensionless(scene: Scene) -> None:
    """The parameters of the solver, in R and E2*."""
    given = scene.given

    def modulus(name: str, nu: str) -> Any:
        return reduced_modulus(given[name], given.get(nu, 0.3))

    scene.R, scene.E2_star = given["R"], modulus("E2", "nu2")
    if "E1" in given:
        scene.parameters["n"] = modulus("E1", "nu1") / scene.E2_star
    if "E_punch" in given:
        own = modulus("E1", "nu1") if "E1" in given else scene.E2_star * scene.parameters.get("n", 1.0)
        scene.parameters["m"] = own / modulus("E_punch", "nu_punch")
    for name, value in given.items():
        if name not in SCENE:
            i, j = VOCABULARY[name].powers
            scene.parameters[name] = value / (scene.E2_star**i * scene.R**j)


def _variable(value: Any) -> xr.Variable:
    return value.variable if isinstance(value, xr.DataArray) else xr.Variable((), value)


def _with_spreads(found: xr.Dataset, moved: int) -> xr.Dataset:
    """The results as given, each with its standard deviation `NAME_spread`, to first order, of independent inputs."""
    centre = found.isel({_MOVED: 0}).drop_vars(_MOVED, errors="ignore")
    for name, array in found.data_vars.items():
        if _MOVED not in array.dims or VOCABULARY[name].role not in ("control", "result", "profile"):
            continue
        if name in ("error", "model_error", "residual"):
            continue
        up, down = (array.isel({_MOVED: slice(first, moved, 2)}) for first in (1, 2))
        spread = np.sqrt((((up - down) / (2 * _STEP)) ** 2).sum(_MOVED, skipna=False))
        spread.attrs = {"long_name": f"standard deviation of {name}, from the spreads of the inputs"}
        spread.attrs["units"] = array.attrs.get("units", "1")
        centre[f"{name}_spread"] = spread
    return centre


class UnitIndex(PandasIndex):
    """An index of SI numbers in which `sel(h="3 um")` finds 3e-6."""

    def sel(self, labels: dict, method=None, tolerance=None):
        name, label = next(iter(labels.items()))
        unit = unit_of(name)
        ones = list(label) if isinstance(label, (list, tuple)) else [label]
        ones = [quantity(name, one, unit).value if has_unit(one) else one for one in ones]
        found = ones if isinstance(label, (list, tuple)) else ones[0]
        return super().sel({name: found}, method=method, tolerance=tolerance)

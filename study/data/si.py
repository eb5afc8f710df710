"""Results in SI units, with their spreads, of contacts whose inputs have units."""

from typing import Any

import numpy as np
import xarray as xr

from ..inputs.definition import Definition
from ..inputs.grid import MOVED
from ..inputs.scene.scene import STEP, Scene, bare_variable
from ..inputs.vocabulary import ROWS, VOCABULARY
from .dataset import Parts
from .index import searchable
from .units import PHYSICAL_SCALE, physical_attributes, with_unit

ASSUMED = "not given: the default"
SAME_PIECE = "same_piece: bodies of one material are one piece of it"
#: Results that get no spread.
_WITHOUT_SPREAD = ("error", "profile_error", "model_error", "residual")


def dataset_of(definition: Definition, parts: Parts) -> xr.Dataset:
    """The dataset of a study: in SI units if the study has units, else dimensionless."""
    return results(definition.scene, parts) if definition.scene else parts.dataset()


def results(scene: Scene, parts: Parts) -> xr.Dataset:
    """The dataset in SI units, made of the dimensionless results: inputs as given, results with their spreads."""
    results, coords = {}, {}
    for name, variable in (parts.variables | parts.coords).items():
        if name in scene.given or name == MOVED:
            continue
        known = name in VOCABULARY and VOCABULARY[name].powers != (0, 0)
        found = _in_si(name, variable, scene.unit, scene.R) if known else variable
        if MOVED in found.dims:
            results |= _spread(name, found, parts.variables.get("model_used"))
            found = found.isel({MOVED: 0})
        (coords if name in parts.coords else results)[name] = found
    coords |= {name: _coordinate(name, _as_given(scene, name, value)) for name, value in scene.given.items()}
    for name, value in scene.spreads.items():
        coords[f"{name}_spread"] = _coordinate(name, value, f"standard deviation of {name}, as given")
    for body, (dim, texts) in scene.names.items():
        values = texts if dim else texts[0]
        about = {"comment": SAME_PIECE} if scene.same_piece and scene.spreads else {}
        coords[body] = xr.Variable(dim or (), values, {"long_name": f"material of the {body}"} | about)
    for name, there in scene.given_in.items():
        if name in coords:
            coords[name] = coords[name].where(there.variable, "" if name == "layer" else np.nan)
    if scene.labels:
        coords["label"] = xr.Variable("case", scene.labels)
    for name in scene.assumed:
        coords[name].attrs["comment"] = ASSUMED
    attributes = parts.attributes | {PHYSICAL_SCALE: "SI; R, E1, E2 and E_punch are coordinates"}
    return searchable(Parts(_renamed(scene, results), _renamed(scene, coords), attributes).dataset())


def _as_given(scene: Scene, name: str, value: Any) -> Any:
    """An input over the dimensions in which it was given. Where it was moved with another body it has more."""
    if MOVED not in getattr(value, "dims", ()):
        return value
    own = getattr(scene.spreads.get(name, value), "dims", ())
    return value.isel({dim: 0 for dim in value.dims if dim not in own or dim == MOVED})


def _renamed(scene: Scene, variables: dict[str, xr.Variable]) -> dict[str, xr.Variable]:
    """The variables over the dimensions that the results have."""
    if not scene.dims:
        return variables
    dims = {name: [scene.dims.get(dim, dim) for dim in variable.dims] for name, variable in variables.items()}
    return {name: xr.Variable(dims[name], v.data, v.attrs, v.encoding) for name, v in variables.items()}


def _coordinate(name: str, value: Any, long_name: str = "") -> xr.Variable:
    """SI values of the input `name`, or their spreads, as given, with the unit."""
    return bare_variable(value, {"long_name": long_name or ROWS[name].long_name} | _units(ROWS[name].unit))


def _units(unit: str) -> dict[str, str]:
    """The attribute `units`; a pure number has none."""
    return {} if unit == "1" else {"units": unit}


def _in_si(name: str, variable: xr.Variable, unit: Any, R: Any) -> xr.Variable:
    """A dimensionless variable in the SI unit of its name, its dimensions first."""
    powers, dims = VOCABULARY[name].powers, variable.dims
    if isinstance(unit, xr.DataArray) or isinstance(R, xr.DataArray):
        found = with_unit(variable, powers, bare_variable(unit), bare_variable(R)).transpose(*dims, ...)
        dims, data = found.dims, found.data
    else:  # the usual case is made quick: arithmetic of labelled arrays takes as long as a contact
        data = with_unit(variable.data, powers, unit, R)
    data = data.astype(variable.dtype, copy=False)
    return xr.Variable(dims, data, physical_attributes(name, variable.attrs), variable.encoding)


def _spread(name: str, variable: xr.Variable, used: xr.Variable | None) -> dict[str, xr.Variable]:
    """{"NAME_spread": standard deviation of a result}, {} for a result that gets none.

    It is the root of Σ (∂result/∂input · spread of the input)², to first order, for independent inputs. Inputs of one
    piece are moved at once, so that they count as one.

    used : `model_used`, None of coordinates alone. On the base auto the cases moved up and down may be solved by two
        models, and a step from one model to another is no derivative. Then the case as given is compared with the moved
        one that has its model.
    """
    if VOCABULARY[name].role not in ("control", "result", "profile") or name in _WITHOUT_SPREAD:
        return {}
    (given, up, down), (own, plus, minus) = (
        [v.isel({MOVED: part}) for part in (0, slice(1, None, 2), slice(2, None, 2))] for v in (variable, used)
    )
    change = up - down
    if not (plus.data == minus.data).all():
        of_one_side = (2 * (up - given)).where(plus == own, (2 * (given - down)).where(minus == own))
        change = change.where((plus == minus) | change.isnull(), of_one_side)
    spread = np.sqrt(((change / (2 * STEP)) ** 2).sum(MOVED, skipna=False))
    long_name = f"standard deviation of {name}, from the spreads of the inputs"
    spread.attrs = {"long_name": long_name} | _units(VOCABULARY[name].unit)
    return {f"{name}_spread": spread}

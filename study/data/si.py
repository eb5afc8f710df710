"""Results in SI units, with their spreads, of contacts whose inputs have units."""

from typing import Any

import numpy as np
import xarray as xr

from ..inputs.definition import Definition
from ..inputs.scene.scene import Scene, bare_variable
from ..inputs.vocabulary import ROWS, VOCABULARY
from .dataset import Parts
from .index import searchable
from .spreads import spreads_of
from .units import PHYSICAL_SCALE, physical_attributes, with_unit

ASSUMED = "not given: the default"
SAME_PIECE = "same_piece: bodies of one material are one piece of it"


def dataset_of(definition: Definition, parts: Parts) -> xr.Dataset:
    """The dataset of a study: in SI units if the study has units, else dimensionless."""
    return results(definition, parts) if definition.scene else parts.dataset()


def results(definition: Definition, parts: Parts) -> xr.Dataset:
    """The dataset in SI units, from dimensionless parts: inputs in SI units, results with their spreads."""
    scene, results, coords = definition.scene, {}, {}
    spreads = spreads_of(definition, parts) if parts.by_input else {}
    for name, variable in (parts.variables | parts.coords).items():
        if name in scene.values:
            continue
        has_powers = name in VOCABULARY and VOCABULARY[name].powers != (0, 0)
        quantity = _in_si(name, variable, scene.unit, scene.R) if has_powers else variable
        if name in spreads:
            spread = _in_si(name, xr.Variable(quantity.dims, spreads[name]), scene.unit, scene.R)
            long_name = f"standard deviation of {name}, from the spreads of the inputs"
            spread.attrs = {"long_name": long_name} | _units(VOCABULARY[name].unit)
            results[f"{name}_spread"] = spread
        (coords if name in parts.coords else results)[name] = quantity
    coords |= {name: _coordinate(name, value) for name, value in scene.values.items()}
    if scene.scale:
        coords["R"].attrs["long_name"] = f"unit of length: {scene.scale}"
    for name, value in scene.spreads.items():
        coords[f"{name}_spread"] = _coordinate(name, value, f"standard deviation of {name}, as given")
    for body, (dim, texts) in scene.names.items():
        values = texts if dim else texts[0]
        comment = {"comment": SAME_PIECE} if scene.same_piece and scene.spreads else {}
        coords[body] = xr.Variable(dim or (), values, {"long_name": f"material of the {body}"} | comment)
    for name, cases in scene.cases_of.items():
        if name in coords:
            coords[name] = coords[name].where(cases.variable, "" if name == "layer" else np.nan)
    if scene.labels:
        coords["label"] = xr.Variable("case", scene.labels)
    for name in scene.assumed:
        coords[name].attrs["comment"] = ASSUMED
    pairs = [f"{first} and {second}: {v:g}" for (first, second), v in scene.correlations.items() if np.ndim(v) == 0]
    correlations = {"correlations": "; ".join(pairs)} if pairs else {}
    attributes = parts.attributes | correlations | {PHYSICAL_SCALE: "SI; R, E1, E2 and E_punch are coordinates"}
    return searchable(Parts(_renamed(scene, results), _renamed(scene, coords), attributes).dataset())


def _renamed(scene: Scene, variables: dict[str, xr.Variable]) -> dict[str, xr.Variable]:
    """The variables over the dimensions that the results have."""
    if not scene.dims:
        return variables
    dims = {name: [scene.dims.get(dim, dim) for dim in variable.dims] for name, variable in variables.items()}
    return {name: xr.Variable(dims[name], v.data, v.attrs, v.encoding) for name, v in variables.items()}


def _coordinate(name: str, value: Any, long_name: str = "") -> xr.Variable:
    """SI values of the input `name`, or their spreads, with the unit."""
    return bare_variable(value, {"long_name": long_name or ROWS[name].long_name} | _units(ROWS[name].unit))


def _units(unit: str) -> dict[str, str]:
    """The attribute `units`; a pure number has none."""
    return {} if unit == "1" else {"units": unit}


def _in_si(name: str, variable: xr.Variable, unit: Any, R: Any) -> xr.Variable:
    """A dimensionless variable in the SI unit of its name, its dimensions first."""
    powers, dims = VOCABULARY[name].powers, variable.dims
    if isinstance(unit, xr.DataArray) or isinstance(R, xr.DataArray):
        array = with_unit(variable, powers, bare_variable(unit), bare_variable(R)).transpose(*dims, ...)
        dims, data = array.dims, array.data
    else:  # the usual case: arithmetic of labelled arrays would take as long as a contact
        data = with_unit(variable.data, powers, unit, R)
    data = data.astype(variable.dtype, copy=False)
    return xr.Variable(dims, data, physical_attributes(name, variable.attrs), variable.encoding)

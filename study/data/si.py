"""Results in SI units, with their spreads, of contacts whose inputs have units."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import xarray_later as xr
from ..arrays.labelled import Labelled
from ..inputs.definition import Definition
from ..inputs.scene.scene import Scene, bare_variable
from ..inputs.vocabulary import Entry
from ..specimen.materials import Strength, known_strength
from .dataset import DatasetParts, labelled, with_numbered_layers
from .spreads import spreads_of
from .units import PHYSICAL_SCALE, physical_attributes, with_unit

ASSUMED = "not given: the default"
OF_USERS = "strengths"
"""Attribute of the names of materials, for those that the user defines: in JSON, name -> [yield strength in Pa, spread,
whether it comes from hardness]."""
SAME_PIECE = "same_piece: bodies of one material are one piece of it"


def dataset_of(definition: Definition, parts: DatasetParts) -> xr.Dataset:
    """The dataset of a study: in SI units if the study has units, otherwise dimensionless."""
    return dataset_in_units(definition, in_units(definition, parts))


def dataset_in_units(definition: Definition, parts: DatasetParts) -> xr.Dataset:
    """The dataset of parts from `in_units`."""
    if not definition.scene or not definition.grid.sizes:  # there is nothing to search along
        return parts.dataset()
    from .coordinates import searchable

    return searchable(parts.dataset())


def axes_of(definition: Definition) -> dict[str, np.ndarray]:
    """Dimension of the results of a study, except `x` -> the values of its coordinate in the results."""
    coords = in_units(definition, labelled(definition, {}, "")).coords
    return {dim: np.asarray(coords[dim].data) for dim in definition.in_results(definition.grid.sizes)}


def in_units(definition: Definition, parts: DatasetParts) -> DatasetParts:
    """Dimensionless parts in the units of the study."""
    parts = results(definition, parts) if definition.scene else parts
    return with_numbered_layers(parts) if definition.layers else parts


def results(definition: Definition, parts: DatasetParts) -> DatasetParts:
    """The parts in SI units, from dimensionless ones: inputs in SI units, results with their spreads."""
    scene, results, coords = definition.scene, {}, {}
    rows = scene.lexicon.all_rows
    spreads = spreads_of(definition, parts) if parts.by_input else {}
    for name, variable in (parts.variables | parts.coords).items():
        if name in scene.values:
            continue
        has_powers = name in scene.lexicon.rows and rows[name].powers != (0, 0)
        quantity = _in_si(rows[name], variable, scene.unit, scene.R) if has_powers else variable
        if name in spreads:
            spread = _in_si(rows[name], Labelled(quantity.dims, spreads[name]), scene.unit, scene.R)
            long_name = f"standard deviation of {name}, from the spreads of the inputs"
            spread.attrs = {"long_name": long_name} | _units(rows[name].unit)
            results[f"{name}_spread"] = spread
        (coords if name in parts.coords else results)[name] = quantity
    coords |= {name: _coordinate(rows[name], value) for name, value in scene.values.items()}
    if scene.scale:
        coords["R"].attrs["long_name"] = f"unit of length: {scene.scale}"
    for name, value in scene.spreads.items():
        coords[f"{name}_spread"] = _coordinate(rows[name], value, f"standard deviation of {name}, as given")
    for body, (dim, texts) in scene.names.items():
        values = texts if dim else texts[0]
        about = {"long_name": f"material of the {body}"}
        about |= {"comment": SAME_PIECE} if scene.same_piece and scene.spreads else {}
        coords[body] = Labelled(dim or (), values, about | _of_users(texts, scene.strengths.get(body, ("", ()))[1]))
    for name, cases in scene.cases_of.items():
        if name in coords:
            none = "" if name == "layer" else np.nan
            coords[name] = Labelled.of(coords[name].to_xarray().where(cases.variable, none))
    if scene.labels:
        coords["label"] = Labelled("case", scene.labels)
    for name in scene.assumed:
        coords[name].attrs["comment"] = ASSUMED
    pairs = [f"{first} and {second}: {v:g}" for (first, second), v in scene.correlations.items() if np.ndim(v) == 0]
    correlations = {"correlations": "; ".join(pairs)} if pairs else {}
    attributes = parts.attributes | correlations | {PHYSICAL_SCALE: "SI; R, E1, E2 and E_punch are coordinates"}
    return DatasetParts(_renamed(scene, results), _renamed(scene, coords), attributes)


def _of_users(texts: list[str], strengths: Sequence[Strength]) -> dict[str, str]:
    """The attribute OF_USERS; {} where every strength is that of the table of materials."""
    of_users = {
        text: strength
        for text, strength in zip(texts, strengths, strict=False)
        if repr(strength) != repr(known_strength(text))
    }
    return {OF_USERS: json.dumps(of_users)} if of_users else {}


def _renamed(scene: Scene, variables: dict[str, Labelled]) -> dict[str, Labelled]:
    """The variables with the dimensions named as in the results."""
    if not scene.dims:
        return variables
    dims = {name: [scene.dims.get(dim, dim) for dim in variable.dims] for name, variable in variables.items()}
    return {name: Labelled(dims[name], v.data, v.attrs, v.encoding) for name, v in variables.items()}


def _coordinate(row: Entry, value: Any, long_name: str = "") -> Labelled:
    """SI values of an input, or their spreads, with the unit."""
    return bare_variable(value, {"long_name": long_name or row.long_name} | _units(row.unit))


def _units(unit: str) -> dict[str, str]:
    """The attribute `units`; a pure number has none."""
    return {} if unit == "1" else {"units": unit}


def _in_si(row: Entry, variable: Labelled, unit: Any, R: Any) -> Labelled:
    """A dimensionless variable in the SI unit of its row. Dimensions of the units come after its own."""
    powers, dims = row.powers, variable.dims
    if xr.is_array(unit) or xr.is_array(R):
        array = with_unit(*(variable.to_xarray(), powers), *(bare_variable(scale).to_xarray() for scale in (unit, R)))
        array = array.transpose(*dims, ...)
        dims, data = array.dims, array.data
    else:  # the usual case: arithmetic of labelled arrays would take as long as a contact
        data = with_unit(variable.data, powers, unit, R)
    data = data.astype(variable.dtype, copy=False)
    return Labelled(dims, data, physical_attributes(row, variable.attrs), variable.encoding)

"""The yield strengths of the bodies and asperities of contacts, in the unit of the solver."""

from __future__ import annotations

import json
from collections.abc import Mapping

import numpy as np

from solver.bases import is_bare
from solver.laws.elastic_plastic import TABOR
from solver.layers import full_name, numbers_of

from ..inputs.vocabulary import name_in_stack
from ..rules.strength import first, softer
from ..specimen.materials import Material, Strength, known_strength
from .contacts import Contacts, without_coordinates
from .dataset import STRENGTHS, material_name
from .si import OF_USERS


def strengths(contacts: Contacts, materials: Mapping[str, Material], spread: bool = False) -> dict:
    """Yield strengths of the layer, body, punch and asperities, (B,) each in the unit of E2; NaN where unknown.

    The asperities have the strength of the softer of the two surfaces. A hardness is 2.84 yield strengths.

    materials : the materials of the call by name, which the table of materials may lack
    spread : give standard deviations instead, 0 for an input without one
    """
    columns_of = known_strengths(contacts, materials)
    return {body: np.where(np.isnan(value), np.nan, (value, sd)[spread]) for body, (value, sd, _) in columns_of.items()}


def known_strengths(contacts: Contacts, materials: Mapping[str, Material]) -> dict[str, list]:
    """For each body, and the asperities: the strength, its standard deviation, whether it comes from hardness, (B,)."""
    of_materials = {body: _of_materials(contacts, body, materials) for body in STRENGTHS}
    none_from_hardness = np.zeros(len(contacts.problem), dtype=bool)
    inputs = {
        name: [contacts.problem.parameters[name], _spread(contacts, name), none_from_hardness] for name in _INPUTS
    }
    of_bodies = {body: first(inputs[name], of_materials[body]) for body, name in STRENGTHS.items()}
    bare, elastic = is_bare(contacts.problem.base), contacts.problem.m > 0
    from_hardness = [inputs["hardness"][0] / TABOR, inputs["hardness"][1] / TABOR, ~none_from_hardness]
    of_spots = softer(of_materials["layer"], of_materials["body"], of_materials["punch"], bare, elastic)
    return of_bodies | {"asperities": first(first(inputs["yield_strength"], from_hardness), of_spots)}


def layer_strengths(contacts: Contacts, materials: Mapping[str, Material]) -> list[list]:
    """The same three columns for each layer of a stack, from the surface down."""
    strengths_of_layers, none_from_hardness = [], np.zeros(len(contacts.problem), dtype=bool)
    for number in range(1, numbers_of(contacts.problem.parameters) + 1):
        name = full_name(number, "Y")
        input_values = contacts.problem.parameters.get(name, np.full(len(none_from_hardness), np.nan))
        material = _of_materials(contacts, name_in_stack(number, "material"), materials)
        strengths_of_layers.append(first([input_values, _spread(contacts, name), none_from_hardness], material))
    return strengths_of_layers


_INPUTS = (*STRENGTHS.values(), "hardness", "yield_strength")


def _spread(contacts: Contacts, name: str) -> np.ndarray:
    """The standard deviation of an input, (B,) in the unit of E2; 0 where it has none."""
    stress, _ = contacts.units
    return np.nan_to_num(contacts.coordinate(f"{name}_spread", 0.0)) / stress


def _of_materials(contacts: Contacts, body: str, materials: Mapping[str, Material]) -> list:
    """Strength, standard deviation, whether it comes from hardness: (B,) each, the first two in the unit of E2."""
    cases, dataset = len(contacts.problem), contacts.dataset
    body = material_name(dataset, body)
    if body not in dataset.coords or contacts.scene is None:
        return [np.full(cases, np.nan), np.zeros(cases), np.zeros(cases, bool)]
    names = contacts.column(without_coordinates(dataset[body])).astype(str)
    of_users = {name: Strength(*row) for name, row in json.loads(dataset[body].attrs.get(OF_USERS, "{}")).items()}
    by_name = {
        name: known_strength(materials[name]) if name in materials else of_users.get(name) or known_strength(name)
        for name in np.unique(names).tolist()
    }
    values, spreads, hard = (np.array(column) for column in zip(*(by_name[name] for name in names), strict=True))
    stress, _ = contacts.units
    return [values / stress, spreads / stress, hard.astype(bool)]

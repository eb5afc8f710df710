"""The contacts of a dataset as a problem that can be solved again, and the strengths of their bodies."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from solver import Problem
from solver.bases import is_bare
from solver.laws.elastic_plastic import TABOR
from solver.laws.own_table import LAW_UNIT
from solver.shapes import PARABOLOID

from .arrays import xarray_later as xr
from .data.dataset import STRENGTHS
from .data.one_case import is_contact
from .data.si import OF_USERS
from .inputs.definition import StudyError
from .inputs.lexicon import Lexicon, lexicon_in
from .inputs.punch.shapes import MICROMETRE, in_metres
from .inputs.punch.stresses import DECIDE, without_stresses
from .inputs.scene.layers import moduli_of
from .inputs.scene.names import is_ratio
from .inputs.scene.scales import make_dimensionless
from .inputs.scene.scene import Scene, over
from .inputs.vocabulary import CONTROLS, NUMERICS, SCENE, scene_of
from .rules.rule import has_units
from .rules.strength import first, softer
from .specimen.materials import Material, Strength, known_strength
from .terminal import shown


class Again(NamedTuple):
    """The problem of a dataset: its cases (B,), in the order of `status`.

    numbers : parameter of the solver -> a number, a text, or a DataArray over `dims`
    scene : of a dataset in SI units, else None
    dims, shape : of `status`
    """

    problem: Problem
    numbers: dict[str, Any]
    scene: Scene | None
    dims: tuple
    shape: tuple[int, ...]

    @classmethod
    def of(cls, contact: xr.Dataset, who: str) -> Again:
        """The problem of a dataset. Raises StudyError if it is no result, or has lost an input.

        who : the name of the public function, for messages
        """
        inputs, lexicon = _checked(contact, who), lexicon_in(contact)
        dims, shape = contact["status"].dims, contact["status"].shape
        scene = _scene(inputs, contact.attrs.get("scale", "R"), lexicon) if "R" in inputs else None
        numbers = scene.parameters if scene else inputs
        names = [name for name in lexicon.parameters_of(numbers) if name in numbers]
        try:
            columns = {name: of_all_cases(numbers[name], dims, shape) for name in names}
            problem = Problem.of(known=lexicon.known, **columns)
        except ValueError as error:
            raise StudyError([f"{who}: {error}"]) from None
        return cls(problem, numbers, scene, dims, shape)


def no_stresses(again: Again, *, largest: bool = True) -> str:
    """Why some contacts have no stresses, or no `largest` ones; "" where all have them."""
    base, *others = (getattr(again.problem, name) for name in DECIDE)
    return without_stresses(base, again.problem.rough(), *others, largest=largest)


def refuse_without_stresses(again: Again, who: str, *, largest: bool = True) -> None:
    """Raise StudyError where stresses of a contact, or the `largest` ones, are not computed: in a stack of layers, at
    an edge where they are infinite."""
    if reason := no_stresses(again, largest=largest):
        raise StudyError([f"{who}: {reason}"])


def _checked(contact: xr.Dataset, who: str) -> dict[str, Any]:
    """The inputs of the cases: numbers and texts, or DataArrays without coordinates. Raises StudyError."""
    if not is_contact(contact) or "status" not in contact:
        raise StudyError([f"{who} takes a dataset of study.solve or of a results file, with its status"])
    lexicon = lexicon_in(contact)
    coords = [str(name) for name in contact.coords]
    settings = {name: contact.attrs[name] for name in NUMERICS if name in contact.attrs}
    coordinates = [name for name in (*CONTROLS, *scene_of(coords), *lexicon.parameters_of(coords)) if name in coords]
    wrong = [f"has no coordinate {name}" for name in ("base", "micro") if name not in coordinates]
    wrong += ["must have one of P, a and D as a coordinate"] * (len({*coordinates} & {*CONTROLS}) != 1)
    if wrong:
        raise StudyError([f"{who}: the dataset {wrong[0]}: its cases cannot be solved again"])
    units_of = {name: lexicon.all_rows[name].unit for name in coordinates}
    units = {unit == contact[name].attrs.get("units") for name, unit in units_of.items() if unit != "1"}
    if units == {True, False} or has_units(contact) != ("R" in coordinates and "E2" in coordinates):
        raise StudyError([f"{who} needs all in SI units, as study.solve gives them, or all without units"])
    unknown = {*np.unique(contact["micro"].values.astype(str)).tolist()} - {*lexicon.known.laws}
    if unknown:
        raise StudyError([f"micro = {shown(min(unknown))}: no law of this name is registered here"])
    words = contact["shape"].values.astype(str) if "shape" in contact.coords else PARABOLOID
    unknown = {*np.unique(words).tolist()} - {*lexicon.known.shapes}
    if unknown:  # whoever sends a results file must not choose which files are opened
        raise StudyError([f"shape = {shown(min(unknown))}: no shape of this name is registered here"])
    return settings | {name: _without_coordinates(contact[name]) for name in coordinates}


def _without_coordinates(array: xr.DataArray) -> Any:
    values = array.values.astype(str) if array.dtype.kind == "O" else array.values
    return xr.DataArray(values, dims=array.dims) if array.dims else values.item()


def _scene(inputs: dict[str, Any], scale: Any, lexicon: Lexicon) -> Scene:
    """The scene of inputs in SI units. What follows from others is computed again.

    scale : the input that is the unit of length
    """
    follows = {ratio for modulus, ratio in (("E1", "n"), ("E_punch", "m")) if modulus in inputs}
    follows |= {ratio for _, _, ratio in moduli_of(inputs)}
    in_si = [name for name in inputs if name in SCENE or is_ratio(name) or lexicon.rows[name].powers != (0, 0)]
    others = {name: value for name, value in inputs.items() if name not in {*in_si, *follows}}
    metres = in_metres(others.get("shape", ""), lexicon)
    in_metre = {LAW_UNIT, *["table_unit"] * bool(np.any(metres))}
    values = {name: inputs[name] for name in in_si if name not in in_metre}
    scale = scale if scale in values and scale != "R" or scale == MICROMETRE else ""
    scene = Scene(values=values, parameters=others, scale=scale, metres=metres, lexicon=lexicon)
    make_dimensionless(scene)
    return scene


def of_all_cases(value: Any, dims: tuple, shape: tuple[int, ...]) -> np.ndarray:
    """A number, a text or a DataArray for all cases, (B,)."""
    return np.broadcast_to(over(value, dims), shape).ravel()


def strengths(contact: xr.Dataset, again: Again, materials: Mapping[str, Material], spread: bool = False) -> dict:
    """Yield strength of the layer, body, punch and asperities, (B,) each in the unit of E2; NaN where it is not known.

    Asperities have that of the softer of the two surfaces. A hardness is 2.84 yield strengths.

    materials : those of the call by name; the table of materials need not have them
    spread : give standard deviations instead, 0 for an input without one
    """
    known = known_strengths(contact, again, materials)
    return {who: np.where(np.isnan(value), np.nan, (value, sd)[spread]) for who, (value, sd, _) in known.items()}


def known_strengths(contact: xr.Dataset, again: Again, materials: Mapping[str, Material]) -> dict[str, list]:
    """The same as a list of the strength, its standard deviation and whether it is from hardness, (B,) each."""
    named = {body: _of_materials(contact, again, body, materials) for body in STRENGTHS}
    no = np.zeros(len(again.problem), dtype=bool)
    inputs = {name: [again.problem.parameters[name], _spread(contact, again, name), no] for name in _INPUTS}
    yields = {body: first(inputs[name], named[body]) for body, name in STRENGTHS.items()}
    bare, elastic = is_bare(again.problem.base), again.problem.m > 0
    hard = [inputs["hardness"][0] / TABOR, inputs["hardness"][1] / TABOR, ~no]
    of_spots = softer(named["layer"], named["body"], named["punch"], bare, elastic)
    return yields | {"asperities": first(first(inputs["yield_strength"], hard), of_spots)}


_INPUTS = (*STRENGTHS.values(), "hardness", "yield_strength")


def _of_all(again: Again, value: Any) -> np.ndarray:
    return of_all_cases(value, again.dims, again.shape).astype(float)


def _unit(again: Again) -> Any:
    return _of_all(again, again.scene.unit) if again.scene else 1.0


def _spread(contact: xr.Dataset, again: Again, name: str) -> np.ndarray:
    """In the unit of E2, (B,)."""
    name = f"{name}_spread"
    spreads = _of_all(again, _without_coordinates(contact[name]) if name in contact.coords else 0.0)
    return np.nan_to_num(spreads) / _unit(again)


def _of_materials(contact: xr.Dataset, again: Again, body: str, materials: Mapping[str, Material]) -> list:
    """Strength, standard deviation and whether it is from hardness, (B,) each, the first two in the unit of E2."""
    if body not in contact.coords or again.scene is None:
        return [np.full(len(again.problem), np.nan), np.zeros(len(again.problem)), np.zeros(len(again.problem), bool)]
    names = of_all_cases(_without_coordinates(contact[body]), again.dims, again.shape).astype(str)
    of_users = {name: Strength(*row) for name, row in json.loads(contact[body].attrs.get(OF_USERS, "{}")).items()}
    known = {
        name: known_strength(materials[name]) if name in materials else of_users.get(name) or known_strength(name)
        for name in np.unique(names).tolist()
    }
    values, spreads, hard = (np.array(column) for column in zip(*(known[name] for name in names), strict=True))
    return [values / _unit(again), spreads / _unit(again), hard.astype(bool)]

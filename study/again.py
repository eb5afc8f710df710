"""Contacts of a dataset, solved again from the inputs that it has; and their strengths."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from solver import Problem
from solver.laws import LAWS
from solver.laws.elastic_plastic import TABOR

from .inputs.definition import StudyError
from .inputs.laws import recall
from .inputs.scene.changes import RATIOS
from .inputs.scene.scales import make_dimensionless
from .inputs.scene.scene import Scene, over
from .inputs.vocabulary import CONTROLS, NUMERICS, PARAMETERS, ROWS, SCENE, VOCABULARY
from .rules.rule import has_units
from .specimen.materials import Material, strength_of
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
    def of(cls, contact: xr.Dataset, who: str) -> "Again":
        """Raises StudyError, which names the function `who`, where a dataset is no result or has lost an input."""
        inputs = _checked(contact, who)
        dims, shape = contact["status"].dims, contact["status"].shape
        scene = _scene(inputs) if "R" in inputs else None
        numbers = scene.parameters if scene else inputs
        try:
            problem = Problem.of(
                **{name: of_all_cases(numbers[name], dims, shape) for name in PARAMETERS if name in numbers}
            )
        except ValueError as error:
            raise StudyError([f"{who}: {error}"]) from None
        return cls(problem, numbers, scene, dims, shape)


def _checked(contact: xr.Dataset, who: str) -> dict[str, Any]:
    """The inputs of the cases: numbers and texts, or DataArrays without coordinates. Raises StudyError."""
    if not isinstance(contact, xr.Dataset) or "status" not in contact:
        raise StudyError([f"{who} takes a dataset of study.solve or of a results file, with its status"])
    recall(contact.attrs.get("micro_laws", ""))
    settings = {name: contact.attrs[name] for name in NUMERICS if name in contact.attrs}
    there = [name for name in (*CONTROLS, *SCENE, *PARAMETERS) if name in contact.coords]
    wrong = [f"has no coordinate {name}" for name in ("base", "micro") if name not in there]
    wrong += ["must have one of P, a and D as a coordinate"] * (len({*there} & {*CONTROLS}) != 1)
    if wrong:
        raise StudyError([f"{who}: the dataset {wrong[0]}: its cases cannot be solved again"])
    units = {ROWS[name].unit == contact[name].attrs.get("units") for name in there if ROWS[name].unit != "1"}
    if units == {True, False} or has_units(contact) != ("R" in there and "E2" in there):
        raise StudyError([f"{who} needs all in SI units, as study.solve gives them, or all without units"])
    unknown = {*np.unique(contact["micro"].values.astype(str)).tolist()} - {*LAWS}
    if unknown:
        raise StudyError([f"micro = {shown(min(unknown))}: no law of this name is registered here"])
    return settings | {name: _without_coordinates(contact[name]) for name in there}


def _without_coordinates(array: xr.DataArray) -> Any:
    values = array.values.astype(str) if array.dtype.kind == "O" else array.values
    return xr.DataArray(values, dims=array.dims) if array.dims else values.item()


def _scene(inputs: dict[str, Any]) -> Scene:
    """The scene of inputs in SI units. What follows from others is computed again."""
    follows = {ratio for modulus, ratio in (("E1", "n"), ("E_punch", "m")) if modulus in inputs}
    in_si = [name for name in inputs if name in SCENE or name in RATIOS or VOCABULARY[name].powers != (0, 0)]
    others = {name: value for name, value in inputs.items() if name not in {*in_si, *follows}}
    scene = Scene(given={name: inputs[name] for name in in_si}, parameters=others)
    make_dimensionless(scene)
    return scene


def of_all_cases(value: Any, dims: tuple, shape: tuple[int, ...]) -> np.ndarray:
    """A number, a text or a DataArray for all cases, (B,)."""
    return np.broadcast_to(over(value, dims), shape).ravel()


STRENGTHS = {"layer": "Y1", "body": "Y2", "punch": "Y_punch"}
"""Body -> the input that is its yield strength."""


def strengths(contact: xr.Dataset, again: Again, own: Mapping[str, Material], spread: bool = False) -> dict:
    """Yield strength of the layer, body, punch and asperities, (B,) each in the unit of E2; NaN where it is not known.

    That of asperities is of the softer of what meets there. A hardness is 2.84 yield strengths.

    own : materials of the call by name, which the table need not have
    spread : their standard deviations instead, 0 where none is given
    """
    unit = _of_all(again, again.scene.unit) if again.scene else 1.0
    named = {
        body: [_of_materials(contact, again, body, own, which) / unit for which in (False, True)] for body in STRENGTHS
    }
    given = {name: [again.problem.parameters[name], _spread(contact, again, name) / unit] for name in _GIVEN}
    found = {body: _first(given[name], named[body]) for body, name in STRENGTHS.items()}
    bare = again.problem.base == "half_space"
    softer = [np.where(bare, *pair) for pair in zip(named["body"], named["layer"], strict=True)]
    punch = (again.problem.m > 0) & ((named["punch"][0] < softer[0]) | np.isnan(named["punch"][0]))
    softer = [np.where(punch, *pair) for pair in zip(named["punch"], softer, strict=True)]
    hard = [values / TABOR for values in given["hardness"]]
    found |= {"asperities": _first(_first(given["yield_strength"], hard), softer)}
    return {who: np.where(np.isnan(pair[0]), np.nan, pair[spread]) for who, pair in found.items()}


_GIVEN = (*STRENGTHS.values(), "hardness", "yield_strength")


def _first(one: list, other: list) -> list:
    """Value and spread of the one where it is known, else those of the other."""
    return [np.where(np.isnan(one[0]), *pair[::-1]) for pair in zip(one, other, strict=True)]


def _of_all(again: Again, value: Any) -> np.ndarray:
    return of_all_cases(value, again.dims, again.shape).astype(float)


def _spread(contact: xr.Dataset, again: Again, name: str) -> np.ndarray:
    name = f"{name}_spread"
    found = _of_all(again, _without_coordinates(contact[name]) if name in contact.coords else 0.0)
    return np.nan_to_num(found)


def _of_materials(
    contact: xr.Dataset, again: Again, body: str, own: Mapping[str, Material], spread: bool
) -> np.ndarray:
    """In Pa, (B,)."""
    if body not in contact.coords or again.scene is None:
        return np.full(len(again.problem), np.nan)
    names = of_all_cases(_without_coordinates(contact[body]), again.dims, again.shape).astype(str)
    known = {name: strength_of(own.get(name, name), spread) for name in np.unique(names)}
    return np.array([known[name] for name in names])

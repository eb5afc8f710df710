"""The contacts of a dataset as a problem that can be solved."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from solver import Problem
from solver.laws.own_table import LAW_UNIT
from solver.shapes import PARABOLOID

from ..arrays import xarray_later as xr
from ..inputs.definition import StudyError
from ..inputs.lexicon import Lexicon, lexicon_in
from ..inputs.punch.shapes import MICROMETRE, in_metres
from ..inputs.punch.stresses import DECIDE, without_stresses
from ..inputs.scene.scene import Scene, is_ratio, make_dimensionless, over
from ..inputs.scene.stacks import moduli_of
from ..inputs.vocabulary import CONTROLS, NUMERICS, SCENE, scene_of
from ..rules.rule import has_units
from ..terminal import shown
from .dataset import is_contact


class Contacts(NamedTuple):
    """The contacts of a dataset, and the problem of their inputs: B cases, in the order of `status`.

    dataset : of `study.solve`, or of a results file
    problem : for the solver, in its units; the layers of stacks are among its parameters, as "layers.2.h"
    numbers : parameter of the solver -> a number, a text, or a DataArray over `dims`
    scene : of a dataset in SI units, else None
    dims, shape : of `status`
    """

    dataset: xr.Dataset
    problem: Problem
    numbers: dict[str, Any]
    scene: Scene | None
    dims: tuple
    shape: tuple[int, ...]

    @classmethod
    def of(cls, dataset: xr.Dataset, who: str) -> Contacts:
        """The contacts of a dataset. Raises StudyError if it is no result, or has lost an input.

        who : the name of the public function, for messages
        """
        inputs, lexicon = _checked(dataset, who), lexicon_in(dataset)
        dims, shape = dataset["status"].dims, dataset["status"].shape
        scene = _scene(inputs, dataset.attrs.get("scale", "R"), lexicon) if "R" in inputs else None
        numbers = scene.parameters if scene else inputs
        try:
            problem = lexicon.problem({name: of_all_cases(value, dims, shape) for name, value in numbers.items()})
        except ValueError as error:
            raise StudyError([f"{who}: {error}"]) from None
        return cls(dataset, problem, numbers, scene, dims, shape)

    @classmethod
    def in_words(cls, dataset: xr.Dataset) -> Contacts | None:
        """The contacts of a dataset, for sentences about it; None if they cannot be solved again, as those of a
        mean."""
        try:
            return cls.of(dataset, "summary")
        except StudyError:
            return None

    def column(self, value: Any) -> np.ndarray:
        """The values of all cases, (B,), from a number, a text or a DataArray over dimensions of the contacts."""
        return of_all_cases(value, self.dims, self.shape)

    def coordinate(self, name: str, default: float) -> np.ndarray:
        """The numbers of a coordinate of the dataset, (B,); the default if the dataset lacks it."""
        there = name in self.dataset.coords
        return self.column(without_coordinates(self.dataset[name]) if there else default).astype(float)

    @property
    def units(self) -> tuple[np.ndarray, np.ndarray]:
        """The stress and the length that are 1 for the solver, (B,) each: Pa and m, or 1 of a dataset without units."""
        stress, length = (self.scene.unit, self.scene.R) if self.scene else (1.0, 1.0)
        return self.column(stress).astype(float), self.column(length).astype(float)

    def without_stresses(self, *, largest: bool = True) -> str:
        """The reason why some contacts have no stresses, or no largest stress since it is infinite at an edge; "" if
        all have them.

        largest : whether the largest stress is needed
        """
        others = (getattr(self.problem, name) for name in DECIDE)
        return without_stresses(self.problem.rough(), *others, largest=largest)

    def refuse_without_stresses(self, who: str, *, largest: bool = True) -> None:
        """Raise StudyError where some contacts have no stresses; arguments as above."""
        if reason := self.without_stresses(largest=largest):
            raise StudyError([f"{who}: {reason}"])


def of_all_cases(value: Any, dims: tuple, shape: tuple[int, ...]) -> np.ndarray:
    """The values of all cases, (B,), from a number, a text or a DataArray."""
    return np.broadcast_to(over(value, dims), shape).ravel()


def refuse_no_results(dataset: Any, who: str) -> None:
    """Raise StudyError unless it is a dataset of results. who : the name of the public function, for messages"""
    if not is_contact(dataset) or "status" not in dataset:
        raise StudyError([f"{who} takes a dataset of study.solve or of a results file, with its status"])


def _checked(contact: xr.Dataset, who: str) -> dict[str, Any]:
    """The inputs of the cases: numbers and texts, or DataArrays without coordinates. Raises StudyError."""
    refuse_no_results(contact, who)
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
        raise StudyError([f"{who} needs all inputs in SI units, as study.solve gives them, or all without units"])
    unknown = {*np.unique(contact["micro"].values.astype(str)).tolist()} - {*lexicon.known.laws}
    if unknown:
        raise StudyError([f"micro = {shown(min(unknown))}: no law of this name is registered here"])
    words = contact["shape"].values.astype(str) if "shape" in contact.coords else PARABOLOID
    unknown = {*np.unique(words).tolist()} - {*lexicon.known.shapes}
    if unknown:  # whoever sends a results file must not choose which files are opened
        raise StudyError([f"shape = {shown(min(unknown))}: no shape of this name is registered here"])
    return settings | {name: without_coordinates(contact[name]) for name in coordinates}


def without_coordinates(array: xr.DataArray) -> Any:
    values = array.values.astype(str) if array.dtype.kind == "O" else array.values
    return xr.DataArray(values, dims=array.dims) if array.dims else values.item()


def _scene(inputs: dict[str, Any], scale: Any, lexicon: Lexicon) -> Scene:
    """The scene of inputs in SI units. Inputs that follow from others are computed again.

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

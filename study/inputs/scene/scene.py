"""A physical scene: its inputs in SI units, and the dimensionless numbers that the solver gets.

The solver works in units R = 1 and E2* = E2/(1 - nu2²) = 1; on a rigid base, where E2* is infinite, in E1* = 1. Each
case is computed by itself, so that it has the same dimensionless numbers, and the same key, in any grid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from solver.bases import is_bare
from solver.laws.own_table import LAW_UNIT
from solver.parameters import is_ratio as of_solver

from ...arrays import xarray_later as xr
from ...arrays.labelled import Labelled
from ...specimen.quantities import Quantity, quantity
from ..lexicon import PACKAGE, Lexicon
from ..punch.micro_laws import laws_in_metres
from ..vocabulary import SCENE
from .stacks import moduli_of

#: Texts for an infinite modulus, that of a rigid body; and for an infinite radius, that of a flat one.
RIGID_TEXTS, _FLAT_TEXTS = ("rigid", "inf", "infinite"), ("flat", "inf", "infinite")
#: Input that may be infinite -> the texts for infinity.
INFINITE = {"E2": RIGID_TEXTS, "E_punch": RIGID_TEXTS, "R1": _FLAT_TEXTS, "R2": _FLAT_TEXTS, "k_machine": RIGID_TEXTS}
#: Default of the Poisson ratio of a punch, equal to that of the other bodies.
_POISSON = PACKAGE.parameter("nu1").default
#: The unit of length, in m, for a punch without any given length.
_MICROMETRE = 1e-6


@dataclass
class Scene:
    """A physical scene.

    values : input -> its SI values, a float or a DataArray
    spreads : input -> standard deviations, likewise; only of inputs that have some
    parameters : dimensionless, for the solver
    R, unit : radius (m) and modulus (Pa) that are 1 for the solver; the modulus is E2*, or E1* on a rigid base
    dims : dimension while the cases are solved -> name of it in the results
    labels : of the dimension `case`
    names : punch, layer, body -> (dimension or "", names of materials along it)
    strengths : likewise -> (dimension or "", (strength in Pa, its spread, whether it comes from hardness) along it);
        NaN for materials without a known strength. Bodies without any known strength are left out
    cases_of : coordinate -> the cases that have it, a DataArray of bool; a case without a layer may lack it
    assumed : Poisson ratios and the interface if they matter but nobody gave them, so that they have their defaults
    same_piece : whether bodies of one material are cut from one piece
    correlations : pair of inputs with spreads -> their correlation, a number or a DataArray; 0 for all other pairs
    scale : the input, or "1 um", that is the unit of length R for shapes without a radius; "" if R, or R1 and R2, are
        given
    lexicon : of its words
    metres : bool, for each case whether its shape is a table with units of length in its header; False: for none
    """

    values: dict = field(default_factory=dict)
    spreads: dict = field(default_factory=dict)
    dims: dict = field(default_factory=dict)
    labels: list = field(default_factory=list)
    names: dict = field(default_factory=dict)
    strengths: dict = field(default_factory=dict)
    cases_of: dict = field(default_factory=dict)
    assumed: tuple = ()
    same_piece: bool = False
    correlations: dict = field(default_factory=dict)
    parameters: dict = field(default_factory=dict)
    R: Any = 1.0
    unit: Any = 1.0
    scale: str = ""
    lexicon: Lexicon = PACKAGE
    metres: Any = False

    def sizes(self, axes: list[str]) -> dict[str, int]:
        """Dimension, named as during the solution -> its length; first `case`, then the axes in their order."""
        dim_of = {name: dim for dim, name in self.dims.items()}
        arrays = [v for v in (*self.values.values(), *self.parameters.values()) if xr.is_array(v)]
        sizes = {dim: size for array in arrays for dim, size in array.sizes.items()}
        order = ("case", *(dim_of.get(axis, axis) for axis in axes))
        return {dim: sizes[dim] for dim in order if dim in sizes}

    def radii(self) -> dict[str, Labelled]:
        """R1 and R2 of two bodies in R, with dimensions named as during the solution; {} for a single R."""
        return {name: bare_variable(self.values[name] / self.R) for name in ("R1", "R2") if name in self.values}

    def within(self, window: dict[str, slice]) -> Scene:
        """The scene of the cases in a window, a slice for each dimension, named as during the solution."""

        def cut(value: Any) -> Any:
            if not xr.is_array(value):
                return value
            return value.isel({dim: part for dim, part in window.items() if dim in value.dims})

        tables = ("values", "spreads", "cases_of", "parameters", "correlations")
        changed = {table: {name: cut(v) for name, v in getattr(self, table).items()} for table in tables}
        labels = self.labels[window["case"]] if self.labels else []
        names, strengths = (
            {body: (dim, entries[window[dim]] if dim else entries) for body, (dim, entries) in table.items()}
            for table in (self.names, self.strengths)
        )
        changed |= {"names": names, "strengths": strengths, "labels": labels}
        return replace(self, **changed, R=cut(self.R), unit=cut(self.unit), metres=cut(self.metres))


def over(value: Any, dims: tuple[str, ...]) -> np.ndarray:
    """A number, a text or the values of a DataArray or Variable, with all dimensions `dims`; of length 1 along those it
    lacks."""
    if not hasattr(value, "sizes"):
        return np.array(value).reshape((1,) * len(dims))
    sizes, ordered = value.sizes, value.transpose(*(dim for dim in dims if dim in value.dims))
    return ordered.values.reshape([sizes.get(dim, 1) for dim in dims])


def bare_variable(value: Any, attributes: dict | None = None) -> Labelled:
    """A number, or the values of a DataArray, without coordinates."""
    dims, data = (value.dims, value.data) if xr.is_array(value) else ((), value)
    return Labelled(dims, data, attributes)


def is_ratio(name: str) -> bool:
    """Whether an input is a Poisson ratio: derivatives are by it, not by its logarithm."""
    return name == "nu_punch" or of_solver(name)


def dim_of(name: str, lexicon: Lexicon) -> str:
    """The name of a parameter's own dimension during the solution.

    For a parameter with a unit it is "h in SI". The name alone belongs to the dimensionless h/R, which may change
    along the dimension of R too.
    """
    return name if lexicon.all_rows[name].unit == "1" else f"{name} in SI"


def si(name: str, value: Any, label: str = "", lexicon: Lexicon = PACKAGE) -> Quantity:
    """The SI value of a parameter or result: a text, a number, a quantity of pint or a Quantity.

    label : its name in messages
    lexicon : it must have the name

    Raises ValueError like `quantity`.
    """
    if type(value) is Quantity:
        return value
    if name in INFINITE and (value.lower() in INFINITE[name] if isinstance(value, str) else value == math.inf):
        return Quantity(math.inf)
    return quantity(label or name, value, lexicon.all_rows[name].unit)


def make_dimensionless(scene: Scene) -> None:
    """Add to a scene what follows from its SI values: effective radius, unit of moduli, parameters of the solver."""
    values = scene.values
    if "R1" in values:
        values["R"] = 1 / (1 / values["R1"] + 1 / values["R2"])
    if scene.scale:
        values["R"] = abs(values.get(scene.scale, _MICROMETRE))  # a thickness below 0 is refused in its own words
    scene.R, scene.unit, layer, body = values["R"], *moduli(values, scene.parameters)
    if "E1" in values:
        scene.parameters["n"] = layer / body
    for modulus, nu, ratio in moduli_of(values):
        scene.parameters[ratio] = _reduced(values, modulus, nu) / scene.unit
    if "E_punch" in values:
        values.setdefault("nu_punch", _POISSON)  # results say which it was
        base = scene.parameters.get("base", "layered")
        surface = _where(is_bare(base), body, layer)
        scene.parameters["m"] = surface / _reduced(values, "E_punch", "nu_punch")
    for name, value in values.items():
        if name not in SCENE:
            scene.parameters[name] = without_unit(value, scene.lexicon.rows[name].powers, scene.unit, scene.R)
    if np.any(scene.metres):
        scene.parameters["table_unit"] = _where(scene.metres, 1 / scene.R, 1.0)
    if laws_in_metres(scene.parameters.get("micro", ""), scene.lexicon):
        scene.parameters[LAW_UNIT] = 1 / scene.R


def moduli(values: dict, parameters: dict) -> tuple:
    """The unit of moduli, E1* and E2*, in Pa. Without E1 and n, on a half-space, E1* is E2*."""
    body = _reduced(values, "E2", "nu2")
    n = values["n"] if "n" in values else parameters.get("n", 1.0)
    layer = _reduced(values, "E1", "nu1") if "E1" in values else n * body
    return _where(np.isinf(body), layer, body), layer, body


def _where(condition: Any, yes: Any, no: Any) -> Any:
    """xr.where for arrays. For single numbers plain Python, as xr.where takes a millisecond."""
    return xr.where(condition, yes, no) if np.ndim(condition) else yes if condition else no


def _reduced(values: dict, name: str, nu: str) -> Any:
    return reduced(values[name], values.get(nu, _POISSON))


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

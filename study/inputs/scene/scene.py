"""A physical scene: its inputs in SI units, and what the solver gets."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...arrays import xarray_later as xr
from ...arrays.labelled import Labelled
from ..lexicon import PACKAGE, Lexicon


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
    strengths : likewise -> (dimension or "", (strength in Pa, its spread, whether it is from hardness) along it), NaN
        of materials of which none is known; only of bodies with some that is known
    cases_of : coordinate -> the cases that have it, a DataArray of bool; a case without a layer may lack it
    assumed : Poisson ratios and the interface, where they matter and have their defaults since nobody gave them
    same_piece : whether bodies of one material are one piece of it
    correlations : pair of inputs with spreads -> their correlation, a number or a DataArray; 0 of all other pairs
    scale : the input that is R, the unit of length, of shapes without a radius, or "1 um"; "": R, or R1 and R2, are
        given
    lexicon : what its words stand for
    metres : bool, where the shape is a table with units of length in its header; False: nowhere
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
        """Dimension while the cases are solved -> its length; first `case`, then the axes in their order."""
        dim_of = {name: dim for dim, name in self.dims.items()}
        arrays = [v for v in (*self.values.values(), *self.parameters.values()) if xr.is_array(v)]
        sizes = {dim: size for array in arrays for dim, size in array.sizes.items()}
        order = ("case", *(dim_of.get(axis, axis) for axis in axes))
        return {dim: sizes[dim] for dim in order if dim in sizes}

    def radii(self) -> dict[str, Labelled]:
        """R1 and R2 of two bodies in R, over the dimensions while the cases are solved; {} for a single R."""
        return {name: bare_variable(self.values[name] / self.R) for name in ("R1", "R2") if name in self.values}

    def within(self, window: dict[str, slice]) -> Scene:
        """The scene of the cases in a window, a slice for each dimension while the cases are solved."""

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

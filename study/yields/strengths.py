"""The strengths of a contact: those of the call, else those of its named materials."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from solver.laws.elastic_plastic import TABOR

from ..again import Again, of_all_cases
from ..specimen import materials
from ..specimen.materials import Material

INPUTS = {"layer": "Y1", "body": "Y2", "punch": "Y_punch"}
"""Body -> the input that is its yield strength."""


def strengths(contact: xr.Dataset, again: Again, own: Mapping[str, Material]) -> dict[str, np.ndarray]:
    """Yield strength of the layer, body, punch and asperities, (B,) each in the unit of E2; NaN where it is not known.

    That of asperities is of the softer of what meets there. A hardness is 2.84 yield strengths.

    own : materials of the call by name, which the table need not have
    """
    unit = of_all_cases(again.scene.unit, again.dims, again.shape).astype(float) if again.scene else 1.0
    named = {body: _of_materials(contact, again, body, own) / unit for body in INPUTS}
    given = again.problem.parameters
    found = {body: np.where(np.isnan(given[name]), named[body], given[name]) for body, name in INPUTS.items()}
    bare = again.problem.base == "half_space"
    softer = np.where(bare, named["body"], named["layer"])
    softer = np.where(again.problem.m > 0, np.minimum(softer, named["punch"]), softer)
    Y = np.where(np.isnan(given["yield_strength"]), given["hardness"] / TABOR, given["yield_strength"])
    return found | {"asperities": np.where(np.isnan(Y), softer, Y)}


def _of_materials(contact: xr.Dataset, again: Again, body: str, own: Mapping[str, Material]) -> np.ndarray:
    """In Pa, (B,)."""
    if body not in contact.coords or again.scene is None:
        return np.full(len(again.problem), np.nan)
    names = of_all_cases(_bare(contact[body]), again.dims, again.shape).astype(str)
    known = {name: _strength(name, own) for name in np.unique(names)}
    return np.array([known[name] for name in names])


def _bare(array: xr.DataArray) -> Any:
    return xr.DataArray(array.values.astype(str), dims=array.dims) if array.dims else array.item()


def _strength(name: str, own: Mapping[str, Material]) -> float:
    try:
        material = own.get(name) or materials.get(name)
    except LookupError:  # of a file of the user
        return np.nan
    return material.yield_strength or (material.hardness or np.nan) / TABOR

"""The dimensionless numbers of cases whose results are in SI units: what a results file was computed from."""

import numpy as np
import xarray as xr

from ..data.units import without_unit
from ..spec.definition import Definition
from ..spec.grid import MOVED, Grid
from ..spec.vocabulary import VOCABULARY
from .names import SCENE
from .scales import moduli

Values = dict[str, tuple[tuple[str, ...], np.ndarray]]
"""Name -> dimensions and numbers over them."""


def dimensionless(given: Values) -> tuple[Values, Values]:
    """Parameters of the solver from the coordinates of results in SI units, and R and the unit of moduli.

    They are computed as they were when the cases were solved, from the same SI numbers: the keys of the cases are the
    same.
    """
    arrays = {name: xr.DataArray(array, dims=dims) for name, (dims, array) in given.items()}
    unit, _, _ = moduli(arrays, arrays)
    found = {}
    for name, array in arrays.items():
        if name not in SCENE:
            powers = VOCABULARY[name].powers
            found[name] = array if powers == (0, 0) else without_unit(array, powers, unit, arrays["R"])
    return _plain(found), _plain({"R": arrays["R"], "unit": unit})


def units_of(definition: Definition) -> Grid | None:
    """R and the unit of moduli of a study with units, over the dimensions that it has while it is solved."""
    scene = definition.scene
    if not scene:
        return None
    units = {name: xr.DataArray(value) for name, value in (("R", scene.R), ("unit", scene.unit))}
    return in_results(definition, Grid(definition.grid.sizes, _plain(units)))


def in_results(definition: Definition, grid: Grid) -> Grid:
    """A grid of a study over the dimensions that its results have, of the cases whose inputs are as they were given."""

    def over(table: Values) -> Values:
        as_given = {
            name: (dims, array.take(0, dims.index(MOVED)) if MOVED in dims else array)
            for name, (dims, array) in table.items()
        }
        return {
            name: (tuple(definition.in_results(dict.fromkeys(dims))), array) for name, (dims, array) in as_given.items()
        }

    return Grid(definition.in_results(grid.sizes), over(grid.values), over(grid.labels))


def in_units(name: str, array: np.ndarray, units: dict[str, np.ndarray]) -> np.ndarray:
    """A result (n, ...) in SI units as a dimensionless one, to rounding; units : R and the unit of moduli (n,)."""
    powers = VOCABULARY[name].powers
    if powers == (0, 0):
        return array
    unit, R = (units[key].reshape(-1, *[1] * (array.ndim - 1)) for key in ("unit", "R"))
    return without_unit(array, powers, unit, R).astype(array.dtype)


def _plain(arrays: dict[str, xr.DataArray]) -> Values:
    return {name: (tuple(map(str, array.dims)), array.values) for name, array in arrays.items()}

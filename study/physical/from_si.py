"""From results in SI units back to the dimensionless numbers that were solved: so cases in a file are found again."""

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


def parameters_from_si(given: Values) -> tuple[Values, Values]:
    """The dimensionless parameters that follow from coordinates in SI units, and the scales: R and the unit of moduli.

    They follow from the same SI numbers by the same operations as when the cases were solved, so they are the same to
    the last bit, and so are the keys of the cases.
    """
    arrays = {name: xr.DataArray(array, dims=dims) for name, (dims, array) in given.items()}
    unit, _, _ = moduli(arrays, arrays)
    found = {}
    for name, array in arrays.items():
        if name not in SCENE:
            powers = VOCABULARY[name].powers
            found[name] = array if powers == (0, 0) else without_unit(array, powers, unit, arrays["R"])
    return _plain(found), _plain({"R": arrays["R"], "unit": unit})


def scales_of(definition: Definition) -> Grid | None:
    """R and the unit of moduli of a study over the dimensions of its results; None for a study without units."""
    scene = definition.scene
    if not scene:
        return None
    scales = {name: xr.DataArray(value) for name, value in (("R", scene.R), ("unit", scene.unit))}
    return grid_of_results(definition, Grid(definition.grid.sizes, _plain(scales)))


def grid_of_results(definition: Definition, grid: Grid) -> Grid:
    """A grid of a study over the dimensions of its results: MOVED is left out, and with it the moved inputs."""
    named = definition.in_results

    def over(table: Values) -> Values:
        as_given = {
            name: (dims, array.take(0, dims.index(MOVED)) if MOVED in dims else array)
            for name, (dims, array) in table.items()
        }
        return {name: (tuple(named(dict.fromkeys(dims))), array) for name, (dims, array) in as_given.items()}

    return Grid(named(grid.sizes), over(grid.values), over(grid.labels))


def result_from_si(name: str, array: np.ndarray, scales: dict[str, np.ndarray]) -> np.ndarray:
    """A result (n, ...) in SI units as a dimensionless one, to rounding; scales : R and the unit of moduli, (n,)."""
    powers = VOCABULARY[name].powers
    if powers == (0, 0):
        return array
    unit, R = (scales[key].reshape(-1, *[1] * (array.ndim - 1)) for key in ("unit", "R"))
    return without_unit(array, powers, unit, R).astype(array.dtype)


def _plain(arrays: dict[str, xr.DataArray]) -> Values:
    return {name: (tuple(map(str, array.dims)), array.values) for name, array in arrays.items()}

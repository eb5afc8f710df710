"""The effects of an input of a scene: on the numbers that the solver gets, and on the units of its results."""

from dataclasses import replace
from typing import Any

import numpy as np

from solver.laws.own_table import LAW_UNIT

from ..grid import Grid
from ..identity import acts
from ..punch.micro_laws import slopes_of_fit
from ..vocabulary import CONTROLS, SCENE
from .scene import Scene, is_ratio, make_dimensionless
from .stacks import moduli_of

SCALES = ("length", "modulus")
"""The radius and the modulus that are 1 for the solver; tables of changes have them besides the solver's inputs."""
#: Inputs are moved by this share of themselves, Poisson ratios by this number itself. The formulas that follow from
#: them are smooth, so that the slopes err by about its square. Poisson ratios stay at least twice this below 0.5.
_STEP = 1e-4


def changes(scene: Scene, name: str, fitted: bool = False) -> dict[str, Any]:
    """s -> d ln s/d ln input, a number or a DataArray, for inputs s of the solver and scales s.

    A Poisson ratio, on either side, has no logarithm.

    name : of the input of the scene

    fitted : whether B and beta follow from Nbar and Ra
    """
    value, ends, step = scene.values[name], [], _STEP
    if is_ratio(name):
        value = np.minimum(value, 0.5 - 2 * _STEP)
    elif name in ("R1", "R2"):  # R = 1/(1/R1 + 1/R2) of a close cup changes by a larger part
        step = _STEP * np.minimum(abs(value / scene.R), 1.0)
    for sign in (1, -1):
        new = value + sign * step * (1.0 if is_ratio(name) else value)
        moved = replace(scene, values=scene.values | {name: new}, parameters=dict(scene.parameters))
        make_dimensionless(moved)
        follow = "n", "m", "table_unit", LAW_UNIT, *(ratio for _, _, ratio in moduli_of(moved.values))
        numbers = {key: moved.parameters[key] for key in follow if key in moved.parameters}
        numbers |= {key: moved.parameters[key] for key in moved.values if key not in SCENE}
        ends.append(numbers | dict(zip(SCALES, (moved.R, moved.unit), strict=True)))
    slopes = {key: _slope(key, up, ends[1][key], step) for key, up in ends[0].items()}
    if fitted and ("Nbar" in slopes or "Ra" in slopes):
        product_slope = slopes.get("Nbar", 0.0) + 2 * slopes.get("Ra", 0.0)
        fits = slopes_of_fit(scene.parameters["Nbar"] * scene.parameters["Ra"] ** 2)
        slopes |= {key: product_slope * slope for key, slope in fits.items()}
    return slopes


def _slope(key: str, up: Any, down: Any, step: Any) -> Any:
    # most are equal, and arithmetic of DataArrays is slow
    if np.array_equal(np.asarray(up), np.asarray(down), equal_nan=True):
        return 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = (up - down if is_ratio(key) else np.log(np.divide(up, down))) / (2 * step)
    # NaN: of 0, or of a rigid body
    return slope.fillna(0.0) if hasattr(slope, "fillna") else np.nan_to_num(slope)


def changes_by_spread(scene: Scene, fitted: bool) -> dict[str, dict[str, Any]]:
    """Input with a spread -> {input of the solver, or scale: its change, as in `changes`, with one spread}."""
    table = {}
    for name, spread in scene.spreads.items():
        value = scene.values[name]
        relative = spread if is_ratio(name) else spread / (value + (value == 0))  # what is 0 has no spread
        table[name] = {key: relative * slope for key, slope in changes(scene, name, fitted).items() if np.any(slope)}
    return table


def inputs_of(scene: Scene, grid: Grid) -> tuple[str, ...]:
    """The inputs of the solver that change with some spread, and act in some case; the control if none do."""
    tables = changes_by_spread(scene, grid.fitted).values()
    moved = {key for table in tables for key, change in table.items() if np.any(change)}
    inputs = tuple(name for name in grid.lexicon.parameters_of(moved) if name in moved and acts(grid, name).any())
    return inputs or tuple(name for name in CONTROLS if name in grid.values)

"""Sensitivities of results: d ln result/d ln input, over the dimensions of the results and `input`."""

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from solver import Problem, sensitivities, solve
from solver.parameters import PARAMETERS, uses
from solver.sensitivity import is_ratio

from .inputs.definition import Definition
from .inputs.grid import MOVED, columns
from .inputs.scene.scales import make_dimensionless
from .inputs.vocabulary import SCENE, VOCABULARY

#: Results that have sensitivities.
QUANTITIES = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD")
#: By which part of itself an input in SI units is moved, and a Poisson ratio by how much, to see what the solver's
#: inputs make of it: closed forms, so that the error is the square of this. Poisson ratios stay this far below 0.5.
_STEP = 1e-4
#: The logarithms of the scales stand beside the solver's inputs: the radius and the modulus that are 1 for the solver.
_SCALES = ("length", "modulus")
_RATIOS = ("nu1", "nu2", "nu_punch")
_COMMENT = "d ln result/d ln input; by nu1, nu2 and nu_punch d ln result/d ratio"


def with_sensitivities(definition: Definition, found: xr.Dataset) -> xr.Dataset:
    """The dataset `found` of a study with NAME_sensitivity of its results. The cases are solved once more."""
    grid, axes = definition.grid, list(definition.grid.sizes)
    index = np.arange(grid.size).reshape(grid.shape)
    index = index.take(0, axes.index(MOVED)) if MOVED in axes else index
    given = columns(grid, index.ravel())
    problem = Problem.of(**given)
    used = [name for name in PARAMETERS if name in given and _counts(problem, name)]
    solved = sensitivities(problem, solve(problem), inputs=(problem.control, *used))
    logs = {name: dict(zip(solved.inputs, values.T, strict=True)) for name, values in solved.logs.items()}
    dims = definition.in_results(grid.sizes)
    if definition.scene:
        over = [dim for dim in axes if dim != MOVED]
        inputs = _in_si(definition.scene, over, index.shape)
        logs = {name: _by_si(logs[name], inputs, VOCABULARY[name].powers) for name in QUANTITIES}
    # of the control they are known, to the last bit
    control = problem.control
    logs[control] = {name: 0 * values + (name == control) for name, values in logs["a"].items()}
    variables = {}
    for name in QUANTITIES:
        values = np.stack(list(logs[name].values()), axis=-1).reshape(*index.shape, -1)
        about = {"long_name": f"sensitivity of {name}", "comment": _COMMENT}
        variables[f"{name}_sensitivity"] = xr.Variable((*dims, "input"), values, about)
    return found.assign(variables).assign_coords(input=list(logs["a"]))


def _counts(problem: Problem, name: str) -> bool:
    """Whether an input is a number on which the answer of some case depends, and no setting."""
    own = PARAMETERS[name]
    setting = VOCABULARY[name].role == "numerics" if name in VOCABULARY else False
    counts = own.interval and not own.whole and not setting
    return bool(counts and np.any(uses(name, lambda key: getattr(problem, key))))


def _in_si(scene: Any, dims: list[str], shape: tuple[int, ...]) -> dict[str, dict[str, np.ndarray]]:
    """Input -> what changes with its logarithm, or with a Poisson ratio itself: the logarithms of the solver's inputs
    and of the scales, (B,) each, and Poisson ratios themselves."""
    given = {name: _as_given(value) for name, value in scene.given.items()}
    default = VOCABULARY["nu1"].own.default
    given |= {nu: default for E, nu in (("E1", "nu1"), ("E2", "nu2")) if E in given and nu not in given}
    scene = replace(scene, given=given)
    names = [name for name in given if np.all(np.isfinite(given[name])) and not (name == "R" and "R1" in given)]
    own = [name for name in PARAMETERS if name in scene.parameters and name not in given and name not in ("n", "m")]
    own += ["n"] * ("E1" not in given) + ["m"] * ("E_punch" not in given)
    ones = np.ones(int(np.prod(shape)))
    return {name: _changes(scene, name, dims, shape) for name in names} | {name: {name: ones} for name in own}


def _as_given(value: Any) -> Any:
    return value.isel({MOVED: 0}) if MOVED in getattr(value, "dims", ()) else value


def _changes(scene: Any, name: str, dims: list[str], shape: tuple[int, ...]) -> dict[str, np.ndarray]:
    value, ends = scene.given[name], []
    value = np.minimum(value, 0.5 - 2 * _STEP) if name in _RATIOS else value
    for sign in (1, -1):
        new = value + sign * _STEP * (1.0 if name in _RATIOS else value)
        moved = replace(scene, given=scene.given | {name: new}, parameters=dict(scene.parameters))
        make_dimensionless(moved)
        numbers = {key: moved.parameters[key] for key in ("n", "m") if key in moved.parameters}
        numbers |= {key: moved.parameters[key] for key in moved.given if key not in SCENE}
        ends.append(numbers | dict(zip(_SCALES, (moved.R, moved.unit), strict=True)))
    found = {}
    with np.errstate(divide="ignore", invalid="ignore"):
        for key, up in ends[0].items():
            up, down = (_flat(end, dims, shape) for end in (up, ends[1][key]))
            change = (up - down if is_ratio(key) else np.log(up / down)) / (2 * _STEP)
            found[key] = np.nan_to_num(change)  # NaN: of 0, or of a rigid body
    return found


def _flat(value: Any, dims: list[str], shape: tuple[int, ...]) -> np.ndarray:
    """A number or a DataArray for all cases, (B,)."""
    if not isinstance(value, xr.DataArray):
        return np.full(int(np.prod(shape)), float(value))
    sizes, ordered = value.sizes, value.transpose(*(dim for dim in dims if dim in value.dims))
    return np.broadcast_to(ordered.values.reshape([sizes.get(dim, 1) for dim in dims]), shape).ravel()


def _by_si(logs: dict, inputs: dict, powers: tuple[int, int]) -> dict[str, np.ndarray]:
    """The derivatives by inputs in SI units, from those by the solver's inputs, of a result in E2*^i R^j."""
    scales = dict(zip(_SCALES, powers[::-1], strict=True))
    still = 0 * next(iter(logs.values()))

    def by(changes: dict) -> np.ndarray:
        parts = [logs[key] * change for key, change in changes.items() if key in logs]
        return sum(parts, still) + sum(scales[key] * changes.get(key, 0.0) for key in _SCALES)

    return {name: by(changes) for name, changes in inputs.items() if any(key in logs for key in changes)}

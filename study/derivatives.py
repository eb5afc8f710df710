"""Sensitivities of results: d ln result/d ln input, over the dimensions of the results and `input`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from solver import Problem, solve
from solver import sensitivities as derivatives
from solver.laws.own_table import LAW_UNIT
from solver.layers import numbers_of

from .arrays import xarray_later as xr
from .data.contacts import Contacts, of_all_cases
from .inputs.definition import StudyError
from .inputs.lexicon import lexicon_of
from .inputs.scene.changes import SCALES, changes
from .inputs.scene.scene import Scene, is_ratio
from .inputs.scene.stacks import moduli_of
from .inputs.vocabulary import VOCABULARY, bodies_of

#: Results that have sensitivities.
QUANTITIES = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD")
#: Inputs are moved by this share of their spread. The change of a formula is then linear to 1e-6.
_STEP = 1e-3
_COMMENT = "d ln result/d ln input; by nu1, nu2 and nu_punch d ln result/d ratio"


def sensitivities(contact: xr.Dataset) -> xr.Dataset:
    """Derivatives of results by their inputs: d ln result/d ln input; by a Poisson ratio d ln result/d ratio.

    The cases are solved again from the inputs in the dataset. Each derivative holds all other inputs fixed: the given
    one of P, a and D, fitted values of B and beta, and the model that `base = "auto"` took.

    Parameters
    ----------
    contact : results of `study.solve` or of a results file, in SI units or dimensionless, or a part of them

    Returns
    -------
    xarray.Dataset : `a_sensitivity`, and likewise for P, D, p0, p_max, Ar_An and dP_dD, over the dimensions of the
        contact and `input`, the names of its inputs that are numbers. NaN for cases that have not converged; 0 if an
        input does not act or is 0

    Raises
    ------
    StudyError : the dataset is no result of `study.solve`, has lost an input or SI units, or has an unknown law

    Examples
    --------
    >>> import study
    >>> contact = study.solve(P=[1e-5, 2e-5], micro="smooth", base="half_space")
    >>> study.sensitivities(contact).a_sensitivity.sel(P=2e-5, input="P").round(6).item()
    0.333333
    """
    logs, _ = _by_inputs(Contacts.of(contact, "sensitivities"), ())
    dims, shape = contact["status"].dims, contact["status"].shape
    variables = {}
    for name in QUANTITIES:
        values = np.stack(list(logs[name].values()), axis=-1)
        about = {"long_name": f"sensitivity of {name}", "comment": _COMMENT}
        variables[f"{name}_sensitivity"] = xr.Variable((*dims, "input"), values.reshape(*shape, -1), about)
    results = {*contact.data_vars}
    left_out = [name for name, array in contact.variables.items() if name in results or {*array.dims} - {*dims}]
    return contact.drop_vars(left_out).assign(variables).assign_coords(input=list(logs["a"]))


def sensitivities_of_case(contact: Contacts, name: str) -> dict[str, float]:
    """Input -> `NAME_sensitivity` of :func:`sensitivities` of one contact, for which no dataset is made: xarray is not
    imported."""
    logs, _ = _by_inputs(contact, ())
    return {by: values.item() for by, values in logs[name].items()}


def _by_inputs(contacts: Contacts, x: Any) -> tuple[dict, dict]:
    """Two tables: result, also A0 -> input -> sensitivity (B,); and input -> d p/d ln input (B, m) at the radii x, in
    the unit of p. NaN for cases that have not converged.
    """
    dataset, problem, numbers, scene, dims, shape = contacts
    used = [name for name in problem.known.table(numbers_of(numbers)) if name in numbers and _counts(problem, name)]
    solution = solve(problem, x)
    solved = derivatives(problem, solution, x, inputs=(problem.control, *used))
    logs = {name: dict(zip(solved.inputs, values.T, strict=True)) for name, values in solved.logs.items()}
    p = dict(zip(solved.inputs, np.moveaxis(solved.p, 1, 0), strict=True))
    if scene:
        of_si = _in_si(scene, dims, shape)
        logs = {name: _by_si(by_input, of_si, VOCABULARY[name].powers) for name, by_input in logs.items()}
        p = _by_si(p, of_si, VOCABULARY["p"].powers, solution.p)
        p = {name: values * of_all_cases(scene.unit, dims, shape)[:, None] for name, values in p.items()}
    # sensitivities of the control are exact; a load or depth of 0 has no logarithm
    control, good = problem.control, (solution.status == 0) & (dataset["status"].values.ravel() == 0)
    sized = np.where(problem.value == 0, np.nan, 0.0)
    logs[control] = {name: 0 * values + (name == control) + sized for name, values in logs["a"].items()}
    for by_input in logs.values():
        by_input.update({name: np.where(good, values, np.nan) for name, values in by_input.items()})
    return logs, p


def spread_of_formula(case: xr.Dataset, formula: Callable[[xr.Dataset], Any]) -> float:
    """The standard deviation of a formula of one contact whose inputs have independent spreads.

    The formula is evaluated for contacts whose results, profile p and inputs are moved along their derivatives. NaN if
    spreads are correlated, or if the case cannot be solved again.
    """
    if correlated(case):
        return np.nan
    try:
        contact = Contacts.of(case, "sensitivities")
    except StudyError:
        return np.nan
    logs, p = _by_inputs(contact, case["x"].values)
    changes_of, sum_of_squares = _in_si(contact.scene, (), ()), 0.0
    for name, part in relative_spreads(case, logs["a"]).items():
        by = {key: slopes[name] * case[key].values for key, slopes in logs.items() if key in case} | {"p": p[name][0]}
        for key, coordinate in {"length": "R", "n": "n", "m": "m"}.items():
            if coordinate in case:
                by[coordinate] = changes_of[name].get(key, 0.0) * case[coordinate].values
        by[name] = 1.0 if is_ratio(name) else case[name].values
        ends = []
        for step in (_STEP * part, -_STEP * part):
            moved = {
                key: case[key].copy(data=np.reshape(case[key].values + step * slope, case[key].shape))
                for key, slope in by.items()
            }
            ends.append(float(formula(case.assign(moved))))
        sum_of_squares += ((ends[0] - ends[1]) / (2 * _STEP)) ** 2
    return float(np.sqrt(sum_of_squares))


def relative_spreads(case: xr.Dataset, names: Iterable[str]) -> dict[str, float]:
    """Input of one contact that has a spread -> spread over value, but for a Poisson ratio the spread itself."""
    spreads = {name: float(case[f"{name}_spread"]) for name in names if f"{name}_spread" in case.coords}
    return {name: spread if is_ratio(name) else spread / float(case[name]) for name, spread in spreads.items()}


def correlated(contact: xr.Dataset) -> bool:
    """Whether the spreads of some inputs are correlated. Then no input has a share of its own."""
    bodies = [contact[body] for body in bodies_of(contact.coords) if body in contact.coords]
    return "correlations" in contact.attrs or any("comment" in body.attrs for body in bodies)


def _counts(problem: Problem, name: str) -> bool:
    """Whether an input is a number, not a setting, and some case depends on it."""
    parameter, rows = problem.known.parameters[name], lexicon_of(problem.known).rows
    setting = rows[name].role == "numerics" if name in rows else False
    counts = parameter.interval and not parameter.whole and not setting
    return bool(counts and np.any(problem.known.uses(name, lambda key: getattr(problem, key))))


def _in_si(scene: Scene, dims: tuple, shape: tuple[int, ...]) -> dict[str, dict[str, np.ndarray]]:
    """Input -> {s: d ln s/d ln input, (B,)} of inputs s of the solver and scales s. Poisson ratios have no
    logarithm."""
    values = scene.values
    unit = {"R"} if "R1" in values or scene.scale else set()
    names = [name for name in values if np.any(np.isfinite(values[name])) and name not in unit]
    dependent = {"n", "m", "table_unit", LAW_UNIT, *(ratio for _, _, ratio in moduli_of(values))}
    names_of_solver = [name for name in scene.lexicon.parameters_of(scene.parameters) if name in scene.parameters]
    pure_numbers = [name for name in names_of_solver if name not in {*values, *dependent}]
    pure_numbers += ["n"] * ("E1" not in values) + ["m"] * ("E_punch" not in values)
    ones = np.ones(int(np.prod(shape)))
    flat = {}
    for name in names:
        flat[name] = {key: of_all_cases(change, dims, shape) for key, change in changes(scene, name).items()}
    return flat | {name: {name: ones} for name in pure_numbers}


def _by_si(logs: dict, inputs: dict, powers: tuple[int, int], value: Any = 1.0) -> dict[str, np.ndarray]:
    """The derivatives of a result by inputs in SI units, from those by the solver's inputs.

    powers : i and j of the result's unit E2*^i R^j
    value : of the result, if the derivatives are not those of its logarithm
    """
    scales = dict(zip(SCALES, powers[::-1], strict=True))
    still = 0 * next(iter(logs.values()))

    def by(changes: dict) -> np.ndarray:
        changes = {key: change.reshape(-1, *[1] * (still.ndim - 1)) for key, change in changes.items()}
        parts = [logs[key] * change for key, change in changes.items() if key in logs]
        with np.errstate(invalid="ignore"):  # p may be infinite at an edge: its change is NaN
            return sum(parts, still) + sum(scales[key] * changes.get(key, 0.0) for key in SCALES) * value

    return {name: by(changes) for name, changes in inputs.items() if any(key in logs for key in changes)}

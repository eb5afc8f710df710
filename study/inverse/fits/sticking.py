"""The curve P(D) of a contact that sticks: from the largest depth along stable contacts to pull-off, and 0 beyond it.

Load and depth pass through 0, so that there are no logarithms of them to tabulate (`tables`). Both are smooth functions
of the contact radius: they are solved at a ladder of radii, and a spline through these is read at the depths.
"""

from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from solver import Problem, solve
from solver.body import BODIES
from solver.smooth_contact.adhesion.jkr import Jkr
from solver.smooth_contact.contact import shape_in

from ...inputs.scene.scales import with_unit
from ...inputs.vocabulary import PARAMETERS, VOCABULARY
from .model import Model

#: Radii of the ladder, by equal steps of the logarithm from the largest radius down to this part of it: the largest
#: error of P in tests/inverse/fits/test_sticking.py is 1e-6 of the largest load, with half as many radii 2e-5.
_RADII, _LEAST = 80, 1 / 60
#: Points between two radii at which the spline is searched for a depth, and steps of Newton's method from there.
_BETWEEN, _NEWTON = 20, 3
#: By which part of themselves unknowns are moved for derivatives (Poisson ratios by this itself).
_STEP = 1e-4


class Direct(NamedTuple):
    """In place of a :class:`.tables.Table`, for a model that has w_adhesion."""

    model: Model

    def contact(self, values: dict[str, Any], depth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """P (B, n) in N at depths (B, n) in m, and dP/dD; 0 beyond pull-off. NaN of curves without a solution."""
        P, slope = np.zeros(depth.shape), np.zeros(depth.shape)
        rows = [np.broadcast_to(value, (len(depth), 1))[:, 0] for value in values.values()]
        both = np.column_stack([*rows, depth])
        _, first, same = np.unique(both, axis=0, return_index=True, return_inverse=True)
        for number, row in enumerate(first):
            one = {name: float(column[row]) for name, column in zip(values, rows, strict=True)}
            here = same.ravel() == number
            P[here], slope[here] = self._curve(one, depth[row])
        return P, slope

    def _curve(self, values: dict[str, float], depth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """P and dP/dD (n,) of one curve."""
        deepest = float(depth.max(initial=0.0))
        largest = self._solved(values, "D", np.array([max(deepest, 0.0)]))[0]
        ln_a = np.log(largest) + np.linspace(np.log(_LEAST), np.log(1.02), _RADII)
        a, P, D = self._solved(values, "a", np.exp(ln_a))
        k = float(values.get("k_machine", self.model.scene.values.get("k_machine", np.inf)))
        good = np.isfinite(P) & np.isfinite(D)
        if good.sum() < _RADII // 2:
            return np.full((2, len(depth)), np.nan)
        load, depths = CubicSpline(ln_a[good], P[good]), CubicSpline(ln_a[good], D[good])
        fine = np.linspace(ln_a[good][0], ln_a[good][-1], _BETWEEN * _RADII)
        control = depths(fine) + (load(fine) / k if np.isfinite(k) and k > 0 else 0.0)
        control = load(fine) if k == 0 else control
        turns = np.flatnonzero(np.diff(control) <= 0)
        fine = fine[turns[-1] + 1 if len(turns) else 0 :]
        place = np.interp(depth, depths(fine), fine, left=np.nan)
        with np.errstate(all="ignore"):
            for _ in range(_NEWTON):
                place = place - np.clip((depths(place) - depth) / depths(place, 1), -0.02, 0.02)
            slope = load(place, 1) / depths(place, 1)
        there = np.isfinite(place)
        return np.where(there, load(np.where(there, place, fine[0])), 0.0), np.where(there, slope, 0.0)

    def _solved(self, values: dict[str, float], control: str, numbers: np.ndarray) -> tuple[np.ndarray, ...]:
        """a, P, D (n,) in SI of contacts whose a or D (n,) are given in m."""
        changed = self.model.scene_of(values)
        unit, R = changed.unit, changed.R
        names = {name: value for name, value in changed.parameters.items() if name in PARAMETERS}
        names = {name: value for name, value in names.items() if name not in ("P", "a", "D", "k_machine", "branch")}
        problem = Problem.of(**{control: numbers / R}, **names)
        answers = _forward(problem) if control == "a" and _is_forward(problem) else _in_full(problem)
        powers = [VOCABULARY[name].powers for name in ("a", "P", "D")]
        return tuple(with_unit(answer, power, unit, R) for answer, power in zip(answers, powers, strict=True))


def _is_forward(problem: Problem) -> bool:
    """Whether the equation at one radius is all that is needed: of JKR, whose pull-off is found here."""
    exact = np.isin(problem.base, ("layered", "stack")) | (problem.base == "half_space") & (problem.m == 0)
    sticks = (problem.adhesion == "jkr") & (problem.w_adhesion > 0) & (problem.shape != "flat")
    return bool((exact & sticks).all())


def _forward(problem: Problem) -> list[np.ndarray]:
    """a, P, D of contacts whose radius is given, in units R = E2* = 1, without a search for their pull-off."""
    body = BODIES[str(problem.base[0])](problem)
    with np.errstate(all="ignore"):
        state = Jkr(shape_in(problem), body, problem.w_adhesion).at(problem.value)
    return [state.a, state.P, state.D]


def _in_full(problem: Problem) -> list[np.ndarray]:
    """a, P, D of contacts, NaN where there is no solution."""
    solution = solve(problem, np.array([0.0]))
    return [np.where(solution.status == 0, getattr(solution, name), np.nan) for name in ("a", "P", "D")]


def moved_by(value: Any, is_ratio: bool) -> tuple[Any, float]:
    """A value moved by a step, and the change of its coordinate: the logarithm, of a Poisson ratio itself."""
    return (value - _STEP, -_STEP) if is_ratio else (value * np.exp(_STEP), _STEP)

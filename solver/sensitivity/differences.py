"""Derivatives by moved inputs: each case is solved again with each input a little larger and a little smaller.

:func:`at_their_radii` is for smooth contacts, with and without adhesion, that :mod:`.step` does not cover. At a given
radius they follow from one linear system, to 1e-12, without a search for the radius and for pull-off.

:func:`by_differences` takes solutions under the control, which have larger errors. It is for all other cases: flat
punches, whose radius is given; contacts whose edge stays at a corner of the punch; and cases whose equation
:mod:`.same_mesh` does not reproduce, such as those whose panels would be chosen differently.
"""

import numpy as np

from ..shapes import is_flat
from ..solve import solve, solve_at_radii
from ..ways import by_equation
from .inputs import moved_cases, slope_of

#: The step of an input, and the rtol of the moved cases. The error is about the sum of _RTOL/_STEP and _STEP². With
#: `fine` the inputs are also moved by twice the step, which leaves _STEP⁴: the results of a cone, for example, change
#: ten times as fast as its angle.
_STEP, _RTOL = 1e-3, 1e-9
#: Numbers that pass through 0 under adhesion, and the powers of E2* and R in their units. Near 0 a step may change the
#: sign, and the logarithm is meaningless.
SIGNED = {"P": (1, 2), "D": (0, 1), "p0": (1, 0), "p_max": (1, 0)}
#: A contact is not determined by its radius, or the curve of its loads or depths has a corner there, if the mean of two
#: with slightly different radii, extrapolated to the radius, differs from it by more than this, over the number and its
#: derivative by ln a.
_OFF = 1e-6


def of_radii(problem):
    """The cases of :func:`at_their_radii`: a list of indices (b,), those without adhesion and those with it."""
    some = by_equation(problem, "basis")
    if not some.any():
        return []
    some &= ~is_flat(problem)
    rows = (some & (problem.w_adhesion > 0), some & ~(problem.w_adhesion > 0))
    return [np.flatnonzero(where) for where in rows if where.any()]


def at_their_radii(problem, solution, inputs, quantities, x):
    """(B,) bool, whether the derivatives are valid; and the three answers of :func:`by_differences`. The cases are
    smooth, and all or none of them have adhesion. `solution` has their radii, loads and depths; it and the problem are
    in units R = E2* = 1."""
    control, others = problem.control, [name for name in inputs if name != problem.control]
    at_radius = type(problem)("a", solution.a, problem.parameters, problem.known)
    solver = solve_at_radii if (problem.w_adhesion > 0).all() else solve
    near, wide = (_at_radii(solver, at_radius, (*others, "a"), quantities, x, step) for step in (_STEP, 2 * _STEP))
    raw, logs, profiles, means = (_extrapolated(*pair) for pair in zip(near, wide, strict=True))
    good, order = np.ones(len(problem), dtype=bool), [others.index(name) if name in others else -1 for name in inputs]
    for name in ("P", "D"):
        value = getattr(solution, name)
        good &= np.abs(means[name] - value) <= _OFF * (np.abs(value) + np.abs(raw[name][-1]))
    logs[control] = raw[control] / getattr(solution, control)

    def under_control(slopes):
        """By d ln a/dθ = -C_θ/C_a at fixed control C, as in :mod:`.answers`, where C is not a logarithm."""
        shape = len(problem), *[1] * (slopes.ndim - 2)
        along = slopes[-1] / raw[control][-1].reshape(shape)
        by_others = slopes[:-1] - raw[control][:-1].reshape(-1, *shape) * along
        return np.concatenate([by_others, (along * getattr(solution, control).reshape(shape))[None]])[order]

    logs, signed = ({name: under_control(values) for name, values in table.items()} for table in (logs, raw))
    for name in ("a", "D", "dP_dD"):
        good &= np.isfinite(logs[name]).all(axis=0)
    return good, logs, np.stack([under_control(values) for values in profiles]), signed


def _at_radii(solver, problem, inputs, quantities, x, step):
    """Slopes of numbers, of their logarithms, and of profiles, as in :func:`_by_step`, for cases with given radii, the
    last of the inputs; and the means of the numbers by which cases are judged, (B,)."""
    answer, k = solver(moved_cases(problem, inputs, step), x), len(inputs)
    numbers = {name: getattr(answer, name) for name in {*quantities, *SIGNED}}
    raw = {name: slope_of(_finite(numbers[name]), k, step) for name in {*SIGNED, "a"}}
    logs = {name: slope_of(np.log(np.abs(numbers[name])), k, step) for name in quantities}
    profiles = np.stack([slope_of(_finite(values), k, step) for values in (answer.p, answer.lam)])
    means = {name: numbers[name].reshape(k, 2, -1)[-1].mean(axis=0) for name in ("P", "D")}
    return raw, logs, profiles, means


def _extrapolated(near, wide):
    """Numbers, or a dict of them, from those of two steps, the second twice as large: the error is of fourth order."""
    if isinstance(near, dict):
        return {name: (4 * values - wide[name]) / 3 for name, values in near.items()}
    return (4 * near - wide) / 3


def by_differences(problem, inputs, quantities, x, fine=False):
    """Quantity -> (k, B), derivatives of ln |quantity|; derivatives of p and λ at the radii x, (2, k, B, m); and
    quantity -> (k, B), derivatives of the :data:`SIGNED` numbers themselves. They are NaN where a moved case has no
    numbers, or infinite ones. `problem` is in units R = E2* = 1."""
    near = _by_step(problem, inputs, quantities, x, _STEP)
    if not fine:
        return near
    wide = _by_step(problem, inputs, quantities, x, 2 * _STEP)
    return tuple(_extrapolated(*pair) for pair in zip(near, wide, strict=True))


def _by_step(problem, inputs, quantities, x, step):
    cases = moved_cases(problem, inputs, step)
    solution = solve(cases.but(rtol=np.minimum(cases.rtol, _RTOL)), x)
    k = len(inputs)
    logs = {name: slope_of(np.log(np.abs(getattr(solution, name))), k, step) for name in quantities}
    slopes = {name: slope_of(_finite(getattr(solution, name)), k, step) for name in SIGNED}
    return logs, np.stack([slope_of(_finite(values), k, step) for values in (solution.p, solution.lam)]), slopes


def _finite(values):
    return np.where(np.isfinite(values), values, np.nan)

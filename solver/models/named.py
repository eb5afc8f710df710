"""Cases whose base is named, each solved by the cheapest way for it."""

from dataclasses import replace

import numpy as np

from .. import ways
from ..bases import is_thin_layer, on_springs
from ..numerics.batch import alike
from ..scaling import dimensionless, restore, with_a_stiff_base, with_rigid_punch, without_springs
from ..solution import Model, Solution
from ..status import Status
from .law_error import edge_error, outside_law
from .thin_layer_error import largest_error

_BY_NAME = {
    "half_space": Model.HALF_SPACE,
    "thin_layer": Model.THIN_LAYER,
    "layered": Model.LAYERED,
    "stack": Model.STACK,
    "thin_stack": Model.THIN_STACK,
}


def model_of(problem):
    """:class:`Model` (B,) int8 of cases whose base is named; NONE for "auto"."""
    used, rough = np.zeros(len(problem), dtype=np.int8), problem.rough()
    for index in alike(problem.base):
        model = _BY_NAME.get(str(problem.base[index[0]]))
        if model is not None:
            used[index] = np.where(rough[index], model, model + 1)
    return used


def solve_named(problem, x):
    """:class:`Solution` of cases whose base is named, in the units of the problem. Thin layers have the `model_error`
    of `model_check` "closed_form".

    problem : its parameters need not be within their bounds, but no smooth case has the scheme "picard"; x : (m,) radii
    """
    rigid = with_a_stiff_base(with_rigid_punch(problem))
    scaled, size = dimensionless(rigid), (len(problem), len(x))
    no_springs = without_springs(scaled)
    status = np.where(no_springs, Status.THIN_LAYER_NOT_APPLICABLE, 0)
    solution = Solution.join(*size, ways.solved(scaled, ~no_springs, x), status=status)
    missed = (solution.status == Status.CONVERGED) & ~(solution.error <= problem.rtol)
    solution.status[missed] = Status.TOLERANCE_NOT_MET
    return with_model_error(problem, _with_model(problem, restore(solution, rigid)))


def with_model_error(problem, solution):
    """The solution with a `model_error` of at least :func:`~.law_error.edge_error`. Cases whose pressures are outside
    the range of their law lose their numbers. `solution` and the result are in the units of the problem."""
    error = np.maximum(solution.model_error, edge_error(problem, solution))
    return replace(solution, model_error=error).refused(outside_law(problem, solution), Status.OUTSIDE_LAW)


def error_of_law(problem):
    """(B,): the relative error of the tables of the micro laws themselves; 0 for asperities that feel the body."""
    tabulated = sum(law.error * (problem.micro == name) for name, law in problem.known.laws.items())
    return np.where(problem.feels_layer(), 0.0, tabulated)


def closed_form(problem, a):
    """Estimated relative error (B,) of the thin-layer model, as if asperities were rigid, by
    :func:`~solver.models.thin_layer_error.largest_error`; NaN where the thin-layer equation does not apply.

    `a` (B,) are its contact radii, in the unit of `problem.h`. The estimate is for a rigid punch. Under an elastic
    punch its value at given a, the largest of the three, counts for each control.
    """

    def error(part, radius, control):
        return largest_error(
            control, part.h / radius, part.n, part.nu1, part.nu2, part.bonding == "bonded", part.rough()
        )

    errors, elastic = error(problem, a, problem.control), np.flatnonzero(problem.m > 0)
    if len(elastic):
        errors[elastic] = error(problem.take(elastic), a[elastic], "a")
    return errors


def _with_model(problem, solution):
    """The solution with its `model_used`, and with its `model_error` without the part of the range of the law."""
    solved = np.isfinite(solution.P) & np.isfinite(solution.D)
    error = np.where(solved & ~on_springs(problem.base), 0.0, np.nan)
    thin = np.flatnonzero(solved & is_thin_layer(problem.base))
    if len(thin):
        part = problem if len(thin) == len(problem) else problem.take(thin)
        error[thin] = closed_form(part, solution.a[thin])
    return replace(solution, model_used=model_of(problem), model_error=error + error_of_law(problem))

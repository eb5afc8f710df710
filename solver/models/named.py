"""Cases whose base has a name, each by the cheapest way that solves it."""

from dataclasses import replace
from itertools import product

import numpy as np

from ..contact import smooth
from ..scaling import (
    as_cases,
    dimensionless,
    kinds_of_laws,
    restore,
    with_a_stiff_base,
    with_rigid_punch,
    without_springs,
)
from ..schemes import SCHEMES
from ..shapes import shaped
from ..smooth_contact.contact import kinds_of
from ..solution import Model, Solution
from ..status import Status
from .range_of_law import edge_error, outside_law
from .thin_layer_error import largest_error

_BY_NAME = {
    "half_space": Model.HALF_SPACE,
    "thin_layer": Model.THIN_LAYER,
    "layered": Model.LAYERED,
    "stack": Model.STACK,
    "thin_stack": Model.THIN_STACK,
}


def model_of(problem):
    """:class:`Model` (B,) int8 of cases whose base is named; NONE of "auto"."""
    used, rough = np.zeros(len(problem), dtype=np.int8), problem.rough()
    for base, model in _BY_NAME.items():
        of_base = problem.base == base
        used[of_base] = np.where(rough[of_base], model, model + 1)
    return used


def solve_named(problem, x):
    """:class:`Solution` of cases whose base has a name, in the units of the problem. The `model_error` of thin layers
    is that of `model_check` "closed_form".

    problem : its parameters need not be within their bounds, but no smooth case has the scheme "picard"; x : (m,) radii
    """
    rigid = with_a_stiff_base(with_rigid_punch(problem))
    scaled, size = dimensionless(rigid), (len(problem), len(x))
    no_springs = without_springs(scaled)
    status = np.where(no_springs, Status.THIN_LAYER_NOT_APPLICABLE, 0)
    pieces = []
    for mask, way in _ways(scaled, ~no_springs):
        if mask.any():
            index = np.flatnonzero(mask)
            part = scaled if len(index) == len(scaled) else scaled.take(index)
            pieces.append((index, way(part, x)))
    solution = Solution.join(*size, pieces, status=status)
    missed = (solution.status == Status.CONVERGED) & ~(solution.error <= problem.rtol)
    solution.status[missed] = Status.TOLERANCE_NOT_MET
    return with_model_error(problem, _with_model(problem, restore(solution, rigid)))


def with_model_error(problem, solution):
    """The solution with a `model_error` of at least :func:`~.range_of_law.edge_error`. Cases at pressures that their
    law does not know lose their numbers. `solution` and result are in the units of the problem."""
    error = np.maximum(solution.model_error, edge_error(problem, solution))
    return replace(solution, model_error=error).refused(outside_law(problem, solution), Status.OUTSIDE_LAW)


def error_of_law(problem):
    """(B,): the relative error of the tables of the micro laws themselves, which asperities that feel the body do not
    have."""
    tabulated = sum(law.error * (problem.micro == name) for name, law in problem.known.laws.items())
    return np.where(problem.feels_layer(), 0.0, tabulated)


def closed_form(problem, a):
    """Estimated relative error (B,) of the thin-layer model, as if asperities did not yield, by
    :func:`~solver.models.thin_layer_error.largest_error`; NaN where the thin-layer equation does not apply.

    `a` (B,) are its contact radii, in the unit of `problem.h`. The estimate is made for a rigid punch. Under an elastic
    one its value at given a, the largest of the three, is taken for each control.
    """

    def error(part, radius, control):
        return largest_error(
            control, part.h / radius, part.n, part.nu1, part.nu2, part.bonding == "bonded", part.rough()
        )

    errors, yields = error(problem, a, problem.control), np.flatnonzero(problem.m > 0)
    if len(yields):
        errors[yields] = error(problem.take(yields), a[yields], "a")
    return errors


def _ways(problem, solvable):
    """Pairs of a mask (B,), True for some cases, and the way to solve these."""
    half_space, thin = problem.base == "half_space", problem.base == "thin_layer"
    is_smooth, special = ~problem.rough(), shaped(problem) | (problem.w_adhesion > 0)
    if np.any(of_shape := solvable & is_smooth & special):
        yield from ((of_shape & mask, way) for mask, way in kinds_of(problem))
        solvable = solvable & ~of_shape
    yield solvable & is_smooth & half_space, _smooth_half_space
    yield solvable & is_smooth & thin, _smooth_layer
    iterated = solvable & ~(is_smooth & (half_space | thin))
    kinds = problem.micro, problem.base, problem.scheme, problem.shape, kinds_of_laws(problem)
    # of each kind the words that occur, and the cases that have them
    present = ([(word, words == word) for word in dict.fromkeys(words.tolist())] for words in kinds)
    for (_, of_law), (_, on_body), (scheme, by_scheme), (_, of_shape), (_, of_kind) in product(*present):
        chosen = iterated & of_law & on_body & by_scheme & of_shape & of_kind
        for limit in np.unique(problem.max_iterations[chosen]):
            yield chosen & (problem.max_iterations == limit), SCHEMES[scheme]


def _smooth_half_space(part, x):
    return smooth.half_space(part.control, part.value, x)


def _smooth_layer(part, x):
    return smooth.thin_layer(part.control, part.value, as_cases(part).body.C, part.rtol, part.nodes, x)


def _with_model(problem, solution):
    """The solution with its `model_used`, and its `model_error` without that of the range of the law."""
    solved, thin = np.isfinite(solution.P) & np.isfinite(solution.D), problem.base == "thin_layer"
    error = np.where(solved & ~thin & (problem.base != "thin_stack"), 0.0, np.nan)
    judged = np.flatnonzero(solved & thin)
    if len(judged):
        part = problem if len(judged) == len(problem) else problem.take(judged)
        error[judged] = closed_form(part, solution.a[judged])
    return replace(solution, model_used=model_of(problem), model_error=error + error_of_law(problem))

"""``solve(problem, x) -> Solution``: each case goes the cheapest way that solves it."""

from itertools import product

import numpy as np

from .contact import adaptive, picard, smooth
from .contact.equation import evaluate
from .contact.error import finish
from .laws import LAWS
from .models import auto
from .models.model_error import closed_form, judged
from .models.range_of_law import outside_law
from .numerics.ladder import start_nodes
from .numerics.mesh import mesh
from .scaling import as_cases, dimensionless, refused, restore, with_rigid_punch
from .solution import Solution
from .status import Status
from .threads import one_blas_thread


@one_blas_thread()
@np.errstate(all="ignore")  # a number that goes wrong is a NaN and a status
def solve(problem, x=(0.0, 1.0)):
    """Solve a batch of cases.

    Parameters
    ----------
    problem : Problem
        B cases of any mixture of bases, micro laws, bondings and schemes.
    x : (m,) float, [0, 1]
        Radii r/a at which the profiles p and λ are wanted.

    Returns
    -------
    Solution
        One row a case, in the order of the problem and in its units. A case that cannot be solved is a status and NaN.

    Raises
    ------
    ValueError
        If x is not one-dimensional or leaves [0, 1].

    Notes
    -----
    Smooth on a half-space is Hertz's closed form; smooth on a thin layer one linear solve; rough cases, and all on the
    exact layer, iterate by their scheme. Successive approximations are for asperities: a smooth case with the scheme
    "picard" is ``Status.INVALID_INPUT``. The base "auto" is the cheapest model that meets `accuracy`; where
    that is a smooth punch, to which the asperities are added, there is nothing to approximate either.

    Examples
    --------
    >>> from solver import Problem
    >>> layer, asperities = {"h": 0.02, "n": 0.5, "base": "thin_layer"}, {"Nbar": 250000, "Ra": 0.004}
    >>> case = Problem.of(a=0.04, **layer, **asperities, micro="power_law", B=0.1, beta=0.5)
    >>> print(f"{solve(case).P[0]:.5e}")
    2.70408e-05
    """
    x = np.asarray(x, dtype=float)
    if x.ndim != 1 or not np.all((x >= 0) & (x <= 1)):
        raise ValueError("x must be one-dimensional and within [0, 1]")
    scaled, _ = dimensionless(problem)
    return _solved(problem, x, refused(problem, scaled) | problem.without_scheme())


def _of_a_model(problem, x):
    """:func:`solve` of cases that a model makes of allowed ones, whatever the bounds say of its parameters."""
    return _solved(problem, x, problem.without_scheme())


def _solved(given, x, invalid):
    problem = with_rigid_punch(given)
    scaled, C = dimensionless(problem)
    solution = Solution.empty(len(problem), len(x))
    solution.status[invalid] = Status.INVALID_INPUT
    no_springs = ~invalid & (problem.base == "thin_layer") & ~(C > 0)
    solution.status[no_springs] = Status.THIN_LAYER_NOT_APPLICABLE
    for index, solver in _routes(problem, ~(invalid | no_springs)):
        solution.put(index, solver(scaled.take(index), C[index], x))
    restore(solution, problem)
    _name_models(given, solution)
    solution.refuse(outside_law(given, solution), Status.OUTSIDE_LAW)
    getattr(solution, given.control)[:] = given.value
    return solution


def _routes(problem, solvable):
    """(index, solver) for each kind of case present."""
    judged = (problem.base == "thin_layer") & (problem.model_check == "first_order")
    yield from _route(solvable & judged, _judged)
    yield from _route(solvable & (problem.base == "auto"), _auto)
    solvable = solvable & ~judged & (problem.base != "auto")
    is_smooth, by_picard = ~problem.rough(), problem.scheme == "picard"
    yield from _route(solvable & is_smooth & (problem.base == "half_space"), _smooth_half_space)
    yield from _route(solvable & is_smooth & (problem.base == "thin_layer"), _smooth_layer)
    layered = problem.base == "layered"
    for name, on_layered in product(LAWS, (False, True)):
        of_law = solvable & (problem.micro == name) & (layered == on_layered) & (on_layered | ~is_smooth)
        for limit in np.unique(problem.max_iterations[of_law]):
            chosen = of_law & (problem.max_iterations == limit)
            yield from _route(chosen & ~by_picard, _newton)
            for nodes in np.unique(_picard_nodes(problem)[chosen & by_picard]):
                yield from _route(chosen & by_picard & (_picard_nodes(problem) == nodes), _picard)


def _route(mask, solver):
    if mask.any():
        yield np.flatnonzero(mask), solver


def _auto(part, C, x):
    return vars(auto.cheapest(part, x, _of_a_model))


def _judged(part, C, x):
    return vars(judged(part, x, _of_a_model))


def _smooth_half_space(part, C, x):
    return smooth.half_space(part.control, part.value, x)


def _smooth_layer(part, C, x):
    return smooth.thin_layer(part.control, part.value, C, part.rtol, part.nodes, x)


def _newton(part, C, x):
    return adaptive.solve_newton(as_cases(part, C), part.rtol, part.nodes, int(part.max_iterations[0]), x)


def _picard_nodes(problem):
    return np.where(problem.nodes > 0, problem.nodes, start_nodes(problem.rtol))


def _picard(part, C, x):
    """Successive approximations on one mesh; their error is the distance to one Newton step on the next finer mesh."""
    cases = as_cases(part, C)
    n = int(_picard_nodes(part)[0])
    grid = mesh(n)
    with np.errstate(all="ignore"):
        state, status, count = picard.solve(cases, grid, part.k, part.rtol, int(part.max_iterations[0]))
        values, _ = finish(cases, grid, state, x, evaluate(cases, state, grid))
    del values["tension"]  # asperities carry none
    status[(status == Status.CONVERGED) & (values["error"] > part.rtol)] = Status.TOLERANCE_NOT_MET
    return values | {"status": status.astype(np.int8), "iterations": count}


def _name_models(problem, solution):
    """`model_used` and `model_error` of the cases whose base was asked for by name, in place."""
    named = problem.base != "auto"
    solution.model_used[named] = auto.model_of(problem)[named]
    solved = np.isfinite(solution.p0)
    solution.model_error[solved & named & (problem.base != "thin_layer")] = 0.0
    thin = np.flatnonzero(solved & (problem.base == "thin_layer") & (problem.model_check == "closed_form"))
    solution.model_error[thin] = closed_form(problem.take(thin), solution.a[thin])
    for law in LAWS.values():
        solution.model_error[named & (problem.micro == law.name)] += law.error

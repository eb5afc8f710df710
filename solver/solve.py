"""``solve(problem, x) -> Solution``: each case goes the cheapest way that solves it."""

from dataclasses import replace
from itertools import product

import numpy as np

from . import picard, rough, smooth
from .base import local_compliance
from .equation import Cases
from .ladder import start_nodes
from .layered import Layer
from .mesh import mesh
from .micro import LAWS, scales
from .problem import Solution
from .status import Status

#: Power of R and of E2* in the unit of each quantity.
_UNITS = {
    "a": (1, 0),
    "D": (1, 0),
    "A0": (1, 0),
    "p0": (0, 1),
    "p_max": (0, 1),
    "p": (0, 1),
    "P": (2, 1),
    "dP_dD": (1, 1),
}


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
    Smooth on a half-space is Hertz's closed form; smooth on a thin layer one linear solve; rough cases iterate.

    Examples
    --------
    >>> from solver import Problem
    >>> case = Problem.of(a=0.04, h=0.02, n=0.5, Nbar=250000, Ra=0.004, micro="power_law", B=0.1, beta=0.5)
    >>> print(f"{solve(case).P[0]:.5e}")
    2.70408e-05
    """
    x = np.asarray(x, dtype=float)
    if x.ndim != 1 or not np.all((x >= 0) & (x <= 1)):
        raise ValueError("x must be one-dimensional and within [0, 1]")
    solution = Solution.empty(len(problem), len(x))
    invalid = problem.invalid()
    solution.status[invalid] = Status.INVALID_INPUT
    with np.errstate(all="ignore"):
        scaled, C = _dimensionless(problem)
    refused = ~invalid & (problem.base == "thin_layer") & ~(C > 0)
    solution.status[refused] = Status.THIN_LAYER_NOT_APPLICABLE
    for index, solver in _routes(problem, ~(invalid | refused)):
        solution.put(index, solver(scaled.take(index), C[index], x))
    _restore(solution, problem)
    return solution


def _dimensionless(problem):
    """The problem in units R = E2* = 1, and C (B,) of Eq. (3) in them: 0 without a layer."""
    R, E2 = problem.R, problem.E2
    # divided one by one: R² or R⁻² may overflow where the quotient does not
    value = problem.value / R / R / E2 if problem.control == "P" else problem.value / R
    layered = problem.base != "half_space"
    h, n = problem.h / R, np.where(layered, problem.n, 1.0)
    springs = local_compliance(h, n, problem.nu1, problem.nu2, problem.bonding == "bonded")
    C = np.where(problem.base == "thin_layer", springs, 0.0)
    return replace(problem, value=value, h=h, n=n, Ra=problem.Ra / R, Nbar=problem.Nbar * R * R), C


def _routes(problem, solvable):
    """(index, solver) for each kind of case present."""
    is_smooth, by_picard = problem.micro == "smooth", (problem.scheme == "picard") & (problem.micro != "smooth")
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


def _smooth_half_space(part, C, x):
    return smooth.half_space(part.control, part.value, x)


def _smooth_layer(part, C, x):
    return smooth.thin_layer(part.control, part.value, C, part.rtol, part.nodes, x)


def _cases(part, C):
    """:class:`~solver.equation.Cases` of one law on one base, and the law."""
    micro = str(part.micro[0])
    spot_scale, spot_depth = scales(part.n, part.Nbar, part.Ra)
    none, one = np.zeros(len(part)), np.ones(len(part))
    p_star, A_star, spot_scale, exponent = {
        "disc_cell": (spot_scale, spot_depth, spot_scale, 2 / 3 * one),
        "power_law": (part.n * one, part.B * part.Ra, spot_scale, part.beta * one),  # A = B Ra (p/E1*)^β: g = q^β
        "smooth": (part.n * one, none, none, one),
    }[micro]
    layered = part.base[0] == "layered"
    layer = Layer(part.h, part.n, part.nu1, part.nu2, part.bonding == "bonded") if layered else None
    E = part.n if layered else one
    return Cases(part.control, layer, part.value, p_star, A_star, spot_scale, E, C, exponent), LAWS[micro]


def _newton(part, C, x):
    cases, law = _cases(part, C)
    return rough.solve_newton(cases, law, part.rtol, part.nodes, int(part.max_iterations[0]), x)


def _picard_nodes(problem):
    return np.where(problem.nodes > 0, problem.nodes, start_nodes(problem.rtol))


def _picard(part, C, x):
    """Successive approximations on one mesh; their error is the distance to one Newton step on the next finer mesh."""
    cases, law = _cases(part, C)
    n = int(_picard_nodes(part)[0])
    grid = mesh(n)
    with np.errstate(all="ignore"):
        state, status, count = picard.solve(cases, law, grid, part.k, part.rtol, int(part.max_iterations[0]))
        values, _ = rough.finish(cases, law, grid, state, x)
    status[(status == Status.CONVERGED) & (values["error"] > part.rtol)] = Status.TOLERANCE_NOT_MET
    return values | {"status": status.astype(np.int8), "iterations": count}


def _restore(solution, problem):
    """Back to the units of the problem; the controlled quantity exactly as given."""
    for name, (of_R, of_E2) in _UNITS.items():
        array = getattr(solution, name)
        factor = problem.R**of_R * problem.E2**of_E2
        array *= factor.reshape(-1, *[1] * (array.ndim - 1))
    getattr(solution, problem.control)[:] = problem.value

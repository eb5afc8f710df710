"""Contacts that stick, given by their radii, without the search for their pull-off: a tenth of the work or less."""

import numpy as np

from .bases import named
from .body.graded import is_graded
from .numerics.threads import one_blas_thread
from .problem import Problem
from .scaling import dimensionless, restore, with_a_stiff_base, with_rigid_punch
from .smooth.contact import kinds_of, sticking
from .solution import Solution
from .solve import solve
from .status import Status

#: Contacts whose error is above this are solved with their pull-off, in whose terms errors are then.
_SURE = 1e-6


@one_blas_thread()
@np.errstate(all="ignore")
def solve_at_radii(problem: Problem, x: np.ndarray) -> Solution:
    """The :class:`Solution` of smooth contacts with w > 0 given by their radii, at the radii x (m,); P_off, D_off,
    a_off, P_in, a_in are 0, and `stable` is True. Graded layers, and contacts that lose their digits, have all
    numbers, and take as long as by :func:`~solver.solve.solve`."""
    if problem.control != "a" or not (problem.w_adhesion > 0).all() or problem.rough().any():
        raise ValueError("for smooth contacts with adhesion that are given by their radii")
    problem = problem.but(base=named(problem.base))
    if is_graded(problem).any():
        return solve(problem, x)
    rigid = with_a_stiff_base(with_rigid_punch(problem))
    part, size = dimensionless(rigid), (len(problem), len(x))
    pieces = [(index, sticking(part.take(index), x, ends=False)) for index in kinds_of(part)]
    solution = restore(Solution.join(*size, pieces), rigid)
    sure = (solution.status == Status.CONVERGED) & (solution.error <= _SURE) | (solution.status == Status.OUTSIDE_LAW)
    rest = np.flatnonzero(~sure)
    if not len(rest):
        return solution
    pieces = [(np.flatnonzero(sure), solution.take(sure)), (rest, solve(problem.take(rest), x))]
    return Solution.join(*size, pieces)

"""Smooth contacts of every shape, with and without adhesion: the functions that solve the cases of a problem."""

import numpy as np

from ..body import BODIES
from ..numerics.batch import alike
from ..shapes import shape_of
from ..shapes.shape import has_radius
from ..solution import Solution
from ..status import Status
from .adhesion import adhesive, limits
from .branches import smallest
from .galerkin import respond
from .radius import touching
from .state import State, answer, at_corner, beyond_profile, pinned
from .tabulated_body import Tabulated, where_slow
from .tension import judged


def kinds_of(problem):
    """Groups of cases with one base, shape and law of adhesion: a list of indices (b,)."""
    return alike(problem.base, problem.shape, np.where(problem.w_adhesion > 0, problem.adhesion, ""))


def not_sticking(part, x):
    """:class:`~..solution.Solution` of cases without adhesion in units R = E2* = 1, at the radii x (m,)."""
    shape, body = shape_of(part), where_slow(BODIES[str(part.base[0])](part))
    if has_radius(shape).all():
        state, counts = pinned(part, shape, body), np.ones(len(part), dtype=np.int32)
        return judged(*answer(part, shape, state, counts, x), shape, body, state, x)[0]
    solution, tensile = _touching(part, shape, body, touching(part.control, part.value, shape, body), x)
    lost = np.flatnonzero(tensile)
    if part.control != "a" and len(lost):  # the contact may be on another branch
        lost_cases = part.take(lost), shape.take(lost), body.take(lost)
        response, counts = smallest(part.control, part.value[lost], *lost_cases[1:])
        other_branch, _ = _touching(*lost_cases, (response, counts + solution.iterations[lost]), x)
        solution = Solution.join(len(part), len(x), [(np.arange(len(part)), solution), (lost, other_branch)])
    outside = beyond_profile(part, shape, lambda index, a: State.free(respond(shape.take(index), body.take(index), a)))
    return solution.refused(outside, Status.OUTSIDE_LAW)


def _touching(part, shape, body, at_radius, x):
    """The solution of contacts from `at_radius`, their Response and counts, with LIFT_OFF where that is NaN or tensile;
    and whether there may be tension, (B,)."""
    response, counts = at_radius
    state, corner = at_corner(part, shape, body, State.free(response))
    solution, tensile = judged(*answer(part, shape, state, counts, x), shape, body, state, x)
    solution.p[np.ix_(corner, x == 1)] = 0.0
    return solution, tensile


def sticking(part, x, ends=True):
    """As :func:`not_sticking`, for cases with adhesion, w > 0. `ends` as of :func:`~.adhesion.adhesive.solve`."""
    shape, body = shape_of(part), Tabulated.of(BODIES[str(part.base[0])](part))
    solution = adhesive.solve(part, shape, body, x, ends)
    if str(part.adhesion[0]) == "maugis" and ends:

        def with_edge(cases, index, x):
            return adhesive.solve(cases, shape.take(index), body.take(index), x)

        solution = limits.with_edges(part, body, solution, with_edge, x)
    return limits.without(part, body, solution, not_sticking, x)

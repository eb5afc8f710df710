"""Newton's method, for each case on the mesh that meets its tolerance.

A case whose estimated error is above its tolerance goes on to the next finer mesh. It begins there at the state by
which the error was estimated. Cases that the finest mesh does not resolve are solved on panels, one by one.
"""

from dataclasses import replace

import numpy as np

from ..numerics.ladder import LADDER, climb, finer_mesh, first_rung
from ..numerics.mesh import mesh_of
from ..solution import Solution
from ..status import Status
from .answer import Answer, answer, hopeless, stuck, tensile_centre
from .driver import BUDGET, newton_steps, solve_on
from .equation import evaluate
from .panels import solve_on_panels
from .start import first_guess, guess_radius, nodes_wanted

#: Panels are halved until the last coefficients on each are small against rtol. If the error is then still above rtol,
#: they are halved until these coefficients are small against this times rtol.
_FINER = 0.03


def solve_newton(cases, rtol, nodes, limit, x):
    """:class:`~solver.solution.Solution` of a batch of one law on one body, in units R = E2* = 1.

    rtol : (B,); nodes : (B,) int, 0: chosen by rtol; limit : int, Newton steps on each mesh, 0: the method's own;
    x : (m,), radii of the profiles.
    """
    size, free = len(rtol), nodes == 0
    work, before, a = np.zeros(size), np.full(size, np.inf), guess_radius(cases)

    def on_mesh(index, n, start):
        part, mesh = cases.take(index), mesh_of(n)
        begin = first_guess(part, mesh, a[index]) if start is None else start
        iterated = solve_on(evaluate(part, begin, mesh), limit)
        work[index] += iterated.count * part.body.work(a[index], n)[1]
        goes_on = free[index] & (n < LADDER[-1]) & (work[index] <= BUDGET)
        found = answer(iterated, x, np.where(goes_on, rtol[index], np.inf), before[index])
        useless = (found.solution.status != Status.CONVERGED) | _hopeless(found, rtol[index])
        useless |= stuck(found.solution.error, found.slow, n, rtol[index]) | (work[index] > BUDGET)
        error = np.where(free[index] & found.unsure, np.inf, found.solution.error)
        before[index] = error
        return np.where(useless, np.nan, error), found.finer, found._replace(finer=None)

    rungs = climb(rtol, nodes, on_mesh, first_rung(nodes_wanted(cases, rtol, a)), cases.body.order(a))
    found = _together(rungs, size, len(x))
    undecided = ~free & found.unsure  # no finer mesh will judge the tension: its part of the load is an error
    np.maximum(found.solution.error, found.tension, out=found.solution.error, where=undecided)
    lifted, closed = found.lifted(cases.edge), found.solution.status == Status.CONVERGED
    missed, spent = closed & ((found.solution.error > rtol) | (free & found.unsure)), work > BUDGET
    unfinished = (missed | lifted | ~closed) & (lifted | ~_hopeless(found, rtol))
    rest = np.flatnonzero(unfinished & free & (limit == 0) & ~spent)
    ends = [([i], _on_panels(cases.take([i]), found.take([i]), rtol[i], x, BUDGET - work[i])) for i in rest]
    # where the budget is spent, no panels can confirm that the punch lifts off: the error counts as too large
    ended = _ended(found.solution, missed | (lifted & spent), lifted & ~spent, spent)
    return Solution.join(size, len(x), [(np.arange(size), ended), *ends]) if ends else ended


def _together(rungs, size, points):
    """:class:`.answer.Answer` of `size` cases from those on all meshes, (index, answer): the last one of each case,
    with the steps of all."""
    count, (tension, floor) = np.zeros(size, int), np.zeros((2, size))
    gap, slow = np.zeros((2, size), bool)
    for index, found in rungs:
        count[index] += found.solution.iterations
        tension[index], gap[index], slow[index], floor[index] = found[1:-1]
    solution = Solution.join(size, points, [(index, found.solution) for index, found in rungs])
    return Answer(replace(solution, iterations=count.astype(np.int32)), tension, gap, slow, floor, None)


def _hopeless(found, rtol):
    """(B,) bool: the error is above rtol, and no mesh will make it smaller."""
    closed, error = found.solution.status == Status.CONVERGED, found.solution.error
    return closed & hopeless(error, found.slow, found.floor, rtol) & ~found.unsure


def _ended(solution, missed, lifted, spent):
    """The solution with its final status. missed, lifted, spent : (B,) bool: the error is above rtol, the punch lifts
    off, the budget is spent."""
    status = np.where(missed, np.where(spent, Status.BUDGET_SPENT, Status.TOLERANCE_NOT_MET), solution.status)
    over = (status == Status.ITERATION_LIMIT) & (spent | (solution.iterations >= newton_steps(solution.nodes)))
    status = np.where(over, Status.BUDGET_SPENT, status).astype(np.int8)
    return replace(solution, status=status).refused(lifted, Status.LIFT_OFF)


def _on_panels(case, before, rtol, x, left):
    """:class:`~solver.solution.Solution` of one case on panels of its own, with `left` of its budget; or that of
    `before`, the :class:`.answer.Answer` on the finest mesh, if its error is smaller.

    Tension and gaps count only if finer panels show them too: panels that are too coarse show some that are not there.
    """
    best, lifted, count, at = before.solution, before.lifted(case.edge), before.solution.iterations, None
    resolved, missed, spent = False, best.status == Status.CONVERGED, False
    for goal in (rtol, _FINER * rtol):
        if left <= 0:
            spent = True
            break
        iterated, work = solve_on_panels(case, goal, left, at)
        left, count, spent = left - work, count + iterated.count, work > left
        if not iterated.closed[0]:
            continue
        if at is not None and iterated.at.mesh == at.mesh:
            break  # no finer panels than those before
        at = iterated.at
        found = answer(iterated, x, before=0.0)  # so `slow` is True: finer panels hardly lower the error
        left -= case.body.work(found.solution.a, finer_mesh(at.mesh).n)[0][0]
        lifted = (found.gap | found.lifted(case.edge)) & (not resolved)
        if lifted[0]:
            continue
        resolved = True
        if not found.gap[0] and found.solution.error[0] < np.nan_to_num(best.error[0], nan=np.inf):
            best = found.solution
        missed = (best.status == Status.CONVERGED) & (best.error > rtol)
        if best.status[0] == Status.CONVERGED and (not missed[0] or _hopeless(found, rtol)[0]):
            spent = False
            break
    best = replace(best, iterations=count.astype(np.int32))
    lifted |= tensile_centre(best, case.edge)
    return _ended(best, missed, lifted, spent)

"""Newton's method, for each case on the mesh that meets its tolerance.

A case whose estimated error is above its tolerance goes on to the next finer mesh. It starts there from the state by
which the error was estimated. Cases that the finest mesh does not resolve are solved on panels, one by one. If the
profile of the punch is not a smooth function of r², two polynomials may have the same error: such cases are solved on
panels from the beginning.
"""

from dataclasses import replace

import numpy as np

from ..numerics.ladder import LADDER, climb, finer_mesh, first_rung
from ..numerics.mesh import mesh_of
from ..solution import Solution
from ..status import Status
from .answer import (
    Answer,
    Goal,
    Verdict,
    after_panels,
    answer,
    before_panels,
    may_be_error,
    tensile_centre,
    unfinished,
)
from .equation import evaluate
from .newton import BUDGET, budget_of, newton_steps, solve_on
from .panels import solve_on_panels
from .start import first_guess, guess_radius, nodes_wanted

#: Panels are halved until the last coefficients on each are small against rtol. If the error is then still above rtol,
#: they are halved until these coefficients are small against this times rtol.
_FINER = 0.03
#: The table of :class:`.answer.Verdict` in code: the verdicts that send a case to panels when no finer mesh follows,
#: and the status of a case that ends. A verdict that is not in _ENDS leaves the status as it is.
_TO_PANELS = (Verdict.LIFTED, Verdict.OPEN, Verdict.STUCK, Verdict.COARSE)
_ENDS = dict.fromkeys((Verdict.FLOOR, Verdict.STUCK, Verdict.COARSE), Status.TOLERANCE_NOT_MET)
_ENDS[Verdict.SPENT] = Status.BUDGET_SPENT
#: Load and depth may not rise with the radius everywhere, and the solution may be on a branch at smaller radii than the
#: first guess. _LOST are the statuses after which such a branch is searched for, _NEARER the parts of the guessed
#: radius at which the search starts, and _SOFT the stiffness of a kernel up to which load and depth always rise.
_LOST = (Status.LIFT_OFF, Status.BUDGET_SPENT, Status.ITERATION_LIMIT, Status.DIVERGED)
_NEARER, _SOFT = (0.5, 0.25, 0.1), 2.0


def solve_newton(cases, rtol, nodes, limit, x):
    """:class:`~solver.solution.Solution` of a batch of one law on one body, in units R = E2* = 1.

    rtol : (B,), tolerances
    nodes : (B,) int, number of nodes; 0: chosen by rtol
    limit : int, most Newton steps on each mesh; 0: the limit of the method
    x : (m,), radii of the profiles
    """
    size, free = len(rtol), nodes == 0
    direct = free & (limit == 0) & ~cases.shape.even
    if direct.any():
        return _split(cases, (rtol, nodes), direct, limit, x)
    work, before, a = np.zeros(size), np.full(size, np.inf), guess_radius(cases)

    def on_mesh(index, n, start):
        part, mesh = cases.take(index), mesh_of(n)
        begin = first_guess(part, mesh, a[index]) if start is None else start
        iterated = solve_on(evaluate(part, begin, mesh), limit)
        work[index] += iterated.count * part.body.work(a[index], n)[1]
        spent = work[index] > BUDGET
        finer = free[index] & (n < LADDER[-1]) & ~spent
        answered = answer(iterated, x, Goal(rtol[index], before[index], free[index], finer, spent))
        error = answered.solution.error
        before[index] = np.where(free[index] & may_be_error(answered.tension, error), np.inf, error)
        error = np.where(answered.verdict == Verdict.COARSE, np.inf, np.nan)  # inf sends a case to the next mesh
        return error, answered.finer, answered._replace(finer=None)

    rungs = climb(rtol, nodes, on_mesh, first_rung(nodes_wanted(cases, rtol, a)), cases.body.order(a))
    answered = _together(rungs, size, len(x))
    rest = np.flatnonzero(np.isin(answered.verdict, _TO_PANELS) & free & (limit == 0))
    ends = [([i], _on_panels(cases.take([i]), answered.take([i]), rtol[i], x, BUDGET - work[i])) for i in rest]
    ended = _ended(answered.solution, answered.verdict)
    return Solution.join(size, len(x), [(np.arange(size), ended), *ends]) if ends else ended


def _split(cases, settings, direct, limit, x):
    """:class:`~solver.solution.Solution` of a batch in which the cases `direct` (B,) bool begin on panels. `settings`:
    rtol and nodes, (B,) each."""
    rest, pieces, size = np.flatnonzero(~direct), [], len(direct)
    if len(rest):
        pieces.append((rest, solve_newton(cases.take(rest), *(v[rest] for v in settings), limit, x)))
    none = Solution.of(1, len(x), status=Status.ITERATION_LIMIT)
    before = Answer(none, np.zeros(1), np.zeros(1, bool), np.full(1, Verdict.OPEN, np.int8), None)
    for i in np.flatnonzero(direct):
        case = cases.take([i])
        solution = _on_panels(case, before, settings[0][i], x, budget_of(case))
        for nearer in _NEARER if solution.status[0] in _LOST and _has_branches(case) else ():
            other = _on_panels(case, before, settings[0][i], x, budget_of(case), nearer)
            if other.status[0] == Status.CONVERGED:
                solution = replace(other, iterations=solution.iterations + other.iterations)
                break
        pieces.append(([i], solution))
    return Solution.join(size, len(x), pieces)


def _has_branches(case):
    """Whether more than one radius may have the load or depth of a case, as on a hard layer, which bends."""
    kernel = case.body.kernel
    return case.control != "a" and kernel is not None and kernel.stiffness[0] > _SOFT


def _together(rungs, size, points):
    """:class:`.answer.Answer` of `size` cases from the answers on all meshes, (index, answer) each. A case has its last
    answer, and the sum of the steps on all its meshes."""
    count, tension, gap = np.zeros(size, int), np.zeros(size), np.zeros(size, bool)
    verdict = np.zeros(size, np.int8)
    for index, answered in rungs:
        count[index] += answered.solution.iterations
        tension[index], gap[index], verdict[index] = answered[1:-1]
    solution = Solution.join(size, points, [(index, answered.solution) for index, answered in rungs])
    return Answer(replace(solution, iterations=count.astype(np.int32)), tension, gap, verdict, None)


def _ended(solution, verdict):
    """The solution with the final status that follows from the `verdict` (B,), :class:`.answer.Verdict`."""
    status, has_numbers = solution.status.copy(), solution.status != Status.DIVERGED
    for ending, last_status in _ENDS.items():
        status[(verdict == ending) & has_numbers] = last_status
    over = (status == Status.ITERATION_LIMIT) & (solution.iterations >= newton_steps(solution.nodes))
    status[over] = Status.BUDGET_SPENT
    return replace(solution, status=status).refused(verdict == Verdict.LIFTED, Status.LIFT_OFF)


def _on_panels(case, before, rtol, x, left, nearer=1.0):
    """:class:`~solver.solution.Solution` of one case on panels of its own, or the solution of `before`, its
    :class:`.answer.Answer` on the finest mesh, if that has the smaller error. `left` is the rest of its budget.

    Each round has finer panels and a verdict (:func:`.answer.after_panels`).
    """
    best, count, at = before.solution, before.solution.iterations, None
    verdict = before_panels(before)
    for goal in (rtol, _FINER * rtol):
        if left <= 0:
            verdict = unfinished(verdict, True)
            break
        iterated, work = solve_on_panels(case, goal, left, at, nearer)
        spent, left, count = work > left, left - work, count + iterated.count
        same = at is not None and iterated.at.mesh == at.mesh
        if same or not iterated.closed[0]:
            verdict = unfinished(verdict, spent)
            if same and iterated.closed[0]:
                break  # this round has no finer panels than the round before
            continue
        clear, at = at is not None and verdict != Verdict.LIFTED, iterated.at
        answered = answer(iterated, x)
        left -= case.body.work(answered.solution.a, finer_mesh(at.mesh).n)[0][0]
        best, verdict = after_panels(best, answered, at.floor, rtol, clear, spent)
        if verdict in (Verdict.SOLVED, Verdict.FLOOR):
            break
    verdict = Verdict.LIFTED if tensile_centre(best)[0] else verdict
    return _ended(replace(best, iterations=count.astype(np.int32)), np.array([verdict]))

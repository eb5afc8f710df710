"""The answer of an iteration on a mesh: the solution with its error and profiles, and a verdict for each case."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..numerics.mesh import gauss_rule
from ..solution import Solution
from ..status import Codes, Status
from . import newton
from .equation import Unknowns
from .error import completed, estimate, profile_error, refine
from .results import pointed, profiles, quantities

#: A ring of tension may lie between two nodes. So the pressure is evaluated at this many times as many points.
_DENSER = 3
#: If the error of a case is below this, p(0) < 0 is real, not an error of the mesh.
_SURE = 0.1
#: A gap higher than this times a²/2, or tension above this part of the load, is real, not rounding.
_GAP, _TENSION = 1e-9, 1e-9
#: A case is stuck if, on a mesh of _LATE nodes or more, its error is above _FALLS times that on the mesh before, and
#: above _FAR times rtol: only two finer meshes are left, and they will not make the error 100 times smaller.
_FALLS, _LATE, _FAR = 0.5, 48, 100.0
#: An error that does not fall from mesh to mesh, and is below this times the error of the operator, comes from the
#: operator.
_NOISE = 30.0


class Verdict(Codes):
    """The fate of a case on a mesh, decided by the first of these conditions that holds (:func:`_verdicts`).

    ========  ==========================================================  ==============================================
    verdict   condition                                                   what happens
    ========  ==========================================================  ==============================================
    SOLVED    closed; the error is at most rtol; no tension               it ends, converged
    SPENT     the budget is spent                                         it ends, budget_spent
    LIFTED    tension that is no error; the error sends it to no finer    panels confirm it; it ends, lift_off
              mesh, or there is none
    OPEN      the iteration has not closed                                panels; else it ends with the status it has
    FLOOR     the error is above rtol, and that of the operator           it ends, tolerance_not_met
    STUCK     on a fine mesh the error is far above rtol and hardly       panels; else it ends, tolerance_not_met
              smaller than on the mesh before
    COARSE    the error is above rtol, or there is tension that may be    the next finer mesh; after the last panels,
              no more than the error                                      else it ends, tolerance_not_met
    ========  ==========================================================  ==============================================

    Cases with a given `nodes` or `max_iterations` never go to panels. Each round of panels has a verdict too, by the
    same conditions in another order (:func:`after_panels`): LIFTED, SOLVED, FLOOR, SPENT, COARSE, OPEN. SOLVED and
    FLOOR end the case at once, any other verdict after the last round, with the same statuses.
    """

    SOLVED = 0
    SPENT = 1
    LIFTED = 2
    OPEN = 3
    FLOOR = 4
    STUCK = 5
    COARSE = 6


class Goal(NamedTuple):
    """The goals of cases on a mesh, arrays (B,).

    rtol : tolerance
    before : error on the mesh before; inf on the first mesh
    free : bool, whether the mesh is chosen by rtol
    finer : bool, whether a finer mesh may follow
    spent : bool, whether the budget is spent
    """

    rtol: np.ndarray
    before: np.ndarray
    free: np.ndarray
    finer: np.ndarray
    spent: np.ndarray


@batch.of_cases
class Answer(NamedTuple):
    """The solution of B cases, with numbers that tell whether the punch lifts off and whether a finer mesh is of use.

    tension : (B,), the tensile part of the load over the load
    gap : (B,) bool, whether there is a gap inside the contact. Gap or tension may also mean that the mesh is too coarse
    verdict : (B,) int8, a :class:`Verdict`; COARSE if there is no goal
    finer : the state on the next finer mesh, from which that mesh starts
    """

    solution: Solution
    tension: np.ndarray
    gap: np.ndarray
    verdict: np.ndarray
    finer: Unknowns | None

    def lifted(self):
        """(B,) bool: whether the tension, in total or in the centre, is too large to be an error."""
        return is_tension(self.tension, self.solution.error) | tensile_centre(self.solution)


@lru_cache(maxsize=32)
def _between(mesh):
    """The basis polynomials (n, m) of a mesh at _DENSER times as many points, and the weights (m,) of ∫ · s ds
    there."""
    s, w = denser_rule(mesh)
    return mesh.basis(s).T, w * s


def denser_rule(mesh):
    """Points s (m,) at which tension between the nodes of a mesh is searched for, and their weights (m,) of
    ∫₀¹ · ds."""
    return gauss_rule(_DENSER * mesh.order, mesh.breaks)


def is_tension(tension, error):
    """(B,) bool: whether the tension is too large to be an error."""
    return tension > np.fmax(10 * error, _TENSION)


def may_be_error(tension, error):
    """(B,) bool: whether there is tension that may be only an error, which a finer mesh will tell."""
    return (tension > _TENSION) & (tension <= 10 * error)


def tensile_centre(solution):
    """(B,) bool: whether p(0) < 0 with an error too small to explain it. `solution` has p0 and error, (B,) each."""
    return (solution.p0 < 0) & (solution.error < _SURE)


def at_floor(error, slow, floor, rtol):
    """(B,) bool: whether the error is above rtol and no mesh would reduce it, since it comes from the operator, whose
    error is `floor`. `slow` : whether the error is hardly smaller than on the mesh before."""
    return (floor > rtol) & (error <= np.where(slow, _NOISE, 1.0) * floor)


def _verdicts(ev, closed, solution, tension, goal):
    """:class:`Verdict` (B,) of cases whose iterations are `closed` (B,) bool; `solution` has p0 and error."""
    error, rtol = solution.error, goal.rtol
    slow, doubt = error > _FALLS * goal.before, may_be_error(tension, error)
    lifted = is_tension(tension, error) | tensile_centre(solution)
    wanting = (error > rtol) | (goal.free & doubt)
    floor = at_floor(error, slow, ev.floor, rtol) & ~doubt
    table = {
        Verdict.SOLVED: closed & ~wanting & ~lifted,
        Verdict.SPENT: goal.spent,
        Verdict.LIFTED: lifted & (~closed | ~wanting | floor | ~goal.finer),
        Verdict.OPEN: ~closed,
        Verdict.FLOOR: floor,
        Verdict.STUCK: slow & (ev.mesh.n >= _LATE) & (error > _FAR * rtol),
    }
    return np.select(list(table.values()), list(table), Verdict.COARSE).astype(np.int8)


def before_panels(answered):
    """The :class:`Verdict` of one case at the start of its panels, from its :class:`Answer` on meshes."""
    if answered.lifted()[0]:
        return Verdict.LIFTED
    return Verdict.COARSE if answered.solution.status[0] == Status.CONVERGED else Verdict.OPEN


def unfinished(verdict, spent):
    """The :class:`Verdict` of one case after a round of panels without a new result. Tension stays tension. `spent` :
    whether the budget is spent."""
    return Verdict.SPENT if spent and verdict != Verdict.LIFTED else verdict


def after_panels(best, answered, floor, rtol, clear, spent):
    """The better of two solutions, `best` and that of a round of panels, whose :class:`Answer` is `answered`; and the
    :class:`Verdict` after that round.

    Tension and gaps count only until panels have shown none: panels that are too coarse show some that are not real.

    floor : (1,), the error of the operator
    clear : whether earlier panels have shown neither tension nor a gap
    spent : whether the budget is spent
    """
    error = answered.solution.error
    if not clear and (answered.gap | answered.lifted())[0]:
        return best, Verdict.LIFTED
    if not answered.gap[0] and error[0] < np.nan_to_num(best.error[0], nan=np.inf):
        best = answered.solution
    converged = best.status[0] == Status.CONVERGED
    missed = converged and best.error[0] > rtol
    # slow = True, because finer panels hardly reduce an error
    at_end = at_floor(error, True, floor, rtol)[0] and not may_be_error(answered.tension, error)[0]
    table = {
        Verdict.SOLVED: converged and not missed,
        Verdict.FLOOR: missed and at_end,
        Verdict.SPENT: spent,
        Verdict.COARSE: missed,
    }
    return best, next((verdict for verdict, holds in table.items() if holds), Verdict.OPEN)


def answer(iterated, x, goal=None):
    """:class:`Answer` of an iteration, with profiles at the radii x (m,).

    goal : :class:`Goal` of cases that may go on to a finer mesh; those that do get no profiles here. None: all end

    A case without finite numbers has the status DIVERGED, and NaN.
    """
    ev, closed, count = iterated
    numbers = quantities(ev)
    refined = refine(ev, numbers)
    error = estimate(ev, numbers, refined)
    finite = np.isfinite(ev.residual) & np.isfinite(error)
    slope, size = refined.dP_dD, len(error)
    last = np.flatnonzero(~closed | ~goal.finer) if goal else np.arange(size)
    if len(last):  # the dP/dD of cases that end here comes from this mesh, like their other numbers
        at = ev.take(last)
        slope[last] = newton.stiffness(at, newton.tangent(at), numbers.P[last], numbers.D[last])
    gap, tension = ev.gap.max(axis=1) > _GAP, _tension(ev, finite)
    error = np.where(gap, np.maximum(error, 1.0), error)
    verdict, goes_on = np.full(size, Verdict.COARSE, dtype=np.int8), np.zeros(size, dtype=bool)
    if goal:
        centre = _Centre(numbers.p0, error)
        goes_on = finite & goal.finer & (_verdicts(ev, closed, centre, tension, goal) == Verdict.COARSE)
    done = np.flatnonzero(finite & ~goes_on)
    numbers.Ar_An[done], error[done] = completed(ev, numbers.Ar_An, error, done)
    if goal:
        fixed = ~goal.free & may_be_error(tension, error)  # no finer mesh will judge the tension: it counts as error
        error = np.where(fixed, np.maximum(error, tension), error)
        verdict = _verdicts(ev, closed & finite, _Centre(numbers.p0, error), tension, goal)
        verdict[goes_on] = Verdict.COARSE
    p, lam = np.full((2, size, len(x)), np.nan)
    p[done], lam[done] = profiles(ev, x, done)
    between = np.full(size, np.nan)
    between[done] = profile_error(ev, refined, done, x)
    status = np.where(closed, Status.CONVERGED, Status.ITERATION_LIMIT)
    errors = {"residual": ev.residual, "error": error, "profile_error": np.maximum(error, between)}
    without = pointed(ev.cases)
    if without.any():
        for values in (numbers.p0, numbers.p_max, numbers.A0):
            values[without] = np.nan
        p[np.ix_(without, x == 0)] = lam[np.ix_(without, x == 0)] = np.nan
    rest = {"dP_dD": slope, "p": p, "lam": lam, "status": status, "nodes": ev.mesh.n, "iterations": count}
    solution = Solution.of(size, len(x), **numbers._asdict(), **errors, **rest)
    return Answer(solution.refused(~finite, Status.DIVERGED), tension, gap, verdict, refined.end.state)


class _Centre(NamedTuple):
    """p(0) and the error, (B,) each, for :func:`tensile_centre`."""

    p0: np.ndarray
    error: np.ndarray


def _tension(ev, finite):
    """The tensile part of the load over the load, (B,); 0 for cases without `finite` numbers. Tension can occur only
    without asperities, since the equation is then linear."""
    if ev.cases.law.rough:
        return np.zeros(len(finite))
    basis, w = _between(ev.mesh)
    q = ev.curve.q @ basis
    return np.where(finite, np.maximum(-q, 0.0) @ w / np.abs(q @ w), 0.0)

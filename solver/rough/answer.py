"""What an iteration on a mesh has found: the solution with its error and profiles, and what becomes of each case."""

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

#: A ring of tension may lie between two nodes: so the pressure is formed at this many times as many points.
_DENSER = 3
#: If the error of a case is below this, p(0) < 0 is real and no error of the mesh.
_SURE = 0.1
#: A gap higher than this times a²/2, or tension above this part of the load, is real and no rounding.
_GAP, _TENSION = 1e-9, 1e-9
#: A case is stuck if, on a mesh of _LATE nodes or more, its error is above _FALLS times that on the mesh before, and
#: above _FAR times rtol: two finer meshes are left, and halving the error twice does not make it 100 times smaller.
_FALLS, _LATE, _FAR = 0.5, 48, 100.0
#: An error that does not fall, and is below this times the error of the operator, comes from the operator.
_NOISE = 30.0


class Verdict(Codes):
    """What becomes of a case on a mesh: of these conditions the first that holds. :func:`_verdicts` has them in code.

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

    There are no panels for cases whose `nodes` or `max_iterations` are given. Each round of panels has a verdict too,
    of the same conditions in another order (:func:`after_panels`): LIFTED, SOLVED, FLOOR, SPENT, COARSE, OPEN. SOLVED
    and FLOOR end the case at once, another verdict after the last round, by the same statuses.
    """

    SOLVED = 0
    SPENT = 1
    LIFTED = 2
    OPEN = 3
    FLOOR = 4
    STUCK = 5
    COARSE = 6


class Goal(NamedTuple):
    """What the cases (B,) of a mesh want: `rtol`; `before`, their error on the mesh before, inf on the first; `free`,
    bool, whether their mesh is chosen by rtol; `finer`, bool, whether a finer one may follow; `spent`, bool, whether
    their budget is."""

    rtol: np.ndarray
    before: np.ndarray
    free: np.ndarray
    finer: np.ndarray
    spent: np.ndarray


@batch.of_cases
class Answer(NamedTuple):
    """The solution of B cases, and what tells whether the punch lifts off and whether a finer mesh is of use.

    tension : (B,), the tensile part of the load over the load
    gap : (B,) bool, there is a gap inside the contact. Gap or tension may also mean a mesh that is too coarse
    verdict : (B,) int8, a :class:`Verdict`; COARSE where there is no goal
    finer : the state on the next finer mesh, with which that mesh begins
    """

    solution: Solution
    tension: np.ndarray
    gap: np.ndarray
    verdict: np.ndarray
    finer: Unknowns | None

    def lifted(self):
        """(B,) bool: there is tension, in all or in the centre, which is too large to be an error."""
        return is_tension(self.tension, self.solution.error) | tensile_centre(self.solution)


@lru_cache(maxsize=32)
def _between(mesh):
    """The polynomials of a mesh (n, m) at _DENSER times as many points, and the weights (m,) of ∫ · s ds there."""
    s, w = denser_rule(mesh)
    return mesh.basis(s).T, w * s


def denser_rule(mesh):
    """Points s and weights (m,) of ∫₀¹ · ds at which tension between the nodes of a mesh is looked for."""
    return gauss_rule(_DENSER * mesh.order, mesh.breaks)


def is_tension(tension, error):
    """(B,) bool: the tension is too large to be an error."""
    return tension > np.fmax(10 * error, _TENSION)


def may_be_error(tension, error):
    """(B,) bool: there is tension, and it may be no more than its error: a finer mesh will tell."""
    return (tension > _TENSION) & (tension <= 10 * error)


def tensile_centre(solution):
    """(B,) bool: p(0) < 0, and the error is too small to make it so. `solution` : what has p0 and error (B,)."""
    return (solution.p0 < 0) & (solution.error < _SURE)


def at_floor(error, slow, floor, rtol):
    """(B,) bool: the error is above rtol, and no mesh makes it smaller: it is that of the operator, `floor`. `slow` :
    it is hardly smaller than on the mesh before."""
    return (floor > rtol) & (error <= np.where(slow, _NOISE, 1.0) * floor)


def _verdicts(ev, closed, solution, tension, goal):
    """:class:`Verdict` (B,) of cases whose iterations are `closed` (B,) bool; `solution` : what has p0 and error."""
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
    """The :class:`Verdict` with which one case begins on panels, after its :class:`Answer` on meshes."""
    if answered.lifted()[0]:
        return Verdict.LIFTED
    return Verdict.COARSE if answered.solution.status[0] == Status.CONVERGED else Verdict.OPEN


def unfinished(verdict, spent):
    """The :class:`Verdict` of one case after a round of panels that has found nothing new; `spent` : whether the budget
    is. Tension that was there is there still."""
    return Verdict.SPENT if spent and verdict != Verdict.LIFTED else verdict


def after_panels(best, answered, floor, rtol, clear, spent):
    """The better one of the solution `best` and that of a round of panels, whose :class:`Answer` is `answered`; and the
    :class:`Verdict` after that round.

    Tension and gaps count only until panels have shown none, which they have if they are `clear`: panels that
    are too coarse show some that are not there. floor : (1,), the error of the operator; spent : whether the budget is
    """
    error = answered.solution.error
    if not clear and (answered.gap | answered.lifted())[0]:
        return best, Verdict.LIFTED
    if not answered.gap[0] and error[0] < np.nan_to_num(best.error[0], nan=np.inf):
        best = answered.solution
    converged = best.status[0] == Status.CONVERGED
    missed = converged and best.error[0] > rtol
    # True: finer panels hardly lower an error
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

    goal : :class:`Goal` of cases that may go on to a finer mesh: those that do get no profiles here. None: all end.

    A case without finite numbers is ``Status.DIVERGED`` and NaN.
    """
    ev, closed, count = iterated
    numbers = quantities(ev)
    refined = refine(ev, numbers)
    error = estimate(ev, numbers, refined)
    finite = np.isfinite(ev.residual) & np.isfinite(error)
    slope, size = refined.dP_dD, len(error)
    last = np.flatnonzero(~closed | ~goal.finer) if goal else np.arange(size)
    if len(last):  # cases that end on this mesh have dP/dD of this mesh, as their other numbers are
        at = ev.take(last)
        slope[last] = newton.stiffness(at, newton.tangent(at), numbers.P[last], numbers.D[last])
    gap, tension = ev.gap.max(axis=1) > _GAP, _tension(ev, finite)
    error = np.where(gap, np.maximum(error, 1.0), error)
    verdict, goes_on = np.full(size, Verdict.COARSE, dtype=np.int8), np.zeros(size, dtype=bool)
    if goal:
        judged = _Judged(numbers.p0, error)
        goes_on = finite & goal.finer & (_verdicts(ev, closed, judged, tension, goal) == Verdict.COARSE)
    done = np.flatnonzero(finite & ~goes_on)
    numbers.Ar_An[done], error[done] = completed(ev, numbers.Ar_An, error, done)
    if goal:
        fixed = ~goal.free & may_be_error(tension, error)  # no finer mesh will judge the tension: it is an error
        error = np.where(fixed, np.maximum(error, tension), error)
        verdict = _verdicts(ev, closed & finite, _Judged(numbers.p0, error), tension, goal)
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


class _Judged(NamedTuple):
    """p(0) and error (B,), by which the centre is judged."""

    p0: np.ndarray
    error: np.ndarray


def _tension(ev, finite):
    """The tensile part (B,) of the load over the load, of cases with `finite` numbers. There can be tension only where
    the equation is linear: without asperities."""
    if ev.cases.law.rough:
        return np.zeros(len(finite))
    basis, w = _between(ev.mesh)
    q = ev.curve.q @ basis
    return np.where(finite, np.maximum(-q, 0.0) @ w / np.abs(q @ w), 0.0)

"""What is said of B cases on a mesh: the solution with its error, its profiles, and whether the punch lifts off."""

from typing import NamedTuple

import numpy as np

from ..solution import Solution
from ..status import Status
from . import newton
from .equation import State, error_floor
from .error import area_error, estimate, refine
from .results import profiles, quantities

#: Where the error of a case is below this, p(0) < 0 is no error of the mesh.
_SURE = 0.1
#: A gap higher than this times a²/2, and tension of more than this part of the load, are no rounding.
_GAP, _TENSION = 1e-9, 1e-9


class Answer(NamedTuple):
    """The solution of B cases, and what tells whether the punch lifts off.

    tension : (B,) tensile part of the load over the load; gap : (B,) bool, whether there is a gap inside the contact.
    Either may also mean that the mesh does not resolve the pressure. finer : the state on the next finer mesh.
    """

    solution: Solution
    tension: np.ndarray
    gap: np.ndarray
    finer: State | None

    def take(self, index):
        """The sub-batch at `index`."""
        finer = None if self.finer is None else self.finer.take(index)
        return Answer(self.solution.take(index), self.tension[index], self.gap[index], finer)

    @property
    def lifted(self):
        """(B,) bool: there is tension, somewhere or in the centre, and it is larger than its error."""
        error = self.solution.error
        return (self.tension > np.fmax(10 * error, _TENSION)) | ((self.solution.p0 < 0) & (error < _SURE))

    @property
    def unsure(self):
        """(B,) bool: there is tension, and it may be no more than its error: a finer mesh will tell."""
        return (self.tension > _TENSION) & (self.tension <= 10 * self.solution.error)


def answer(iterated, x, enough=np.inf):
    """:class:`Answer` of an iteration, with profiles at the radii x (m,).

    A case goes on to a finer mesh, and gets no profiles, where it has closed and its error exceeds both `enough` (B,)
    and the least error that is possible. A case without finite numbers is ``Status.DIVERGED`` and NaN.
    """
    ev, closed, count = iterated
    own, refined = quantities(ev), refine(ev)
    error = estimate(ev, own, refined)
    finite = np.isfinite(ev.residual) & np.isfinite(error)
    enough = np.where(closed, enough, np.inf)
    slope, last = refined.dP_dD, np.flatnonzero(enough == np.inf)
    if len(last):  # of cases that stay on this mesh dP/dD is that of this mesh, as their other numbers are
        at = ev.take(last)
        slope[last] = newton.stiffness(at, newton.tangent(at), own.P[last], own.D[last])
    floor = error_floor(ev.cases.body, own.a, ev.mesh.n)
    done = np.flatnonzero(finite & (error <= np.maximum(enough, floor)))
    error[done] = np.maximum(error[done], area_error(ev, own.Ar_An, done))
    p, lam = np.full((2, len(error), len(x)), np.nan)
    p[done], lam[done] = profiles(ev, x, done)
    gap = ev.gap.max(axis=1) > _GAP
    error = np.where(gap, np.maximum(error, 1.0), error)
    status = np.where(closed, Status.CONVERGED, Status.ITERATION_LIMIT)
    rest = {"dP_dD": slope, "residual": ev.residual, "error": error, "p": p, "lam": lam, "status": status}
    ends = {"nodes": ev.mesh.n, "iterations": count}
    solution = Solution.of(len(error), len(x), **own._asdict(), **rest, **ends)
    # only where the equation is linear can there be tension
    q, w = ev.curve.q, ev.mesh.w
    tension = np.where(finite, np.maximum(-q, 0.0) @ np.abs(w) / np.abs(q @ w), 0.0)
    return Answer(solution.refused(~finite, Status.DIVERGED), tension, gap, refined.state)

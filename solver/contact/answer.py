"""What is said of B cases on a mesh: the solution with its error, its profiles, and whether the punch lifts off."""

from typing import NamedTuple

import numpy as np

from ..solution import Solution
from ..status import Status
from . import newton
from .equation import State, error_floor
from .error import area_error, estimate, refine
from .results import profiles, quantities

#: Error of p(0) below which its sign is sure, and height of a gap over a²/2 that is none of rounding.
_SURE, _GAP = 0.1, 1e-9
#: Share of tension in the load that is none of rounding.
_TENSION = 1e-9


class Answer(NamedTuple):
    """The solution of B cases; the share (B,) of tension in the load, and whether there is a gap (B,): the punch lifts
    off, or the mesh does not resolve the pressure; and the state on the next finer mesh."""

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
        """(B,) bool: the tension, or that in the centre, is more than an error."""
        error = self.solution.error
        return (self.tension > np.fmax(10 * error, _TENSION)) | ((self.solution.p0 < 0) & (error < _SURE))

    @property
    def unsure(self):
        """(B,) bool: there is tension that may be an error, or none: a finer mesh will tell."""
        return (self.tension > _TENSION) & (self.tension <= 10 * self.solution.error)


def answer(iterated, x, enough=np.inf):
    """:class:`Answer` of an iteration, with profiles at the radii x (m,).

    A case that has closed and whose error exceeds `enough` (B,), and the least that it can be, is not done: it goes on
    to a finer mesh, and gets no profiles. One without finite numbers is ``Status.DIVERGED`` and NaN.
    """
    ev, closed, count = iterated
    own, refined = quantities(ev), refine(ev)
    error = estimate(ev, own, refined)
    finite = np.isfinite(ev.residual) & np.isfinite(error)
    enough = np.where(closed, enough, np.inf)
    slope, last = refined.dP_dD, np.flatnonzero(enough == np.inf)
    if len(last):  # at the solution itself, which may be worse than the estimate by a margin
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

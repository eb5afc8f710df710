"""What an iteration on a mesh has found: the solution with its error and profiles, and whether the punch lifts off."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..numerics.mesh import gauss_rule
from ..solution import Solution
from ..status import Status
from . import newton
from .equation import State
from .error import completed, estimate, of_profiles, refine
from .results import profiles, quantities

#: A ring of tension may lie between two nodes: so the pressure is looked at in this many times as many points.
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


class Answer(NamedTuple):
    """The solution of B cases, and what tells whether the punch lifts off and whether a finer mesh is of use.

    tension : (B,), the tensile part of the load over the load; 0 where the edge pulls
    gap : (B,) bool, there is a gap inside the contact. Gap or tension may also mean a mesh that is too coarse
    slow : (B,) bool, the error is hardly smaller than on the mesh before
    floor : (B,), no mesh brings the error below this
    finer : the state on the next finer mesh, with which that mesh begins
    """

    solution: Solution
    tension: np.ndarray
    gap: np.ndarray
    slow: np.ndarray
    floor: np.ndarray
    finer: State | None

    def take(self, index):
        finer = None if self.finer is None else self.finer.take(index)
        return Answer(self.solution.take(index), *(values[index] for values in self[1:-1]), finer)

    def lifted(self, edge):
        """(B,) bool: there is tension, in all or in the centre, which is too large to be an error, though the `edge`
        does not pull."""
        return (self.tension > np.fmax(10 * self.solution.error, _TENSION)) | tensile_centre(self.solution, edge)

    @property
    def unsure(self):
        """(B,) bool: there is tension, and it may be no more than its error: a finer mesh will tell."""
        return (self.tension > _TENSION) & (self.tension <= 10 * self.solution.error)


@lru_cache(maxsize=32)
def _between(mesh):
    """The polynomials of a mesh (n, m) at _DENSER times as many points, and the weights (m,) of ∫ · s ds there."""
    s, w = gauss_rule(_DENSER * mesh.order, mesh.breaks)
    return mesh.basis(s).T, w * s


def tensile_centre(solution, edge):
    """(B,) bool: p(0) < 0, the error is too small to make it so, and the `edge` does not pull."""
    return (solution.p0 < 0) & (solution.error < _SURE) & (not edge.pulls)


def stuck(error, slow, nodes, rtol):
    """(B,) bool: finer meshes of one panel will hardly bring the error to rtol."""
    return slow & (nodes >= _LATE) & (error > _FAR * rtol)


def hopeless(error, slow, floor, rtol):
    """(B,) bool: the error is above rtol, and no mesh makes it smaller: it is that of the operator, `floor`."""
    return (floor > rtol) & (error <= np.where(slow, _NOISE, 1.0) * floor)


def answer(iterated, x, enough=np.inf, before=np.inf):
    """:class:`Answer` of an iteration, with profiles at the radii x (m,).

    A case will go on to a finer mesh, and gets no profiles here, if it has closed, its error is above `enough` (B,),
    and it is neither stuck nor hopeless. `before` (B,): its error on the mesh before. A case without finite numbers is
    ``Status.DIVERGED`` and NaN.
    """
    ev, closed, count = iterated
    own = quantities(ev)
    refined = refine(ev, own)
    error = estimate(ev, own, refined)
    finite = np.isfinite(ev.residual) & np.isfinite(error)
    enough = np.where(closed, enough, np.inf)
    slope, last = refined.dP_dD, np.flatnonzero(enough == np.inf)
    if len(last):  # cases that end on this mesh have dP/dD of this mesh, as their other numbers are
        at = ev.take(last)
        slope[last] = newton.stiffness(at, newton.tangent(at), own.P[last], own.D[last])
    slow = error > _FALLS * before
    useless = hopeless(error, slow, ev.floor, enough) | stuck(error, slow, ev.mesh.n, enough)
    done = np.flatnonzero(finite & (useless | (error <= enough)))
    own.Ar_An[done], error[done] = completed(ev, own.Ar_An, error, done)
    p, lam = np.full((2, len(error), len(x)), np.nan)
    p[done], lam[done] = profiles(ev, x, done)
    between = np.full(len(error), np.nan)
    between[done] = of_profiles(ev, refined, done)
    gap = ev.gap.max(axis=1) > _GAP
    error = np.where(gap, np.maximum(error, 1.0), error)
    status = np.where(closed, Status.CONVERGED, Status.ITERATION_LIMIT)
    errors = {"residual": ev.residual, "error": error, "profile_error": np.maximum(error, between)}
    rest = {"dP_dD": slope, "p": p, "lam": lam, "status": status, "nodes": ev.mesh.n, "iterations": count}
    solution = Solution.of(len(error), len(x), **own._asdict(), **errors, **rest)
    tension = np.zeros(len(error))
    # there can be tension only where the equation is linear: without asperities
    if not ev.cases.law.rough and not ev.cases.edge.pulls:
        basis, w = _between(ev.mesh)
        q = ev.curve.q @ basis
        tension = np.where(finite, np.maximum(-q, 0.0) @ w / np.abs(q @ w), 0.0)
    return Answer(solution.refused(~finite, Status.DIVERGED), tension, gap, slow, ev.floor, refined.end.state)

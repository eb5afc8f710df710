"""The paper's successive approximations, Eqs (8) and (10), at one contact radius; and a search for the radius of a
given load or depth.

They begin at p = 0. They end when |p̃ - p| is below rtol/10 of the largest pressure, or in a cycle (docs/solving.md).
On a finer mesh the first node is nearer to the edge, where A'(p) is larger, and a larger k is needed.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..body.operator import Operator
from ..numerics import batch
from ..numerics.bracket import false_position
from ..status import Status
from .equation import Cases, Unknowns, control_residual, evaluate, groups
from .newton import Iterated, iterate
from .start import guess_radius

#: Most successive approximations at one radius.
LIMIT = 1000
#: Most successive approximations of one case at all radii, four times LIMIT. Those at the last radius still run to
#: their end.
APPROXIMATIONS = 4_000
#: The load has settled when one more approximation changes it by less than this part of it.
_SETTLED = 1e-2
_TINY = np.finfo(float).tiny


@batch.of_cases
@dataclass(frozen=True, eq=False)
class Approximation:
    """B cases at the radii exp(eta), after `done` approximations.

    q : (B, n), the pressure
    change : (B,), the last |p̃ - p| over the largest pressure
    load_change : (B,), the last relative change of the load
    earlier : (B,), `change` after half of all approximations
    """

    cases: Cases
    operator: Operator
    eta: np.ndarray
    groups: tuple
    k: np.ndarray
    rtol: np.ndarray
    q: np.ndarray
    change: np.ndarray
    load_change: np.ndarray
    earlier: np.ndarray
    done: int = 0

    @property
    def closed(self):
        """(B,) bool: whether the pressure has settled."""
        return self.change < 0.1 * self.rtol

    @property
    def lost(self):
        """(B,) bool: whether the approximations have diverged."""
        return np.isnan(self.change)

    @property
    def G(self):
        """Residual of the control (B,), as :attr:`.equation.Evaluation.G`."""
        edge_q = np.einsum("bj,bj->b", self.operator.edge + 0 * self.q, self.q)
        return control_residual(self.cases, self.eta, self.groups[0], self.q, edge_q, self.operator.mesh)


def solve(cases, mesh, k, rtol, limit):
    """:class:`~solver.rough.newton.Iterated` by the paper's scheme, whose `at` is the equation at the end; and the
    status (B,).

    k, rtol : (B,) float, k >= 0; limit : int, most approximations at one radius; 0: LIMIT
    """
    size, limit = len(cases.value), min(limit or LIMIT, APPROXIMATIONS)
    count, last = np.zeros(size, dtype=int), [()] * size  # last: for each case the approximation at the latest radius

    def control_at(eta, index):
        iterated = approximate(cases.take(index), eta, mesh, k[index], rtol[index], limit)
        np.add.at(count, index, iterated.count)
        for row, i in enumerate(index.tolist()):
            last[i] = iterated.at.take([row])
        return np.where(count[index] < APPROXIMATIONS, iterated.at.G, np.nan)

    if cases.control == "a":
        control_at(np.log(cases.value), np.arange(size))
    else:
        false_position(control_at, np.log(guess_radius(cases)), 0.1 * rtol)
    at = batch.join(last, np.arange(size)[:, None], cases=cases)
    status = _status(at, np.abs(at.G), count >= APPROXIMATIONS)
    y = np.maximum(cases.law.from_pressure(at.q), _TINY)
    at = evaluate(cases, Unknowns(y, at.eta), mesh)
    return Iterated(at, status == Status.CONVERGED, count), status


def _status(at, missed, spent):
    """:class:`~solver.status.Status` (B,) of approximations; `missed` (B,) is the residual of the control, `spent` (B,)
    bool whether all APPROXIMATIONS have been made."""
    ends = {
        Status.DIVERGED: ~np.isfinite(at.q).all(axis=1),
        Status.CONVERGED: at.closed & (missed < at.rtol),
        Status.LIMIT_CYCLE: (at.change > 0.1 * at.earlier) & (at.load_change < _SETTLED) & (missed < _SETTLED),
    }
    return np.select(list(ends.values()), list(ends), np.where(spent, Status.BUDGET_SPENT, Status.ITERATION_LIMIT))


def approximate(cases, eta, mesh, k, rtol, limit):
    """:class:`~solver.rough.newton.Iterated` of successive approximations at the radii exp(eta) (B,) from p = 0.

    If they do not settle quickly, they amplify rounding. So the operator of each case is made as if the case were
    alone, and its numbers do not depend on the batch.
    """
    never, q = np.full(len(eta), np.inf), np.zeros((len(eta), mesh.n))
    alone = [cases.body.take([i]).at(np.exp(eta[i : i + 1]), mesh) for i in range(len(eta))]
    operator = batch.join(alone, np.arange(len(eta))[:, None])
    first = Approximation(cases, operator, eta, groups(cases, eta), k, rtol, q, never, never, never)
    return iterate(first, lambda now: _next(now, limit // 2), limit)


def _next(now, half):
    """The approximation after `now`. After `half` of all approximations, it stores the change as `earlier`."""
    q, k, cases = now.q, now.k, now.cases
    K, w = now.operator.K, now.operator.mesh.w
    Kq = np.matmul(K, q[..., None])[..., 0]
    drop = cases.punch.drop(np.exp(now.eta), now.operator.mesh.s)
    new = (_pressure(cases.law, now.groups, drop, q, Kq) + k[:, None] * q) / (1 + k[:, None])
    change = (1 + k) * np.abs(new - q).max(axis=1) / np.maximum(new.max(axis=1), _TINY)
    load_change = np.abs((q @ w) / (new @ w) - 1)
    earlier = now.change if now.done == half else now.earlier
    return replace(now, q=new, change=change, load_change=load_change, earlier=earlier, done=now.done + 1)


def _pressure(law, groups, drop, q, Kq):
    """p̃/p* (B, n), at least 0: by Eq. (8) where there are springs, else by Eq. (10)."""
    X, Y, Z = groups
    left, springs, by_springs, by_spots = drop - X * Kq, Y > 0, 0.0, 0.0
    if springs.any():
        by_springs = np.maximum((left - Z * law.evaluate(law.from_pressure(q)).g) / Y, 0.0)
    if not springs.all():
        by_spots = law.evaluate(law.from_displacement(np.maximum(left / Z, 0.0))).q
    return np.where(springs, by_springs, by_spots)

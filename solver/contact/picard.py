"""The paper's successive approximations, Eqs (8) and (10), and the load or depth by a search on the contact radius.

On a layer (C > 0), Eq. (8): p̂ = ((a² - r²)/(2R) - half-space part - A[p])/C, without a layer, Eq. (10): p̂ is the
pressure whose A is what the half-space part leaves; either is relaxed with the paper's k, p_new = (p̂ + k p)/(1 + k),
from p = 0, until |p̂ - p| is below rtol/10 of the largest pressure. The slope of A ~ p^β, β < 1, is infinite at the
edge, and where A'(p) > (1 + 2k) C the iterates of (8) end in a cycle of two: the pressure there never settles, the
load does to 3 to 4 digits. The finer the mesh, the nearer to the edge is its last node, and the more k it takes.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.bracket import false_position
from ..status import Status
from .budget import APPROXIMATIONS
from .equation import State, control_residual, groups, guess_radius, operate

#: Successive approximations at one radius.
LIMIT = 1000
#: The load has settled when one more approximation changes it by less than this.
_SETTLED = 1e-2


_TINY = np.finfo(float).tiny


class Fixed(NamedTuple):
    """At given radii: q (B, n); last |p̂ - p|, change of the load, count, |p̂ - p| half-way, and edge q, all (B,)."""

    q: np.ndarray
    change: np.ndarray
    load_change: np.ndarray
    count: np.ndarray
    earlier: np.ndarray
    edge_q: np.ndarray


def solve(cases, mesh, k, rtol, limit, search=false_position, follow=False, budget=0):
    """State, status (B,) and total number of approximations (B,) of :class:`.equation.Cases` by the paper's scheme.

    k, rtol : (B,) float, k >= 0; limit : int, approximations at one radius (0: LIMIT); search : of numerics/bracket.py;
    follow : begin at each radius with the pressure found at the one before, not with p = 0, and multiply all cases at
    once (their rounding then depends on their number); budget : most approximations of a case at all radii but
    the last (0: APPROXIMATIONS).
    """
    eta, count = np.log(cases.value), np.zeros(len(cases.value), dtype=int)
    q = np.zeros((len(eta), mesh.n)) if follow else None
    budget = budget or APPROXIMATIONS
    limit = min(limit or LIMIT, budget)
    if cases.control != "a":
        eta = _search(search, cases, mesh, k, rtol, limit, count, q, budget)
    fixed = approximate(cases, eta, mesh, k, rtol, limit, q)
    missed = np.abs(_control(cases, eta, fixed, mesh))
    with np.errstate(invalid="ignore"):
        status = np.select(
            [
                ~np.isfinite(fixed.q).all(axis=1),
                (fixed.change < 0.1 * rtol) & (missed < rtol),
                (fixed.change > 0.1 * fixed.earlier) & (fixed.load_change < _SETTLED) & (missed < _SETTLED),
            ],
            [Status.DIVERGED, Status.CONVERGED, Status.LIMIT_CYCLE],
            np.where(count + fixed.count >= budget, Status.BUDGET_SPENT, Status.ITERATION_LIMIT),
        )
    y = cases.law.from_pressure(fixed.q)
    return State(np.maximum(y, _TINY), eta), status, count + fixed.count


def approximate(cases, eta, mesh, k, rtol, limit, start=None):
    """Successive approximations at the radii exp(eta) (B,) from `start` (B, n), or from p = 0: finished cases leave
    the batch.

    They amplify rounding where they do not settle quickly, so that all of a case is computed as if it were alone.
    """
    size = len(eta)
    q = np.zeros((size, mesh.n)) if start is None else start.copy()
    change, load_change = np.full(size, np.inf), np.full(size, np.inf)
    count, earlier = np.zeros(size, dtype=int), np.full(size, np.inf)
    active = np.arange(size)
    XYZ, K, edge = groups(cases, eta), *_operator(cases, eta, mesh)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for step in range(limit):
            if step == limit // 2:
                earlier = change.copy()
            now = q[active]
            Kq = now @ K[0].T if start is not None and len(K) == 1 else _each(K if len(K) == 1 else K[active], now)
            new = _next(now, Kq, cases.take(active), [v[active] for v in XYZ], mesh, k[active])
            change[active] = (1 + k[active]) * np.abs(new - q[active]).max(axis=1) / np.maximum(new.max(axis=1), _TINY)
            load_change[active] = np.abs((q[active] @ mesh.w) / (new @ mesh.w) - 1)
            q[active] = new
            count[active] += 1
            active = active[change[active] >= 0.1 * rtol[active]]  # NaN leaves as well: it has diverged
            if not len(active):
                break
    return Fixed(q, change, load_change, count, earlier, np.einsum("bj,bj->b", edge + 0 * q, q))


def _operator(cases, eta, mesh):
    """K (B or 1, n, n) and the row (B or 1, n) of the edge; of layers one by one."""
    if cases.layer is None or not len(eta):
        return mesh.K[None], mesh.edge[None]
    none = np.zeros((1, mesh.n))
    alone = [operate(cases.take([i]), eta[i : i + 1], none, mesh) for i in range(len(eta))]
    return np.concatenate([base.matrix(mesh) for base in alone]), np.concatenate([base.edge(mesh) for base in alone])


def _each(K, q):
    """Products (B, n) of K (B or 1, n, n) and q (B, n), one by one."""
    return np.matmul(K, q[..., None])[..., 0]


def _next(q, Kq, cases, XYZ, mesh, k):
    law, (X, Y, Z) = cases.law, XYZ
    left = mesh.s**2 - X * Kq
    springs, by_layer, by_spots = (cases.C > 0)[:, None], 0.0, 0.0
    if springs.any():
        y = law.from_pressure(q)
        by_layer = np.maximum((left - Z * law.evaluate(y).g) / Y, 0.0)
    if not springs.all():
        y = law.from_displacement(np.maximum(left / Z, 0.0))
        by_spots = law.evaluate(y).q
    target = np.where(springs, by_layer, by_spots)
    return (target + k[:, None] * q) / (1 + k[:, None])


def _search(search, cases, mesh, k, rtol, limit, count, q, budget):
    """ln a (B,) for the load or depth; adds the approximations to `count` (B,), and keeps the last ones in q (B, n),
    where the next radius begins, if it is given. A case that has spent its budget is given up where it is."""

    def evaluate(eta, index):
        part = cases.take(index)
        fixed = approximate(part, eta, mesh, k[index], rtol[index], limit, None if q is None else q[index])
        count[index] += fixed.count
        if q is not None:
            q[index] = np.where((fixed.change < 0.1 * rtol[index])[:, None], fixed.q, 0.0)  # no cycle is handed on
        return np.where(count[index] < budget, _control(part, eta, fixed, mesh), np.nan)

    with np.errstate(all="ignore"):
        return search(evaluate, np.log(guess_radius(cases)), 0.1 * rtol)[0]


def _control(cases, eta, fixed, mesh):
    """Logarithm of (load or depth/given value) (B,)."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return control_residual(cases, eta, groups(cases, eta)[0], fixed.q, fixed.edge_q, mesh)

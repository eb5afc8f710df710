"""Rough contacts of flat punches: Newton's method on q at the nodes and ln τ, where τ a²/2 is the displacement of the
asperities at the edge. Each case has panels of its own, which shrink towards the edge and are halved where its pressure
needs it.

The profile is 0, and the pressure does not vanish at the edge. As everywhere, the displacement is relative to that of
the edge. The equation at all nodes is

    X K[q] + Z g = τ,       D = (a²/2) (τ + X edge @ q),

like that of a punch whose drop is τ. Here τ is unknown and a is given; under other punches a is unknown and the drop is
given.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..numerics.caches import once
from ..numerics.ladder import MARGIN, finer_mesh
from ..numerics.linalg import solve_stack
from ..numerics.mesh import mesh_of, panel_mesh
from ..shapes.shape import Shape
from ..solution import Solution
from ..status import Status
from . import newton
from .equation import Evaluation, Unknowns, control_gradient, evaluate, groups
from .error import completed
from .panels import GOALS, ORDER, resolve
from .results import interpolate, judged_difference, profiles, quantities

#: Most steps on a mesh, and the residual, over 2D/a², at which only rounding is left. It is not over τ: τ is far less
#: than the displacement where asperities are stiff. Under laws that are tables, the residual stays larger near the
#: edge, where the pressure grows without bound. Up to _STALLED this is accepted, and counts as a part of the error.
LIMIT, _CLOSED, _STALLED = 60, 1e-13, 1e-7
#: Ends in s of the first panels.
_START = (0.0, *(0.4**k for k in range(7, 0, -1)), 0.7, 1.0)
#: A gap higher than this times a²/2 is real, not rounding, as in :mod:`.answer`.
_GAP = 1e-9
#: Rounding error of the answers, for each node.
_ROUNDING, _TINY = 4 * np.finfo(float).eps, np.finfo(float).tiny


@batch.of_cases
class AsFlat(NamedTuple):
    """A flat `shape` as a :class:`~solver.rough.punch.Punch` whose drop is `tau` (B,) at any radius. It has no first
    guesses of the radius, which is known."""

    tau: np.ndarray
    shape: Shape

    polynomial = True

    @property
    def pointed(self):
        return self.shape.pointed

    @property
    def even(self):
        return self.shape.even

    def kinks(self):
        return self.shape.kinks()

    def least(self):
        return self.shape.least()

    def most(self):
        return self.shape.most()

    def drop(self, a, s):
        return self.tau[:, None] + 0 * s

    def drop_slope(self, a, s):
        return 0.0

    def depth(self, a):
        return self.tau

    def depth_slope(self, a):
        return 0.0


def first_guess(case, a, mesh):
    """The first :class:`~solver.rough.equation.Evaluation` of one `case`, at the radius a (1,): 1/q is the sum of the
    1/q of a smooth punch and of asperities alone."""
    eta, softness, s = np.log(a), case.body.softness(a), mesh.s
    X, _, Z = groups(case, eta)
    value = case.value[:, None]
    if case.control == "P":
        mean = value / (np.pi * a**2 * case.law.p_star)[:, None]
        q = mean / (2 * np.maximum(s, 0.3))
    else:
        smooth = (case.body.E / (np.pi * softness * a * case.law.p_star))[:, None] * value / s
        q = 1 / (1 / smooth + 1 / case.law.sparse(2 * value / a**2 / Z))
    y = case.law.guess(q)
    tau = (Z * case.law.evaluate(y).g)[:, 0]
    return evaluate(case._replace(shape=AsFlat(tau, case.shape)), Unknowns(y, eta), mesh)


def tangent(ev):
    """dq/d ln τ (1, n), and the derivatives of ln P and ln D along the branch."""
    along = _linear(ev, (ev.drop / ev.X)[..., None])[..., 0]
    slopes = [(control_gradient(name, ev)[0] * along).sum(axis=1) + explicit(name, ev) for name in ("P", "D")]
    return along, *slopes


def explicit(control, ev):
    """Derivative (1,) of the logarithm of `control` by ln τ at fixed q."""
    tau = ev.cases.shape.tau
    return tau / (tau + ev.X[:, 0] * ev.edge_q) if control == "D" else 0 * tau


def _linear(ev, right):
    diagonal = (ev.Y + ev.Z * (ev.curve.dg / ev.curve.dq)) / ev.X
    return solve_stack(ev.operator.K, diagonal, right)


def residual_of(ev):
    """The larger residual (1,) of two: that of the equation, over 2D/a², except where asperities hang over the surface,
    and that of the control."""
    scale = ev.cases.shape.tau + np.abs(ev.X[:, 0] * ev.edge_q)
    return np.maximum(np.where(ev.gap > 0, 0.0, np.abs(ev.F)).max(axis=1) / scale, np.abs(ev.G))


@batch.of_cases
@dataclass(frozen=True, eq=False)
class FlatStep:
    """The equation `ev` at one step of the iteration, and its residual at the step before."""

    ev: Evaluation
    before: np.ndarray

    @property
    def cases(self):
        return self.ev.cases

    @once
    def residual(self):
        return residual_of(self.ev)

    @property
    def closed(self):
        """(1,) bool: whether the residual is rounding, or is far below any rtol and no longer falls."""
        return (self.residual < _CLOSED) | (self.before / 2 <= self.residual) & (self.residual < _STALLED)

    @property
    def lost(self):
        return ~np.isfinite(self.residual)


def step(now):
    """The next :class:`FlatStep` after `now`."""
    ev = now.ev
    both = _linear(ev, np.stack([ev.drop / ev.X, -ev.F / ev.X], axis=-1))
    along, dq = both[..., 0], both[..., 1]
    by_q, _ = control_gradient(ev.cases.control, ev)
    growth = explicit(ev.cases.control, ev) + (by_q * along).sum(axis=1)
    d_tau = np.clip(-(ev.G + (by_q * dq).sum(axis=1)) / growth, -1.0, 1.0)
    y = ev.state.y + (dq + along * d_tau[:, None]) / ev.curve.dq
    cases = ev.cases._replace(shape=AsFlat(ev.cases.shape.tau * np.exp(d_tau), ev.cases.shape.shape))
    state = Unknowns(cases.law.limit(y, ev.state.y), ev.state.eta)
    return FlatStep(evaluate(cases, state, ev.mesh, ev.operator), now.residual)


def iterate(ev, limit):
    """The equation at the end, the number of steps, and whether the iteration has closed."""
    iterated = newton.iterate(FlatStep(ev, np.full(1, np.inf)), step, limit)
    return iterated.at.ev, int(iterated.count[0]), bool(iterated.closed[0])


def on_mesh(ev, mesh, y):
    """The equation of `ev` on another mesh, with y (1, n) at its nodes."""
    return evaluate(ev.cases, Unknowns(y, ev.state.eta), mesh)


def solve_flat(cases, rtol, nodes, limit, x):
    """:class:`~solver.solution.Solution` of rough flat punches; arguments as in
    :func:`~solver.rough.adaptive.solve_newton`. The control is P or D."""
    size = len(rtol)
    pieces = [([i], _solve_one(cases.take([i]), float(rtol[i]), int(nodes[i]), limit, x)) for i in range(size)]
    return Solution.join(size, len(x), pieces)


def _solve_one(case, rtol, nodes, limit, x):
    a, limit = case.shape.least(), limit or LIMIT
    mesh = mesh_of(nodes) if nodes else panel_mesh(ORDER, _START)
    ev, count, closed = iterate(first_guess(case, a, mesh), limit)
    work, spent = case.body.work(a, mesh.n)[0][0], False
    for goal in () if nodes else np.maximum(max(rtol, case.body.error(a, ORDER)[0]), GOALS).tolist():
        if not closed:
            break
        breaks, y = resolve(ev, goal)
        if breaks == ev.mesh.breaks:
            continue
        more = ORDER * (len(breaks) - 1)
        work += case.body.work(a, more)[0][0]
        if work + case.body.work(a, more + more // 3)[0][0] > newton.BUDGET:
            spent = True
            break
        ev, steps, closed = iterate(on_mesh(ev, panel_mesh(ORDER, breaks), y), limit)
        count += steps
    return _answer(ev, count, closed, spent, rtol, x)


def _answer(ev, count, closed, spent, rtol, x):
    """:class:`~solver.solution.Solution` of one case, with its error from a finer mesh if the iteration has closed."""
    size, a = (1, len(x)), np.exp(ev.state.eta)
    if not closed:
        lost = not np.isfinite(residual_of(ev)[0])
        return Solution.of(*size, status=Status.DIVERGED if lost else Status.ITERATION_LIMIT)
    mesh = finer_mesh(ev.mesh)
    fine, _, _ = iterate(on_mesh(ev, mesh, interpolate(ev, mesh.s)), LIMIT)
    numbers, _, of_load, of_depth = quantities(ev), *tangent(ev)
    error = MARGIN * (judged_difference(ev.cases, numbers, quantities(fine)) + residual_of(ev) + residual_of(fine))
    error = np.maximum(error, np.maximum(_ROUNDING * ev.mesh.n, ev.cases.body.error(a, ev.mesh.n)))
    area, error = completed(ev, numbers.Ar_An, error, np.array([0]))
    p, lam = _profiles(ev, x)
    finer_p, finer_lam = _profiles(fine, x)
    between = MARGIN * max(_change(p, finer_p), _change(lam, finer_lam)) if len(x) else 0.0
    status = Status.CONVERGED if error[0] <= rtol else Status.TOLERANCE_NOT_MET
    if spent and status == Status.TOLERANCE_NOT_MET:
        status = Status.BUDGET_SPENT
    rest = {"dP_dD": numbers.P * of_load / (numbers.D * of_depth), "residual": residual_of(ev), "error": error}
    rest |= {"profile_error": np.maximum(error, between), "nodes": ev.mesh.n, "iterations": count, "status": status}
    solution = Solution.of(*size, **(numbers._asdict() | {"Ar_An": area}), p=p, lam=lam, **rest)
    gap = (ev.gap.max(axis=1) > _GAP) & (fine.gap.max(axis=1) > _GAP)
    return solution.refused(~np.isfinite(error), Status.DIVERGED).refused(gap, Status.LIFT_OFF)


def _change(values, finer):
    there = np.isfinite(finer)
    return np.abs(values - finer)[there].max(initial=0.0) / np.abs(finer[there]).max(initial=_TINY)


def _profiles(ev, x):
    """p and λ (1, m) at the radii x (m,). At the edge the displacement of the asperities is τ, and so there is a
    pressure. If the asperities cannot be displaced so far, it is infinite, as under a smooth punch."""
    p, lam = profiles(ev, x, np.array([0]))
    at_edge, law = x == 1, ev.cases.law
    if at_edge.any():
        y = law.from_displacement(ev.cases.shape.tau[:, None] / ev.Z)
        q = law.evaluate(y).q
        full = ~np.isfinite(q)
        p[:, at_edge] = law.p_star[:, None] * np.where(full, np.inf, q)
        lam[:, at_edge] = np.where(full, 1.0, law.area(y, q))
    return p, lam

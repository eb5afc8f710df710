"""Newton's method under a flat punch of radius a: on q at the nodes and ln τ, where τ a²/2 is how far asperities yield
at the edge.

The profile is 0, and the pressure does not vanish at the edge. With the displacement taken relative to that of the
edge, as everywhere, the equation at all nodes is

    X K[q] + Z g = τ,       D = (a²/2) (τ + X edge @ q),

that of a punch whose drop is τ. Here τ is unknown and a is given: elsewhere it is the other way round.
"""

from typing import NamedTuple

import numpy as np

from ..contact.equation import State, control_gradient, evaluate, groups
from ..numerics import batch
from ..numerics.linalg import solve_stack
from ..shapes.shape import Shape

#: Most steps on a mesh, and the residual, over 2D/a², at which only rounding is left. It is not over τ, which is far
#: less than the displacement where asperities hardly yield. Under laws that are tables the residual stays higher, next
#: to the edge, where the pressure grows without bound; up to _STALLED that is let pass, as a part of the error.
LIMIT, _CLOSED, _STALLED = 60, 1e-13, 1e-7


class AsFlat(NamedTuple):
    """The :class:`~solver.contact.punch.Punch` of a flat `shape` whose drop is `tau` (B,) at any radius. It needs no
    first guess."""

    tau: np.ndarray
    shape: Shape

    polynomial = True

    take = batch.take

    def drop(self, a, s):
        return self.tau[:, None] + 0 * s

    def drop_slope(self, a, s):
        return 0.0

    def depth(self, a):
        return self.tau

    def depth_slope(self, a):
        return 0.0


def first_guess(case, a, mesh):
    """:class:`~solver.contact.equation.Evaluation` of one `case` to begin with, at the radius a (1,): 1/q is the sum of
    the 1/q of a smooth punch and of asperities alone."""
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
    return evaluate(case._replace(punch=AsFlat(tau, case.shape)), State(y, eta), mesh)


def tangent(ev):
    """dq/d ln τ (1, n), and the derivatives of ln P and ln D along the branch."""
    along = _solved(ev, (ev.drop / ev.X)[..., None])[..., 0]
    slopes = [(control_gradient(name, ev)[0] * along).sum(axis=1) + explicit(name, ev) for name in ("P", "D")]
    return along, *slopes


def explicit(control, ev):
    """Derivative (1,) of the logarithm of `control` by ln τ at fixed q."""
    tau = ev.cases.punch.tau
    return tau / (tau + ev.X[:, 0] * ev.edge_q) if control == "D" else 0 * tau


def _solved(ev, right):
    diagonal = (ev.Y + ev.Z * (ev.curve.dg / ev.curve.dq)) / ev.X
    return solve_stack(ev.operator.K, diagonal, right)


def misses(ev):
    """Largest residual (1,): of the equation over 2D/a², where asperities do not hang over the surface, and of the
    control."""
    scale = ev.cases.punch.tau + np.abs(ev.X[:, 0] * ev.edge_q)
    return np.maximum(np.where(ev.gap > 0, 0.0, np.abs(ev.F)).max(axis=1) / scale, np.abs(ev.G))


def step(ev):
    """The equation after one step from `ev`."""
    both = _solved(ev, np.stack([ev.drop / ev.X, -ev.F / ev.X], axis=-1))
    along, dq = both[..., 0], both[..., 1]
    by_q, _ = control_gradient(ev.cases.control, ev)
    growth = explicit(ev.cases.control, ev) + (by_q * along).sum(axis=1)
    d_tau = np.clip(-(ev.G + (by_q * dq).sum(axis=1)) / growth, -1.0, 1.0)
    y = ev.state.y + (dq + along * d_tau[:, None]) / ev.curve.dq
    cases = ev.cases._replace(punch=AsFlat(ev.cases.punch.tau * np.exp(d_tau), ev.cases.shape))
    return evaluate(cases, State(cases.law.limit(y, ev.state.y), ev.state.eta), ev.mesh, ev.operator)


def iterate(ev, limit):
    """The equation at the end, how many steps that took, and whether it has closed: only rounding is left, or what is
    left, far below any rtol, does not fall any more."""
    best = np.inf
    for count in range(limit + 1):
        missed = misses(ev)[0]
        closed = missed < _CLOSED or best / 2 <= missed < _STALLED
        if closed or count == limit or not np.isfinite(missed):
            break
        best, ev = missed, step(ev)
    return ev, count, bool(closed)


def on_mesh(ev, mesh, y):
    """The equation of `ev` on another mesh, with y (1, n) at its nodes."""
    return evaluate(ev.cases, State(y, ev.state.eta), mesh)

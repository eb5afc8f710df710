"""The discrete equation of a batch of cases of one micro law on one body: its groups X, Y, Z, its residual and its
derivatives.

With p = p* q(y), A = A* g(y), x = r/a and s = sqrt(1 - x²), Eq. (4) divided by a²/2 is

    X K[q] + Y q + Z g - s² = 0,    X = 8 p*/(π a E),  Y = 2 C p*/a²,  Z = 2 A*/a²        (R = E2* = 1)

at the nodes of the mesh. Under a punch of another shape its drop replaces s² (:mod:`.punch`). The control (load, radius
or depth) is one more equation. The unknowns are y at the nodes and η = ln a. E, the compliance C of springs and K
belong to the body (:mod:`..body.operator`); p*, A*, q and g belong to the law (:mod:`..laws.law`). At the edge of the
contact q is 0.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..body.operator import Body, Operator
from ..laws import Bound, Curve
from ..numerics import batch
from ..numerics.caches import once
from ..shapes.shape import Shape, has_radius
from .punch import largest, punch_of

#: A pressure below this part of the largest counts as 0.
_NOTHING = 1e-16
#: An iteration has closed, that is, found its solution, when the residual is below _CLOSED, or below _OF_OPERATOR times
#: the error of the operator, or no larger than the rounding error on a soft layer.
_CLOSED, _OF_OPERATOR = 1e-13, 1e-2
#: A residual above this is too large for any operator: the iteration has not closed, and the error of the operator need
#: not be computed. It is far above the residual that closes an iteration with the worst operator
#: (tests/rough/extremes/test_extremes.py).
_OPEN = 1e-5
#: Rounding error of the residual on a soft layer, times its softness. In its operator the terms of the half-space and
#: of L - 1 nearly cancel. The softer the layer, the more rounding moves the pressure, and so the load. The residual
#: scatters from step to step: half of them are below 0.5 eps, few above 20 eps (tests/rough/test_equation.py).
_ROUNDING = 20 * np.finfo(float).eps
#: Rounding error of the residual near a flat end of radius b of the punch, times (a - b)/a: the height of the edge
#: depends on a - b, and the unknown is ln a. With a frustum of b = 0.012 and a/(a - b) = 1100 the residual scatters by
#: 2.5e-13, which is 1 eps times 1100.
_OF_RADIUS = 16 * np.finfo(float).eps
#: The paper's scheme may leave no pressure in the centre; 0/0 is then no error.
_TINY = np.finfo(float).tiny


@batch.of_cases
class Cases(NamedTuple):
    """A batch of B cases of one kind of body, micro law and shape in units R = 1, E2* = 1.

    control : "P", "a" or "D", the same for the whole batch
    law, body, shape : each with its numbers
    value : (B,), the value of the control
    """

    control: str
    law: Bound
    body: Body
    value: np.ndarray
    shape: Shape

    @property
    def punch(self):
        """The :class:`.punch.Punch` of the shape."""
        return punch_of(self.shape)

    @property
    def is_flat(self):
        """Whether the contact radius is that of the punch under any load."""
        return bool(has_radius(self.shape).all())


@batch.of_cases
class Unknowns(NamedTuple):
    """The unknowns: y (B, n) of the micro law at the nodes, and η = ln a (B,)."""

    y: np.ndarray
    eta: np.ndarray


@batch.of_cases
@dataclass(frozen=True, eq=False)
class Evaluation:
    """The equation of `cases` at a state.

    operator, curve : of the body and of the law at this state
    X, Y, Z : (B, 1), groups
    Kq, F : (B, n), K q and the residual at the nodes
    edge_q : (B,), edge @ q
    """

    cases: Cases
    state: Unknowns
    operator: Operator
    curve: Curve
    X: np.ndarray
    Y: np.ndarray
    Z: np.ndarray
    Kq: np.ndarray
    edge_q: np.ndarray
    F: np.ndarray

    @property
    def mesh(self):
        return self.operator.mesh

    @once
    def G(self):
        """Residual of the control, (B,): the logarithm of the controlled quantity over its given value. The load is by
        Eq. (5), the depth by Eq. (3) at r = a."""
        return control_residual(self.cases, self.state.eta, self.X, self.curve.q, self.edge_q, self.mesh)

    @once
    def drop(self):
        """Right-hand side of the equation at the nodes, (B or 1, n)."""
        return self.cases.punch.drop(np.exp(self.state.eta), self.mesh.s)

    @once
    def slopes(self):
        """Derivatives of K q (B, n) and edge @ q (B,) by η at fixed q."""
        return self.operator.slopes(self.curve.q)

    @once
    def gap(self):
        """(B, n): height of the asperities above the surface, over a²/2, where they bear no pressure because the
        pressure around them pushes the surface away; else 0."""
        q = self.curve.q
        if q.min(initial=np.inf) > _NOTHING * q.max(initial=0.0):  # a quick test, which most batches pass
            return np.zeros(q.shape)
        bare = (q >= 0) & (q < _NOTHING * q.max(axis=1, keepdims=True))
        return np.where(bare, np.maximum(self.F - self.Z * self.curve.g, 0.0), 0.0)

    @once
    def residual(self):
        """The larger residual (B,) of two: that of the equation, over the largest right-hand side, and that of the
        control. The equation need not hold where asperities hang over the surface without pressure."""
        F = np.abs(self.F)
        F[self.gap > 0] = 0.0
        return np.maximum(F.max(axis=1) / largest(self.cases.punch, np.exp(self.state.eta)), np.abs(self.G))

    @once
    def floor(self):
        """The lower bound (B,) of any estimated error: the error of the operator itself, and rounding, which may be
        large in a small p(0) under a plate."""
        q = self.curve.q
        rounded = self.cases.body.rounding() * q.max(axis=1)
        centre = rounded / np.maximum(np.abs(q[:, -1]), np.maximum(rounded, _TINY))
        body, a = self.cases.body, np.exp(self.state.eta)
        return np.maximum(np.maximum(_floor(body, a, self.mesh.n), centre), _near_flat(self.cases, a))

    @property
    def closed(self):
        """(B,) bool: whether the residual is so small that only rounding and the error of the operator are left."""
        closed = self.residual < _CLOSED
        near = np.flatnonzero(~closed & (self.residual < _OPEN))
        if len(near):
            body, a = self.cases.body.take(near), np.exp(self.state.eta[near])
            least = np.maximum(_OF_OPERATOR * _floor(body, a, self.mesh.n), _ROUNDING / body.softness(a))
            closed[near] = self.residual[near] < np.maximum(least, _near_flat(self.cases.take(near), a))
        return closed

    @property
    def lost(self):
        return ~np.isfinite(self.residual)


def _floor(body, a, nodes):
    return np.maximum(4 * nodes * np.finfo(float).eps, body.error(a, nodes))


def _near_flat(cases, a):
    """Rounding error (B,) of the height of the edge of a contact of radius a (B,) near a flat end of the punch; 0 for a
    punch without one."""
    if cases.is_flat:
        return np.zeros(len(a))
    b = cases.shape.least()
    return np.where(b > 0, _OF_RADIUS * a / (a - b), 0.0)


def groups(cases, eta):
    """X, Y, Z (B, 1) at η = ln a (B,)."""
    a, p_star = np.exp(eta), cases.law.p_star
    X = (8 / np.pi) * p_star / (a * cases.body.E)
    return X[:, None], (2 * cases.body.C * p_star / a**2)[:, None], (2 * cases.law.A_star / a**2)[:, None]


def evaluate(cases, state, mesh, near=None, curve=None):
    """:class:`Evaluation` of `cases` at `state`. `near`: their operator at another state or on another mesh, from which
    everything that is still valid is reused. `curve`: that of their law at `state`, if it has been computed."""
    return evaluate_with(cases.body.at(np.exp(state.eta), mesh, near), cases, state, curve)


def evaluate_with(operator, cases, state, curve=None):
    """:class:`Evaluation` of `cases` at `state`, at which their `operator` is known; `curve` as above."""
    X, Y, Z = groups(cases, state.eta)
    curve, a = cases.law.evaluate(state.y) if curve is None else curve, np.exp(state.eta)
    Kq, edge_q = operator.products(curve.q)
    F = X * Kq + Y * curve.q + Z * curve.g - cases.punch.drop(a, operator.mesh.s)
    return Evaluation(cases, state, operator, curve, X, Y, Z, Kq, edge_q, F)


def control_residual(cases, eta, X, q, edge_q, mesh):
    """:attr:`Evaluation.G` (B,) at η (B,) for X (B, 1), q (B, n) and edge @ q (B,)."""
    if cases.control == "a":
        return eta - np.log(cases.value)
    if cases.control == "P":
        load = np.einsum("bj,j->b", q, mesh.w)  # not BLAS, whose rounding would depend on the number of cases
        return np.log(2 * np.pi * cases.law.p_star * load / cases.value) + 2 * eta
    depth = cases.punch.depth(np.exp(eta)) + X[:, 0] * edge_q
    return np.log(depth / (2 * cases.value)) + 2 * eta


def control_gradient(control, ev):
    """Derivatives of the logarithm of `control` by q (B, n) and by η (B,)."""
    q, X, w, a = ev.curve.q, ev.X[:, 0], ev.mesh.w, np.exp(ev.state.eta)
    if control == "P":
        return w / (q @ w)[:, None], np.full(len(q), 2.0)
    if control == "a":
        return np.zeros_like(q), np.ones(len(q))
    edge, punch = X * ev.edge_q, ev.cases.punch
    depth, slope = punch.depth(a) + edge, punch.depth_slope(a) + X * ev.slopes[1] - edge
    return ev.X * ev.operator.edge / depth[:, None], 2 + slope / depth


def jacobian(ev):
    """d (B, n) in dF/dq = X (K + diag(d)) at fixed η; and dF/dη over X, (B, n), at fixed q. The derivatives are by q
    and not by y, because the operator is linear in q."""
    diagonal = ev.Y + ev.Z * (ev.curve.dg / ev.curve.dq)
    drop_slope = ev.cases.punch.drop_slope(np.exp(ev.state.eta), ev.mesh.s)
    dF_deta = ev.slopes[0] - ev.Kq - 2 * (ev.Y * ev.curve.q + ev.Z * ev.curve.g) / ev.X - drop_slope / ev.X
    return diagonal / ev.X, dF_deta

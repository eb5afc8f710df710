"""Newton's method on (q at the nodes, ln a), with the control as one more equation."""

import numpy as np

from ..numerics.linalg import solve_stack
from ..punches.shaped import kept_within
from .equation import State, control_gradient, evaluate, jacobian

#: Most steps on a mesh, where nothing else is said.
LIMIT = 60


def tangent(ev):
    """dq/dη (B, n) along the branch of solutions."""
    diagonal, dF_deta = jacobian(ev)
    return solve_stack(ev.operator.K, diagonal, -dF_deta[..., None])[..., 0]


def advance(ev):
    """The :class:`State` one step from that of `ev`, and dq/dη (B, n) along the branch of solutions.

    The step is taken in y: q is nearly a power of y, and g nearly its square. A step changes y by a factor of five at
    most, and the radius by a factor of e at most. From the first guess of :mod:`.start` it needs no line search.
    """
    diagonal, dF_deta = jacobian(ev)
    solution = solve_stack(ev.operator.K, diagonal, np.stack([-dF_deta, -ev.F / ev.X], axis=-1))
    dq_deta, dq = solution[..., 0], solution[..., 1]
    by_q, by_eta = control_gradient(ev.cases.control, ev)
    d_eta = -(ev.G + (by_q * dq).sum(axis=1)) / (by_eta + (by_q * dq_deta).sum(axis=1))
    d_eta = np.clip(d_eta, -1.0, 1.0)
    dy = (dq + dq_deta * d_eta[:, None]) / ev.curve.dq
    y = ev.cases.law.limit(ev.state.y + dy, ev.state.y)
    eta, shape = ev.state.eta + d_eta, ev.cases.shape
    return State(y, eta if shape is None else kept_within(shape, eta, ev.state.eta)), dq_deta


def step(ev):
    state, _ = advance(ev)
    return evaluate(ev.cases, state, ev.mesh, ev.operator)


def stiffness(ev, dq_deta, P, D):
    """Contact stiffness dP/dD (B,) in E2* R at the load P and depth D (B,), from dq/dη (B, n) along the branch."""

    def slope(control):
        by_q, by_eta = control_gradient(control, ev)
        return (by_q * dq_deta).sum(axis=1) + by_eta

    return P * slope("P") / (D * slope("D"))

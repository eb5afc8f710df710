"""One Newton step on (q at the nodes, ln a), with the control as one more equation."""

import numpy as np

from ..numerics.linalg import solve_stack
from .equation import State, control_gradient, jacobian

#: Relative size of the residual at which the iteration has closed, and the largest number of steps.
TOLERANCE = 1e-13
LIMIT = 60


def tangent(ev, mesh):
    """dq/dη (B, n) along the branch of solutions."""
    K, diagonal, dF_deta = jacobian(ev, mesh)
    return solve_stack(K, diagonal, -dF_deta[..., None])[..., 0]


def advance(cases, state, ev, mesh, K=None):
    """The :class:`State` after one step from `state`, where the equation is `ev`, and dq/dη (B, n) along the branch of
    solutions. K is the matrix (B or 1, n, n) of the operator, if it is at hand.

    The step is taken in y, in which q is a convex power and g nearly a square, and limited to a factor of five: from
    the first guess of :mod:`.equation` it converges without a line search.
    """
    K, diagonal, dF_deta = jacobian(ev, mesh, K)
    solution = solve_stack(K, diagonal, np.stack([-dF_deta, -ev.F / ev.X], axis=-1))
    dq_deta, dq = solution[..., 0], solution[..., 1]
    by_q, by_eta = control_gradient(cases.control, ev, mesh)
    d_eta = -(ev.G + (by_q * dq).sum(axis=1)) / (by_eta + (by_q * dq_deta).sum(axis=1))
    d_eta = np.clip(d_eta, -1.0, 1.0)
    dy = (dq + dq_deta * d_eta[:, None]) / ev.curve.dq
    y = cases.law.limit(state.y + dy, state.y)
    return State(y, state.eta + d_eta), dq_deta

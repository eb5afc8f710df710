"""The error of a solution on a mesh: one Newton step on the next finer mesh, from so close nearly as good as the
solution there; and what a finished solution is asked for.
"""

import numpy as np

from ..body.layered import operator_error
from ..numerics.ladder import MARGIN, finer_mesh
from . import newton
from .equation import State, control_gradient, evaluate, groups
from .results import interpolate, profiles, quantities

#: Areas of the ring outside the first node, times λ there, that the error of Ar/An may come to (3 were seen).
_UNSEEN = 8.0
_RISEN = 0.05
#: By how much more the error may exceed the estimate (7 times was seen) where the layer at the edge is not resolved.
_BLIND = 3.0
#: λ in the centre from which on it may rise sharply inside the contact.
_SATURATED = 0.5

#: The quantities whose largest relative error is the error of a case.
JUDGED = ("a", "P", "D", "p0", "p_max", "Ar_An")


def finish(cases, grid, state, x, ev, enough=np.inf):
    """Output arrays of a state (dict; NaN for a case without finite numbers), and the state on the next finer mesh.

    `ev` is the equation at the state. A case whose error exceeds `enough` (B,), and the least that it can be, is not
    done: it gets no profiles.
    """
    values = quantities(cases, state, ev.curve, ev.X[:, 0], ev.base.edge_q, grid)
    finer, better, slope = _refine(cases, state, ev, grid)
    error = np.max([np.abs(values[name] / better[name] - 1) for name in JUDGED], axis=0)
    finite = np.isfinite(ev.residual) & np.isfinite(error)
    # share of tension in the load: only where the equation is linear can it be
    values["tension"] = np.maximum(-ev.curve.q, 0.0) @ np.abs(grid.w) / np.abs(ev.curve.q @ grid.w)
    last = np.flatnonzero(enough * np.ones(len(error)) == np.inf)
    if len(last):  # not the estimate's, which is as good as the error, but at the solution itself
        own, part = ev.take(last), {name: values[name][last] for name in ("P", "D")}
        slope[last] = stiffness(own, newton.tangent(own, grid), part, grid)
    values |= {"dP_dD": slope, "residual": ev.residual}
    floor = error_floor(cases, values["a"], grid.n)
    error = np.maximum(_margin(cases, ev, grid) * error, floor)
    done = np.flatnonzero(finite & (error <= np.maximum(enough, floor)))
    error[done] = np.maximum(error[done], _area_error(cases, state, ev, grid, values["Ar_An"], done))
    values["p"], values["lam"] = np.full((2, len(error), len(x)), np.nan)
    values["p"][done], values["lam"][done] = profiles(cases, ev, grid, x, done)
    values["error"] = error
    values = {name: np.where(finite.reshape(-1, *[1] * (v.ndim - 1)), v, np.nan) for name, v in values.items()}
    return values | {"nodes": np.full(len(finite), grid.n)}, finer


def _refine(cases, state, ev, grid):
    """One Newton step on the next finer mesh: the state there, its quantities (dict), and dP/dD (B,) in E2* R."""
    fine = finer_mesh(grid)
    start = State(interpolate(cases, ev, grid, fine.s, 1e-8), state.eta)
    at_start = evaluate(cases, start, fine, ev.base.weights)
    better, dq_deta = newton.advance(cases, start, at_start, fine)
    base, curve = at_start.base, at_start.curve
    # to first order, as the step itself: neither law nor operator are formed anew
    dy = better.y - start.y
    curve = curve._replace(q=curve.q + curve.dq * dy, g=curve.g + curve.dg * dy)
    edge_q = (base.edge(fine) * curve.q).sum(axis=1) + base.d_edge_q * (better.eta - start.eta)
    X, _, _ = groups(cases, better.eta)
    values = quantities(cases, better, curve, X[:, 0], edge_q, fine)
    return better, values, stiffness(at_start, dq_deta, values, fine)


def _margin(cases, ev, grid):
    """MARGIN (B,), larger where no mesh sees the layer at the edge in which asperities yield more than the base."""
    share = ev.Z[:, 0] * ev.curve.g[:, 0] / grid.s[0] ** 2
    return np.where(cases.law.rough & (share < 0.5), _BLIND * MARGIN, MARGIN)


def _area_error(cases, state, ev, grid, Ar_An, index):
    """Relative error of Ar/An that both meshes may miss, of the cases `index`.

    Near the edge, if λ has risen before the first node; and where asperities saturate, against a rule with other nodes.
    """
    if not cases.law.rough:
        return 0.0
    ends = cases.law.area(state.y[:, [0, -1]], ev.curve.q[:, [0, -1]])
    error = np.where(ends[:, 0] > _RISEN, _UNSEEN * grid.s[0] ** 2 / 2 * ends[:, 0] / Ar_An, 0.0)
    saturated = index[ends[index, 1] > _SATURATED]
    if len(saturated):
        s, w = grid.rule(grid.order + 5)
        y = interpolate(cases, ev, grid, s, rows=saturated)
        law = cases.law.take(saturated)
        area = law.area(y, law.evaluate(y).q) @ (2 * w * s)
        error[saturated] = np.maximum(error[saturated], MARGIN * np.abs(area / Ar_An[saturated] - 1))
    return error[index]


def error_floor(cases, a, nodes, closing=False):
    """Error (B,) that no estimate may go below: rounding, and on the exact layer the operator's own."""
    rounding = 4 * nodes * np.finfo(float).eps
    if cases.layer is None:
        return rounding
    return np.maximum(rounding, operator_error(cases.layer, a, nodes, cases.coarse & ~np.bool_(closing)))


def stiffness(ev, dq_deta, values, grid):
    """Contact stiffness dP/dD (B,) in E2* R from dq/dη (B, n) along the branch of solutions."""

    def slope(control):
        by_q, by_eta = control_gradient(control, ev, grid)
        return (by_q * dq_deta).sum(axis=1) + by_eta

    return values["P"] * slope("P") / (values["D"] * slope("D"))

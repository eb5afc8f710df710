"""Rough cases, and smooth ones on the exact layer: the batched Newton iteration, on the mesh that meets the tolerance.

The error of the solution on a mesh is estimated by one Newton step on the next finer mesh: a step from so close is
nearly as good as the solution there. A case that does not meet its tolerance goes on from there, and what the finest
mesh does not resolve, on panels of its own.
"""

import numpy as np

from . import newton
from .bracket import false_position
from .equation import (
    State,
    control_gradient,
    control_residual,
    evaluate,
    first_guess,
    groups,
    guess_radius,
    operate,
    smooth_start,
)
from .ladder import MARGIN, climb, finer_mesh
from .layered import octave_of, operator_error
from .mesh import mesh
from .micro import smooth
from .outputs import interpolate, profiles, quantities, spot_area
from .panels import solve_on_panels
from .status import Status

#: Areas of the ring outside the first node, times λ there, that the error of Ar/An may come to (3 were seen).
_UNSEEN = 8.0
_RISEN = 0.05
#: Part of the operator's own error at which the iteration has closed.
_CLOSING = 1e-2
#: By how much more the error may exceed the estimate (7 times was seen) where the layer at the edge is not resolved.
_BLIND = 3.0
#: Part of rtol to which panels are made anew where they miss it.
_FINER = 0.03
#: λ in the centre from which on it may rise sharply inside the contact.
_SATURATED = 0.5

_JUDGED = ("a", "P", "D", "p0", "p_max", "Ar_An")


def solve_newton(cases, law, rtol, nodes, limit, x):
    """Solve a batch of one law on one base: dict of output arrays in units R = E2* = 1, named as in Solution.

    rtol (B,); nodes (B,) int, 0: chosen by rtol; limit int, Newton steps a mesh (0: the scheme's own); x (m,) radii of
    the profiles.
    """
    size = len(rtol)
    out = {name: np.full(size, np.nan) for name in (*_JUDGED, "A0", "dP_dD", "residual", "error")}
    out |= {
        "status": np.full(size, Status.DIVERGED, dtype=np.int8),
        "iterations": np.zeros(size, int),
        "nodes": np.zeros(size, int),
    }
    out["tension"] = np.zeros(size)
    out |= {"p": np.full((size, len(x)), np.nan), "lam": np.full((size, len(x)), np.nan)}
    starts = {}

    def solve_on(index, n):
        part = cases.take(index)
        start = _stack_start([starts.pop(i, None) for i in index], part, law, mesh(n))
        with np.errstate(all="ignore"):  # a case that goes wrong is a NaN and a status
            finer = _rung(part, law, n, limit, start, x, out, index)
        closed = out["status"][index] == Status.CONVERGED
        missed = closed & (out["error"][index] > rtol[index])
        starts.update({index[i]: State(finer.y[i], finer.eta[i]) for i in np.flatnonzero(missed)})
        return np.where(closed, out["error"][index], np.nan)

    unmet = climb(rtol, nodes, solve_on, _neighbours(cases, law), cases.layer is not None)
    lifted = _lifted(out)  # perhaps by the polynomial: panels must confirm it
    open_end = (unmet | lifted | (out["status"] != Status.CONVERGED)) & (nodes == 0) & (limit == 0)
    for i in np.flatnonzero(open_end):
        with np.errstate(all="ignore"):
            unmet[i] = _on_panels(cases.take([i]), law, rtol[i], x, out, i)
    out["status"][unmet] = Status.TOLERANCE_NOT_MET
    lifted = _lifted(out)
    del out["tension"]
    _refuse(out, lifted, Status.LIFT_OFF)
    return out


def _lifted(out):
    """Cases (B,) in which the share of tension in the load is more than an error."""
    return out["tension"] > np.maximum(10 * out["error"], 1e-9)


def _refuse(out, mask, status):
    """Take the numbers of the cases of `mask` away."""
    for values in out.values():
        if values.dtype == float:
            values[mask] = np.nan
    out["status"][mask] = status


def _neighbours(cases, law):
    """Order (B,) in which layered cases of one octave of h/a stand together: fewer, larger matrix products."""
    if cases.layer is None:
        return None
    with np.errstate(all="ignore"):
        octave, depth = octave_of(cases.layer, guess_radius(cases, law))
    return np.lexsort((octave, depth))


def _stack_start(starts, cases, law, grid):
    guess = first_guess(cases, law, grid)
    for i, start in enumerate(starts):
        if start is not None:
            guess.y[i], guess.eta[i] = start
    return guess


def _rung(cases, law, n, limit, start, x, out, index):
    """Solve on n nodes, write everything to `out` at `index`; returns the state on the next finer mesh."""
    grid = mesh(n)
    state, closed, count = iterate(cases, start, law, grid, limit or newton.LIMIT)
    if not (closed.all() or limit):
        _rescue(cases, law, grid, state, closed, count)
    values, finer = finish(cases, law, grid, state, x)
    for name, value in values.items():
        out[name][index] = value
    finite = np.isfinite(values["error"])
    out["status"][index] = np.where(finite, np.where(closed, Status.CONVERGED, Status.ITERATION_LIMIT), Status.DIVERGED)
    out["iterations"][index] += count
    return finer


def _on_panels(case, law, rtol, x, out, i):
    """Solve case `i` on panels of its own and write it to `out` if that is better; returns whether it misses rtol.

    Tension there counts if it is on finer panels as well: what panels do not resolve may look like it.
    """
    lifts = True
    for goal in (rtol, _FINER * rtol):  # the last coefficients on the panels may be small where the error is not
        grid, state, closed, count = solve_on_panels(case, law, goal, _close)
        values, _ = finish(case, law, grid, state, x)
        out["iterations"][i] += count[0]
        lifts &= bool(closed[0] and values["tension"][0] > 10 * values["error"][0])
        if lifts:
            continue
        if closed[0]:
            out["tension"][i] = 0.0
        if closed[0] and values["error"][0] < np.nan_to_num(out["error"][i], nan=np.inf):
            for name, value in values.items():
                out[name][i] = value[0]
            out["status"][i] = Status.CONVERGED
        if out["status"][i] == Status.CONVERGED and out["error"][i] <= rtol:
            return False
    if lifts:
        out["tension"][i] = np.inf
    return not lifts and out["status"][i] == Status.CONVERGED


def _close(case, state, law, grid):
    """As :func:`iterate`, with a second attempt."""
    state, closed, count = iterate(case, state, law, grid)
    if not closed[0]:
        _rescue(case, law, grid, state, closed, count)
    return state, closed, count


def finish(cases, law, grid, state, x):
    """Output arrays of a state (dict; NaN for a case without finite numbers), and the state on the next finer mesh."""
    ev = evaluate(cases, state, law, grid)
    values = quantities(cases, state, ev.curve, ev.X[:, 0], ev.base.edge_q, law, grid)
    finer, better = refine(cases, state, ev, law, grid)
    error = np.max([np.abs(values[name] / better[name] - 1) for name in _JUDGED], axis=0)
    finite = np.isfinite(ev.residual) & np.isfinite(error)
    values["p"], values["lam"] = profiles(cases, ev, grid, law, x)
    # share of tension in the load: only where the equation is linear can it be
    values["tension"] = np.maximum(-ev.curve.q, 0.0) @ np.abs(grid.w) / np.abs(ev.curve.q @ grid.w)
    values |= {"dP_dD": stiffness(ev, values, grid), "residual": ev.residual}
    error = np.maximum(_margin(law, ev, grid) * error, _area_error(cases, law, state, ev, grid, values["Ar_An"]))
    values["error"] = np.maximum(error, _floor(cases, values["a"], grid.n))
    values = {name: np.where(finite.reshape(-1, *[1] * (v.ndim - 1)), v, np.nan) for name, v in values.items()}
    return values | {"nodes": np.full(len(finite), grid.n)}, finer


def _margin(law, ev, grid):
    """MARGIN (B,), larger where no mesh sees the layer at the edge in which asperities yield more than the base."""
    share = ev.Z[:, 0] * ev.curve.g[:, 0] / grid.s[0] ** 2
    return np.where((law is not smooth) & (share < 0.5), _BLIND * MARGIN, MARGIN)


def _area_error(cases, law, state, ev, grid, Ar_An):
    """Relative error (B,) of Ar/An that both meshes may miss.

    Near the edge, if λ has risen before the first node; and where asperities saturate, against a rule with other nodes.
    """
    if law is smooth:
        return 0.0
    ratio = (cases.p_star / cases.spot_scale)[:, None]
    ends = spot_area(law.spot(state.y[:, [0, -1]], ratio * ev.curve.q[:, [0, -1]]))
    error = np.where(ends[:, 0] > _RISEN, _UNSEEN * grid.s[0] ** 2 / 2 * ends[:, 0] / Ar_An, 0.0)
    saturated = ends[:, 1] > _SATURATED
    if not saturated.any():
        return error
    s, w = grid.rule(grid.order + 5)
    y = interpolate(cases, ev, law, grid, s, 1e-9)
    area = spot_area(law.spot(y, ratio * law.evaluate(y, cases.exponent).q)) @ (2 * w * s)
    return np.where(saturated, np.maximum(error, MARGIN * np.abs(area / Ar_An - 1)), error)


def _floor(cases, a, nodes):
    """Error (B,) that no estimate may go below: rounding, and on the exact layer the operator's own."""
    rounding = 4 * nodes * np.finfo(float).eps
    return rounding if cases.layer is None else np.maximum(rounding, operator_error(cases.layer, a, nodes))


def iterate(cases, state, law, grid, limit=newton.LIMIT):
    """Newton steps until the residual is below its tolerance; finished cases leave the batch.

    Returns the state, closed (B,) bool and the number of steps (B,).
    """
    size = len(state.eta)
    y, eta = state.y.copy(), state.eta.copy()
    closed, count = np.zeros(size, bool), np.zeros(size, int)
    active = np.arange(size)
    # a soft film leaves residuals of the rounding of its operator
    tolerance = np.maximum(newton.TOLERANCE, _CLOSING * _floor(cases, np.exp(eta), grid.n)) * np.ones(size)
    for step in range(limit + 1):
        ev = evaluate(cases, state, law, grid)
        y[active], eta[active], count[active] = state.y, state.eta, step
        done = ev.residual < tolerance[active]
        closed[active[done]] = True
        keep = np.flatnonzero(~done & np.isfinite(ev.residual))
        if step == limit or not len(keep):
            break
        if len(keep) < len(active):
            active, cases, state, ev = active[keep], cases.take(keep), state.take(keep), ev.take(keep)
        state = newton.advance(cases, state, ev, grid, law)
    return State(y, eta), closed, count


def _rescue(cases, law, grid, state, closed, count):
    """Second attempt at cases that did not close, in place: search the radius, start each from the smooth contact.

    The load under a very stiff film hardly depends on the radius: Newton on both leaves the branch.
    """
    failed = np.flatnonzero(~closed)
    part = cases.take(failed)

    def at_radius(eta, index):
        fixed = part.take(index)._replace(control="a", value=np.exp(eta))
        found, done, steps = iterate(fixed, smooth_start(fixed, law, grid), law, grid)
        count[failed[index]] += steps
        return found, done

    def control_at(eta, index):
        found, closed = at_radius(eta, index)
        q, here = law.evaluate(found.y, part.exponent[index]).q, part.take(index)
        edge_q = operate(here, eta, q, grid).edge_q
        return np.where(closed, control_residual(here, eta, groups(here, eta)[0], q, edge_q, grid), np.nan)

    eta = np.log(guess_radius(part, law))
    if cases.control != "a":
        eta, _ = false_position(control_at, eta, np.full(len(eta), 1e-9))
    found, done = at_radius(eta, np.arange(len(failed)))
    if cases.control != "a":
        found, done, steps = iterate(part, found, law, grid)
        count[failed] += steps
    state.y[failed], state.eta[failed], closed[failed] = found.y, found.eta, done


def refine(cases, state, ev, law, grid):
    """One Newton step on the next finer mesh: the state there and its quantities (dict)."""
    fine = finer_mesh(grid)
    start = State(interpolate(cases, ev, law, grid, fine.s, 1e-4), state.eta)
    at_start = evaluate(cases, start, law, fine, ev.base.weights)
    better = newton.advance(cases, start, at_start, fine, law)
    curve, base = law.evaluate(better.y, cases.exponent), at_start.base
    # to first order, as the step itself: the operator is not formed anew
    edge_q = (base.edge * curve.q).sum(axis=1) + base.d_edge_q * (better.eta - start.eta)
    X, _, _ = groups(cases, better.eta)
    return better, quantities(cases, better, curve, X[:, 0], edge_q, law, fine)


def stiffness(ev, values, grid):
    """Contact stiffness dP/dD (B,) in E2* R, along the solution branch, from the Jacobian."""
    dq = newton.tangents(ev, grid)[..., 0]

    def slope(control):
        by_q, by_eta = control_gradient(control, ev, grid)
        return (by_q * dq).sum(axis=1) + by_eta

    return values["P"] * slope("P") / (values["D"] * slope("D"))

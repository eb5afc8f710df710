"""The batched Newton loop: finished cases leave it; and a second way in for those that do not finish."""

import numpy as np

from ..body.layered import place_weights, take_weights
from ..numerics.bracket import false_position
from . import newton
from .budget import newton_steps
from .equation import State, control_residual, evaluate, groups, guess_radius, operate, smooth_start, softness
from .error import error_floor

#: Part of the operator's own error at which the iteration has closed.
_CLOSING = 1e-2
#: Residual from which one more step closes the iteration: they square.
NEAR = 1e-8
#: Rounding of the residual of a soft layer, times the softness of the layer. Its half-space and its layer terms are
#: large and nearly cancel. Under three BLAS kernels, on 12 to 64 nodes, at most 18 eps were seen.
_ROUNDING = 20 * np.finfo(float).eps
#: Change of ln a over which the matrix of the exact layer is not formed anew: the iteration loses so much a step.
_LAG = 1e-3


def iterate(cases, state, grid, limit=newton.LIMIT, near=0.0, known=None):
    """Newton steps until the residual is below its tolerance; finished cases leave the batch.

    So do cases after the step from a residual below `near`, without another look. `known`: weights of the layer (list)
    near the state, in place replaced by those where the cases left. Returns the state, closed (B,) bool and the number
    of steps (B,).
    """
    size = len(state.eta)
    y, eta = np.empty_like(state.y), np.empty_like(state.eta)
    closed, count = np.zeros(size, bool), np.zeros(size, int)
    active, last, left, weights = np.arange(size), np.zeros(size, bool), [], known or []
    tolerance, lagged = _tolerance(cases, state, grid) * np.ones(size), None
    for step in range(limit + 1):
        y[active], eta[active], count[active] = state.y, state.eta, step
        if last.any():
            closed[active[last]] = True
            left += place_weights(take_weights(weights, np.flatnonzero(last)), active[last])
            keep = np.flatnonzero(~last)
            if not len(keep):
                break
            active, cases, state = active[keep], cases.take(keep), state.take(keep)
            weights, lagged = take_weights(weights, keep), _take(lagged, keep)
        ev = evaluate(cases, state, grid, weights)
        residual = ev.residual
        done = residual < tolerance[active]
        closed[active[done]] = True
        go = ~done & np.isfinite(residual)
        keep = np.flatnonzero(go)
        if len(keep) < len(active):
            left += place_weights(take_weights(ev.base.weights, np.flatnonzero(~go)), active[~go])
        if step == limit or not len(keep):
            break
        if len(keep) < len(active):
            active, cases, state, ev = active[keep], cases.take(keep), state.take(keep), ev.take(keep)
            lagged = _take(lagged, keep)
        last, weights = residual[keep] < near, ev.base.weights
        lagged = _matrix(lagged, ev, state.eta, grid)
        state, _ = newton.advance(cases, state, ev, grid, lagged and lagged[0])
    if known is not None:
        known[:] = left
    return State(y, eta), closed, count


def _matrix(lagged, ev, eta, grid):
    """Matrix (B, n, n) of the operator of the exact layer, and the η (B,) it is of: the one at hand, formed anew where
    η has moved on. None for other bases."""
    if not ev.base.weights:
        return None
    if lagged is None:
        return ev.base.matrix(grid), eta.copy()
    K, at = lagged
    moved = np.flatnonzero(np.abs(eta - at) > _LAG)
    if len(moved):
        K[moved], at[moved] = ev.base.take(moved).matrix(grid), eta[moved]
    return K, at


def _take(lagged, index):
    """The sub-batch at `index` of what :func:`_matrix` returns."""
    return lagged and (np.take(lagged[0].transpose(1, 2, 0), index, axis=2).transpose(2, 0, 1), lagged[1][index])


def settle(cases, grid, state, closed, count, known):
    """:class:`Evaluation` of states that :func:`iterate` left; those that had not closed after all go on, in place."""
    ev = evaluate(cases, state, grid, known)
    again = np.flatnonzero(closed & ~(ev.residual < _tolerance(cases, state, grid)))
    if not len(again):
        return ev
    found, closed[again], steps = iterate(cases.take(again), state.take(again), grid)
    state.y[again], state.eta[again] = found
    count[again] += steps
    return evaluate(cases, state, grid, ev.base.weights)


def _tolerance(cases, state, grid):
    """Residual (B,) below which an iteration has closed: no less than rounding leaves of it."""
    a = np.exp(state.eta)
    floor = np.maximum(_CLOSING * error_floor(cases, a, grid.n, closing=True), _ROUNDING / softness(cases, a))
    return np.maximum(newton.TOLERANCE, floor)


def rescue(cases, grid, state, closed, count):
    """Second attempt at cases that did not close, in place: search the radius, start each from the smooth contact.

    The load under a very stiff film hardly depends on the radius: Newton on both leaves the branch.
    """
    failed = np.flatnonzero(~closed)
    part = cases.take(failed)

    def at_radius(eta, index):
        fixed = part.take(index)._replace(control="a", value=np.exp(eta))
        found, done, steps = iterate(fixed, smooth_start(fixed, grid), grid)
        count[failed[index]] += steps
        return found, done

    def control_at(eta, index):
        found, closed = at_radius(eta, index)
        here = part.take(index)
        q = here.law.evaluate(found.y).q
        edge_q = operate(here, eta, q, grid).edge_q
        closed &= count[failed[index]] < newton_steps(grid.n)  # else its budget is spent
        return np.where(closed, control_residual(here, eta, groups(here, eta)[0], q, edge_q, grid), np.nan)

    eta = np.log(guess_radius(part))
    if cases.control != "a":
        eta, _ = false_position(control_at, eta, np.full(len(eta), 1e-9))
    found, done = at_radius(eta, np.arange(len(failed)))
    if cases.control != "a":
        found, done, steps = iterate(part, found, grid)
        count[failed] += steps
    state.y[failed], state.eta[failed], closed[failed] = found.y, found.eta, done

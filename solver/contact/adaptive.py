"""Rough cases, and smooth ones on the exact layer: each on the mesh that meets its tolerance.

A case whose estimated error does not meet it goes on to the next finer mesh from the state of the estimate, and what
the finest mesh does not resolve, to panels of its own.
"""

import numpy as np

from ..body.layered import octave_of
from ..numerics.ladder import LADDER, STACK, climb, first_rung
from ..numerics.mesh import mesh
from ..status import Status
from . import newton
from .budget import PANELS, newton_steps
from .driver import NEAR, iterate, rescue, settle
from .equation import evaluate, guess_radius
from .error import JUDGED, error_floor, finish
from .panels import solve_on_panels
from .start import begin, nodes_wanted, only_as_wanted

#: Part of rtol to which panels are made anew where they miss it.
_FINER = 0.03
#: Error of p(0) below which its sign is sure, and height of a gap over a²/2 that is none of rounding.
_SURE, _GAP = 0.1, 1e-9
#: Share of tension in the load that is none of rounding.
_TENSION = 1e-9


def solve_newton(cases, rtol, nodes, limit, x):
    """Solve a batch of one law on one base: dict of output arrays in units R = E2* = 1, named as in Solution.

    rtol (B,); nodes (B,) int, 0: chosen by rtol; limit int, Newton steps a mesh (0: the scheme's own); x (m,) radii of
    the profiles.
    """
    size = len(rtol)
    out = {name: np.full(size, np.nan) for name in (*JUDGED, "A0", "dP_dD", "residual", "error")}
    out |= {
        "status": np.full(size, Status.DIVERGED, dtype=np.int8),
        "iterations": np.zeros(size, int),
        "nodes": np.zeros(size, int),
    }
    out["tension"] = np.zeros(size)
    out |= {"p": np.full((size, len(x)), np.nan), "lam": np.full((size, len(x)), np.nan)}
    if cases.layer is not None and limit == 0:
        with np.errstate(all="ignore"):
            cases = only_as_wanted(cases, np.where(nodes == 0, rtol, 0.0))
    hopeless, spent = np.zeros((2, size), dtype=bool)
    starts = {}  # n -> which cases (B,) have a state on n nodes to begin with, and those

    def solve_on(index, n):
        for done in [m for m in starts if m < n]:
            del starts[done]
        part, begun = cases.take(index), starts.get(n)
        start, known = begin(part, mesh(n), limit, *(v[index] for v in begun) if begun else ())
        goes_on = (nodes[index] == 0) & (n < LADDER[-1])
        with np.errstate(all="ignore"):  # a case that goes wrong is a NaN and a status
            finer = _rung(part, n, limit, start, known, x, out, index, np.where(goes_on, rtol[index], np.inf))
        closed = out["status"][index] == Status.CONVERGED
        unsure = (nodes[index] == 0) & _perhaps_lifted(out, index)
        error = np.where(unsure, np.inf, out["error"][index])
        floor = error_floor(part._replace(coarse=np.zeros(len(index), dtype=bool)), out["a"][index], n)
        hopeless[index] = closed & goes_on & (floor > rtol[index]) & (error <= floor)
        closed &= ~hopeless[index]
        missed = closed & goes_on & (error > rtol[index])
        if missed.any():
            _keep(starts, index[missed], finer.take(missed), size)
        return np.where(closed, error, np.nan)

    with np.errstate(all="ignore"):
        first = first_rung(nodes_wanted(cases, rtol))
    stack = STACK if cases.layer is None else 3 * STACK  # there the calls are more
    unmet = climb(rtol, nodes, solve_on, first, _neighbours(cases), stack)
    lifted = _lifted(out)  # perhaps by the polynomial: panels must confirm it
    hopeless &= ~lifted
    open_end = (unmet | lifted | (out["status"] != Status.CONVERGED)) & (nodes == 0) & (limit == 0) & ~hopeless
    for i in np.flatnonzero(open_end):
        with np.errstate(all="ignore"):
            unmet[i], spent[i] = _on_panels(cases.take([i]), rtol[i], x, out, i)
    out["status"][unmet | hopeless] = Status.TOLERANCE_NOT_MET
    spent &= out["status"] == Status.TOLERANCE_NOT_MET
    spent |= (out["status"] == Status.ITERATION_LIMIT) & (out["iterations"] >= newton_steps(out["nodes"]))
    out["status"][spent] = Status.BUDGET_SPENT
    lifted = _lifted(out)
    del out["tension"]
    _refuse(out, lifted, Status.LIFT_OFF)
    return out


def _lifted(out):
    """Cases (B,) in which the share of tension in the load, or the tension in the centre, is more than an error."""
    error = out["error"]
    return (out["tension"] > np.fmax(10 * error, _TENSION)) | ((out["p0"] < 0) & (error < _SURE))


def _perhaps_lifted(out, index):
    """Which of the cases `index` have a tension that may be an error, and may be none: a finer mesh will tell."""
    tension, error = out["tension"][index], out["error"][index]
    return (tension > _TENSION) & (tension <= 10 * error)


def _refuse(out, mask, status):
    """Take the numbers of the cases of `mask` away."""
    for values in out.values():
        if values.dtype == float:
            values[mask] = np.nan
    out["status"][mask] = status


def _neighbours(cases):
    """Order (B,) in which layered cases of one octave of h/a stand together: fewer, larger matrix products."""
    if cases.layer is None:
        return None
    with np.errstate(all="ignore"):
        octave, depth = octave_of(cases.layer, guess_radius(cases))
    return np.lexsort((octave, depth))


def _keep(starts, index, state, size):
    """Keep the states of the cases `index` for the mesh they are on."""
    if state.y.shape[1] not in starts:
        starts[state.y.shape[1]] = np.zeros(size, bool), np.empty((size, state.y.shape[1])), np.empty(size)
    known, y, eta = starts[state.y.shape[1]]
    known[index], y[index], eta[index] = True, *state


def _rung(cases, n, limit, start, known, x, out, index, enough):
    """Solve on n nodes, write everything to `out` at `index`; returns the state on the next finer mesh."""
    grid = mesh(n)
    most = min(limit, newton_steps(n)) or newton.LIMIT
    state, closed, count = iterate(cases, start, grid, most, 0.0 if limit else NEAR, known)
    if not (closed.all() or limit):
        rescue(cases, grid, state, closed, count)
    ev = settle(cases, grid, state, closed, count, known)
    values, finer = finish(cases, grid, state, x, ev, np.where(closed, enough, np.inf))  # the others end here
    opened = ev.gap.max(axis=1) > _GAP  # perhaps by the mesh
    values["error"][opened] = np.maximum(values["error"][opened], 1.0)
    for name, value in values.items():
        out[name][index] = value
    finite = np.isfinite(values["error"])
    out["status"][index] = np.where(finite, np.where(closed, Status.CONVERGED, Status.ITERATION_LIMIT), Status.DIVERGED)
    out["iterations"][index] += count
    return finer


def _on_panels(case, rtol, x, out, i):
    """Solve case `i` on panels of its own and write it to `out` if that is better; returns whether it misses rtol, and
    whether its budget is spent.

    Tension and gaps there count if they are on finer panels as well: what panels do not resolve may look like them.
    """
    lifts, left, case = None, PANELS, case._replace(coarse=np.zeros(1, dtype=bool), reach=np.zeros(1))
    for goal in (rtol, _FINER * rtol):  # the last coefficients on the panels may be small where the error is not
        if left <= 0:
            break
        grid, state, closed, count, work = solve_on_panels(case, goal, _close, left)
        left -= work
        ev = evaluate(case, state, grid)
        values, _ = finish(case, grid, state, x, ev)
        out["iterations"][i] += count[0]
        if not closed[0]:
            continue
        opened = ev.gap.max() > _GAP
        lifts = bool(lifts is not False and (opened or _lifted(values)[0]))
        if lifts:
            continue
        out["tension"][i] = 0.0
        if not opened and values["error"][0] < np.nan_to_num(out["error"][i], nan=np.inf):
            for name, value in values.items():
                out[name][i] = value[0]
            out["status"][i] = Status.CONVERGED
        if out["status"][i] == Status.CONVERGED and out["error"][i] <= rtol:
            return False, False
    if lifts:
        out["tension"][i] = np.inf
    return not lifts and out["status"][i] == Status.CONVERGED, left <= 0


def _close(case, state, grid):
    """As :func:`iterate`, with a second attempt."""
    state, closed, count = iterate(case, state, grid)
    if not closed[0]:
        rescue(case, grid, state, closed, count)
    return state, closed, count

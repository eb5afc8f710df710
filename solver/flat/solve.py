"""Rough contacts of flat punches, each on panels that shrink to the edge and are halved where its pressure asks it."""

import numpy as np

from ..contact.error import completed
from ..contact.newton import BUDGET
from ..contact.panels import ORDER, resolve
from ..contact.results import interpolate, judged_difference, profiles, quantities
from ..numerics.ladder import MARGIN, finer_mesh
from ..numerics.mesh import mesh_of, panel_mesh
from ..solution import Solution
from ..status import Status
from .newton import LIMIT, first_guess, iterate, misses, on_mesh, tangent

#: Ends in s of the panels to begin with.
_START = (0.0, *(0.4**k for k in range(7, 0, -1)), 0.7, 1.0)
#: Tolerances of the rounds, each of which solves and then halves panels, as in :mod:`..contact.panels`.
_GOALS = (1e-5, 1e-7, 1e-9, 1e-11, 1e-13)
#: A gap higher than this times a²/2 is real and no rounding, as in :mod:`..contact.answer`.
_GAP = 1e-9
#: Rounding of the answers, for each node.
_ROUNDING, _TINY = 4 * np.finfo(float).eps, np.finfo(float).tiny


def solve_flat(cases, rtol, nodes, limit, x):
    """:class:`~solver.solution.Solution` of rough flat punches; arguments as of
    :func:`~solver.contact.adaptive.solve_newton`. The control is P or D."""
    size = len(rtol)
    pieces = [([i], _solved(cases.take([i]), float(rtol[i]), int(nodes[i]), limit, x)) for i in range(size)]
    return Solution.join(size, len(x), pieces)


def _solved(case, rtol, nodes, limit, x):
    a, limit = case.shape.least(), limit or LIMIT
    mesh = mesh_of(nodes) if nodes else panel_mesh(ORDER, _START)
    ev, count, closed = iterate(first_guess(case, a, mesh), limit)
    work, spent = case.body.work(a, mesh.n)[0][0], False
    for goal in () if nodes else np.maximum(max(rtol, case.body.error(a, ORDER)[0]), _GOALS).tolist():
        if not closed:
            break
        breaks, y = resolve(ev, goal)
        if breaks == ev.mesh.breaks:
            continue
        more = ORDER * (len(breaks) - 1)
        work += case.body.work(a, more)[0][0]
        if work + case.body.work(a, more + more // 3)[0][0] > BUDGET:
            spent = True
            break
        ev, steps, closed = iterate(on_mesh(ev, panel_mesh(ORDER, breaks), y), limit)
        count += steps
    return _answer(ev, count, closed, spent, rtol, x)


def _answer(ev, count, closed, spent, rtol, x):
    """:class:`~solver.solution.Solution` of one case that has `closed`, with its error by a finer mesh."""
    size, a = (1, len(x)), np.exp(ev.state.eta)
    if not closed:
        lost = not np.isfinite(misses(ev)[0])
        return Solution.of(*size, status=Status.DIVERGED if lost else Status.ITERATION_LIMIT)
    mesh = finer_mesh(ev.mesh)
    fine, _, _ = iterate(on_mesh(ev, mesh, interpolate(ev, mesh.s)), LIMIT)
    numbers, _, of_load, of_depth = quantities(ev), *tangent(ev)
    error = MARGIN * (judged_difference(ev.cases, numbers, quantities(fine)) + misses(ev) + misses(fine))
    error = np.maximum(error, np.maximum(_ROUNDING * ev.mesh.n, ev.cases.body.error(a, ev.mesh.n)))
    area, error = completed(ev, numbers.Ar_An, error, np.array([0]))
    p, lam = _profiles(ev, x)
    finer_p, finer_lam = _profiles(fine, x)
    between = MARGIN * max(_change(p, finer_p), _change(lam, finer_lam)) if len(x) else 0.0
    status = Status.CONVERGED if error[0] <= rtol else Status.TOLERANCE_NOT_MET
    if spent and status == Status.TOLERANCE_NOT_MET:
        status = Status.BUDGET_SPENT
    rest = {"dP_dD": numbers.P * of_load / (numbers.D * of_depth), "residual": misses(ev), "error": error}
    rest |= {"profile_error": np.maximum(error, between), "nodes": ev.mesh.n, "iterations": count, "status": status}
    solution = Solution.of(*size, **(numbers._asdict() | {"Ar_An": area}), p=p, lam=lam, **rest)
    gap = (ev.gap.max(axis=1) > _GAP) & (fine.gap.max(axis=1) > _GAP)
    return solution.refused(~np.isfinite(error), Status.DIVERGED).refused(gap, Status.LIFT_OFF)


def _change(values, finer):
    there = np.isfinite(finer)
    return np.abs(values - finer)[there].max(initial=0.0) / np.abs(finer[there]).max(initial=_TINY)


def _profiles(ev, x):
    """p and λ (1, m) at the radii x (m,). At the edge asperities yield by τ: there is a pressure. It is infinite, as
    under a smooth punch, where they cannot yield so much."""
    p, lam = profiles(ev, x, np.array([0]))
    at_edge, law = x == 1, ev.cases.law
    if at_edge.any():
        y = law.from_displacement(ev.cases.punch.tau[:, None] / ev.Z)
        q = law.evaluate(y).q
        full = ~np.isfinite(q)
        p[:, at_edge] = law.p_star[:, None] * np.where(full, np.inf, q)
        lam[:, at_edge] = np.where(full, 1.0, law.area(y, q))
    return p, lam

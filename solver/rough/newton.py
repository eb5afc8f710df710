"""Newton's method on (q at the nodes, ln a), with the control as one more equation; the loop of every iterative scheme;
and a search for the radius, for cases in which Newton's method fails."""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..numerics import batch
from ..numerics.bracket import false_position
from ..numerics.linalg import solve_stack
from .equation import Unknowns, control_gradient, evaluate, jacobian
from .punch import keep_within
from .start import guess_radius, smooth_start

#: Most steps on a mesh, by default.
LIMIT = 60
#: Most Newton steps of a case on a mesh, including a search for the radius: _STEPS on up to _NODES nodes; fewer on
#: finer meshes, where a step takes longer, and at least _FEWEST. A search for the radius takes the most, a hundred and
#: more (tests/rough/errors/test_counts.py).
_STEPS, _NODES, _FEWEST = 1000, 96, 60
#: Most work of one case (:meth:`~solver.body.operator.Body.work`): its steps on all meshes, and the meshes of panels
#: that are made for it alone. Unlike seconds, work is the same on every machine. None of the 3,000 cases of the study
#: extremes_layered spends this budget, and about 1 % would spend half of it (`make extremes`).
#: `python tools/fuzz/fuzz_solver.py` prints the longest time of a lone case.
BUDGET = 1_500_000
#: The factor of the budget for cases that begin on panels, which follow the kinks of their shape. With it none of 14
#: random cases spends its budget at rtol 1e-3, 1e-6 or 1e-9 (`python tools/errors/rough_shapes.py 2 4`).
_ON_PANELS = 4


class Iterated(NamedTuple):
    """The end of an iteration.

    at : the batch after the last step of each case
    closed : (B,) bool, whether the case has reached its solution
    count : (B,), number of steps
    """

    at: Any
    closed: np.ndarray
    count: np.ndarray


@np.errstate(all="ignore")  # a failure is NaN, which makes a case `lost`
def iterate(start, step, limit):
    """Repeat `step` on a batch. A case that has closed or is lost leaves, and the others go on. Returns
    :class:`Iterated`.

    start : the first batch (:mod:`..numerics.batch`), which has the attributes `cases`, and `closed` and `lost`, (B,)
        bool: an :class:`.equation.Evaluation`, for example, or an :class:`.picard.Approximation`
    step : ``step(now) -> next``
    limit : most steps, int or (B,) int
    """
    size = len(start.cases.value)
    limit, every = np.broadcast_to(limit, size), np.arange(size)
    closed, count, parts, places = np.zeros(size, bool), np.zeros(size, int), [], []

    def ended(active, now):
        closed[active] = now.closed
        leaves = closed[active] | now.lost | (count[active] >= limit[active])
        if leaves.any():
            parts.append(now if leaves.all() else now.take(np.flatnonzero(leaves)))
            places.append(active[leaves])
        return leaves

    def after(active, now):
        count[active] += 1
        now = step(now)
        return ended(active, now), now

    left = np.flatnonzero(~ended(every, start))
    if len(left):
        batch.march(after, left, start if len(left) == size else start.take(left))
    return Iterated(parts[0] if len(parts) == 1 else batch.join(parts, places, cases=start.cases), closed, count)


def tangent(ev):
    """dq/dη (B, n) along the branch of solutions."""
    diagonal, dF_deta = jacobian(ev)
    return solve_stack(ev.operator.K, diagonal, -dF_deta[..., None])[..., 0]


def advance(ev):
    """The :class:`Unknowns` after one step from those of `ev`, and dq/dη (B, n) along the branch of solutions.

    The step is in y: q is nearly a power of y, and g nearly its square. A step changes y at most by a factor of five,
    and the radius at most by a factor of e. From the first guess of :mod:`.start` no line search is needed.
    """
    diagonal, dF_deta = jacobian(ev)
    solution = solve_stack(ev.operator.K, diagonal, np.stack([-dF_deta, -ev.F / ev.X], axis=-1))
    dq_deta, dq = solution[..., 0], solution[..., 1]
    by_q, by_eta = control_gradient(ev.cases.control, ev)
    d_eta = -(ev.G + (by_q * dq).sum(axis=1)) / (by_eta + (by_q * dq_deta).sum(axis=1))
    d_eta = np.clip(d_eta, -1.0, 1.0)
    dy = (dq + dq_deta * d_eta[:, None]) / ev.curve.dq
    y = ev.cases.law.limit(ev.state.y + dy, ev.state.y)
    return Unknowns(y, keep_within(ev.cases.shape, ev.state.eta + d_eta, ev.state.eta)), dq_deta


def step(ev):
    state, _ = advance(ev)
    return evaluate(ev.cases, state, ev.mesh, ev.operator)


def stiffness(ev, dq_deta, P, D):
    """Contact stiffness dP/dD (B,) in E2* R at the load P and depth D (B,), from dq/dη (B, n) along the branch."""

    def slope(control):
        by_q, by_eta = control_gradient(control, ev)
        return (by_q * dq_deta).sum(axis=1) + by_eta

    return P * slope("P") / (D * slope("D"))


def budget_of(cases):
    """Most work of the case in `cases`, a batch of one."""
    return BUDGET if cases.shape.even.all() else _ON_PANELS * BUDGET


def newton_steps(nodes):
    """Most Newton steps of a case on a mesh of `nodes` nodes; it has the shape of `nodes`."""
    share = np.minimum(1.0, (_NODES / np.maximum(nodes, 1)) ** 2)
    return np.maximum(_FEWEST, (_STEPS * share).astype(int))


def solve_on(start, limit=0, budget=BUDGET):
    """:class:`Iterated` by Newton's method from the equation `start`, and for cases in which that fails, by a search
    for the radius.

    limit : most steps, and no search follows; 0: the default limit, and a search may follow
    budget : float, or (B,), the work left to each case; the last step may spend a little more
    """
    cases, mesh = start.cases, start.mesh
    left = np.where(budget > 0, budget // cases.body.work(np.exp(start.state.eta), mesh.n)[1] + 1, 0)
    most = np.minimum(newton_steps(mesh.n), left).astype(int)
    iterated = iterate(start, step, np.minimum(limit or LIMIT, most))
    failed = np.flatnonzero(~iterated.closed)
    if limit or not len(failed):
        return iterated
    rest = np.flatnonzero(iterated.closed)
    searched = _by_radius(cases.take(failed), mesh, (most - iterated.count)[failed])
    ends = [iterated.at.take(rest), searched.at], [rest, failed]
    iterated.closed[failed] = searched.closed
    iterated.count[failed] += searched.count
    return iterated._replace(at=batch.join(*ends, cases=cases))


def _by_radius(cases, mesh, most):
    """:class:`Iterated` by a search for the radius, with at most `most` (B,) steps at all radii together. At each
    radius Newton's method starts from the smooth contact.

    On a very stiff film, for example, the load hardly depends on the radius, and Newton's method on pressure and radius
    together leaves the branch of solutions.
    """
    spent, radius = np.zeros(len(cases.value), int), guess_radius(cases)

    def at_radius(eta, index):
        fixed = cases.take(index)._replace(control="a", value=np.exp(eta))
        iterated = iterate(smooth_start(fixed, mesh), step, np.minimum(LIMIT, (most - spent)[index]))
        np.add.at(spent, index, iterated.count)
        return iterated

    def control_at(eta, index):
        iterated = at_radius(eta, index)
        valid = iterated.closed & (spent[index] < most[index])  # NaN ends the search where the budget is spent
        return np.where(valid, replace(iterated.at, cases=cases.take(index)).G, np.nan)

    eta = np.log(radius)
    if cases.control != "a":
        eta, _ = false_position(control_at, eta, np.full(len(eta), 1e-9))
    iterated = at_radius(eta, np.arange(len(eta)))
    if cases.control == "a":
        return Iterated(replace(iterated.at, cases=cases), iterated.closed, spent)
    iterated = iterate(replace(iterated.at, cases=cases), step, np.minimum(LIMIT, most - spent))
    return Iterated(iterated.at, iterated.closed, spent + iterated.count)

"""The error of a solution on a mesh: its distance to the solution on the next finer mesh.

One Newton step on the finer mesh stands for the solution there: it begins so close that it nearly arrives.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..numerics.ladder import MARGIN, finer_mesh
from . import newton
from .equation import State, evaluate, groups
from .results import difference, interpolate, quantities

#: No mesh sees how λ rises between the edge and the node next to it. That ring has a real area of about λ at the node
#: times the area of the ring. The error of Ar/An was seen to reach 3 times this area; it is taken to be 8 times.
_UNSEEN = 8.0
#: λ at the node next to the edge above which this error is counted.
_RISEN = 0.05
#: Near the edge asperities yield more than the body, in a ring that the meshes may not resolve. The estimate is then
#: multiplied by this; the error was seen to be up to 7 times the estimate without it.
_BLIND = 3.0
#: Where λ in the centre is above this, λ may rise sharply inside the contact, and Ar/An is compared with another rule.
_SATURATED = 0.5
#: By how many nodes the rule that Ar/An is compared with is finer; and the rules for a law with corners, of which one
#: may agree with the mesh by chance (tests/contact/test_error_bars.py has such contacts).
_FINER, _CORNERED = (5,), (3, 5, 8)


class Refined(NamedTuple):
    """One Newton step on the next finer mesh: the state there, its quantities, and dP/dD (B,) in E2* R."""

    state: State
    found: NamedTuple
    dP_dD: np.ndarray


def refine(ev):
    """:class:`Refined` of the equation at a solution."""
    fine = finer_mesh(ev.mesh)
    start = evaluate(ev.cases, State(interpolate(ev, fine.s, 1e-8), ev.state.eta), fine, ev.operator)
    state, dq_deta = newton.advance(start)
    found = quantities(nearby(start, state))
    return Refined(state, found, newton.stiffness(start, dq_deta, found.P, found.D))


def nearby(ev, state, curve=None):
    """:class:`~solver.contact.equation.Evaluation` at a state near that of `ev`, with the operator to first order, and
    the law as well, if its `curve` there is not given; for :func:`~solver.contact.results.quantities`, not for F."""
    if curve is None:
        dy, old = state.y - ev.state.y, ev.curve
        curve = old._replace(q=old.q + old.dq * dy, g=old.g + old.dg * dy)
    edge_q = (ev.operator.edge * curve.q).sum(axis=1) + ev.slopes[1] * (state.eta - ev.state.eta)
    return replace(ev, state=state, X=groups(ev.cases, state.eta)[0], curve=curve, edge_q=edge_q)


def estimate(ev, found, refined):
    """Estimated relative error (B,) of a solution with the quantities `found`. :func:`area_error` is not in it."""
    share = ev.Z[:, 0] * ev.curve.g[:, 0] / ev.mesh.s[0] ** 2
    # a small share of the asperities at the first node: the ring in which they yield more than the body is not seen
    margin = np.where(ev.cases.law.rough & (share < 0.5), _BLIND * MARGIN, MARGIN)
    error = margin * difference(found, refined.found)
    return np.maximum(error, ev.floor)


def area_error(ev, Ar_An, rows):
    """Relative error (b,) of Ar/An (B,) that both meshes may have alike, of the cases `rows` (b,).

    Near the edge it is an upper bound, where λ has risen before the first node. Where the asperities saturate in the
    centre, and of laws with corners, it is the largest difference to quadratures with other nodes.
    """
    law, mesh = ev.cases.law, ev.mesh
    if not law.rough:
        return 0.0
    ends = law.area(ev.state.y[:, [0, -1]], ev.curve.q[:, [0, -1]])
    error = np.where(ends[:, 0] > _RISEN, _UNSEEN * mesh.s[0] ** 2 / 2 * ends[:, 0] / Ar_An, 0.0)
    sharp = rows[law.law.corners | (ends[rows, 1] > _SATURATED)]
    if len(sharp):
        law = law.take(sharp)
        for more in _CORNERED if law.law.corners else _FINER:
            s, w = mesh.rule(mesh.order + more)
            y = interpolate(ev, s, rows=sharp)
            area = law.area(y, law.evaluate(y).q) @ (2 * w * s)
            error[sharp] = np.maximum(error[sharp], MARGIN * np.abs(area / Ar_An[sharp] - 1))
    return error[rows]

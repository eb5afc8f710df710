"""The error of a solution on a mesh: its distance to the solution on the next finer mesh.

One Newton step on the finer mesh stands for the solution there: it starts so close that it nearly reaches it.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..numerics.ladder import MARGIN, finer_mesh
from ..numerics.mesh import gauss_rule
from . import newton
from .equation import Evaluation, Unknowns, evaluate, groups
from .results import cornered, interpolate, judged_difference, pointed, quantities

#: No mesh resolves the rise of λ between the edge and the first node. With λ and s at that node, this ring adds about
#: λ s² to Ar/An. Where that matters, the error of Ar/An is at most 5.3 times λ s²/2
#: (`python tools/errors/error_bars.py`; one such case is "ring" of tests/rough/errors/test_error_bars.py).
#: The estimate is at least _UNSEEN times λ s²/2.
_UNSEEN = 8.0
#: This error is counted if λ at the first node is above _RISEN.
_RISEN = 0.05
#: In a ring near the edge asperities are more compliant than the body. If both meshes may miss this ring, the estimate
#: is multiplied by _BLIND. Without the factor, 10 % of these extreme cases on 6 nodes have an error above the estimate;
#: with it, 3 % (`python tools/errors/error_bars.py`). "blind" of tests/rough/errors/test_error_bars.py needs it.
_BLIND = 3.0
#: In such a ring both meshes may also agree on the place of the edge by chance, but they do not agree on the pressures
#: near it (:func:`_moved_edge`). If the estimates from both are about equal, both may be too small: if the edge moves
#: by δ a, Ar/An and P change by 2 δ and 3 δ. So the smaller of the two is multiplied by _BOTH: "edge" and "edge, a
#: given" of the same tests.
_BOTH = 2.0
#: In the centre the pressures of two meshes may agree by chance: in the case "centre" of
#: tests/rough/errors/test_error_bars.py to a twentieth of their error. So on meshes of one panel any change of the
#: pressure where s is above _MIDDLE counts. Several panels may enclose a corner there.
_MIDDLE = 0.9
#: Tolerance of the solution between its nodes, from which the step on the finer mesh starts. Changes below it are no
#: errors.
_NEAR = 1e-8
#: If λ rises sharply inside the contact, the quadratures of two meshes may agree by chance. λ may rise so if λ in the
#: centre is above _SATURATED, or if the exponent of the displacement is below _SHARP. Then Ar/An is compared with
#: another rule, which has on each panel _TIMES as many points as the mesh has nodes, and _MORE: "saturated" and
#: "quadratures" of tests/rough/errors/test_error_bars.py. With _SATURATED = 0.3 `python tools/errors/error_bars.py`
#: prints the same.
_SATURATED, _SHARP = 0.7, 0.45
_TIMES, _MORE = 2, 4
#: If the exponent of the displacement is below STEEP, λ rises sharply where the pressure begins. Then Ar/An is compared
#: with the quadrature for corners: "steep" of tests/rough/errors/test_error_bars.py. Panels enclose that place.
STEEP = 0.1
#: Under a law with corners two meshes may agree by chance. So the error includes the load that the mesh misses between
#: its nodes: its sum over the contact, in which opposite signs cancel, and _CHANCE times the largest sum from the edge
#: to any radius (test_random_heights of tests/rough/errors/test_error_bars.py).
_CHANCE = 1 / 2
#: For each control: the largest relative change of the judged quantities of a smooth contact, over that of its radius.
_OF_RADIUS = {"a": 3.0, "P": 1.0, "D": 1.0}
#: In a ring at the edge, asperities or springs are more compliant than the body. Both meshes miss it if the compliance
#: over that of the body is below RING s² at the first node s. The error is then at most :func:`added_in_ring` times the
#: number of ENCLOSING for the control (tests/rough/errors/test_rings.py; test_accuracy.py for smooth punches on
#: springs).
RING, ENCLOSING = 16.0, {"a": 0.5, "P": 0.2, "D": 0.25}


class Refined(NamedTuple):
    """One Newton step on the next finer mesh.

    start : the equation on that mesh at the interpolated solution
    end : the equation after the step, by :func:`nearby`
    numbers : the quantities after the step
    dP_dD : (B,), in E2* R
    """

    start: Evaluation
    end: Evaluation
    numbers: NamedTuple
    dP_dD: np.ndarray


def refine(ev, coarse):
    """:class:`Refined` of the equation at a solution with the quantities `coarse`.

    If λ has a kink (:meth:`~solver.laws.Bound.bent`), Ar/An is that of the coarse mesh plus the change by the step on
    the finer mesh. The difference between the quadratures of the two meshes at the kink is no error: such cases have
    another quadrature (:func:`~.results.cornered`).
    """
    fine, law = finer_mesh(ev.mesh), ev.cases.law
    bent = law.bent(ev.state.y, ev.curve.q)
    y = interpolate(ev, fine.s, np.where(bent, 1e-10, _NEAR)[:, None])
    start = evaluate(ev.cases, Unknowns(y, ev.state.eta), fine, ev.operator)
    state, dq_deta = newton.advance(start)
    end = nearby(start, state)
    numbers = quantities(end)
    if bent.any():
        before = 2 * (law.area(start.state.y, start.curve.q) @ fine.w)
        numbers = numbers._replace(Ar_An=np.where(bent, coarse.Ar_An + numbers.Ar_An - before, numbers.Ar_An))
    return Refined(start, end, numbers, newton.stiffness(start, dq_deta, numbers.P, numbers.D))


def nearby(ev, state):
    """:class:`~solver.rough.equation.Evaluation` at a state near that of `ev`, with the operator and the law to first
    order. It is valid for :func:`~solver.rough.results.quantities`; its F is still that of `ev`."""
    dy, old = state.y - ev.state.y, ev.curve
    curve = old._replace(q=old.q + old.dq * dy, g=old.g + old.dg * dy)
    edge_q = ev.operator.at_edge(curve.q) + ev.slopes[1] * (state.eta - ev.state.eta)
    return replace(ev, state=state, X=groups(ev.cases, state.eta)[0], curve=curve, edge_q=edge_q)


def estimate(ev, coarse, refined):
    """Estimated relative error (B,) of a solution with the quantities `coarse`, from the two meshes alone."""
    change, start = judged_difference(ev.cases, coarse, refined.numbers), refined.start
    if ev.mesh.order == ev.mesh.n:
        first = np.searchsorted(start.mesh.s, _MIDDLE)
        around = np.abs(refined.end.curve.q - start.curve.q)[:, first:].max(axis=1) / ev.curve.q[:, -1]
        counts = around > np.maximum(change, _NEAR)
        if ev.curve.q.min() <= 0:  # with tension, only the centre itself decides whether the punch lifts off
            counts &= ev.curve.q.min(axis=1) > 0
        change = np.where(counts & ~pointed(ev.cases), around, change)
    if not ev.cases.law.rough:  # with asperities, their compliance at the edge shows whether the mesh is too coarse
        unseen = ev.cases.body.unseen(np.exp(ev.state.eta), ev.mesh.s[0])
        change = np.maximum(change, _OF_RADIUS[ev.cases.control] * unseen)
    error = np.maximum(margin(ev) * change, ev.floor)
    if not ev.cases.law.rough:
        return error
    error = np.maximum(error, _missed_ring(ev))
    if ev.mesh.order == ev.mesh.n:
        moved = MARGIN * _moved_edge(refined)
        both = np.where(_blind(ev), _BOTH * np.minimum(error, moved), 0.0)
        error = np.maximum(np.maximum(error, moved), both)
    return error


def _moved_edge(refined):
    """The distance (B,) by which the step on the finer mesh moves the edge, over the radius: the largest of estimates
    at all nodes.

    Let the edge move by δ a. Where the body is more compliant than the asperities, the pressure near the edge, q ~ s,
    has the relative change δ/s². Where the asperities are more compliant, their displacement, g ~ s², has the relative
    change 2 δ/s². So s² times both changes, each weighted by its share of the right-hand side, is δ or a little more.
    These numbers cannot cancel from node to node, as they do in the radius. Under a hard plate the pressure inside a
    ring is nearly 0, and its relative changes mean nothing. So the pressure counts as at least 0.02 s² of the largest.
    """
    start, end, s2 = refined.start.curve, refined.end.curve, refined.start.mesh.s**2
    share = np.clip(refined.start.Z * start.g / refined.start.drop, 0.0, 1.0)
    least = np.maximum(start.q, 0.02 * s2 * start.q.max(axis=1, keepdims=True))
    moved = (1 - share) * np.abs(end.q - start.q) / least + share * np.abs(end.g / start.g - 1)
    return (s2 * np.where(moved > _NEAR, moved, 0.0)).max(axis=1)


def _missed_ring(ev):
    """Bound (B,) of the error by a ring at the edge that is too narrow for both meshes, and in which asperities and
    springs are compliant; 0 where the meshes resolve the ring."""
    s1, q1, bound = ev.mesh.s[0], ev.curve.q[:, 0], np.zeros(len(ev.state.eta))
    body = ev.X[:, 0] * ev.cases.body.softness(np.exp(ev.state.eta) * s1**2)
    springs, asperities = ev.Y[:, 0] / body, ev.Z[:, 0] * ev.curve.g[:, 0] / (body * q1)
    blind = np.flatnonzero(springs + asperities < RING * s1**2)
    if len(blind):
        _, beta = ev.cases.law.take(blind).edge()
        ring = added_in_ring(springs[blind], s1) + added_in_ring(asperities[blind], s1, beta)
        bound[blind] = ENCLOSING[ev.cases.control] * ring
    return bound


def added_in_ring(t, s1, beta=1.0):
    """Relative change (B,) of a, and the like, by a compliance in the ring between the edge and the first node s1. The
    compliance over that of the body is t (s/s1)^(β-1), with t (B,).

    The change is 2 ∫ t (s/s1)^(β-1) ds/s up to s1, from about the s at which that ratio is s². Below that s the
    compliance exceeds that of the body. With β = 1, for springs, the change is t ln(1 + s1²/2t).
    """
    end = 2 * (t / s1**2) ** (2 / (3 - beta))
    wide, less = np.log1p(1 / end), (1 - beta) / 2
    integral = np.where(less > 0, end**-less * -np.expm1(-less * wide) / np.where(less > 0, less, 1.0), wide)
    return np.where(t > 0, t * integral, 0.0)


def margin(ev):
    """The factor (B,) by which an error may exceed the change on the finer mesh."""
    return np.where(_blind(ev), _BLIND * MARGIN, MARGIN)


def _blind(ev):
    """(B,) bool: whether the share of the asperities in the right-hand side is small even at the first node, so that
    the mesh misses the ring in which it is large."""
    return ev.cases.law.rough & (ev.Z[:, 0] * ev.curve.g[:, 0] / ev.drop[:, 0] < 0.5)


def profile_error(ev, refined, rows, x):
    """Estimated error (b,) of the profiles of the cases `rows` (b,) at the radii x (m,), over the largest p or λ. It is
    the change by the step on the finer mesh at the nodes of that mesh, most of which lie between those of the other.
    Under a smooth punch the pressure at the edge is 0, so the value there of the polynomial through the nodes is an
    error too. Under a pointed punch, nodes nearer to the axis than the smallest x do not count."""
    law = ev.cases.law.take(rows)
    start, end = refined.start, refined.end
    seen = slice(None, max(1, _outside(start.mesh, x)) if pointed(ev.cases)[rows].any() else None)
    q, new_q = start.curve.q[rows, seen], end.curve.q[rows, seen]
    if law.rough:
        lam, new_lam = (law.area(at.state.y[rows], at.curve.q[rows])[:, seen] for at in (start, end))
        other = np.abs(new_lam - lam).max(axis=1) / new_lam.max(axis=1)
    else:
        other = np.abs(ev.curve.q[rows] @ ev.mesh.basis(np.zeros(1))[0]) / new_q.max(axis=1)
    return margin(ev)[rows] * np.maximum(np.abs(new_q - q).max(axis=1) / new_q.max(axis=1), other)


def _outside(mesh, x):
    """Number of nodes whose radii are at least the smallest x (m,) above 0."""
    return np.count_nonzero(mesh.x >= np.min(x[x > 0], initial=1.0))


def completed(ev, Ar_An, error, rows):
    """Ar/An (b,) of the cases `rows` (b,), and their relative error (b,), including the part that both meshes may miss.

    Ar_An : (B,), by the quadrature of the nodes; error : (B,), of :func:`estimate`

    If λ has a kink, Ar/An has a quadrature of its own.
    """
    area, error = Ar_An[rows], error[rows]
    if not ev.cases.law.rough or not len(rows):
        return area, error
    bent = ev.cases.law.take(rows).bent(ev.state.y[rows], ev.curve.q[rows])
    for part, judge in ((np.flatnonzero(~bent), _without_bends), (np.flatnonzero(bent), _with_bends)):
        if len(part):
            area[part], error[part] = judge(ev, area[part], error[part], rows[part])
    return area, error


def another_rule(mesh):
    """Points s and weights (m,) of ∫₀¹ · ds with which the quadrature of a mesh is compared."""
    return gauss_rule(_TIMES * mesh.order + _MORE, mesh.breaks)


def _with_bends(ev, area, error, rows):
    area, of_area, missed, largest = cornered(ev, rows)
    return area, np.maximum(error + MARGIN * missed + _CHANCE * largest, MARGIN * of_area)


def _without_bends(ev, area, error, rows):
    """:func:`completed` for the cases `rows`, whose λ has no kink.

    If λ has risen before the first node, _UNSEEN counts the missed part. If λ may rise sharply, Ar/An is compared with
    another quadrature. If the displacement hardly depends on the pressure, it is also compared with the quadrature for
    corners.
    """
    law, mesh = ev.cases.law.take(rows), ev.mesh
    ends = law.area(ev.state.y[rows][:, [0, -1]], ev.curve.q[rows][:, [0, -1]])
    ring = np.where(ends[:, 0] > _RISEN, _UNSEEN * mesh.s[0] ** 2 / 2 * ends[:, 0] / area, 0.0)
    _, exponent = law.edge()
    error, sharp = np.maximum(error, ring), np.flatnonzero((ends[:, 1] > _SATURATED) | (exponent < _SHARP))
    if len(sharp):
        s, w = another_rule(mesh)
        y, law = interpolate(ev, s, rows=rows[sharp]), law.take(sharp)
        other = law.area(y, law.evaluate(y).q) @ (2 * w * s)
        error[sharp] = np.maximum(error[sharp], MARGIN * np.abs(other / area[sharp] - 1))
    steep = np.flatnonzero((exponent < STEEP) & (mesh.order == mesh.n))
    if len(steep):
        other, of_area, _, _ = cornered(ev, rows[steep])
        error[steep] = np.maximum(error[steep], MARGIN * (np.abs(other / area[steep] - 1) + of_area))
    return area, error

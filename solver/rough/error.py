"""The error of a solution on a mesh: its distance to the solution on the next finer mesh.

One Newton step on the finer mesh stands for the solution there: it begins so close that it nearly arrives.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..numerics.ladder import MARGIN, finer_mesh
from ..numerics.mesh import gauss_rule
from . import newton
from .equation import Evaluation, Unknowns, evaluate, groups
from .results import cornered, interpolate, judged_difference, pointed, quantities

#: No mesh sees how λ rises between the edge and the node next to it. With λ and s at that node, this ring adds about λ
#: s² to Ar/An. Where that matters, the error of Ar/An is at most 5.3 times λ s²/2
#: (`python tools/errors/error_bars.py`; one such case is "ring" of tests/rough/errors/test_error_bars.py).
#: The estimate is at least _UNSEEN times λ s²/2.
_UNSEEN = 8.0
#: This error is counted if λ at the node next to the edge is above this.
_RISEN = 0.05
#: Near the edge asperities yield more than the body, in a ring that both meshes may miss. Where they may, the estimate
#: is multiplied by this. Without the factor 10 % of such extreme cases on 6 nodes have an error above the estimate,
#: with it 3 % (`python tools/errors/error_bars.py`); one that needs it is "blind" of
#: tests/rough/errors/test_error_bars.py.
_BLIND = 3.0
#: There both meshes may also place the edge alike by chance, but not the pressures near it: :func:`_moved_edge`. Where
#: this and the estimate are of one size, both may be too small: where the edge moves by δ a, Ar/An and P change by 2 δ
#: and 3 δ. So the smaller of the two counts _BOTH times: "edge" and "edge, a given" of the same tests.
_BOTH = 2.0
#: In the centre the pressures of two meshes may agree by chance: in the case "centre" of
#: tests/rough/errors/test_error_bars.py to a twentieth of their error. So on meshes of one panel any change of the
#: pressure where s is above this counts. Several panels may enclose a corner there.
_MIDDLE = 0.9
#: Tolerance of the solution between its nodes, where the step on the finer mesh begins. Changes below it are no errors.
_NEAR = 1e-8
#: The quadratures of two meshes may agree by chance, if λ rises sharply inside the contact. It may, if λ in the centre
#: is above _SATURATED or the exponent of the displacement below _SHARP. Then Ar/An is compared with another rule, which
#: has _TIMES as many points on each panel as the mesh has nodes, and _MORE: "saturated" and "quadratures" of
#: tests/rough/errors/test_error_bars.py. With _SATURATED = 0.3 `python tools/errors/error_bars.py` prints
#: the same.
_SATURATED, _SHARP = 0.7, 0.45
_TIMES, _MORE = 2, 4
#: If the exponent of the displacement is below this, λ rises sharply where pressure begins. Then Ar/An is compared with
#: the quadrature for corners: "steep" of tests/rough/errors/test_error_bars.py. Panels enclose that place.
STEEP = 0.1
#: Under a law with corners two meshes may agree by chance. So the error also counts the load that the mesh misses
#: between its nodes: the sum over the contact, in which opposite signs cancel, and _CHANCE times the largest sum from
#: the edge to any radius (test_random_heights of tests/rough/errors/test_error_bars.py).
_CHANCE = 1 / 2
#: For each control: the largest relative change of the judged quantities of a smooth contact, over that of its radius.
_OF_RADIUS = {"a": 3.0, "P": 1.0, "D": 1.0}
#: Both meshes miss a ring at the edge where asperities or springs yield more than the body, if their compliance over
#: the body's is below RING s² at the first node s. The error is then at most this times :func:`added_in_ring`, for each
#: control (tests/rough/errors/test_rings.py; test_accuracy.py for smooth punches on springs).
RING, ENCLOSING = 16.0, {"a": 0.5, "P": 0.2, "D": 0.25}


class Refined(NamedTuple):
    """One Newton step on the next finer mesh.

    start, end : the equation there at the interpolated solution, and after the step, by :func:`nearby`
    numbers : the quantities after the step
    dP_dD : (B,), in E2* R
    """

    start: Evaluation
    end: Evaluation
    numbers: NamedTuple
    dP_dD: np.ndarray


def refine(ev, coarse):
    """:class:`Refined` of the equation at a solution with the quantities `coarse`.

    Where λ bends (:meth:`~solver.laws.Bound.bent`), Ar/An is the coarse one plus what the step changes on the finer
    mesh. That the two meshes see the bends differently is no error: such cases have another quadrature
    (:func:`~.results.cornered`).
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
    """:class:`~solver.rough.equation.Evaluation` at a state near that of `ev`: good for
    :func:`~solver.rough.results.quantities`, but not for F. The operator and the law are taken to first order."""
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
        if ev.curve.q.min() <= 0:  # where there is tension, the centre alone judges whether the punch lifts off
            counts &= ev.curve.q.min(axis=1) > 0
        change = np.where(counts & ~pointed(ev.cases), around, change)
    if not ev.cases.law.rough:  # asperities show that a mesh is too coarse for the edge, by how they yield there
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
    """By how much of the radius (B,) the step on the finer mesh seems to move the edge, at the node where that is most.

    Let the edge move by δ a. Near it the pressure, q ~ s, changes by δ/s² of itself where the body yields most. Where
    the asperities yield most, their displacement, g ~ s², changes by 2 δ/s². So s² times both changes, each weighed by
    its share of the right-hand side, is δ or a little more. From node to node these numbers cannot cancel, as they do
    in the radius. Under a hard plate the pressure inside a ring is nearly 0, and its relative changes say nothing:
    there the pressure is taken to be at least 0.02 s² of the largest.
    """
    start, end, s2 = refined.start.curve, refined.end.curve, refined.start.mesh.s**2
    share = np.clip(refined.start.Z * start.g / refined.start.drop, 0.0, 1.0)
    least = np.maximum(start.q, 0.02 * s2 * start.q.max(axis=1, keepdims=True))
    moved = (1 - share) * np.abs(end.q - start.q) / least + share * np.abs(end.g / start.g - 1)
    return (s2 * np.where(moved > _NEAR, moved, 0.0)).max(axis=1)


def _missed_ring(ev):
    """Bound (B,) of the error by a ring at the edge, so narrow that neither mesh sees how asperities and springs yield
    there; 0 where they see it."""
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
    """Relative change (B,) of a and the like by a compliance in the ring between the edge and the first node s1. Its
    ratio to the compliance of the body is t (s/s1)^(β-1), with t (B,).

    The change is 2 ∫ t (s/s1)^(β-1) ds/s from about the s where the compliance is s² to s1. Below that s, in a ring at
    the edge, it is more than the body's. With β = 1, for springs, the change is t ln(1 + s1²/2t).
    """
    end = 2 * (t / s1**2) ** (2 / (3 - beta))
    wide, less = np.log1p(1 / end), (1 - beta) / 2
    integral = np.where(less > 0, end**-less * -np.expm1(-less * wide) / np.where(less > 0, less, 1.0), wide)
    return np.where(t > 0, t * integral, 0.0)


def margin(ev):
    """The factor (B,) by which an error may be larger than the change on the finer mesh."""
    return np.where(_blind(ev), _BLIND * MARGIN, MARGIN)


def _blind(ev):
    """(B,) bool: the share of the asperities is small at the first node already, so the mesh misses the ring where it
    is large."""
    return ev.cases.law.rough & (ev.Z[:, 0] * ev.curve.g[:, 0] / ev.drop[:, 0] < 0.5)


def profile_error(ev, refined, rows, x):
    """Estimated error (b,) of the profiles at the radii x (m,) of the cases `rows` (b,), over the largest p or λ. It is
    what the step on the finer mesh changes at its nodes, most of which lie between the others. A smooth punch has no
    pressure at the edge: so what the polynomial through the nodes has there is an error too. Under a point, the nodes
    nearer to the axis than the least of the radii do not count."""
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
    """Number of nodes at radii above the least of x (m,) that is not 0."""
    return np.count_nonzero(mesh.x >= np.min(x[x > 0], initial=1.0))


def completed(ev, Ar_An, error, rows):
    """Ar/An (b,) of the cases `rows` (b,), and their relative error (b,), now with what both meshes may miss alike.

    Ar_An : (B,), by the quadrature of the nodes; error : (B,), of :func:`estimate`

    Where λ bends, Ar/An has a quadrature of its own.
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
    """:func:`completed` of cases `rows` whose λ does not bend.

    If λ has risen before the first node, what is missed there is counted by _UNSEEN. Where λ may rise sharply, Ar/An is
    compared with another quadrature; where the displacement hardly depends on the pressure, with one for corners too.
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

"""Cases that one polynomial does not resolve: polynomials on panels, which are chosen for each case by the variation of
its solution.

Where asperities saturate inside a contact, A → B̄²/(3Ra), the pressure has a corner at s² = Z/3; the stiffer the body,
the rounder the corner. On a stiff or thin body the pressure also rises steeply at the edge. The coefficients of the
pressure and of λ on each panel show both, and halving the panels encloses them.

Where the profile of a punch has a kink, its pressure has one too. The first panels have an end there, at
s = sqrt(1 - (b/a)²) for a kink at the radius b. When the contact radius moves, so do these ends, and the panels between
them are stretched accordingly. The values at their nodes are a first guess on the new panels.
"""

from itertools import pairwise

import numpy as np

from ..numerics.mesh import on_panels, panel_mesh
from ..numerics.quadrature import radau_nodes
from .equation import Unknowns, evaluate
from .newton import Iterated, solve_on
from .results import interpolate
from .start import first_guess, guess_radius

#: Number of nodes on a panel; the width of the narrowest panel is 1/2 to the power DEPTH.
ORDER = 12
DEPTH = 30
#: The matrix (ORDER, 2) that makes the last two coefficients of a Legendre series from values at the nodes of a panel.
_LAST = np.linalg.inv(np.polynomial.legendre.legvander(2 * radau_nodes(ORDER) - 1, ORDER - 1)).T[:, -2:]
#: Most panels: the operator is not accurate enough to resolve more.
_MOST = 32
#: For punches with kinks or a point: the number of times that a panel is halved in one round, which is small because an
#: error spoils neighbouring panels; rounds for each of GOALS; number of further panels for each kink; and rounds at the
#: end in which panels only follow kinks.
_AT_ONCE, _ROUNDS, _MORE, _FOLLOWING = 1, 3, 8, 8
#: Tolerances of the rounds. Each round solves, and then halves panels. A coarse solution does not show where a fine one
#: needs panels, so rtol is approached in steps.
GOALS = (1e-5, 1e-7, 1e-9, 1e-11, 1e-13)
#: A panel is resolved when its last two coefficients add to the load and to the real area less than _SHARE rtol of
#: them, or less than _FLOOR of them: for the smallest rtol the error of the operator is larger.
_SHARE = 0.3
_FLOOR = 1e-12

#: Ends in s of the panels next to the edge, over the length to the first kink or to the centre; the last end is _WHOLE.
_FROM_EDGE, _WHOLE = (0.0, 0.0625, 0.25, 0.5, 0.75), 1.0
#: Panels shrink by the factor _SHRINK towards a kink, _LEVELS times; towards the axis _ON_AXIS times, and towards a
#: point _TO_POINT times. Coarse panels there would spoil the solution far away too, and too many panels would be
#: halved.
_SHRINK, _LEVELS, _ON_AXIS, _TO_POINT = 0.4, 4, 6, 10
#: Most kinks that get panels of their own. A profile with more kinks is a table, and its kinks are small: panels are
#: only halved where the pressure needs it.
MOST_KINKS = 12
#: A kink nearer than this to the edge or to the axis, in s, gets no panel of its own: rounding of its place would
#: count.
_AT_EDGE, _AT_AXIS = 1e-6, 1e-12
#: Panels follow the kinks until the last step moves ln(a - b) by less than _SETTLED rtol. A misplaced kink changes the
#: pressure by far less than its distance from the right place.
_SETTLED, _ROUNDING = 0.01, 1e-13


def solve_on_panels(case, rtol, budget, at=None, nearer=1.0):
    """Solve one case (a batch of one) on panels that resolve it, as far as the budget allows.

    at : :class:`.equation.Evaluation` at a solution on panels, from which to continue; None: start anew
    nearer : for a new start, the factor of the guessed radius, measured from the flat part of the punch

    Returns its :class:`.newton.Iterated`, and the work. The work exceeds the budget if the budget did not last until
    every panel was resolved.
    """
    radius, count = guess_radius(case), 0
    if nearer < 1.0:
        radius = case.shape.least() + nearer * (radius - case.shape.least())
    if at is None:
        iterated, work, place = _first(case, rtol, budget, radius)
    else:
        iterated, work, place = Iterated(at, at.closed, np.zeros(1, dtype=int)), 0.0, _radius(at)
    least = max(rtol, case.body.error(radius, ORDER)[0])  # panels do not reduce the error of the operator itself
    goals = np.maximum(least, GOALS).tolist()
    if not case.punch.polynomial:
        goals = [*np.repeat(goals, _ROUNDS), *goals[-1:] * _FOLLOWING]
    for goal in goals:
        count, iterated = count + iterated.count, iterated._replace(count=0 * iterated.count)
        if iterated.at.lost[0]:
            break
        breaks, y, now = *resolve(iterated.at, goal), _radius(iterated.at)
        if not settled(case.shape, place, now, rtol):
            breaks, y = _follow_kinks(iterated.at, breaks, y, place)
            place = now
        if breaks == iterated.at.mesh.breaks:
            continue
        nodes = ORDER * (len(breaks) - 1)
        making, judging = (case.body.work(radius, n)[0][0] for n in (nodes, nodes + nodes // 3))
        if work + making + judging > budget:  # the rest of the budget is needed to estimate the error so far
            work = np.inf
            break
        work, mesh = work + making, panel_mesh(ORDER, breaks)
        iterated = solve_on(
            evaluate(case, Unknowns(y, iterated.at.state.eta), mesh, iterated.at.operator), budget=budget - work
        )
        work += iterated.count[0] * case.body.work(radius, mesh.n)[1][0]
    return iterated._replace(count=count + iterated.count), work


def _radius(at):
    return float(np.exp(at.state.eta[0]))


def _follow_kinks(at, breaks, y, place):
    """Panels and y (1, n) at their nodes for the contact radius of the solution `at`, from the panels `breaks` and y,
    which were made for the contact radius `place`. If the number of kinks inside the contact has changed, the panels
    are new."""
    before, now = ends_of(at.cases.shape, place), ends_of(at.cases.shape, _radius(at))
    if len(before) == len(now):
        return stretch(breaks, before, now), y
    breaks = panels_between(now, at.cases.shape)
    return breaks, np.concatenate(_between(at, list(pairwise(breaks))), axis=1)


def _first(case, rtol, budget, radius):
    """:class:`.newton.Iterated` of one case on its first panels, with a radius of about `radius` (1,); the work; and
    the contact radius for which these panels have their ends at the kinks.

    If a far cheaper body is displaced nearly as this one (:meth:`~solver.body.operator.Body.alike`), the first panels
    are those that resolve the contact with that body. This saves a seventh of the time of the study extremes_layered.
    Without it, 2 of 600 cases of that study spent their budget, although they have a solution. One of them is
    test_a_film_that_begins_as_a_thin_layer of tests/rough/extremes/test_budget.py.
    """
    place = float(radius[0])
    mesh = panel_mesh(ORDER, panels_between(ends_of(case.shape, place), case.shape))
    alike, start, count, work = case.body.alike(radius), None, 0, 0.0
    if alike is not None:
        iterated, work = solve_on_panels(case._replace(body=alike), rtol, budget)
        count = iterated.count
        if iterated.closed[0]:
            mesh, start, place = iterated.at.mesh, iterated.at.state, _radius(iterated.at)
    operator, step = case.body.work(radius, mesh.n)
    work += operator[0]
    iterated = solve_on(evaluate(case, start or first_guess(case, mesh, radius), mesh), budget=budget - work)
    return iterated._replace(count=count + iterated.count), work + iterated.count[0] * step[0], place


def resolve(ev, rtol):
    """Ends of panels (tuple) that resolve q and λ of the solution `ev`, and y (1, n) at their nodes. If the panels of
    `ev` resolve them, they stay."""
    mesh, law = ev.mesh, ev.cases.law
    values = np.concatenate([ev.curve.q, law.area(ev.state.y, ev.curve.q)])
    scale = values @ mesh.w * max(_SHARE * rtol, _FLOOR)
    inside = dict(zip(pairwise(mesh.breaks), np.split(ev.state.y, len(mesh.breaks) - 1, axis=1), strict=True))
    done, room = {}, _MOST - len(inside) + _MORE * (len(ends_of(ev.cases.shape, _radius(ev))) - 2)
    levels = DEPTH + 1 if ev.cases.punch.polynomial else _AT_ONCE
    # if the profile is not smooth on the axis, the load changes little, and the pressure there much
    centre = max(rtol, _FLOOR) * values[:, -1] if bends_on_axis(ev.cases.shape) else np.inf
    while inside:  # panel -> y at its nodes
        halves, levels = [], levels - 1
        for (low, high), y in inside.items():
            tail, least = _tail(law, y), scale if high < 1.0 else np.minimum(scale, centre * (high**2 - low**2))
            if levels >= 0 and room > 0 and high - low > 2.0**-DEPTH and np.any(tail * (high**2 - low**2) > least):
                middle = (low + high) / 2
                halves += [(low, middle), (middle, high)]
                room -= 1
            else:
                done[low] = y
        inside = dict(zip(halves, _between(ev, halves), strict=True)) if halves else {}
    return (*sorted(done), 1.0), np.concatenate([done[low] for low in sorted(done)], axis=1)


def _between(ev, panels):
    """y (1, ORDER) at the nodes of each of the `panels` (low, high), by interpolation."""
    y = interpolate(ev, np.concatenate([on_panels(radau_nodes(ORDER), panel) for panel in panels]))
    return np.split(y, len(panels), axis=1)


def _tail(law, y):
    """Sums (2,) of the absolute values of the last two coefficients of q and of λ, from y (1, ORDER) at the nodes of a
    panel."""
    q = law.evaluate(y).q
    return np.abs(np.concatenate([q, law.area(y, q)]) @ _LAST).sum(axis=1)


def ends_of(shape, a):
    """Ends (tuple) in s, from 0 to 1, of the smooth parts of a contact of radius a, a float, under one `shape`; (0, 1)
    if there are no kinks inside."""
    inside = np.array([b for b in np.unique(shape.kinks()[0]) if 0 < b < a])
    s = np.sqrt((1 - inside / a) * (1 + inside / a))
    s = np.sort(s[(s > _AT_EDGE) & (s < 1 - _AT_AXIS)])
    return (0.0, *s.tolist(), 1.0) if len(s) <= MOST_KINKS else (0.0, 1.0)


def panels_between(ends, shape):
    """Ends (tuple) of the first panels between the `ends` of smooth parts, under one `shape`."""
    breaks = [0.0]
    for low, high in zip(ends, ends[1:], strict=False):
        levels = _LEVELS if high < 1.0 else _on_axis(shape)
        inner = [part for part in _FROM_EDGE[1:] if not levels or part < 0.75] if low == 0.0 else _graded(_LEVELS)[::-1]
        inner = sorted([*inner, *(1 - part for part in _graded(levels))])
        breaks += [low + (high - low) * part for part in dict.fromkeys([*inner, _WHOLE])]
    return tuple(breaks)


def _graded(levels):
    """Distances of ends of panels from a kink, up to the middle of the part, over the length to the next kink."""
    return [0.5 * _SHRINK**level for level in range(levels)]


def _on_axis(shape):
    """The number of times that panels shrink towards the axis."""
    if shape.pointed[0]:
        return _TO_POINT
    return _ON_AXIS * bends_on_axis(shape)


def bends_on_axis(shape):
    """Whether a profile without a point is still not smooth on the axis: it is not a smooth function of r², and this is
    not due to a kink elsewhere."""
    if shape.even[0] or shape.pointed[0]:
        return False
    return bool(np.isnan(shape.kinks()[0]).all())


def stretch(breaks, ends, new):
    """The panels `breaks` between `ends`, stretched so that the ends come to lie at `new`, a tuple of equal length."""
    return tuple(np.interp(breaks, ends, new).tolist())


def settled(shape, before, a, rtol):
    """Whether the kinks are, at the contact radius a, still where they were at the radius `before`; both floats."""
    if len(ends_of(shape, a)) == len(ends_of(shape, before)) == 2:
        return True
    least = float(shape.least()[0])
    rounding = _ROUNDING * a / (a - least)
    return abs(np.log((a - least) / (before - least))) <= max(_SETTLED * rtol, rounding)

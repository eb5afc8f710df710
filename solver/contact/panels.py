"""Cases that one polynomial does not resolve: polynomials on panels, chosen for each case by how its solution varies.

Where the asperities saturate, A → B̄²/(3Ra), inside a contact, the pressure has a corner at s² = Z/3, as wide as the
base is stiff; a stiff or thin base adds an edge layer. Both are found by the coefficients of the pressure and of the
contact area on each panel, and enclosed by halving.
"""

import numpy as np

from ..body.layered import octave_of
from ..body.springs import local_compliance
from ..body.wave_rule import FILM
from ..numerics.mesh import on_panels, panel_mesh
from ..numerics.quadrature import radau_nodes
from .budget import panel_work
from .equation import State, evaluate, first_guess, guess_radius
from .results import interpolate

#: Panels to begin with, nodes on each, and the narrowest panel as a power of 1/2.
START = (0.0, 0.0625, 0.25, 0.5, 0.75, 1.0)
ORDER = 12
DEPTH = 30
#: More panels than this are not made: the operator is not accurate enough to tell more.
_MOST = 32
#: Films thinner than this times the radius start from the thin layer.
_THIN = 0.02
#: Tolerances of the rounds of solving and halving: a coarse solution cannot tell where a fine one is not resolved.
_GOALS = (1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 1e-13)
#: A panel is resolved when what its last coefficients add to the load and the real area is below this times rtol.
_SHARE = 0.3
#: ... or, for the smallest rtol, below this: the operator has an error too.
_FLOOR = 1e-12


def solve_on_panels(case, rtol, iterate, budget):
    """Solve one case (a batch of one) on panels that resolve it, or as far as the budget goes.

    iterate(case, state, grid) -> state, closed (1,), count (1,).

    Returns
    -------
    grid, state, closed, count, work (more than the budget: it was spent before all was resolved)
    """
    breaks, state, total, work = START, None, 0, 0.0
    if case.layer is not None and case.layer.h[0] < _THIN * guess_radius(case)[0]:
        alike = _on_thin_layer(case)
        if alike.C[0] > 0:  # nearly the same solution, far cheaper
            grid, found, closed, total, work = solve_on_panels(alike, rtol, iterate, budget)
            if closed[0]:
                breaks, state = grid.breaks, found
    goals = np.maximum(rtol, _GOALS)
    film = case.layer is not None and octave_of(case.layer, guess_radius(case))[0][0] == FILM
    for i, goal in enumerate(goals):
        grid = panel_mesh(ORDER, breaks)
        state, closed, count = iterate(case, state or first_guess(case, grid), grid)
        total += count
        ev = evaluate(case, state, grid)
        if not np.isfinite(ev.residual[0]) or i == len(goals) - 1:
            break
        better = resolve(case, ev, state, grid, goal)
        if better == breaks:
            if goal == rtol:
                break
            continue
        work += panel_work(ORDER * (len(better) - 1), film)
        if work > budget:
            break
        nodes = on_panels(radau_nodes(ORDER), better)
        state, breaks = State(interpolate(case, ev, grid, nodes), state.eta), better
    return grid, state, closed, total, work


def _on_thin_layer(case):
    """The case with the thin layer in place of the exact one."""
    springs = local_compliance(*case.layer)
    return case._replace(layer=None, E=np.ones_like(case.E), C=springs)


def resolve(case, ev, state, grid, rtol):
    """Ends of panels (tuple) that resolve q and λ of a solution; those of `grid` where it is resolved."""
    q = ev.curve.q[0]
    lam = case.law.area(state.y, q[None])[0]
    scale = np.array([q @ grid.w, lam @ grid.w]) * max(_SHARE * rtol, _FLOOR)
    inside = {}  # panel -> values of q and λ at its nodes
    for i, panel in enumerate(zip(grid.breaks[:-1], grid.breaks[1:], strict=True)):
        part = slice(i * grid.order, (i + 1) * grid.order)
        inside[panel] = np.stack([q[part], lam[part]])
    ends, todo, room = {1.0}, list(inside), _MOST - len(inside)
    while todo:
        halves = []
        for low, high in todo:
            if room > 0 and high - low > 2.0**-DEPTH and np.any(_tail(inside[low, high]) * (high**2 - low**2) > scale):
                middle = (low + high) / 2
                halves += [(low, middle), (middle, high)]
                room -= 1
            else:
                ends.add(low)
        if halves:
            nodes = np.concatenate([low + (high - low) * radau_nodes(ORDER) for low, high in halves])
            y = interpolate(case, ev, grid, nodes)
            q_new = case.law.evaluate(y).q
            values = np.stack([q_new[0], case.law.area(y, q_new)[0]])
            inside = dict(zip(halves, np.split(values, len(halves), axis=1), strict=True))
        todo = halves
    return tuple(sorted(ends))


def _tail(values):
    """Size of the last two Legendre coefficients of values (k, ORDER) at the nodes of a panel: (k,)."""
    return np.abs(values @ _LAST).sum(axis=1)


_LAST = np.linalg.inv(np.polynomial.legendre.legvander(2 * radau_nodes(ORDER) - 1, ORDER - 1)).T[:, -2:]

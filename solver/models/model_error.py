"""The error of a cheap model against the exact layer with its asperities, estimated from the solution of the cheap one.

One Newton step of the exact equation begins at the pressure and the radius of the cheap solution. It gives to first
order what the exact model would have found under the same control. The largest relative difference over a, P, D, p(0),
p_max, Ar/An is the estimate.
"""

from dataclasses import replace

import numpy as np

from ..contact.equation import State, evaluate
from ..contact.error import nearby
from ..contact.newton import advance
from ..contact.results import difference, quantities
from ..numerics.mesh import mesh_of
from ..scaling import as_cases
from ..solution import Solution
from .thin_layer_error import largest_error

#: Nodes of the step: they need only resolve the error, not the solution.
NODES = 24


def judged(problem, x, solve):
    """:class:`Solution` of thin layers in units R = E2* = 1, with the model error of first order.

    problem : all of base "thin_layer"; x : (m,) radii; solve : ``solve(problem, x)``, without this estimate.
    """
    pieces = []
    for micro in np.unique(problem.micro):
        index = np.flatnonzero(problem.micro == micro)
        part = problem.take(index).but(model_check="closed_form")
        found = solve(part, np.concatenate([x, mesh_of(NODES).x]))
        error = first_order(as_cases(part.but(base="layered")), found, found.p[:, len(x) :])
        shown = {"p": found.p[:, : len(x)], "lam": found.lam[:, : len(x)]}
        pieces.append((index, replace(found, **shown, model_error=error)))
    return Solution.join(len(problem), len(x), pieces)


def first_order(cases, cheap, p):
    """Estimated relative error (B,) of a cheap solution against the exact model `cases`, to first order. It is
    NaN for a case whose cheap solution has no numbers, inf where the step fails.

    cases : the exact equation in units R = E2* = 1; cheap : the cheap solution in the same units, and p (B, NODES) its
        nominal pressure at the nodes ``mesh_of(NODES).x``
    """
    state = State(cases.law.from_pressure(p / cases.law.p_star[:, None]), np.log(cheap.a))
    ev = evaluate(cases, state, mesh_of(NODES))
    state, _ = advance(ev)
    exact = quantities(nearby(ev, state, cases.law.evaluate(state.y)))
    error = difference(cheap, exact)
    return np.where(np.isfinite(cheap.a) & ~np.isfinite(error), np.inf, error)


def closed_form(problem, a):
    """Estimated relative error (B,) of the thin-layer model, as if asperities did not yield; nothing is solved for it.

    `a` (B,) are its contact radii, in the unit of `problem.h`. NaN where the thin-layer equation does not apply. The
    estimate, :func:`~solver.models.thin_layer_error.largest_error`, is made for a rigid punch. Under an elastic one its
    value at given a, which is the largest of the three controls, is taken for each control.
    """

    def error(part, radius, control):
        return largest_error(
            control, part.h / radius, part.n, part.nu1, part.nu2, part.bonding == "bonded", part.rough()
        )

    found, yields = error(problem, a, problem.control), np.flatnonzero(problem.m > 0)
    if len(yields):
        found[yields] = error(problem.take(yields), a[yields], "a")
    return found

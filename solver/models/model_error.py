"""The error of a cheap model against the exact layer with its asperities, estimated from the solution of the cheap one.

From there Newton's method solves the exact equation, and the cheap one too, on a coarse mesh under the same control.
The estimate is the largest relative difference of the first over a, P, D, p(0), p_max, Ar/An, plus that of the second,
which is what the mesh misses.
"""

from dataclasses import replace

import numpy as np

from ..contact.driver import solve_on
from ..contact.equation import State, evaluate
from ..contact.results import difference, quantities
from ..numerics.mesh import mesh_of
from ..scaling import as_cases
from ..solution import Solution
from .thin_layer_error import largest_error

#: Nodes of the mesh.
NODES = 24


def judged(problem, x, solve):
    """:class:`Solution` of thin layers in units R = E2* = 1, with the `model_error` of `model_check` "first_order".

    problem : all of base "thin_layer"; x : (m,) radii; solve : ``solve(problem, x)``, without this estimate.
    """
    pieces = []
    for micro in np.unique(problem.micro):
        index = np.flatnonzero(problem.micro == micro)
        part = problem.take(index).but(model_check="closed_form")
        found = solve(part, np.concatenate([x, mesh_of(NODES).x]))
        p = found.p[:, len(x) :]
        error = sum(distance(as_cases(one), found, p) for one in (part.but(base="layered"), part))
        shown = {"p": found.p[:, : len(x)], "lam": found.lam[:, : len(x)]}
        pieces.append((index, replace(found, **shown, model_error=error)))
    return Solution.join(len(problem), len(x), pieces)


def distance(cases, cheap, p):
    """Relative difference (B,) of a cheap solution from that of `cases` on NODES nodes: NaN for a case whose cheap
    solution has no numbers, inf where Newton's method from it finds none.

    One step would not do: on a layer that is nearly incompressible the exact pressure at the edge is several times that
    of the thin layer, and a step finds a part of this only (tests/models/test_first_order.py).

    cases : in units R = E2* = 1; cheap : the cheap solution in the same units
    p : (B, NODES), its nominal pressure at the nodes ``mesh_of(NODES).x``
    """
    state = State(cases.law.from_pressure(p / cases.law.p_star[:, None]), np.log(cheap.a))
    found = solve_on(evaluate(cases, state, mesh_of(NODES)))
    error = np.where(found.closed, difference(cheap, quantities(found.at)), np.inf)
    return np.where(np.isfinite(cheap.a), error, np.nan)


def closed_form(problem, a):
    """Estimated relative error (B,) of the thin-layer model, as if asperities did not yield, by
    :func:`~solver.models.thin_layer_error.largest_error`; NaN where the thin-layer equation does not apply.

    `a` (B,) are its contact radii, in the unit of `problem.h`. The estimate is made for a rigid punch. Under an elastic
    one its value at given a, the largest of the three, is taken for each control.
    """

    def error(part, radius, control):
        return largest_error(
            control, part.h / radius, part.n, part.nu1, part.nu2, part.bonding == "bonded", part.rough()
        )

    found, yields = error(problem, a, problem.control), np.flatnonzero(problem.m > 0)
    if len(yields):
        found[yields] = error(problem.take(yields), a[yields], "a")
    return found

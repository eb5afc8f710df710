"""The error of a cheap model against the exact layer with its asperities, estimated from the cheap solution.

Starting from this solution, Newton's method solves two equations on a coarse mesh under the same control, the exact one
and the cheap one. For each the largest relative change over a, P, D, p(0), p_max, Ar/An counts, and the estimate is
their sum: the second is the error of the mesh.
"""

from dataclasses import replace

import numpy as np

from ..bases import exact_of
from ..numerics.batch import alike
from ..numerics.mesh import mesh_of
from ..rough.equation import Unknowns, evaluate
from ..rough.newton import solve_on
from ..rough.results import difference, quantities
from ..scaling import as_cases, dimensionless, kinds_of_laws, restore
from ..solution import Solution
from .named import error_of_law, solve_named, with_model_error

#: Nodes of the mesh.
NODES = 24


def judged(problem, x):
    """:class:`Solution` of thin layers, in the units of the problem, with the `model_error` of `model_check`
    "first_order".

    problem : cases of the bases "thin_layer" and "thin_stack"; x : (m,) radii
    """
    pieces, scaled = [], dimensionless(problem)
    exact = scaled.but(base=exact_of(scaled.base))
    for index in alike(problem.micro, problem.base, kinds_of_laws(exact)):
        part = scaled.take(index).but(model_check="closed_form")
        cheap = solve_named(part, np.concatenate([x, mesh_of(NODES).x]))
        solved, error = np.flatnonzero(np.isfinite(cheap.a)), np.full(len(index), np.nan)
        if len(solved):
            part, start, p = part.take(solved), cheap.take(solved), cheap.p[solved, len(x) :]
            both = as_cases(exact.take(index[solved])), as_cases(part)
            error[solved] = sum(distance(cases, start, p) for cases in both) + error_of_law(part)
        shown = {"p": cheap.p[:, : len(x)], "lam": cheap.lam[:, : len(x)]}
        pieces.append((index, replace(cheap, **shown, model_error=error)))
    return with_model_error(problem, restore(Solution.join(len(problem), len(x), pieces), problem))


def distance(cases, cheap, p):
    """Relative difference (B,) of a cheap solution from the solution of `cases` on NODES nodes; inf where Newton's
    method, which starts from the cheap solution, does not converge.

    One step is not enough: on a layer that is nearly incompressible the exact pressure at the edge is several times
    that of the thin layer, and a step covers only a part of the difference (tests/models/test_first_order.py).

    cases : in units R = E2* = 1; cheap : the cheap solution in the same units
    p : (B, NODES), its nominal pressure at the nodes ``mesh_of(NODES).x``
    """
    state = Unknowns(cases.law.from_pressure(p / cases.law.p_star[:, None]), np.log(cheap.a))
    iterated = solve_on(evaluate(cases, state, mesh_of(NODES)))
    return np.where(iterated.closed, difference(cheap, quantities(iterated.at)), np.inf)

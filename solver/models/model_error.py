"""The error of a cheap model against the exact layer with its asperities, estimated from the solution of the cheap one.

One Newton step of the exact equation (two, where asperities come in) begins at the pressure and the radius of the cheap
solution. It gives to first order what the exact model would have found under the same control. The largest relative
difference over a, P, D, p(0), p_max, Ar/An is the estimate. A whole solution takes some ten steps on each of several
meshes; this takes one, on few nodes.
"""

import numpy as np

from ..contact.equation import State, evaluate
from ..contact.error import nearby
from ..contact.newton import advance
from ..contact.results import difference, quantities
from ..numerics.mesh import mesh
from .thin_layer_error import largest_error

#: The base "auto" multiplies the estimate by this. Below TRUSTED, the estimate is at least 0.85 of the true error on
#: the grids of studies/validity.toml and validity_load.toml; tests/models/test_auto.py holds it to that.
MARGIN = 1.25
#: A larger estimate only says that the error is large: "auto" takes no cheap model there.
TRUSTED = 0.3
#: Nodes of the step for an accuracy of at least this; they need only resolve the error, not the solution.
_NODES = ((5e-5, 16),)


def nodes_for(accuracy):
    """Number of nodes (B,) of the Newton step whose estimate is compared with `accuracy` (B,)."""
    return np.select([accuracy >= limit for limit, _ in _NODES], [n for _, n in _NODES], 24)


def first_order(cases, cheap, p, n, steps=1):
    """Estimated relative error (B,) of a cheap solution against the exact model `cases`, to first order.

    Parameters
    ----------
    cases : Cases
        The exact equation of the B cases in units R = E2* = 1.
    cheap : Solution
        The cheap solution in the same units.
    p : (B, n) float, E2*
        Its nominal pressure at the nodes ``mesh(n).x``.
    n : int
        Number of nodes.
    steps : int
        Newton steps. Two, where the cheap solution is smooth and the exact one is not: asperities change the pressure
        most at the edge, where the smooth one has a root, and one step does not follow.

    Returns
    -------
    (B,) float
        NaN for a case whose cheap solution has no numbers, inf where the step fails.
    """
    state = State(cases.law.from_pressure(p / cases.law.p_star[:, None]), np.log(cheap.a))
    for _ in range(steps):
        ev = evaluate(cases, state, mesh(n))
        state, _ = advance(ev)
    exact = quantities(nearby(ev, state, cases.law.evaluate(state.y)))  # to first order, as the step itself
    error = difference(cheap, exact)
    return np.where(np.isfinite(cheap.a) & ~np.isfinite(error), np.inf, error)


def closed_form(problem, a):
    """Estimated relative error (B,) of the thin-layer model, without asperities and at no cost.

    `a` (B,) are its contact radii, in the unit of `problem.h`. NaN where the thin-layer equation does not apply. See
    :func:`~solver.models.thin_layer_error.largest_error`.
    """
    material = problem.n, problem.nu1, problem.nu2, problem.bonding == "bonded"
    return largest_error(problem.control, problem.h / a, *material)

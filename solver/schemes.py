"""The schemes that solve rough cases, and all cases on exact layers. Each is one function."""

from dataclasses import replace

import numpy as np

from .compiled import newton_in_c as compiled
from .known import register_scheme
from .numerics.ladder import start_nodes
from .numerics.mesh import mesh_of
from .rough import picard as approximations
from .rough.answer import answer
from .scaling import as_cases
from .solution import Solution

#: Name -> ``function(part, x)``.
SCHEMES = {}


def scheme(function):
    """Decorator that makes a function a scheme under its own name, which becomes a choice of the parameter `scheme`.

    ``function(part, x) -> Solution`` gets a :class:`~solver.problem.Problem` with one micro law, one body and one
    `max_iterations`, in units R = E2* = 1, and the radii x (m,); docs/extending.md shows an example. A case whose error
    is above its rtol gets ``Status.TOLERANCE_NOT_MET``, whatever status the scheme returns.

    Raises ValueError if a scheme of another module has this name: its results on disk would be confused with those of
    this one.
    """
    other = SCHEMES.get(function.__name__, function)
    if other.__module__ != function.__module__:
        raise ValueError(f"scheme {function.__name__}: {other.__module__} has one of this name: take another name")
    SCHEMES[function.__name__] = function
    register_scheme(function.__name__)
    return function


@scheme
def newton(part, x):
    """Newton's method, for each case on the mesh that meets rtol."""
    return compiled.solve_newton(as_cases(part), part.rtol, part.nodes, int(part.max_iterations[0]), x)


@scheme
def picard(part, x):
    """The paper's successive approximations on one mesh, of `nodes` nodes; if that is 0, of as many as rtol is likely
    to need. `error` is their distance from the result of one Newton step on the next finer mesh."""
    nodes = np.where(part.nodes > 0, part.nodes, start_nodes(part.rtol))
    groups = [(n, np.flatnonzero(nodes == n)) for n in np.unique(nodes).tolist()]
    return Solution.join(len(nodes), len(x), [(i, _picard_on(part.take(i), mesh_of(n), x)) for n, i in groups])


def _picard_on(part, mesh, x):
    iterated, status = approximations.solve(as_cases(part), mesh, part.k, part.rtol, int(part.max_iterations[0]))
    return replace(answer(iterated, x).solution, status=status)

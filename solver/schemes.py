"""The schemes by which rough cases, and all on the exact layer, are solved. Each is one function."""

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
    """Decorator: make a function a scheme of its name, and the name a choice of the parameter `scheme`.

    ``function(part, x) -> Solution`` gets a :class:`~solver.problem.Problem` of one micro law, one body and one
    `max_iterations`, in units R = E2* = 1, and the radii x (m,); docs/extending.md shows one. A case whose error is
    above its rtol is ``Status.TOLERANCE_NOT_MET``, whatever the scheme says.

    Raises ValueError for the name of a scheme of another module: its results on disk would be taken for those of this
    one.
    """
    other = SCHEMES.get(function.__name__, function)
    if other.__module__ != function.__module__:
        raise ValueError(f"scheme {function.__name__}: {other.__module__} has one of this name: take another name")
    SCHEMES[function.__name__] = function
    register_scheme(function.__name__)
    return function


@scheme
def newton(part, x):
    """Newton's method, on the mesh that meets rtol."""
    return compiled.solve_newton(as_cases(part), part.rtol, part.nodes, int(part.max_iterations[0]), x)


@scheme
def picard(part, x):
    """The paper's successive approximations on one mesh: of `nodes` nodes, or if that is 0 of as many as rtol is likely
    to need. `error` is their distance to one Newton step on the next finer mesh."""
    nodes = np.where(part.nodes > 0, part.nodes, start_nodes(part.rtol))
    groups = [(n, np.flatnonzero(nodes == n)) for n in np.unique(nodes).tolist()]
    return Solution.join(len(nodes), len(x), [(i, _approximated(part.take(i), mesh_of(n), x)) for n, i in groups])


def _approximated(part, mesh, x):
    iterated, status = approximations.solve(as_cases(part), mesh, part.k, part.rtol, int(part.max_iterations[0]))
    return replace(answer(iterated, x).solution, status=status)

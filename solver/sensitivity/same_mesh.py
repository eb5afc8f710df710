"""The solved equation of cases whose radius is known, on the mesh of their solution, by a few Newton steps."""

import numpy as np

from ..numerics.ladder import LADDER
from ..numerics.mesh import mesh_of
from ..rough.equation import evaluate
from ..rough.newton import budget_of, solve_on
from ..rough.panels import solve_on_panels
from ..rough.results import quantities
from ..rough.start import first_guess
from ..scaling import as_cases, kinds_of_laws
from ..ways import by_equation

#: The closed form of the smooth half-space is a polynomial in s, which the coarsest mesh represents exactly.
_LEAST = LADDER[0]


def meshes(solution, problem):
    """Number of nodes (B,) of the one panel on which each case was solved; 0 for cases on several panels."""
    nodes = np.maximum(solution.nodes, _LEAST)
    return np.where((problem.nodes > 0) | np.isin(nodes, LADDER), nodes, 0)


def without_state(problem):
    """(B,) bool: cases whose equation is not that of :mod:`..rough`: smooth punches that are not paraboloids, contacts
    with adhesion, and flat punches."""
    return ~by_equation(problem, "nodes")


def stacks(problem, nodes, a, most, *words):
    """Yield stacks: the indices of cases with one law, base, shape and mesh, and with the same further `words` (B,);
    and their number of nodes, which is 0 for a single case on panels. No stack has more than `most` unknowns."""
    kinds = nodes.astype(str), problem.micro, problem.base, problem.shape, kinds_of_laws(problem).astype(str)
    kinds = np.stack([*kinds, *words])
    for kind in np.unique(kinds, axis=1).T:
        index, count = np.flatnonzero(np.all(kinds == kind[:, None], axis=0)), int(kind[0])
        order = as_cases(problem.take(index)).body.order(a[index])
        index = index if order is None else index[order]
        yield from ((part, count) for part in np.array_split(index, -(-len(index) * count // most) or len(index)))


def solve_again(cases, nodes, a, rtol):
    """:class:`~solver.rough.newton.Iterated` of cases in units R = E2* = 1, at the radii a (B,) on `nodes` nodes. With
    0 nodes: that of a single case under its control, on panels of its own, whose tables may still be in the cache."""
    if not nodes:
        return solve_on_panels(cases, rtol[0], budget_of(cases))[0]
    mesh, cases = mesh_of(nodes), cases._replace(control="a", value=a)
    return solve_on(evaluate(cases, first_guess(cases, mesh, a), mesh))


def same(ev, solution, rtol):
    """(B,) bool: whether `ev` has the radius and the depth of `solution`, to rtol (B,). It may differ where there are
    two solutions, or if the panels are different."""
    results = quantities(ev)
    return np.maximum(np.abs(results.a / solution.a - 1), np.abs(results.D / solution.D - 1)) <= rtol

"""The solved equation of cases whose radius is known: on the mesh that gave the solution, by a few Newton steps."""

import numpy as np

from ..contact.driver import solve_on
from ..contact.equation import evaluate
from ..contact.results import difference, quantities
from ..contact.start import first_guess
from ..numerics.mesh import mesh_of

#: A solution found again may differ from the first by its rounding and by what a loose operator leaves out, this part
#: of rtol. Where it differs by more, its mesh was another one, or there are two solutions.
_SAME = 0.1


def found_again(cases, solution, nodes, rtol):
    """:class:`~solver.contact.equation.Evaluation` of cases on `nodes` nodes, and (B,) bool: it is that of `solution`.

    cases : in units R = E2* = 1, as `solution` is; nodes : int; rtol : (B,)
    """
    mesh = mesh_of(nodes)
    iterated = solve_on(evaluate(cases, first_guess(cases, mesh, solution.a), mesh))
    change = difference(quantities(iterated.at), solution)
    if cases.law.law.corners:  # whose Ar/An is not the sum over the nodes
        change = np.abs(iterated.at.state.eta - np.log(solution.a))
    return iterated.at, iterated.closed & (change <= _SAME * rtol)

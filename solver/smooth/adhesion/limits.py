"""Stand-ins for contacts that stick where their equations lose their digits: narrow rings, hardly any adhesion.

The narrower the ring of :mod:`.maugis`, the nearer are its contacts to those of :mod:`.jkr`; and there is a work of
adhesion so small that it changes no digit of a contact.
"""

from dataclasses import replace

import numpy as np

from ...solution import PULLS, Solution
from ...status import Status
from .maugis import ring_stress

#: The numbers of contacts with a ring, d wide, are farther from those of an edge by at most this times d/a of pull-off:
#: 0.2 to 0.3 (tests/smooth/test_zero.py). From this part on nothing is gained.
_OF_RING, _WIDE = 2.0, 0.1
#: A work of adhesion above this always counts, in units R = E2* = 1; one that changes load and depth by less than this
#: part changes no digit; and two contacts are the same up to this part.
_COUNTS, _NO_DIGIT, _SAME = 1e-20, 1e-16, 1e-9
#: Below this rings have no digits at pull-off.
_DEEP = 1e-100
_WITH_ERROR = (Status.CONVERGED, Status.TOLERANCE_NOT_MET)


def with_edges(part, body, solution, solve_edges, x):
    """The `solution` of contacts with rings. Where contacts with an edge, from ``solve_edges(part, index, x)``, are
    more accurate, they stand instead: their error is that of the edge and the change by the ring, which is about
    π E w/(4 σ₀²) wide."""
    failed = np.isin(solution.status, (Status.DIVERGED, *_WITH_ERROR)) & ~(solution.error <= part.rtol)
    sigma, none = ring_stress(part), np.full(len(part), np.nan)
    with np.errstate(all="ignore"):
        width = np.pi * body.E * (part.w_adhesion / sigma) / sigma / 4
    index = np.flatnonzero(failed & (width < _WIDE))
    if not len(index):
        return solution
    few, edge = solution.take(index), solve_edges(part.but(adhesion="jkr", sigma0=none, z0=none).take(index), index, x)
    wide = ~(width[index] < _WIDE * edge.a_off / _OF_RING)  # at pull-off, which has an equation with digits then
    pulls = {name: np.where(wide, getattr(few, name), getattr(edge, name)) for name in PULLS}
    error = edge.error + _OF_RING * width[index] / np.where(wide, edge.a, np.fmin(edge.a, edge.a_off))
    pulled = (edge.status == Status.PULLED_OFF) & (few.status == Status.DIVERGED) & ~wide
    better = pulled | np.isin(edge.status, _WITH_ERROR) & ~(error >= few.error) & np.isfinite(pulls["P_off"])
    rest = {"error": error, "profile_error": np.maximum(edge.profile_error, error)}
    edge = replace(edge, **pulls, **rest, stable=edge.a >= pulls["a_off"])
    return _joined(solution, index[better], edge.take(better), x)


def without(part, body, solution, solve_free, x):
    """The `solution` of contacts that stick. Where it failed, or is another contact, although the work of adhesion is
    too small to change a digit, it has the numbers of the contact without adhesion, from ``solve_free(part, x)``."""
    tiny = (part.w_adhesion < _COUNTS) & (part.value > 0) & ((part.branch == "stable") | (part.control == "a"))
    index = np.flatnonzero(tiny)
    if not len(index):
        return solution
    free, few = solve_free(part.but(w_adhesion=np.zeros(len(part))).take(index), x), solution.take(index)
    edge = np.sqrt(2 * np.pi * free.a / body.E[index]) * np.sqrt(part.w_adhesion[index])
    nothing = (edge < _NO_DIGIT * free.D) & (edge * free.dP_dD < _NO_DIGIT * free.P)
    same = (
        (few.status == Status.CONVERGED)
        & np.isfinite(few.error)
        & np.all([np.abs(getattr(few, name) / getattr(free, name) - 1) < _SAME for name in "aPD"], axis=0)
    )
    same &= (part.adhesion[index] != "maugis") | (part.w_adhesion[index] > _DEEP)
    rows = nothing & (free.status == Status.CONVERGED) & ~same
    return _joined(solution, index[rows], free.take(rows), x)


def _joined(solution, index, others, x):
    whole = np.arange(len(solution.a))
    return Solution.join(len(whole), len(x), [(whole, solution), (index, others)]) if len(index) else solution

"""Substitutes for contacts with adhesion whose equations lose their digits: narrow rings, and hardly any adhesion.

Contacts with a narrow ring of :mod:`.maugis` are replaced by those of :mod:`.jkr`, to which they tend as the ring
narrows. Contacts whose work of adhesion is too small to change a digit are replaced by those without adhesion.
"""

from dataclasses import replace

import numpy as np

from ...solution import PULLS, Solution
from ...status import Status
from .maugis import ring_stress

#: The relative difference between contacts with a ring of the width d and those with an edge is at most _OF_RING d/a,
#: with a of pull-off; it is 0.2 to 0.3 d/a (tests/smooth/test_zero.py). Rings with d/a above _WIDE are not replaced.
_OF_RING, _WIDE = 2.0, 0.1
#: A work of adhesion above _COUNTS, in units R = E2* = 1, is never left out. Below it, one that changes load and depth
#: by less than the part _NO_DIGIT is. Contacts whose numbers differ by less than the part _SAME are the same.
_COUNTS, _NO_DIGIT, _SAME = 1e-20, 1e-16, 1e-9
#: Below this work of adhesion rings have no digits at pull-off.
_DEEP = 1e-100
_WITH_ERROR = (Status.CONVERGED, Status.TOLERANCE_NOT_MET)


def with_edges(part, body, solution, solve_edges, x):
    """The `solution` of contacts with rings. Cases for which contacts with an edge, from ``solve_edges(part, index,
    x)``, are more accurate have those numbers instead; the error then includes the effect of the ring, whose width is
    about π E w/(4 σ₀²)."""
    failed = np.isin(solution.status, (Status.DIVERGED, *_WITH_ERROR)) & ~(solution.error <= part.rtol)
    sigma, none = ring_stress(part), np.full(len(part), np.nan)
    with np.errstate(all="ignore"):
        width = np.pi * body.E * (part.w_adhesion / sigma) / sigma / 4
    index = np.flatnonzero(failed & (width < _WIDE))
    if not len(index):
        return solution
    few, edge = solution.take(index), solve_edges(part.but(adhesion="jkr", sigma0=none, z0=none).take(index), index, x)
    wide = ~(width[index] < _WIDE * edge.a_off / _OF_RING)  # then the equation of rings has digits at pull-off
    pulls = {name: np.where(wide, getattr(few, name), getattr(edge, name)) for name in PULLS}
    error = edge.error + _OF_RING * width[index] / np.where(wide, edge.a, np.fmin(edge.a, edge.a_off))
    pulled = (edge.status == Status.PULLED_OFF) & (few.status == Status.DIVERGED) & ~wide
    better = pulled | np.isin(edge.status, _WITH_ERROR) & ~(error >= few.error) & np.isfinite(pulls["P_off"])
    rest = {"error": error, "profile_error": np.maximum(edge.profile_error, error)}
    edge = replace(edge, **pulls, **rest, stable=edge.a >= pulls["a_off"])
    return _joined(solution, index[better], edge.take(better), x)


def without(part, body, solution, solve_free, x):
    """The `solution` of contacts with adhesion. Cases whose work of adhesion is too small to change a digit, but whose
    solution failed or differs from the contact without adhesion, have the numbers of the latter instead, from
    ``solve_free(part, x)``."""
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

"""The pressure in the spots of asperities that feel their bodies: its maximum and the place of that, and whether it is
below 0 somewhere."""

import numpy as np

from ..bases import is_exact_stack, named
from ..laws import elastic_plastic
from ..laws.cell.members import members, peaks_of
from ..laws.cell.peak import NARROW, U
from ..laws.cell.summits import SUMMIT
from ..scaling import dimensionless, felt_body, law_of, of_one_law

#: On one layer with n up to this, the largest pressure stays in the middle: L - 1 is at most 1.2 there, and the largest
#: pressure leaves the middle at 1.6 (solver/laws/cell/peak.py).
_HARD = 2.0
#: The pressure in the middle of a spot falls below 0 if n is about 1e5. With n = 1e4 it never does
#: (tests/laws/cell/test_peak.py).
_LIFTS = 1e4


def pressure_in_spots(problem, solution, lam0):
    """p_spot and r_spot (2, B): the largest pressure in the central spot, and the radius of its place over that of the
    spot; NaN where asperities do not feel the body. `solution` is in the units of `problem`; lam0 : (B,), λ in the
    centre.

    If heights are random, the spot is that of the highest summit. Where spots yield, the difference between the ring
    and the middle is reduced by the same factor as that between the middle and the mean.
    """
    felt = problem.feels_layer() & np.isfinite(solution.p_max)
    answers = np.where(felt, [solution.p_max, np.zeros(len(problem))], np.nan)
    p0, p_max = solution.p0 / problem.E2, solution.p_max / problem.E2
    for index, part, body in _of_one_law(problem, felt & _may_be_hard(problem)):
        law = part.known.laws[str(part.micro[0])]
        b = largest_radius(part, body, lam0[index], p0[index])
        for rows, member in _wide_spots(part, body, b):
            here, some, radii = index[rows], part.take(rows), b[rows]
            unit, middle, ease = (body.E / (part.Ra * np.sqrt(part.Nbar)))[rows], p_max[here], 1.0
            if law.yielded:
                bound = law_of(some)
                middle, ease = elastic_plastic.in_the_middle(np.sqrt(np.pi) * radii[:, None], *bound.own)
                middle = bound.p_star * middle
            others = (p0[here] / unit,) * member.alone
            largest, answers[1, here] = peaks_of(member).at(np.minimum(radii, member.reach), middle / unit, *others)
            answers[0, here] += ease * (largest * unit - middle) * problem.E2[here]
    return answers


def lifts_off(problem, lam):
    """(B,) bool: whether the pressure is below 0 inside some spot; False for random heights, where it is not computed.
    lam : (B,), the largest λ of the contact."""
    lifted, felt = np.zeros(len(problem), dtype=bool), problem.feels_layer()
    problem = problem.but(base=named(problem.base))
    for index, part, body in _of_one_law(problem, felt & _may_be_hard(problem, _LIFTS)):
        b = np.sqrt(lam[index] / np.pi)
        for rows, member in _wide_spots(part, body, b, _LIFTS):
            if not member.alone:
                lifted[index[rows]] = peaks_of(member).lifts_off(np.minimum(b[rows], member.reach))
    return lifted


def _may_be_hard(problem, hard=_HARD):
    return is_exact_stack(problem.base) | (problem.n > hard)


def _of_one_law(problem, some):
    """Yield, for each law and base among the cases `some` (B,) bool: their indices, the cases in units R = E2* = 1, and
    their bodies."""
    index = np.flatnonzero(some)
    scaled = dimensionless(problem.take(index))
    for rows in of_one_law(scaled):
        part = scaled.take(rows)
        yield index[rows], part, felt_body(part)


def largest_radius(part, body, lam0, p0):
    """Radius (B,), in l, of the largest spot in the centre, for cases of one law in units R = E2* = 1. body : their
    body; lam0, p0 : (B,), λ and p in the centre."""
    if part.known.laws[str(part.micro[0])].cell != SUMMIT:
        return np.sqrt(lam0 / np.pi)
    bound = law_of(part, body)
    q = (p0 / bound.p_star)[:, None]
    y = bound.from_pressure(q)
    return bound.law.spot(y, q, *bound.own)[:, 0] / np.sqrt(np.pi)


def _wide_spots(part, body, b, hard=_HARD):
    """Yield the rows of cases of one family whose largest pressure may be outside the middle, and the
    :class:`~solver.laws.cell.members.Member`. b : (B,), radii of spots in l."""
    pitch = 1 / (body.h * np.sqrt(part.Nbar))
    wide = np.flatnonzero(b * pitch > NARROW)
    if not len(wide):
        return
    cell = part.known.laws[str(part.micro[0])].cell
    different, which = members(cell, pitch[wide], body.kernel.take(wide), body.m[wide])
    for j, member in enumerate(different):
        if member.cell.L1(U).max() > hard - 1:
            yield wide[which == j], member

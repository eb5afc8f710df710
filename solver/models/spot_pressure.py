"""The pressure in the spots of asperities that feel their bodies: where it is largest, and whether it is below 0."""

import numpy as np

from ..body import BODIES
from ..laws import LAWS, elastic_plastic
from ..laws.cell.members import members, peaks_of
from ..laws.cell.peak import NARROW, U
from ..scaling import dimensionless, law_of, of_one_law

#: Of one layer the largest pressure stays in the middle where n is at most this: L - 1 is nowhere above 1.2 there, and
#: it leaves at 1.6 (solver/laws/cell/peak.py).
_HARD = 2.0
#: The pressure in the middle of a spot falls below 0 where n is about 1e5, in no case yet where it is 1e4
#: (tests/models/test_spot_pressure.py).
_LIFTS = 1e4


def pressure_in_spots(problem, solution, lam0):
    """p_spot and r_spot (2, B): the largest pressure in the central spot, and its radius over that of the spot; NaN
    where asperities do not feel the body. `solution` is in the units of `problem`; lam0 : (B,), λ in the centre.

    Where spots yield the pressure in the ring exceeds that of the middle by as much less as the middle does its mean.
    """
    felt = problem.feels_layer() & np.isfinite(solution.p_max)
    made = np.where(felt, [solution.p_max, np.zeros(len(problem))], np.nan)
    for index, part, member, b in _wide_spots(problem, lam0, felt):
        body = BODIES[str(part.base[0])](part)
        unit, middle, ease = body.E / (part.Ra * np.sqrt(part.Nbar)), solution.p_max[index] / problem.E2[index], 1.0
        if LAWS[str(part.micro[0])].yielded:
            law = law_of(part, body)
            middle, ease = elastic_plastic.in_the_middle(np.sqrt(np.pi) * b[:, None], *law.own)
            middle = law.p_star * middle
        largest, made[1, index] = peaks_of(member).at(b, middle / unit)
        made[0, index] += ease * (largest * unit - middle) * problem.E2[index]
    return made


def lifts_off(problem, lam):
    """(B,) bool: the pressure is below 0 inside of a spot; lam : (B,), the largest λ of the contact."""
    lifted, felt = np.zeros(len(problem), dtype=bool), problem.feels_layer()
    problem = problem.but(base=np.where(problem.base == "auto", "layered", problem.base))
    for index, _, member, b in _wide_spots(problem, lam, felt, _LIFTS):
        lifted[index] = peaks_of(member).lifts_off(b)
    return lifted


def _wide_spots(problem, lam, felt, hard=_HARD):
    """Yield indices of `felt` (B,) cases of one law and family whose pressure may be largest beside the middle, these
    in units R = E2* = 1, the :class:`~solver.laws.cell.members.Member`, and the radii of the spots in l."""
    with np.errstate(invalid="ignore", over="ignore"):
        wide = lam > np.pi * problem.Nbar * (NARROW * problem.h) ** 2
        index = np.flatnonzero(felt & wide & ((problem.base == "stack") | (problem.n > hard)))
    scaled, b = dimensionless(problem.take(index)), np.sqrt(lam[index] / np.pi)
    for rows in of_one_law(scaled):
        part = scaled.take(rows)
        body = BODIES[str(part.base[0])](part)
        pitch = 1 / (body.h * np.sqrt(part.Nbar))
        different, which = members(LAWS[str(part.micro[0])].cell, pitch, body.kernel, body.m)
        for j, member in enumerate(different):
            if member.cell.L1(U).max() > hard - 1:
                some = np.flatnonzero(which == j)
                yield index[rows[some]], part.take(some), member, np.minimum(b[rows[some]], member.reach)

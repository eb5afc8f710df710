"""Cases whose pressures a micro law does not know, in part or in all."""

import numpy as np

from ..bases import is_bare
from ..kernels.two_layers import layer_modulus
from ..laws.cell.cell_law import end
from ..laws.cell.family import MOST
from ..parameters import one_of
from ..scaling import dimensionless, law_of, of_one_law
from ..status import Status

#: Radii r/a at which the pressure is compared with the range, whatever profile is asked for. They are denser near the
#: edge, where a hard film presses most.
_S = np.append(np.geomspace(1e-5, 0.09, 40), np.linspace(0.1, 1, 41))
RADII = np.sqrt((1 - _S) * (1 + _S))
#: Pitches that are above MOST h by no more than this are left to the law.
_EPS = 1e-9
#: Each of so many of these is enough for the largest pressure, of asperities that feel the body.
_FEW = 4
#: Near the edge p is below the first row of a table, p1, and A and λ are guesses. That changes a, P, D, p(0), p_max and
#: Ar/An by at most _GUESSED (p1/p(0))^_STEEPNESS. Random tables (`python tools/errors/own_tables.py`) need at most
#: 0.205 for _GUESSED; a table of random heights needs more than 0.25 (tests/laws/test_own_table_range.py).
_GUESSED, _STEEPNESS = 0.4, 1.2


def has_yield(problem):
    """(B,) bool: the cases whose micro law has spots that yield."""
    return one_of(problem.micro, [name for name, law in problem.known.laws.items() if law.yielded])


def radii_of(problem, all_of_them=False):
    """Radii r/a (m,) at which the pressure is compared with the range of the laws of a problem. There are none where
    these know all pressures, and few where they end at full spots alone; `all_of_them`: all RADII, whatever they
    know."""
    if all_of_them or _laws(problem):
        return RADII
    return RADII[::_FEW] if problem.feels_layer().any() else RADII[:0]


def outside_law(problem, solution):
    """(B,) bool: p(0) is below the range of the law, or p(0) or a pressure of the profile is above it; NaN is within.
    `solution` is in the units of `problem`."""
    outside = np.zeros(len(problem), dtype=bool)
    for law in _laws(problem):
        index, p0, E = _of_law(problem, solution, law)
        largest = np.maximum(p0, np.fmax.reduce(solution.p[index], axis=1, initial=0.0))
        outside[index] = (p0 < law.least * E) | (largest > law.most * E)
    return outside


def without_family(problem):
    """(B,) bool: the pitch is so many times the thickness of the layer that no law of asperities on a body knows it."""
    return problem.Nbar * (MOST * problem.h) ** 2 < 1 - _EPS


def beyond_end(problem, solution):
    """(B,) bool: cases with numbers of which p(0) or a pressure of the profile is beyond the end of the law of spots
    that feel the body, and all cases whose law ends at once. `solution` is in the units of `problem`, whose bases have
    names."""
    beyond = np.zeros(len(problem), dtype=bool)
    felt = np.flatnonzero(problem.feels_layer())
    scaled = dimensionless(problem.take(felt))
    for rows in of_one_law(scaled):
        index, most = felt[rows], end(law_of(scaled.take(rows)))
        largest = np.fmax(solution.p0[index], np.fmax.reduce(solution.p[index], axis=1, initial=0.0))
        solved = np.isin(solution.status[index], (Status.CONVERGED, Status.TOLERANCE_NOT_MET))
        beyond[index] = solved & (largest > most * problem.E2[index]) | ~(most > 0)
    return beyond


def edge_error(problem, solution):
    """(B,): relative error of contacts because their law begins at a pressure > 0; 0 where it does not."""
    error = np.zeros(len(problem))
    for law in _laws(problem):
        index, p0, E = _of_law(problem, solution, law)
        error[index] = _GUESSED * (law.least * E / p0) ** _STEEPNESS
    return error


def _laws(problem):
    """The laws of the problem that have a range."""
    present = set(problem.micro.tolist())
    return [law for law in problem.known.laws.values() if law.name in present and (law.least > 0 or law.most < np.inf)]


def _of_law(problem, solution, law):
    """Index, p(0) and the modulus E that the asperities feel, of the cases of a law. Where p(0) is not known, under a
    point, the largest pressure of the profile stands for it."""
    index = np.flatnonzero(problem.micro == law.name)
    part = problem.take(index)
    E = part.E2 * np.where(is_bare(part.base), 1.0, layer_modulus(part.n)) / (1 + part.m)
    p0 = solution.p0[index]
    return index, np.where(np.isnan(p0), np.fmax.reduce(solution.p[index], axis=1, initial=np.nan), p0), E

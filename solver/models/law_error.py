"""The errors of micro laws: pressures outside their range, and effects of a coated body that they leave out
(docs/coated_body.md).

The law of asperities that feel the body has three errors: the pressure of a spot is a mean over the angle, the
neighbours have no places in the disc cell, and they are a mean if heights are random. The law of asperities on a
half-space of the layer's material leaves out the whole effect of the body, which counts where their pitch is above h.
"""

from dataclasses import replace

import numpy as np

from ..bases import is_bare, is_exact, named
from ..body.graded import contrast
from ..kernels.two_layers import layer_modulus
from ..laws import LAWS
from ..laws.cell.cell_law import end
from ..laws.cell.family import MOST
from ..parameters import one_of
from ..problem import far_apart
from ..scaling import dimensionless, law_of, of_one_law
from ..status import Status

#: Radii r/a at which the pressure is compared with the range of the law, whatever profiles the caller wants. They are
#: denser near the edge, where a hard film presses most.
_S = np.append(np.geomspace(1e-5, 0.09, 40), np.linspace(0.1, 1, 41))
RADII = np.sqrt((1 - _S) * (1 + _S))
#: A pitch that exceeds MOST h by a relative _EPS at most is rounding, and the law still covers it.
_EPS = 1e-9
#: For asperities that feel the body, every _FEW-th of the RADII is enough for the largest pressure.
_FEW = 4
#: Near the edge p is below p1, the pressure of the first row of a table, and A and λ are guesses. That changes a, P, D,
#: p(0), p_max and Ar/An by at most _GUESSED (p1/p(0))^_STEEPNESS. Random tables (`python tools/errors/own_tables.py`)
#: need at most 0.205 for _GUESSED; a table of random heights needs more than 0.25
#: (tests/laws/test_own_table_range.py).
_GUESSED, _STEEPNESS = 0.4, 1.2
#: A law that errs more at low pressures has the error at this part of p(0): on three quarters of a contact p is larger.
_MIDDLE = 0.5
#: (factor, power): the error by the mean over the angle is the factor times (2 λ)^power, in A, λ or p_max, compared
#: with resolved cells (tests/models/test_errors_on_layers.py). One pair is for a square lattice, the other for a
#: hexagonal one, whose waves the disc cell has.
_SQUARE, _HEX = (0.03, 3.5), (1e-3, 4.0)
_ANGULAR = {"square_lattice": _SQUARE}
#: _DISC stands for a law that does not know the body, as the power law, which is fitted to it, and for laws without
#: places of the neighbours; _LATTICE is compared with it.
_DISC, _LATTICE = "disc_cell", "hex_lattice"
#: With random heights of the standard deviation _WIDE A*, D is larger by _DEEPER A* than with resolved ones, without a
#: layer and on one; the difference is proportional to the standard deviation above _WIDE A*, and to its square below.
#: The error of λ and p_max is up to _OF_LAMBDA from _LITTLE A* on (docs/validate.md;
#: tests/laws/heights/test_heights_on_body.py). A histogram counts as one of _WIDE A*.
_WIDE, _DEEPER, _LITTLE, _OF_LAMBDA = 0.3, 0.04, 0.1, 0.08
#: Below asperities a graded layer is cut into only a few sublayers. The error of A, λ and p_max is at most this times
#: ln of the largest over the smallest modulus (tests/stacks/test_felt.py).
_CUT = 5e-3
#: Largest error that is reported: from there on the number means nothing.
_MOST = 30.0


def has_yield(problem):
    """(B,) bool: the cases with a micro law whose spots yield."""
    return one_of(problem.micro, [name for name, law in problem.known.laws.items() if law.yielded])


def radii_of(problem, all_of_them=False):
    """Radii r/a (m,) at which the pressure is compared with the range of the laws of a problem. There are none if the
    laws cover all pressures, and few if only asperities that feel the body limit them. `all_of_them`: all RADII in any
    case."""
    if all_of_them or _laws(problem):
        return RADII
    return RADII[::_FEW] if problem.feels_layer().any() else RADII[:0]


def outside_law(problem, solution):
    """(B,) bool: whether p(0) is below the range of the law, or p(0) or a pressure of the profile is above it. NaN
    counts as inside. `solution` is in the units of `problem`."""
    outside = np.zeros(len(problem), dtype=bool)
    for law in _laws(problem):
        index, p0, E = _of_law(problem, solution, law)
        largest = np.maximum(p0, np.fmax.reduce(solution.p[index], axis=1, initial=0.0))
        outside[index] = (p0 < law.least * E) | (largest > law.most * E)
    return outside


def without_family(problem):
    """(B,) bool: whether the pitch is too many times the thickness of the layer for any law of asperities on a body."""
    return problem.Nbar * (MOST * problem.h) ** 2 < 1 - _EPS


def beyond_end(problem, solution):
    """(B,) bool: solved cases in which p(0) or a pressure of the profile is beyond the end of their law of spots that
    feel the body, and all cases whose law has its end at 0. `solution` is in the units of `problem`, whose bases have
    names."""
    past_end = np.zeros(len(problem), dtype=bool)
    felt = np.flatnonzero(problem.feels_layer())
    scaled = dimensionless(problem.take(felt))
    for rows in of_one_law(scaled):
        index, most = felt[rows], end(law_of(scaled.take(rows)))
        largest = np.fmax(solution.p0[index], np.fmax.reduce(solution.p[index], axis=1, initial=0.0))
        solved = np.isin(solution.status[index], (Status.CONVERGED, Status.TOLERANCE_NOT_MET))
        past_end[index] = solved & (largest > most * problem.E2[index]) | ~(most > 0)
    return past_end


def edge_error(problem, solution):
    """(B,): relative error of contacts because the range of their law begins at a pressure above 0, or because the law
    is less exact at low pressures; else 0."""
    error = np.zeros(len(problem))
    for law in _laws(problem):
        index, p0, E = _of_law(problem, solution, law)
        error[index] = _GUESSED * (law.least * E / p0) ** _STEEPNESS
        if law.error_at is not None:
            error[index] = np.maximum(error[index], law.error_at(_MIDDLE * p0 / E))
    return error


def _laws(problem):
    """The laws of the problem with a limited range."""
    present = set(problem.micro.tolist())
    return [law for law in problem.known.laws.values() if law.name in present and (law.least > 0 or law.most < np.inf)]


def _of_law(problem, solution, law):
    """Index, p(0), and the modulus E that the asperities feel, for the cases of a law. Under a point, where p(0) is
    unknown, the largest pressure of the profile stands for it."""
    index = np.flatnonzero(problem.micro == law.name)
    part = problem.take(index)
    E = part.E2 * np.where(is_bare(part.base), 1.0, layer_modulus(part.n)) / (1 + part.m)
    p0 = solution.p0[index]
    return index, np.where(np.isnan(p0), np.fmax.reduce(solution.p[index], axis=1, initial=np.nan), p0), E


def left_out(problem, solution):
    """(B,) relative error because of effects of the coated body that the law of asperities leaves out: the largest of
    those of p_max, λ and D. It is 0 for smooth cases, for laws without Nbar and Ra, and for asperities on a half-space
    with a pitch of at most h. `solution` is in the units of the problem."""
    error = np.zeros(len(problem))
    wide = problem.feels_layer() | far_apart(problem.Nbar, problem.h)
    if not wide.any():  # the usual case
        return error
    # the base "auto" has this error too if its law could feel the body; the thin layer does not have it
    there = (is_exact(problem.base) | problem.can_feel()) & np.isfinite(problem.Ra) & problem.rough()
    index = np.flatnonzero(there & np.isfinite(solution.P) & wide)
    if not len(index):
        return error
    part, ended = problem.take(index), solution.take(index)
    scaled = dimensionless(part).but(base=named(part.base))
    ended = replace(ended, p0=_largest(ended) / part.E2, D=ended.D / part.R, A0=ended.A0 / part.R)
    for rows in of_one_law(scaled):
        some, state = scaled.take(rows), ended.take(rows)
        error[index[rows]] = _of_felt(some, state) if some.feels_layer()[0] else _of_half_space(some, state)
    return error


def last_fraction(problem):
    """(B,): the largest contact fraction λ that the law of asperities on their coated body covers; 0 if it covers none,
    NaN for asperities that do not feel the body, and inf for laws without an end."""
    fraction = np.full(len(problem), np.nan)
    felt = np.flatnonzero(problem.feels_layer())
    scaled = dimensionless(problem.take(felt))
    for rows in of_one_law(scaled.but(base=named(scaled.base))):
        law = law_of(scaled.take(rows))
        most = end(law)
        lam = law.at(np.where(np.isfinite(most), most, 0.0)[:, None]).lam[:, 0]
        fraction[felt[rows]] = np.where(most > 0, np.where(np.isinf(most), np.inf, lam), 0.0)
    return fraction


def _largest(solution):
    """p(0) (B,), or the largest pressure of the profile where p(0) is unknown."""
    return np.where(np.isnan(solution.p0), np.fmax.reduce(solution.p, axis=1, initial=np.nan), solution.p0)


@np.errstate(all="ignore")  # unknown pressures are NaN
def _of_felt(part, solution):
    """The error (B,) of asperities that feel the body, in units R = E2* = 1."""
    name = str(part.micro[0])
    factor, power = _ANGULAR.get(name, _HEX)
    lam = np.fmax.reduce(solution.lam, axis=1, initial=0.0)
    error = factor * (2 * lam) ** power + _CUT * contrast(part)
    law = part.known.laws[name]
    if not law.smears:
        return error
    error = error + _of_disc(part, lam, solution)
    return error if law.touching is None else error + law.error + _of_heights(part, solution)


def _of_heights(part, solution):
    """The error (B,) because the neighbours of a summit are a mean: those of a high summit carry less than the mean."""
    A_star = 1 / (np.pi * part.Nbar * part.Ra)
    spread = np.nan_to_num(part.sigma / A_star, nan=_WIDE)
    deeper = _DEEPER * np.minimum((spread / _WIDE) ** 2, spread / _WIDE) * A_star / solution.D
    return np.maximum(deeper, _OF_LAMBDA * np.minimum(spread / _LITTLE, 1.0))


def _of_disc(part, lam, solution):
    """The error (B,) because the neighbours of a spot have no places, at the contact fractions lam (B,), from a cell on
    a half-space. The neighbours lift the surface under a spot by a part of p/E that depends on λ, and hardly on the
    body. If this is a larger part of A than on a half-space, the errors of λ and p_max grow by the same factor."""
    y = np.sqrt(lam / (1 - lam))
    ones = np.ones(len(lam))
    disc, lattice = (LAWS[name].bind(ones, Nbar=ones, Ra=ones) for name in (_DISC, _LATTICE))
    p = disc.p_star * disc.evaluate(y[:, None]).q[:, 0]
    spots, true = disc.at(p[:, None]), lattice.at(p[:, None])
    lifted = ((spots.A - true.A) / spots.A)[:, 0]
    E = layer_modulus(part.n) / (1 + part.m)
    A = (spots.A - true.A)[:, 0] / p * solution.p0 / (E * np.sqrt(part.Nbar))
    more = np.maximum(A / solution.A0 / lifted, 1.0)
    others = [np.abs(values / exact - 1)[:, 0] for values, exact in zip(spots[1:], true[1:], strict=True)]
    return np.maximum(A / solution.D, more * np.maximum(*others))


@np.errstate(all="ignore")
def _of_half_space(part, solution):
    """The error (B,) of asperities on a half-space although their pitch is above h, in units R = E2* = 1."""
    part = part.but(asperities_on="half_space")
    if part.known.laws[str(part.micro[0])].on_body is None:
        part = part.but(micro=_DISC)
    on_body = law_of(part.but(asperities_on="layer"))
    return _difference(law_of(part), on_body, np.minimum(solution.p0, end(on_body)), solution.D)


def _difference(law, right, p, D):
    """The largest relative difference (B,) of p_max, λ and D from those of the `right` law at the pressures p (B,)."""
    spots, true = law.at(p[:, None]), right.at(p[:, None])
    of_spots = [np.abs(values / exact - 1)[:, 0] for values, exact in zip(spots[1:], true[1:], strict=True)]
    deeper = (true.A - spots.A)[:, 0] / D
    error = np.maximum.reduce([*of_spots, np.abs(deeper) / np.maximum(1 + deeper, 1.0)])
    return np.where(np.isfinite(p), np.minimum(np.nan_to_num(error, nan=_MOST), _MOST), 0.0)

"""What the laws of asperities leave out on a coated body: docs/model.md, Asperities on the coated body.

Asperities that feel the body are right but for three things: the pressure of a spot is taken to be a mean over the
angle, of the disc cell the neighbours have no places, and of random heights they are a mean. Asperities on a half-space
of the layer's material, where their pitch is above h, err by all that the body changes.
"""

from dataclasses import replace

import numpy as np

from ..bases import is_exact, named
from ..body.graded import contrast
from ..kernels.two_layers import layer_modulus
from ..laws import LAWS
from ..laws.cell.cell_law import end
from ..problem import far_apart
from ..scaling import dimensionless, law_of, of_one_law

#: The mean over the angle errs by this part, times 2 λ to a power, in A, λ or p_max of resolved cells
#: (tests/models/test_errors_on_layers.py): of a square lattice, and of a hexagonal one, whose waves the disc cell has.
_SQUARE, _HEX = (0.03, 3.5), (1e-3, 4.0)
_ANGULAR = {"square_lattice": _SQUARE}
#: The law that stands for one without a body of its own, as the power law is fitted to it, and for those that have no
#: places of the neighbours; and the lattice with which it is compared.
_DISC, _LATTICE = "disc_cell", "hex_lattice"
#: Random heights of the standard deviation _WIDE A* are deeper by _DEEPER A* than resolved ones, those of less by its
#: square, without a layer and on one. λ and p_max err by up to _OF_LAMBDA from _LITTLE A* on (docs/validate.md;
#: tests/laws/heights/test_heights_on_body.py). _WIDE stands for that of a histogram.
_WIDE, _DEEPER, _LITTLE, _OF_LAMBDA = 0.3, 0.04, 0.1, 0.08
#: A graded layer is cut in few sublayers below asperities: A, λ and p_max err by at most this times ln of the largest
#: over the smallest modulus (tests/stacks/test_felt.py).
_CUT = 5e-3
#: An error is at most this: beyond, it says that the number means nothing.
_MOST = 30.0


def left_out(problem, solution):
    """(B,) relative error of what asperities leave out of the coated body they stand on: the largest of p_max, λ and
    D. 0 of smooth cases, of laws that do not know the asperities, and on a half-space where their pitch is at most h.
    `solution` and problem have one unit."""
    error = np.zeros(len(problem))
    felt = problem.feels_layer()
    # to the error of "auto" this one is added where its law could feel the body; that of a thin layer is left as it is
    there = (is_exact(problem.base) | problem.can_feel()) & np.isfinite(problem.Ra) & problem.rough()
    index = np.flatnonzero(there & np.isfinite(solution.P) & (felt | far_apart(problem.Nbar, problem.h)))
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
    """(B,): the largest contact fraction λ that the law of asperities on their coated bodies knows; 0 where it knows
    none, NaN of asperities that do not feel the body, and inf of laws without an end."""
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
    """p(0) (B,), or where it is not known the largest pressure of the profile."""
    return np.where(np.isnan(solution.p0), np.fmax.reduce(solution.p, axis=1, initial=np.nan), solution.p0)


@np.errstate(all="ignore")  # of pressures that are not known
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
    """The error (B,) because the neighbours of a summit are a mean: where one stands high they carry less than that."""
    A_star = 1 / (np.pi * part.Nbar * part.Ra)
    spread = np.nan_to_num(part.sigma / A_star, nan=_WIDE)
    deeper = _DEEPER * np.minimum((spread / _WIDE) ** 2, spread / _WIDE) * A_star / solution.D
    return np.maximum(deeper, _OF_LAMBDA * np.minimum(spread / _LITTLE, 1.0))


def _of_disc(part, lam, solution):
    """The error (B,) because the neighbours of a spot have no places, at the contact fractions lam (B,): by a cell on a
    half-space. They lift the surface under the spots by a part of p/E that depends on λ, and hardly on the body; where
    this is a larger part of A than on a half-space, λ and p_max err by as much more."""
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
    """The error (B,) of asperities on a half-space though their pitch is above h, in units R = E2* = 1."""
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

"""The largest stresses of smooth contacts on one layer under other loads, of which no tables of meshes are made."""

import numpy as np

from ...scaling import dimensionless
from .unit_contacts import AtUnitRadius, unit_contacts

#: Newton's steps to the radius of a load, in ln a; one below _SAME is the last. They are 3 to 5.
_STEPS, _SAME = 30, 1e-12


def radius_under(problem, P, a):
    """The contact radius (B,) under loads P (B,), found from the radii a (B,) on, in the units of the problem; NaN
    where there is none.

    problem : B cases for which :func:`~.unit_contacts.are_similar`
    """
    scaled, load = dimensionless(problem), np.log(P / (problem.E2 * problem.R**2))
    log_a = np.log(a / problem.R)
    for _ in range(_STEPS):
        contact = unit_contacts(scaled, scaled.h / np.exp(log_a))
        change = (np.log(contact.P) + 3 * log_a - load) / contact.growth
        log_a = log_a - change
        if not (np.abs(change) > _SAME).any():
            break
    return np.exp(log_a) * problem.R


@np.errstate(all="ignore")  # a number that goes wrong is a NaN
def extremes_at(problem, a, names, punch=None):
    """Name of :data:`~..extremes.EXTREMES` -> (3, B), as :func:`~..contact.of_contacts` has them, at the radii a (B,).

    problem : B cases for which :func:`~.unit_contacts.are_similar`
    punch : (B,), Poisson ratios of the punches, if the stresses are those of the punch
    """
    scaled = dimensionless(problem)
    contact = AtUnitRadius.of(scaled.but(h=scaled.h / (a / problem.R)))
    lost, scale = contact.tensile(), problem.E2 * a / problem.R
    extremes = contact.largest(names, 0.0, punch)
    for values in extremes.values():
        values[0] *= scale
        values[:, lost] = np.nan
    return extremes

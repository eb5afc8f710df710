"""The contacts in which the first yield under a shape is searched for, from one in which nothing yields:
docs/stresses.md."""

from typing import NamedTuple

import numpy as np

from ..bases import is_bare
from ..fields.shaped import corners
from ..layers import full_name, numbers_of
from ..scaling import dimensionless
from ..shapes import ROUND, shape_of
from ..smooth.contact import kinds_of
from ..smooth.shape_terms import on_half_space

#: The range of radii, in R, for paraboloids and spheres.
NARROWEST, WIDEST = 1e-8, 0.2
#: For other shapes the search ends at the slope STEEPEST at the edge of the contact, beyond which linear elasticity is
#: a poor model; or, if they are not so steep, at _KINKS times the radius of their last kink.
STEEPEST, _KINKS = 0.4, 100.0
#: No body yields if the largest pressure on a half-space of the stiffer material is below this part of the strength,
#: over 1 + _BY_FRICTION mu: under a ball a half-space yields at 1.6 strengths, and layers that bend yield earlier.
_NEVER, _BY_FRICTION = 0.19, 4.0
#: Steps of the variable, the radius less that of a flat end, by which the start of the search is determined; steps for
#: the last contact, which is at most 2 % short of the slope; smallest and largest value. And radii at which the
#: pressure is evaluated.
_STEPS, _FINE, _LEAST, _MOST = 120, 1200, 1e-8, 1e2
_LOOKED_AT = np.sin(np.pi / 2 * np.arange(24) / 24)


class Reach(NamedTuple):
    """The range of the search in `at` = a - flat; arrays (B,), in R.

    flat : radius of the flat end; 0 for shapes without one
    start, last : the range of `at`
    sharp : bool, whether the stress in the layer or body that is touched is infinite under any load
    """

    flat: np.ndarray
    start: np.ndarray
    last: np.ndarray
    sharp: np.ndarray


@np.errstate(all="ignore")  # pressures are infinite at tips and corners
def reach_of(problem, strength, mu, touched):
    """The :class:`Reach` of cases; NaN for those whose shape is :data:`ROUND`.

    strength : (B,), in units of E2
    touched : (B,) bool, whether the search is about the layer or body that the punch touches, and this is not
        incompressible
    """
    reach = Reach(*np.full((3, len(problem)), np.nan), np.zeros(len(problem), dtype=bool))
    reach.flat[:] = 0.0
    others = np.flatnonzero(~np.isin(problem.shape, ROUND))
    if not len(others):
        return reach
    scaled = dimensionless(problem.take(others))
    least = _NEVER / (1 + _BY_FRICTION * mu) * strength[others] / stiffest(scaled)
    for rows in kinds_of(scaled):
        shape = shape_of(scaled.take(rows))
        reach.flat[others[rows]] = shape.least()
        reach.last[others[rows]] = _last(shape)
        reach.start[others[rows]] = _start(shape, reach.last[others[rows]], least[rows])
    reach.sharp[others] = np.isfinite(corners(scaled, reach.flat[others] + reach.last[others])) & touched[others]
    return reach


def stiffest(problem):
    """(B,): the largest modulus of body and layers, over E2*, which is at least 1; on a rigid body over E1*."""
    numbers = range(1, numbers_of(problem.parameters) + 1)
    layers = [getattr(problem, full_name(j, "n")) for j in numbers]
    layers += [np.nan_to_num(getattr(problem, full_name(j, "n_bottom"))) for j in numbers]
    tables = [float(np.max(table.n) / table.n[0]) for table in problem.known.profiles.values()]
    largest = np.max([problem.n, *layers], axis=0) * max([1.0, *tables])
    return np.where(is_bare(problem.base), 1.0, np.maximum(largest, 1.0))


def _last(shape):
    """The largest a - flat (B,) of the search."""
    flat, steps = shape.least()[:, None], np.geomspace(_LEAST, _MOST, _FINE)
    within = flat + steps < shape.most()[:, None]
    slopes = shape.slope(np.where(within, flat + steps, flat))
    steep = within & (slopes > STEEPEST)
    kinks = np.nan_to_num(shape.kinks()).max(axis=1, initial=0.0)
    farthest = np.where(steep.any(axis=1) | (kinks == 0), np.inf, _KINKS * kinks)
    allowed = within & ~steep & (steps <= farthest[:, None])
    # a shape is at least as steep farther out, so that the allowed steps are the first ones
    return np.where(allowed.any(axis=1), steps[allowed.sum(axis=1) - 1], _LEAST)


def _start(shape, last, least):
    """The largest a - flat (B,) up to which the largest pressure, over E, is below `least`."""
    steps = np.geomspace(_LEAST, 1.0, _STEPS)[:, None] * last
    flat, below, still = shape.least(), np.zeros(len(last), dtype=int), np.ones(len(last), dtype=bool)
    for step in steps:
        p = np.nanmax(on_half_space(shape, flat + step, _LOOKED_AT), axis=1) / np.pi
        # near a flat end the largest pressure is in a ring as narrow as the step, and about that under a ball there
        p = np.maximum(p, 2 / np.pi * shape.slope((flat + step)[:, None])[:, 0])
        still &= p < least
        below += still
        if not still.any():
            break
    return np.maximum(steps[np.maximum(below - 1, 0), np.arange(len(last))], _LEAST * last)

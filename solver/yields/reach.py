"""Which contacts are looked at for the first yield under a shape, from where nothing yields: docs/stresses.md."""

from typing import NamedTuple

import numpy as np

from ..bases import is_bare
from ..fields.shaped import corners
from ..scaling import dimensionless
from ..shapes import ROUND, shape_of
from ..smooth.contact import kinds_of
from ..smooth.shape_terms import on_half_space

#: Radii in R that are looked at: of paraboloids and spheres.
NARROWEST, WIDEST = 1e-8, 0.2
#: Other shapes are looked at up to this slope at the edge of the contact, beyond which elasticity says little; or, if
#: they are less steep, up to so many times the radius of their last kink.
STEEPEST, _KINKS = 0.4, 100.0
#: No body yields where the largest pressure of a half-space of the stiffer material is below this part of the strength
#: over 1 + _BY_FRICTION mu: on a half-space a ball makes a body yield at 1.6 strengths, and layers that bend do sooner.
_NEVER, _BY_FRICTION = 0.19, 4.0
#: What is marched over, the radius less that of a flat end: so many steps on the way to where nothing yields, and many
#: more to the last contact, which is 2 % short of the slope at most; and radii at which the pressure is looked at.
_STEPS, _FINE, _LEAST, _MOST = 120, 1200, 1e-8, 1e2
_LOOKED_AT = np.sin(np.pi / 2 * np.arange(24) / 24)


class Reach(NamedTuple):
    """What the search marches over, `at` = a - flat, (B,) each, in R.

    flat : radius of the flat end, 0 of shapes without one
    start, last : of `at`
    sharp : bool, the stress of what is touched is infinite under any load
    """

    flat: np.ndarray
    start: np.ndarray
    last: np.ndarray
    sharp: np.ndarray


@np.errstate(all="ignore")  # pressures are infinite at tips and corners
def reach_of(problem, strength, mu, touched):
    """The :class:`Reach` of cases with shapes, some of which may be :data:`ROUND` and are left out: NaN.

    strength : (B,), in units of E2
    touched : (B,) bool, it is about what the punch touches and is not incompressible
    """
    made = Reach(*np.full((3, len(problem)), np.nan), np.zeros(len(problem), dtype=bool))
    made.flat[:] = 0.0
    others = np.flatnonzero(~np.isin(problem.shape, ROUND))
    if not len(others):
        return made
    scaled = dimensionless(problem.take(others))
    E = np.where(is_bare(scaled.base), 1.0, np.maximum(scaled.n, 1.0))
    least = _NEVER / (1 + _BY_FRICTION * mu) * strength[others] / E
    for rows in kinds_of(scaled):
        shape = shape_of(scaled.take(rows))
        made.flat[others[rows]] = shape.least()
        made.last[others[rows]] = _last(shape)
        made.start[others[rows]] = _start(shape, made.last[others[rows]], least[rows])
    made.sharp[others] = np.isfinite(corners(scaled, made.flat[others] + made.last[others])) & touched[others]
    return made


def _last(shape):
    """The largest a - flat (B,) that is looked at."""
    flat, steps = shape.least()[:, None], np.geomspace(_LEAST, _MOST, _FINE)
    within = flat + steps < shape.most()[:, None]
    slopes = shape.slope(np.where(within, flat + steps, flat))
    steep = within & (slopes > STEEPEST)
    kinks = np.nan_to_num(shape.kinks()).max(axis=1, initial=0.0)
    farthest = np.where(steep.any(axis=1) | (kinks == 0), np.inf, _KINKS * kinks)
    allowed = within & ~steep & (steps <= farthest[:, None])
    # a shape is at least as steep farther out: what is allowed comes first
    return np.where(allowed.any(axis=1), steps[allowed.sum(axis=1) - 1], _LEAST)


def _start(shape, last, least):
    """The largest a - flat (B,) up to which the largest pressure is below `least`, over E."""
    steps = np.geomspace(_LEAST, 1.0, _STEPS)[:, None] * last
    flat, below, still = shape.least(), np.zeros(len(last), dtype=int), np.ones(len(last), dtype=bool)
    for step in steps:
        p = np.nanmax(on_half_space(shape, flat + step, _LOOKED_AT), axis=1) / np.pi
        # next to a flat end the largest pressure is in a ring as narrow as the step: of the order of a ball's there
        p = np.maximum(p, 2 / np.pi * shape.slope((flat + step)[:, None])[:, 0])
        still &= p < least
        below += still
        if not still.any():
            break
    return np.maximum(steps[np.maximum(below - 1, 0), np.arange(len(last))], _LEAST * last)

"""The contact radius at which a quantity has a given value: for contacts without adhesion, the load or the depth."""

import numpy as np

from ..numerics.batch import march
from ..shapes.shape import column
from .galerkin import Response, respond

#: Most evaluations of a case, and the relative distance of P or D to the given value at which it is done.
MOST, NEAR = 80, 1e-13
#: Longest step of Newton's method in the variable of :class:`Radii`, a logarithm.
_LONGEST = 3.0
#: The variable of the last radius before the end of a profile.
LAST = 30.0
#: If the relative distance of P or D from the given value stays above this, there is no such contact.
_REACHED = 1e-9
#: Rounding error of a radius. Near the flat part it is a larger part of a - least, on which P and D depend.
_ROUNDED = 4 * np.finfo(float).eps
#: Relative error of P or D at which the search for a first guess ends; and the radius, in R, at which it begins.
_CLOSE, _USUAL = 0.01, 0.05
#: The width of a bracket, relative to x, that is only rounding.
_NARROW = 4e-16


class Radii:
    """The variable x in which radii between the bounds `least` and `most` of shapes are searched: ln(a - least), or, if
    the profile ends, ln((a - least)/(most - a))."""

    def __init__(self, shape):
        self.least, self.most = shape.least(), shape.most()
        self.ends = np.isfinite(self.most)
        self._span = np.where(self.ends, self.most - self.least, 1.0)

    def at(self, x, index):
        """a (b,) at x (b,) for the cases `index`, and da/dx."""
        least, span, ends = self.least[index], self._span[index], self.ends[index]
        e = np.exp(np.minimum(x, 700.0))
        share = np.where(ends, 1 / (1 + np.exp(-x)), e)
        over = span * share
        return least + over, np.where(ends, over / (1 + e), over)

    def of(self, a):
        """x (B,) of radii a."""
        with np.errstate(all="ignore"):
            over = a - self.least
            return np.log(np.where(self.ends, over / (self.most - a), over))


def rising_root(evaluate, start, low=-np.inf, high=np.inf):
    """Roots x (B,) of one rising function g for each of B cases, by Newton's method inside a bracket that it narrows;
    and the number (B,) of evaluations of each case.

    evaluate : ``evaluate(x, index) -> g, slope`` at x (b,) for the cases `index` (b,)
    start : (B,), first x. A case whose g is NaN at some step is abandoned: its x is NaN
    low, high : the bracket, (B,) or one number for all cases
    """
    x, counts = start.copy(), np.zeros(len(start), dtype=np.int32)
    low, high = np.full(len(x), low), np.full(len(x), high)

    def step(active):
        g, slope = evaluate(x[active], active)
        counts[active] += 1
        here = x[active]
        low[active] = np.where(g < 0, np.maximum(low[active], here), low[active])
        high[active] = np.where(g > 0, np.minimum(high[active], here), high[active])
        by = np.clip(np.where(slope > 0, -g / slope, -np.sign(g) * _LONGEST), -_LONGEST, _LONGEST)
        following = here + by
        lo, hi = low[active], high[active]
        outside = (following <= lo) | (following >= hi)
        following = np.where(outside & np.isfinite(lo + hi), (lo + hi) / 2, following)
        ended = (np.abs(g) <= NEAR) | np.isnan(g) | (hi - lo <= _NARROW * np.maximum(1.0, np.abs(here)))
        x[active] = np.where(ended, np.where(np.isnan(g), np.nan, here), following)
        return ended

    march(step, np.arange(len(x)), most=MOST)
    return x, counts


def touching(control, value, shape, body):
    """The :class:`~.galerkin.Response` of B contacts without adhesion whose radius a, load P or depth D is `value`
    (B,); and the number (B,) of times that the equation was solved. It is NaN where there is no such contact, and where
    the search ends on a wrong branch (:mod:`.branches`).

    A contact over the full circle ends where D no longer rises with a: the punch lifts off inside.
    """
    if control == "a":
        return respond(shape, body, value), np.ones(len(value), dtype=np.int32)
    radii = Radii(shape)
    return _searched(control, value, (shape, body, radii), guess(control, value, shape, body, radii))


def bracketed(control, value, shape, body, low, high):
    """As :func:`touching`, for a load or depth that is reached between the radii whose variables are `low` and `high`
    (B,), between which D rises."""
    return _searched(control, value, (shape, body, Radii(shape)), (low + high) / 2, low, high)


def _searched(control, value, parts, start, low=-np.inf, high=np.inf):
    """The Response and the counts of :func:`touching` by a search from `start` (B,). `parts`: shapes, body and
    :class:`Radii`."""
    (shape, body, radii), pieces = parts, []

    def evaluate(x, index):
        a, da = radii.at(x, index)
        response = respond(shape.take(index), body.take(index), a)
        pieces.append((index, response))
        Q, slope = getattr(response, control), response.slope * (response.S if control == "P" else 1.0)
        g = np.log(Q / value[index])
        return np.where(slope > 0, g, np.maximum(g, 1.0)), slope * da / Q

    x, counts = rising_root(evaluate, start, low, high)
    response = Response.join(len(value), pieces)
    rounding = _ROUNDED * response.a / (response.a - radii.least)
    reached = np.abs(np.log(getattr(response, control) / value)) < _REACHED + rounding
    return response.only(np.isfinite(x) & reached & (response.slope > 0)), counts


def guess(control, value, shape, body, radii):
    """x (B,) on a half-space as compliant as the body is to waves as long as the contact."""

    def evaluate(x, index):
        a, da = radii.at(x, index)
        part, E = shape.take(index), body.E[index] / body.take(index).softness(a)
        depth, slope = (f(column(a))[:, 0] for f in (part.lifted, part.lifted_slope))
        Q, growth = (depth, slope) if control == "D" else (2 * E * part.lifted_load(a), 2 * E * a * slope)
        g = np.log(Q / value[index])
        return np.where(np.abs(g) < _CLOSE, 0.0, g), growth * da / Q

    start = np.where(np.isfinite(radii.most) | (radii.least > 0), -1.0, np.log(_USUAL))
    x = rising_root(evaluate, start)[0]
    return np.where(radii.ends, np.minimum(x, LAST), x)  # on a half-space the contact may reach beyond the profile

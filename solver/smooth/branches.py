"""The smallest contact without tension inside, for cases in which Newton's method of :mod:`.radius` may end on another
branch.

Load and depth do not always rise with the radius: on a hard plate they have a maximum, fall, and rise again, and on the
outer branch there is tension inside. A punch that is pressed on from zero stays on the inner branch. So the search goes
from small radii to large ones, and takes in turn each branch on which the control rises.
"""

import numpy as np

from ..numerics.batch import march
from ..numerics.bracket import between, turns_between
from .galerkin import Response, respond
from .radius import LAST, Radii, bracketed, guess
from .tension import is_tensile

#: Distance of the radii in the variable of :class:`~.radius.Radii`, and number of radii that are evaluated together.
_STEP, _TOGETHER = 0.125, 8
#: The first radius is _THIN times the thickness of the first layer, or exceeds the flat radius by _CORNER times that.
#: If it bears too much, it is reduced in steps: _DOWN has their largest number and their size in the variable. The last
#: radius is _PAST_GUESS, in the variable, beyond the guess, or twice as much if the control has not been reached.
_THIN, _CORNER, _DOWN, _PAST_GUESS = 0.02, 1e-6, (60, 2.0), 4.0
#: Width of the bracket, in the variable, at which the end of a branch is accepted.
_NARROW = 1e-14


def smallest(control, value, shape, body):
    """The :class:`~.galerkin.Response` of B contacts without adhesion at the smallest radius where the load or depth is
    `value` (B,) and rises with the radius, and the pressure is nowhere tensile; NaN where there is none. And the number
    (B,) of times that the equation was solved."""
    search = _Search(control, value, shape, body)
    every, pieces = np.arange(len(value)), []
    first = search.samples(search.first()[:, None], every)
    last = guess(control, value, shape, body, search.radii) + _PAST_GUESS
    end = np.minimum(last, np.where(search.radii.ends, LAST, 700))

    def step(active, *samples):
        above = samples[0][:, -1:] + _STEP * np.arange(1, _TOGETHER + 1)
        more = search.samples(above, active)
        samples = tuple(np.hstack(pair) for pair in zip(samples, more, strict=True))
        solved, turning = np.zeros(len(active), dtype=bool), _turning(*samples)
        for rows in (np.flatnonzero(~turning), np.flatnonzero(turning)):
            if len(rows):
                part = tuple(values[rows] for values in samples)
                part = search.with_middles(*part, active[rows]) if turning[rows[0]] else part
                solved[rows] = search.note(pieces, active[rows], *part)
        x, g = samples[0][:, -1], samples[1][:, -1]
        goes_on = ~solved & np.isfinite(x + g) & (x < end[active] + np.where(g < 0, _PAST_GUESS, 0.0))
        return ~goes_on, *(values[:, -1:] for values in samples)

    march(step, every, *first)
    return Response.join(len(value), pieces), search.counts


def _turning(x, g, slope):
    """(b,) bool: whether between two of the radii g seems to turn twice."""
    pairs = ((values[:, :-1], values[:, 1:]) for values in (g, slope))
    return turns_between(np.diff(x, axis=1), *pairs).any(axis=1)


class _Search:
    """The contacts of B cases as functions of the variable x of their radii; g = ln(Q/value) for the control Q."""

    def __init__(self, control, value, shape, body):
        self.control, self.value, self.shape, self.body = control, value, shape, body
        self.radii, self.counts = Radii(shape), np.zeros(len(value), dtype=np.int32)

    def at(self, x, index):
        """g and its derivative by x, at x (b,) for the cases `index`."""
        a, da = self.radii.at(x, index)
        np.add.at(self.counts, index, 1)
        response = respond(self.shape.take(index), self.body.take(index), a)
        Q = getattr(response, self.control)
        slope = response.slope * (response.S if self.control == "P" else 1.0) * da
        return np.where(Q > 0, np.log(Q / self.value[index]), -np.inf), slope / np.abs(Q)

    def samples(self, x, index):
        """x, g and its slope, (b, m) each, at x (b, m)."""
        g, slope = self.at(x.ravel(), np.repeat(index, x.shape[1]))
        return x, g.reshape(x.shape), slope.reshape(x.shape)

    def with_middles(self, x, g, slope, index):
        """x, g and its slope, together with those in the middles of all intervals."""
        middles = self.samples((x[:, 1:] + x[:, :-1]) / 2, index)
        out = [np.empty((len(index), 2 * x.shape[1] - 1)) for _ in range(3)]
        for array, ends, inner in zip(out, (x, g, slope), middles, strict=True):
            array[:, ::2], array[:, 1::2] = ends, inner
        return out

    def first(self):
        """The first x (B,), at which g is negative."""
        least = self.radii.least
        thick = np.ones(len(least)) if self.body.kernel is None else self.body.h
        x = self.radii.of(least + np.where(least > 0, _CORNER * least, _THIN * thick))
        x = np.where(np.isnan(x), LAST, x)
        high, (steps, width) = np.arange(len(x)), _DOWN
        for _ in range(steps):
            high = high[self.at(x[high], high)[0] > 0]
            if not len(high):
                break
            x[high] -= width
        return x

    def note(self, pieces, index, x, g, slope):
        """Add to `pieces` the first contact of each case `index` (b,) within its radii x (b, m). Returns (b,) bool,
        whether the case has one."""
        solved = np.zeros(len(index), dtype=bool)
        for low in range(x.shape[1] - 1):
            rows = np.flatnonzero(~solved)
            places, response = self._rising(index[rows], *(v[rows, low + i] for v in (x, g, slope) for i in (0, 1)))
            solved[rows[places]] = True
            pieces.append((index[rows[places]], response))
        return solved

    def _rising(self, index, low, high, g_low, g_high, slope_low, slope_high):
        """Places (b,) among the cases `index`, and their contacts: those between x = `low` and `high` at which the
        control rises to the value and there is no tension."""
        bottom, top, g_bottom, g_top = low.copy(), high.copy(), g_low.copy(), g_high.copy()
        rest = np.flatnonzero(slope_low * slope_high < 0)
        if len(rest):
            x, g = self._turn(index[rest], low[rest], high[rest], slope_low[rest], slope_high[rest])
            peak = slope_low[rest] > 0
            for mask, ends, of_g in (peak, top, g_top), (~peak, bottom, g_bottom):
                ends[rest[mask]], of_g[rest[mask]] = x[mask], g[mask]
        there = np.flatnonzero((g_bottom < 0) & (g_top >= 0) & ((slope_low > 0) | (slope_high > 0)))
        places = index[there]
        part = self.shape.take(places), self.body.take(places)
        response, counts = bracketed(self.control, self.value[places], *part, bottom[there], top[there])
        self.counts[places] += counts
        right = np.flatnonzero(np.isfinite(response.P) & ~is_tensile(*part, response))
        return there[right], response.take(right)

    def _turn(self, index, low, high, slope_low, slope_high):
        """x (b,) between `low` and `high` at which the slope changes its sign, and g there."""
        scale = np.abs(slope_high - slope_low) * np.where(slope_low > 0, -1.0, 1.0)
        x, _ = between(
            lambda y, i: self.at(y, index[i])[1] / scale[i],
            low.copy(), high.copy(), slope_low / scale, slope_high / scale, np.full(len(index), _NARROW),
        )  # fmt: skip
        return x, self.at(x, index)[0]

"""The radius at which a smooth contact on one layer first yields, by the tables of its pair of bodies."""

import numpy as np

from ...scaling import dimensionless
from ..crossing import ASIDE, NUMBERS
from .node_search import Line, first_place
from .stress_table import EACH, StressTable, node_at, thickness
from .unit_contacts import unit_contacts

#: Where a layer is thicker than in this octave of h/a, counted from 1 down, its stresses are those of a half-space, and
#: those of the body below it fall like (a/h)², both to some percent: a search begins this part of the radius before
#: the place that follows (tests/yields/similar/test_first_load.py).
_THICK, _BEFORE = -5, 0.7
#: The power of a/R with which the stress grows there.
_GROWS = {"layer": 1.0, "body": 3.0, "punch": 1.0}


def put_first_loads(crossing, problem, index, strength, sought, reach):
    """Put the crossings of the cases `index` into `crossing`, a :class:`~..crossing.Crossing`. NaN of the strength or
    of the start, or a start beyond the end: nothing is looked for.

    problem : B cases, of which those of the `index` are :func:`~.unit_contacts.are_similar`
    strength : (B,), in the unit of E2
    sought : :class:`~.unit_contacts.Sought`, Poisson ratios of the punches (B,), and whether slopes are wanted
    reach : radii from which and to which is searched, (2, B), in R
    """
    sought, punch, slopes = sought
    start, last = reach
    index = index[start[index] <= last[index]]
    if not len(index):
        return
    part = problem.take(index)
    scaled = dimensionless(part)
    table = StressTable(scaled, sought, np.zeros(len(index)) if punch is None else punch[index])
    h, Y = np.log(scaled.h), np.log(strength[index] / part.E2)
    first = np.floor(node_at(h - np.log(start[index]))).astype(int)
    line = Line(h, Y, np.zeros(len(h), bool), first, np.ceil(node_at(h - np.log(last[index]))).astype(int))
    place = first_place(table, line._replace(first=_not_thick(table, line)))
    radius = h - place.log_t
    there = np.flatnonzero(radius <= np.log(last[index]))
    crossing.unsolved[index] = place.unsolved
    crossing.crossed[index[there]], crossing.at[index[there]] = True, np.exp(radius[there])
    crossing.r[index], crossing.z[index] = np.where(radius <= np.log(last[index]), [place.r, place.z], np.nan)
    numbers = _numbers(part, scaled, there, radius[there])
    for name in NUMBERS:
        crossing.numbers[name][index[there]] = numbers[name]
    if slopes:
        _put_slopes(crossing, index, part, there, radius, (table, line), numbers)


def _not_thick(table, line):
    """The first nodes (B,), beyond thick layers of which a single octave says where they yield."""
    first, end = line.first.copy(), EACH * _THICK
    rows = np.flatnonzero((first < end) & (line.last >= end))
    if len(rows):
        logs = table.octaves(rows, np.full(len(rows), _THICK))
        nodes = np.tile(end + np.arange(EACH), (len(rows), 1))
        share = line.take(rows).share(thickness(nodes), logs)[:, 0]
        nodes_before = (share / _GROWS[table.sought.body] - np.log(_BEFORE)) * (EACH / np.log(2))
        place = np.floor(end - np.nan_to_num(nodes_before, nan=1e6, posinf=1e6)).astype(int)
        first[rows] = np.clip(place, first[rows], end)
    return first


def _numbers(part, scaled, rows, radius):
    """P, a, D, p0 of the cases `rows`, in the units of the problem, at ln of their radius."""
    some, unit = scaled.take(rows), part.take(rows)
    contact, a = unit_contacts(some, some.h / np.exp(radius)), np.exp(radius)
    scale = {"P": unit.E2 * unit.R**2, "D": unit.R, "p0": unit.E2, "a": unit.R}
    values = {"P": contact.P * a**3, "a": a, "D": contact.D * a**2, "p0": contact.p0 * a}
    return {name: values[name] * scale[name] for name in NUMBERS}


def _put_slopes(crossing, index, part, there, radius, searched, numbers):
    """Put `by_strength` into `crossing`, by contacts a little beyond the crossings."""
    table, line = searched
    log_a = radius[there] + np.log1p(ASIDE)
    log_t = line.size[there] - log_a
    value = np.log(table.at(there, log_t).mises) + log_a - line.strength[there]
    after = _numbers(part, table.scaled, there, log_a)
    for name in NUMBERS:
        crossing.by_strength[name][index[there]] = np.log(after[name] / numbers[name]) / value

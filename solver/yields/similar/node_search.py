"""The first contact of a pair of bodies whose stress is the strength, along layers of one thickness or under one load:
by the nodes of a table, by the polynomial through four of them, and by the contact itself."""

from typing import NamedTuple

import numpy as np

from ...numerics import batch
from ...numerics.batch import march
from .stress_table import EACH, Logs, thickness

#: The coarse grid misses at most this part of the largest stress: above it the stress itself is computed.
_MISSED = 0.15
#: A place is found when the stress is the strength to _SAME, or given up after _MOST steps. The slope of the polynomial
#: is off by some _OF_SLOPE times as much a node as the polynomial: so one contact is enough where that is close.
_SAME, _MOST, _OF_SLOPE = 1e-7, 40, 4.0
#: The nodes of the polynomial, from the first one over the strength on; and its coefficients from its values there.
_STENCIL = np.arange(-2, 2)
_POLYNOMIAL = np.linalg.inv(np.vander(_STENCIL.astype(float), increasing=True)).T
#: Halvings to the place of a polynomial: to the last digit.
_HALVINGS = 52


@batch.of_cases
class Line(NamedTuple):
    """Along which contacts a search goes, (B,) each.

    size : ln of h/R, the radius grows with the node; or, where it is `of_load`, of the load over E2* R², and the layer
        gets thinner with it
    strength : ln of the strength over E2*
    first, last : whole numbers, the nodes from which and to which it goes, up or down
    """

    size: np.ndarray
    strength: np.ndarray
    of_load: np.ndarray
    first: np.ndarray
    last: np.ndarray

    def radius(self, log_t, P):
        """ln of a/R (B, m) at ln(h/a) (B, m); P : ln of the load at a = R."""
        size = self.size[:, None]
        return np.where(self.of_load[:, None], (size - P) / 3, size - log_t)

    def share(self, log_t, logs):
        """ln of the stress over the strength (B, m), of :class:`~.stress_table.Logs`."""
        return logs.mises + self.radius(log_t, logs.P) - self.strength[:, None]


class Place(NamedTuple):
    """Where the stress first is the strength, (B,) each; NaN where it is not.

    log_t : ln of h/a; r, z : the place of the stress, in a
    unsolved : bool, none was found, and some contacts on the way have no solution; or it is before the first node
    """

    log_t: np.ndarray
    r: np.ndarray
    z: np.ndarray
    unsolved: np.ndarray


def first_place(table, line):
    """:class:`Place` of the cases of a :class:`~.stress_table.StressTable` along a :class:`Line`."""
    size = len(line.size)
    place = Place(*np.full((3, size), np.nan), np.zeros(size, dtype=bool))
    way = np.where(line.last >= line.first, 1, -1)
    over, failed = _first_over(table, line, way)
    place.unsolved[:] = failed & (over == _NONE)
    index = np.flatnonzero(over != _NONE)
    if not len(index):
        return place
    nodes = over[index, None] + way[index, None] * _STENCIL
    shares = _shares(table, line, np.repeat(index, len(_STENCIL)), nodes.ravel()).reshape(nodes.shape)
    enclosed = (shares[:, 1] < 0) & (shares[:, 2] >= 0)
    place.unsolved[index[~enclosed]] = True
    index, shares = index[enclosed], shares[enclosed]
    _closer(place, table, line, (index, over[index], way[index]), _smooth(shares))
    return place


#: In place of a node where there is none.
_NONE = np.iinfo(int).min


def _shares(table, line, index, node):
    """ln of the stress over the strength (b,) at nodes (b,) of the cases `index`."""
    logs = table.nodes(index, node)
    columns = logs._replace(mises=logs.mises[:, None], P=logs.P[:, None])
    return line.take(index).share(thickness(node)[:, None], columns)[:, 0]


def _first_over(table, line, way):
    """The first node (B,) at which the stress is at least the strength, _NONE where there is none; and whether some
    contact before it has no solution."""
    over, failed = np.full(len(way), _NONE), np.zeros(len(way), dtype=bool)
    octave = line.first // EACH

    def step(active):
        nodes = EACH * octave[active, None] + np.arange(EACH)
        part = line.take(active)
        shares = part.share(thickness(nodes), table.octaves(active, octave[active]))
        down = way[active] < 0
        nodes[down], shares[down] = nodes[down, ::-1], shares[down, ::-1]
        outside = (nodes - part.first[:, None]) * way[active, None] < 0
        outside |= (nodes - part.last[:, None]) * way[active, None] > 0
        shares[outside] = -np.inf
        column = _refined(table, line, active, nodes, shares)
        there = column < EACH
        over[active[there]] = nodes[there, column[there]]
        failed[active] |= (np.isnan(shares) & (np.arange(EACH) < column[:, None])).any(axis=1)
        octave[active] += way[active]
        return there | (octave[active] * way[active] > part.last // EACH * way[active])

    march(step, np.flatnonzero(line.first != _NONE))
    return over, failed


def _refined(table, line, active, nodes, shares):
    """The first columns (b,) whose `shares` (b, EACH) are not below 0, EACH where there are none. Where coarse ones are
    close to 0 the stresses themselves take their places first."""
    exact, columns = ~np.isfinite(shares), np.arange(EACH)
    while True:
        column = np.where((shares >= 0).any(axis=1), np.argmax(shares >= 0, axis=1), EACH)
        away = columns - column[:, None]
        wanted = (shares >= np.log1p(-_MISSED)) & (away <= 0) & ~exact
        some = wanted.any(axis=1, keepdims=True) & (column < EACH)[:, None]
        wanted |= some & (away >= _STENCIL[0]) & (away <= _STENCIL[-1]) & ~exact
        if not wanted.any():
            return column
        rows, places = np.nonzero(wanted)
        shares[rows, places] = _shares(table, line, active[rows], nodes[rows, places])
        exact |= wanted


def _smooth(shares):
    """The values (b, 4) for a polynomial: a straight line where some have no solution."""
    below, above = shares[:, 1:2], shares[:, 2:3]
    straight = np.hstack([2 * below - above, below, above, 2 * above - below])
    return np.where(np.isfinite(shares).all(axis=1, keepdims=True), shares, straight)


def _closer(place, table, line, cases, shares):
    """Put the places into `place`.

    cases : index, first node over the strength, and way there, (b,) each
    shares : (b, 4), at the nodes of the polynomial
    """
    index, node, way = cases
    terms = shares @ _POLYNOMIAL
    low, high = np.full(len(index), -1.0), np.zeros(len(index))
    at = _root(terms)
    slope = terms[:, 1] + at * (2 * terms[:, 2] + 3 * at * terms[:, 3])
    first, before = np.ones(len(index), dtype=bool), np.full((2, len(index)), np.nan)

    def step(active):
        rows = index[active]
        log_t = thickness(node[active] + way[active] * at[active])
        contact = table.at(rows, log_t)
        logs = np.log(contact.mises)[:, None], np.log(contact.P)[:, None]
        value = line.take(rows).share(log_t[:, None], Logs(*logs))[:, 0]
        secant = (value - before[1, active]) / (at[active] - before[0, active])
        slope[active] = np.where(first[active] | ~np.isfinite(secant), slope[active], secant)
        low[active] = np.where(value < 0, at[active], low[active])
        high[active] = np.where(value >= 0, at[active], high[active])
        before[:, active] = at[active], value
        there = at[active] - value / slope[active]
        inside = (there >= low[active]) & (there <= high[active]) & (slope[active] > 0)
        close = first[active] & inside & (_OF_SLOPE * value**2 <= _SAME * slope[active])
        done = close | (np.abs(value) <= _SAME)
        at[active] = np.where(inside, there, (low[active] + high[active]) / 2)
        first[active] = False
        place.r[rows[done]], place.z[rows[done]] = contact.r[done], contact.z[done]
        place.log_t[rows[done]] = thickness(node[active] + way[active] * at[active])[done]
        return done

    place.unsolved[index[march(step, np.arange(len(index)), most=_MOST)]] = True


def _root(terms):
    """Where the polynomials with these coefficients (b, 4) are 0, from below 0 at -1 to above at 0."""
    low, high = np.full(len(terms), -1.0), np.zeros(len(terms))
    for _ in range(_HALVINGS):
        at = (low + high) / 2
        over = terms[:, 0] + at * (terms[:, 1] + at * (terms[:, 2] + at * terms[:, 3])) >= 0
        low, high = np.where(over, low, at), np.where(over, at, high)
    return high

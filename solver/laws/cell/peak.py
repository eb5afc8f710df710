"""Where in a spot the pressure is largest: docs/model.md, Asperities on the coated body.

With phi of :mod:`.spot` and f(t) = -phi'(t)/t, the pressure at r = sqrt(b² - s²) is

    q(r) = ∫ f(t) t/sqrt(t² - r²) dt, t from r to b,   = ∫ f(sqrt(r² + u²)) du, u from 0 to s:

a smooth function of s from the edge, s = 0, to the middle, s = b. So it is a polynomial in s/b on each of a few panels.
Below a hard film on a soft body the largest pressure leaves the middle at some radius b, in a ring that widens, and
may come back to the middle at a larger one, where the middle has overtaken the ring. A table of the radii between these
says how large it is in the ring and where.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...numerics.quadrature import gauss_legendre, lagrange
from .family import in_groups
from .spot import panels_of, pieces, spots
from .summits import parts

__all__ = ["NARROW", "Peaks", "SummitPeaks", "U", "may_leave_the_middle", "peaks", "pressures", "summit_peaks"]

#: The largest pressure stays in the middle where b/h is below NARROW, and wherever L - 1 nowhere exceeds _HARD: it
#: leaves it from 1.04 on, as on a plate that nothing supports, and from 1.6 on, whatever the Poisson ratios and the
#: interface; in stacks no earlier (tests/laws/cell/test_peak.py).
NARROW, _HARD = 1.0, 1.3
#: u = kh at which L - 1 is looked at.
U = np.geomspace(1e-4, 12, 60)
#: Nodes of the polynomials on a panel of s/b (Chebyshev's, with both ends), and the widest panel in h.
_NODES, _WIDEST = 32, 5.0
#: Radii at which the cell is solved, by the powers of ln(b/h): the pressures between are right to 1e-7 of themselves
#: (tests/laws/cell/test_peak.py).
_RADII = 14, 8, 3
#: So many radii are looked at, and around each end of a ring _ROUNDS times _SECTIONS more: it is then right to 1e-7.
_LOOKED_AT, _SECTIONS, _ROUNDS = 96, 13, 5
#: Terms of the table on each of its pieces, which are halved at most _HALVINGS times, until what the pressure and r²
#: miss between is below _SAME.
_TERMS, _HALVINGS, _SAME = 14, 6, 1e-8
#: Steps of Newton's method to the place of the largest pressure, from the best of the nodes.
_STEPS = 5


class Peaks(NamedTuple):
    """The largest pressure in spots of a cell, by their radius.

    ends : (n + 1,), ln b (unit l) at the ends of the pieces of the table; below the first the peak is in the middle
    ring, lifts : (n,) bool: on this piece it is in a ring; the pressure is below 0 somewhere inside
    series : (n, 2, terms), Chebyshev series in ln b: of the largest pressure over 2 b/pi, and of (r/b)² of its place
    """

    ends: np.ndarray
    ring: np.ndarray
    lifts: np.ndarray
    series: np.ndarray

    def at(self, b, p_max):
        """The largest pressure, and its radius over b, (B,) each.

        b : (B,), radii in l, up to the largest of the table; p_max : (B,), pressures in the middle, E = Ra = l = 1
        """
        w = np.log(b)
        piece = np.minimum(np.searchsorted(self.ends, w, side="right"), len(self.ring)) - 1
        p, r = np.array(p_max, dtype=float), np.zeros(len(w))
        some = np.flatnonzero((piece >= 0) & np.append(self.ring, False)[piece])
        if len(some):
            low, high = self.ends[piece[some]], self.ends[piece[some] + 1]
            T = _vander(2 * (w[some] - low) / (high - low) - 1, self.series.shape[2])
            value, square = np.einsum("pt,pkt->kp", T, self.series[piece[some]])
            value = value * 2 * b[some] / np.pi
            ring = value > p[some]
            p[some] = np.where(ring, value, p[some])
            r[some] = np.where(ring, np.sqrt(np.clip(square, 0.0, 1.0)), 0.0)
        return p, r

    def lifts_off(self, b):
        """Whether the pressure is below 0 inside of a spot of one of the radii up to b (B,): bool."""
        first = np.min(self.ends[:-1][self.lifts], initial=np.inf)
        return np.log(b) > first


def in_the_middle():
    """:class:`Peaks` of cells whose largest pressure is in the middle at any radius."""
    return Peaks(np.zeros(1), np.zeros(0, dtype=bool), np.zeros(0, dtype=bool), np.zeros((0, 2, _TERMS)))


def may_leave_the_middle(cell):
    """Whether the largest pressure of some spot may be beside the middle."""
    return cell.L1 is not None and bool(cell.L1(U).max() > _HARD)


def peaks(cell, reach):
    """:class:`Peaks` of a :class:`~.spot.Cell` for radii up to `reach` (unit l)."""
    if reach * cell.pitch <= NARROW or not may_leave_the_middle(cell):
        return in_the_middle()
    w = np.log([NARROW / cell.pitch, reach])
    count, breaks, N = _count(w), _breaks(reach * cell.pitch), pieces(cell, reach)
    b, y = np.exp(_on(*w, _roots(count))), _at_nodes(breaks)
    rows = in_groups(cell, b, lambda some: pressures(spots(cell, some, N), y).T, len(y)) / (2 * b / np.pi)
    series = np.linalg.solve(_vander(_roots(count), count), rows.T)

    def looked_up(at):
        """:class:`_Largest` at ln b (B,)."""
        return largest(_vander((2 * at - w[0] - w[1]) / (w[1] - w[0]), count) @ series, breaks)

    return _table(looked_up, w)


class SummitPeaks(NamedTuple):
    """The pressures of spots of their own load under the pressure p of others, over 2 b/pi, at nodes of panels of s/b
    between `breaks`: Chebyshev series (2, terms, nodes) in ln b between both `w`, of those without p and of those by p.
    """

    w: np.ndarray
    breaks: np.ndarray
    series: np.ndarray

    def _values(self, b, p):
        x = (2 * np.log(b) - self.w[0] - self.w[1]) / (self.w[1] - self.w[0])
        T = _vander(np.clip(x, -1.0, 1.0), self.series.shape[1])
        return T @ self.series[0] + p[:, None] * (T @ self.series[1])

    def at(self, b, p_max, p):
        """As of :class:`Peaks`, under the nominal pressures p (B,)."""
        values, r, lone = np.array(p_max, dtype=float), np.zeros(len(b)), 2 * b / np.pi
        some = np.flatnonzero(np.log(b) >= self.w[0]) if len(self.series[0]) else np.zeros(0, dtype=int)
        if len(some):
            found = largest(self._values(b[some], p[some]), self.breaks)
            ring = found.ring & (found.value * lone[some] > values[some])
            values[some] = np.where(ring, found.value * lone[some], values[some])
            r[some] = np.where(ring, np.sqrt(found.square), 0.0)
        return values, r


def summit_peaks(cell, reach):
    """:class:`SummitPeaks` of a :class:`~.spot.Cell` of disc cells, for radii up to `reach` (unit l)."""
    w = np.log([NARROW / cell.pitch, reach])
    if w[1] <= w[0] or not may_leave_the_middle(cell):
        return SummitPeaks(w, np.zeros(0), np.zeros((2, 0, 0)))
    count, breaks = _count(w), _breaks(reach * cell.pitch)
    b, y = np.exp(_on(*w, _roots(count))), _at_nodes(breaks)
    of_lattice, lone = pieces(cell, reach), pieces(cell._replace(lattice="lone"), reach)

    def of(some):
        both = parts(cell, some, of_lattice, lone)
        without, under = (pressures(both.spots(np.full(len(some), p)), y).T for p in (0.0, 1.0))
        return np.concatenate([without, under - without])

    rows = (in_groups(cell, b, of, 2 * len(y)) / (2 * b / np.pi)).reshape(2, len(y), count)
    return SummitPeaks(w, breaks, np.linalg.solve(_vander(_roots(count), count), rows.transpose(0, 2, 1)))


def _count(w):
    """How many radii are solved between both `w`, ln b."""
    return int(np.polynomial.polynomial.polyval(w[1] - w[0], _RADII))


def _breaks(most):
    """Ends of the panels of s/b for spots of up to b/h = `most`."""
    return np.sqrt(1 - np.linspace(1, 0, 1 + int(np.ceil(most / _WIDEST))) ** 2)


class _Largest(NamedTuple):
    """Of pressures (B,) each: the largest, (r/b)² of its place, whether that is in a ring, and whether some are below
    0."""

    value: np.ndarray
    square: np.ndarray
    ring: np.ndarray
    lifts: np.ndarray


def pressures(spot, y):
    """q (S, Y) of :class:`~.spot.CellSpots` at r = b sqrt(1 - y²), for y (Y,) in [0, 1]."""
    return spot.b[:, None] * (spot.fall @ _weights(spot.t.shape[1], y.tobytes()).T)


@lru_cache(maxsize=32)
def _weights(count, y_bytes):
    """From values of f at `count` points t/b to q/b at y: (Y, count)."""
    panels, size = panels_of(count)
    y, rows, nodes = np.frombuffer(y_bytes), [], gauss_legendre(size)[0]
    x, weights = gauss_legendre(size + 8)
    ends = np.arange(panels + 1) / panels
    # of the variable u/b: where t = sqrt(r² + u²) passes the ends of the panels
    u = np.sqrt(np.maximum(y[:, None] ** 2 - (1 - ends) * (1 + ends), 0.0))
    for j in range(panels):
        some = np.flatnonzero(u[:, j + 1] > 0)
        width = np.diff(u[some, j : j + 2])
        at = u[some, j, None] + width * x
        t = np.sqrt((1 - y[some, None]) * (1 + y[some, None]) + at**2)
        basis = lagrange(nodes, np.clip(t * panels - j, 0.0, 1.0).ravel()).reshape(*at.shape, size)
        row = np.zeros((len(y), size))
        row[some] = np.matmul((width * weights)[:, None], basis)[:, 0]
        rows.append(row)
    return np.concatenate(rows, axis=1)


def largest(values, breaks):
    """:class:`_Largest` of pressures (B, P nodes) at the :func:`_at_nodes` of the panels between `breaks`."""
    panels, row = values.reshape(len(values), -1, _NODES), np.arange(len(values))
    best = _highest(values)
    j, k = best // _NODES, best % _NODES
    # a node that two panels share belongs to the one into which the pressure rises
    onward = (k == _NODES - 1) & (panels[row, j] @ _slopes()[-1] > 0)
    j, k = np.where(onward, j + 1, j), np.where(onward, 0, k)
    series = panels[row, j] @ _to_series()
    first = series @ _derivative()
    second, x = first @ _derivative(), _ends()[k]
    low, high = _ends()[np.maximum(k - 1, 0)], _ends()[np.minimum(k + 1, _NODES - 1)]
    for _ in range(_STEPS):
        T = _vander(x, _NODES)
        slope, bend = (T * first).sum(axis=1), (T * second).sum(axis=1)
        x = np.clip(x - np.where(bend < 0, slope / np.where(bend < 0, bend, 1.0), 0.0), low, high)
    value, middle = (_vander(x, _NODES) * series).sum(axis=1), values[:, -1]
    y = _on(breaks[j], breaks[j + 1], x)
    ring = (value > middle) & (y < 1)
    lifts = (values[:, 1:] < 0).any(axis=1)
    return _Largest(np.where(ring, value, middle), np.where(ring, (1 - y) * (1 + y), 0.0), ring, lifts)


def _highest(values):
    """Index (B,) of the largest of the local maxima among pressures (B, P nodes) outside of the middle, which is the
    last; of the node beside the middle where there is none."""
    inside = values[:, 1:-1]
    peaks = (inside >= values[:, :-2]) & (inside >= values[:, 2:])
    highest = 1 + np.where(peaks, inside, -np.inf).argmax(axis=1)
    return np.where(peaks.any(axis=1), highest, values.shape[1] - 2)


def _table(looked_up, w):
    """:class:`Peaks` of a function of ln b, between both `w`."""
    at = np.linspace(*w, _LOOKED_AT)
    kind = _kind(looked_up(at))
    last = np.flatnonzero(np.diff(kind))
    ends, row = np.stack([at[last], at[last + 1]]), np.arange(len(last))
    for _ in range(_ROUNDS if len(last) else 0):
        fine = np.linspace(*ends, _SECTIONS)
        changed = _kind(looked_up(fine.ravel())).reshape(fine.shape) != kind[last]
        first = np.where(changed[1:].any(axis=0), 1 + changed[1:].argmax(axis=0), _SECTIONS - 1)
        ends = np.stack([fine[first - 1, row], fine[first, row]])
    edges, pieces = [w[0], *ends[1], w[1]], []
    for low, high, own in zip(edges[:-1], edges[1:], [kind[0], *kind[last + 1]], strict=True):
        pieces += _pieces(looked_up, low, high, own, _HALVINGS)
    lows, highs, kinds, series = (np.array(column) for column in zip(*pieces, strict=True))
    return Peaks(np.append(lows, highs[-1]), kinds % 2 == 1, kinds >= 2, series)


def _kind(found):
    """1 in a ring, and 2 more where it lifts off."""
    return found.ring + 2 * found.lifts


def _pieces(looked_up, low, high, kind, halvings):
    """(low, high, kind, series) of pieces of the table; those in the middle need no series."""
    if kind % 2 == 0:
        return [(low, high, kind, np.zeros((2, _TERMS)))]
    found = looked_up(_on(low, high, _roots(_TERMS)))
    series = np.linalg.solve(_vander(_roots(_TERMS), _TERMS), np.stack([found.value, found.square], axis=1)).T
    between = (_roots(_TERMS)[1:] + _roots(_TERMS)[:-1]) / 2
    found = looked_up(_on(low, high, between))
    missed = np.abs(series @ _vander(between, _TERMS).T - [found.value, found.square])
    if halvings == 0 or (missed.max(axis=1) <= _SAME * np.array([found.value.max(), 1.0])).all():
        return [(low, high, kind, series)]
    middle = (low + high) / 2
    halves = (low, middle), (middle, high)
    return [piece for half in halves for piece in _pieces(looked_up, *half, kind, halvings - 1)]


def _on(low, high, x):
    """What is at x in [-1, 1] of an interval."""
    return low + (high - low) * (1 + x) / 2


def _roots(count):
    """Chebyshev's nodes (count,) in (-1, 1), ascending."""
    return -np.cos(np.pi * (np.arange(count) + 0.5) / count)


def _ends():
    """The nodes (_NODES,) of a panel in [-1, 1], with both ends."""
    return -np.cos(np.pi * np.arange(_NODES) / (_NODES - 1))


def _at_nodes(breaks):
    """y (P nodes,) at the nodes of the panels between `breaks`."""
    return _on(breaks[:-1, None], breaks[1:, None], _ends()).ravel()


def _vander(x, count):
    return np.polynomial.chebyshev.chebvander(x, count - 1)


@lru_cache(maxsize=1)
def _to_series():
    """From values at the nodes of a panel to Chebyshev coefficients, from the right, (nodes, nodes)."""
    return np.linalg.inv(_vander(_ends(), _NODES)).T


@lru_cache(maxsize=1)
def _derivative():
    """From Chebyshev coefficients to those of the derivative, from the right, (nodes, nodes)."""
    return np.array([np.append(np.polynomial.chebyshev.chebder(row), [0.0]) for row in np.eye(_NODES)])


@lru_cache(maxsize=1)
def _slopes():
    """From values at the nodes of a panel to derivatives there, (nodes, nodes)."""
    return _vander(_ends(), _NODES) @ _derivative().T @ _to_series().T

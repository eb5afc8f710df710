"""The largest pressure in a spot, and its place: docs/coated_body.md, The pressure inside a spot.

With phi of :mod:`.spot` and f(t) = -phi'(t)/t, the pressure at r = sqrt(b² - s²) is

    q(r) = ∫ f(t) t/sqrt(t² - r²) dt, t from r to b,   = ∫ f(sqrt(r² + u²)) du, u from 0 to s:

a smooth function of s from the edge, s = 0, to the middle, s = b. So it is a polynomial in s/b on each of a few panels.
On a hard film over a soft body, the place of the largest pressure leaves the middle at some radius b and becomes a ring
that widens with b. At a larger b the pressure in the middle may overtake that in the ring. For the radii in between, a
table has the pressure in the ring and the radius of the ring.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...numerics.quadrature import gauss_legendre, lagrange
from .family import in_groups
from .spot import panels_of, pieces, spots
from .summits import parts

__all__ = ["NARROW", "Peaks", "SummitPeaks", "U", "may_leave_the_middle", "peaks", "pressures", "summit_peaks"]

#: The largest pressure stays in the middle where b/h is below NARROW, and wherever L - 1 exceeds _HARD nowhere. It
#: leaves the middle only for b/h above 1.04, the value on a plate without support, and only if the largest L - 1 is
#: above 1.6, whatever the Poisson ratios and the interface; in stacks not earlier (tests/laws/cell/test_peak.py).
NARROW, _HARD = 1.0, 1.3
#: The u = kh at which L - 1 is evaluated for this.
U = np.geomspace(1e-4, 12, 60)
#: Nodes of the polynomials on a panel of s/b (Chebyshev's, with both ends), and the widest panel in h.
_NODES, _WIDEST = 32, 5.0
#: Number of radii at which the cell is solved, as coefficients of a polynomial in ln of the largest b/h over NARROW.
#: The pressures between them have a relative error of 1e-7 (tests/laws/cell/test_peak.py).
_RADII = 14, 8, 3
#: Number of radii at which the place of the peak is examined; and around each radius where a ring begins or ends, in
#: each of _ROUNDS rounds, _SECTIONS more. That radius is then right to 1e-7.
_EXAMINED, _SECTIONS, _ROUNDS = 96, 13, 5
#: Number of terms of the table on each of its pieces. A piece is halved, at most _HALVINGS times, until the errors of
#: the pressure and of r² between the nodes are below _SAME.
_TERMS, _HALVINGS, _SAME = 14, 6, 1e-8
#: Steps of Newton's method to the place of the largest pressure, from the best of the nodes.
_STEPS = 5


class Peaks(NamedTuple):
    """The largest pressure in spots of a cell, as a function of their radius.

    ends : (n + 1,), ln b, b in l, at the ends of the pieces of the table; below the first end the peak is in the middle
    ring : (n,) bool, whether on this piece the peak is in a ring
    lifts : (n,) bool, whether on this piece the pressure is below 0 somewhere inside the spot
    series : (n, 2, terms), Chebyshev series in ln b: of the largest pressure over 2 b/pi, and of (r/b)² at its place
    """

    ends: np.ndarray
    ring: np.ndarray
    lifts: np.ndarray
    series: np.ndarray

    def at(self, b, p_max):
        """The largest pressure, and the radius of its place over b, (B,) each.

        b : (B,), radii in l, at most the largest of the table
        p_max : (B,), pressures in the middle; units E = Ra = l = 1
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
        """(B,) bool: whether in a spot of some radius up to b (B,) the pressure is below 0 somewhere."""
        first = np.min(self.ends[:-1][self.lifts], initial=np.inf)
        return np.log(b) > first


def in_the_middle():
    """:class:`Peaks` of cells whose largest pressure is in the middle for all radii."""
    return Peaks(np.zeros(1), np.zeros(0, dtype=bool), np.zeros(0, dtype=bool), np.zeros((0, 2, _TERMS)))


def may_leave_the_middle(cell):
    """Whether in some spot of a :class:`~.spot.Cell` the largest pressure may be outside the middle."""
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

    def largest_at(at):
        """:class:`_Largest` at ln b (B,)."""
        return largest(_vander((2 * at - w[0] - w[1]) / (w[1] - w[0]), count) @ series, breaks)

    return _table(largest_at, w)


class SummitPeaks(NamedTuple):
    """The pressures, over 2 b/pi, in spots that have their own load and feel the nominal pressure p of others.

    w : (2,), the smallest and the largest ln b
    breaks : ends of the panels of s/b
    series : (2, terms, nodes), Chebyshev series in ln b of the pressures at the nodes of the panels: without p, and
        their change for each p
    """

    w: np.ndarray
    breaks: np.ndarray
    series: np.ndarray

    def _values(self, b, p):
        x = (2 * np.log(b) - self.w[0] - self.w[1]) / (self.w[1] - self.w[0])
        T = _vander(np.clip(x, -1.0, 1.0), self.series.shape[1])
        return T @ self.series[0] + p[:, None] * (T @ self.series[1])

    def at(self, b, p_max, p):
        """As :meth:`Peaks.at`, under the nominal pressures p (B,)."""
        values, r, lone = np.array(p_max, dtype=float), np.zeros(len(b)), 2 * b / np.pi
        some = np.flatnonzero(np.log(b) >= self.w[0]) if len(self.series[0]) else np.zeros(0, dtype=int)
        if len(some):
            highest = largest(self._values(b[some], p[some]), self.breaks)
            ring = highest.ring & (highest.value * lone[some] > values[some])
            values[some] = np.where(ring, highest.value * lone[some], values[some])
            r[some] = np.where(ring, np.sqrt(highest.square), 0.0)
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
    """Number of radii that are solved between both `w`, ln b."""
    return int(np.polynomial.polynomial.polyval(w[1] - w[0], _RADII))


def _breaks(most):
    """Ends of the panels of s/b for spots of up to b/h = `most`."""
    return np.sqrt(1 - np.linspace(1, 0, 1 + int(np.ceil(most / _WIDEST))) ** 2)


class _Largest(NamedTuple):
    """Arrays (B,): the largest pressure, (r/b)² of its place, whether this place is a ring, and whether some pressure
    is below 0."""

    value: np.ndarray
    square: np.ndarray
    ring: np.ndarray
    lifts: np.ndarray


def pressures(spot, y):
    """q (S, Y) of :class:`~.spot.CellSpots` at r = b sqrt(1 - y²), for y (Y,) in [0, 1]."""
    return spot.b[:, None] * (spot.fall @ _weights(spot.t.shape[1], y.tobytes()).T)


@lru_cache(maxsize=32)
def _weights(count, y_bytes):
    """The matrix (Y, count) that makes q/b at y from values of f at `count` points t/b."""
    panels, size = panels_of(count)
    y, rows, nodes = np.frombuffer(y_bytes), [], gauss_legendre(size)[0]
    x, weights = gauss_legendre(size + 8)
    ends = np.arange(panels + 1) / panels
    # the u/b at which t = sqrt(r² + u²) reaches the ends of the panels
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
    # a node that two panels share belongs to the panel into which the pressure rises
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
    """Index (B,) of the largest local maximum of the pressures (B, P nodes) outside the middle, which is the last node.
    If there is none, it is that of the node next to the middle."""
    inside = values[:, 1:-1]
    peaks = (inside >= values[:, :-2]) & (inside >= values[:, 2:])
    highest = 1 + np.where(peaks, inside, -np.inf).argmax(axis=1)
    return np.where(peaks.any(axis=1), highest, values.shape[1] - 2)


def _table(largest_at, w):
    """:class:`Peaks` from `largest_at`, a function of ln b that returns :class:`_Largest`, between both `w`."""
    at = np.linspace(*w, _EXAMINED)
    kind = _kind(largest_at(at))
    last = np.flatnonzero(np.diff(kind))
    ends, row = np.stack([at[last], at[last + 1]]), np.arange(len(last))
    for _ in range(_ROUNDS if len(last) else 0):
        fine = np.linspace(*ends, _SECTIONS)
        changed = _kind(largest_at(fine.ravel())).reshape(fine.shape) != kind[last]
        first = np.where(changed[1:].any(axis=0), 1 + changed[1:].argmax(axis=0), _SECTIONS - 1)
        ends = np.stack([fine[first - 1, row], fine[first, row]])
    edges, pieces = [w[0], *ends[1], w[1]], []
    for low, high, kind_there in zip(edges[:-1], edges[1:], [kind[0], *kind[last + 1]], strict=True):
        pieces += _pieces(largest_at, low, high, kind_there, _HALVINGS)
    lows, highs, kinds, series = (np.array(column) for column in zip(*pieces, strict=True))
    return Peaks(np.append(lows, highs[-1]), kinds % 2 == 1, kinds >= 2, series)


def _kind(peaks):
    """1 if the peak is in a ring, plus 2 if the pressure is below 0 somewhere."""
    return peaks.ring + 2 * peaks.lifts


def _pieces(largest_at, low, high, kind, halvings):
    """Pieces of the table, (low, high, kind, series) each. A piece whose peak is in the middle needs no series."""
    if kind % 2 == 0:
        return [(low, high, kind, np.zeros((2, _TERMS)))]
    peaks = largest_at(_on(low, high, _roots(_TERMS)))
    series = np.linalg.solve(_vander(_roots(_TERMS), _TERMS), np.stack([peaks.value, peaks.square], axis=1)).T
    between = (_roots(_TERMS)[1:] + _roots(_TERMS)[:-1]) / 2
    peaks = largest_at(_on(low, high, between))
    missed = np.abs(series @ _vander(between, _TERMS).T - [peaks.value, peaks.square])
    if halvings == 0 or (missed.max(axis=1) <= _SAME * np.array([peaks.value.max(), 1.0])).all():
        return [(low, high, kind, series)]
    middle = (low + high) / 2
    halves = (low, middle), (middle, high)
    return [piece for half in halves for piece in _pieces(largest_at, *half, kind, halvings - 1)]


def _on(low, high, x):
    """The point of the interval from `low` to `high` that corresponds to x in [-1, 1]."""
    return low + (high - low) * (1 + x) / 2


def _roots(count):
    """Chebyshev's nodes (count,) in (-1, 1), ascending."""
    return -np.cos(np.pi * (np.arange(count) + 0.5) / count)


def _ends():
    """The nodes (_NODES,) of a panel in [-1, 1]; both ends are nodes."""
    return -np.cos(np.pi * np.arange(_NODES) / (_NODES - 1))


def _at_nodes(breaks):
    """y (P nodes,) at the nodes of the panels between `breaks`."""
    return _on(breaks[:-1, None], breaks[1:, None], _ends()).ravel()


def _vander(x, count):
    return np.polynomial.chebyshev.chebvander(x, count - 1)


@lru_cache(maxsize=1)
def _to_series():
    """The matrix (nodes, nodes) that makes Chebyshev coefficients from a row of values at the nodes of a panel."""
    return np.linalg.inv(_vander(_ends(), _NODES)).T


@lru_cache(maxsize=1)
def _derivative():
    """The matrix (nodes, nodes) that makes Chebyshev coefficients of the derivative from a row of coefficients."""
    return np.array([np.append(np.polynomial.chebyshev.chebder(row), [0.0]) for row in np.eye(_NODES)])


@lru_cache(maxsize=1)
def _slopes():
    """The matrix (nodes, nodes) that makes derivatives at the nodes from a column of values there."""
    return _vander(_ends(), _NODES) @ _derivative().T @ _to_series().T

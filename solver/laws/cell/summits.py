"""One spot with a radius and a load of its own on a coated body, in the mean field of the other spots: for asperities
of random heights.

The load of the spot itself acts through the kernel of a lone spot on the layer. The loads of the others act through
their mean, the nominal pressure p: by the field of a half-space outside the cell, as in the disc cell, and by the part
of the layer for the waves of the hexagonal lattice, less that of the spot itself. N1 is the kernel of the lone spot, Nh
that of the lattice, and s the phi of a spot of equal heights (disc cell, load 1, the same radius). Then

    pi phi(t) + 2 int_0^b phi N1 ds = A - t² + p [2 sqrt(Bbar² - t²) - 2 int_0^b s (Nh - N1) ds].

It is linear in p. In units of the disc cell, with c = b/Bbar = sin θ, v = cos θ and k = (2/3) q,

    approach   a = c² e^G - 2 k (v + B),
    load       f = (2/pi) [c³ e^P + q (θ - v c + F)],
    p_max/p*     = (3/pi) c e^Q + (2/pi) q (θ + D),

where G, P, Q, B, F and D are smooth functions of b/h, all 0 without a layer. A spot whose load is the mean is the disc
cell of the family. A and λ of resolved cells of random heights are within 8 %
(tests/laws/heights/test_heights_on_body.py). If each spot felt others of its own load, they would be up to 70 % off.
"""

from typing import NamedTuple

import numpy as np

from ...numerics.caches import Cache
from .family import REACH, chebyshev_series, in_groups
from .rows import of_kernel
from .spot import Cell, CellSpots, kernels, pieces, points, spots

__all__ = ["SUMMIT", "SUMMIT_NUMBERS", "Lookup", "Parts", "Summit", "at", "clenshaw", "parts", "summit"]

#: The numbers of a summit before its series, in this order:
#: scale : b/h over c
#: width, end : 1/asinh(largest b/h), and the largest c, of the series, as in the family of disc cells
#: on : beyond the end the series are straight lines in ln c (1), or constant (0) if that family ends early
SUMMIT_NUMBERS = ("scale", "width", "end", "on")
SERIES = ("G", "P", "Q", "B", "F", "D")
#: As in :mod:`.family`, with fewer terms, since the laws of heights are right only to 2e-4.
_TERMS, _ENOUGH, _SMALL = ((2.0, 16), (24.0, 28), (np.inf, 56)), 130, 1e-7
#: Polynomials of a lookup: number for each term of the series, and degree. They are right to 1e-9.
_PIECES, _DEGREE = 6, 5
_summits = Cache(2e7)
#: `cell` of the :class:`~solver.laws.law.Law` of random heights.
SUMMIT = "summit"


class Summit(NamedTuple):
    """Pitch over h, the largest radius of the series, in l, and the series (6, N) of G, P, Q, B, F and D."""

    pitch: float
    reach: float
    series: np.ndarray

    @property
    def terms(self):
        return self.series.shape[1]

    def row(self, terms):
        """Its numbers, (len(SUMMIT_NUMBERS) + 6 `terms`,): SUMMIT_NUMBERS, then the series, each filled up with
        zeros."""
        Bbar = 1 / np.sqrt(np.pi)
        scale, end = self.pitch * Bbar, self.reach / Bbar
        series = np.zeros((len(SERIES), terms))
        series[:, : self.series.shape[1]] = self.series
        on = float(self.reach > 0.99 * np.sqrt(REACH / np.pi))
        return np.concatenate([[scale, 1 / np.arcsinh(scale * end), end, on], series.ravel()])


def summit(key, disc, kernel, m, i):
    """The :class:`Summit` of case i, cached under the `key` of its family `disc` of disc cells (:mod:`.family`). If no
    law can use the family, it is the summit without a layer."""
    return _summits.get(key, lambda: Summit(disc.pitch, disc.reach, _series_of(disc, kernel.take([i]), float(m[i]))))


@np.errstate(all="ignore")  # the numbers may be those of no real body
def _series_of(disc, kernel, m):
    """The series of a :class:`Summit`."""
    none = np.zeros((len(SERIES), 1))
    if not disc.usable:
        return none
    cell = Cell("disc", disc.pitch, of_kernel(kernel, m))
    of_lattice, lone = pieces(cell, disc.reach), pieces(cell._replace(lattice="lone"), disc.reach)

    def of(b):
        return in_groups(cell, b, lambda some: _corrections(cell, some, of_lattice, lone), len(SERIES))

    series = chebyshev_series(of, disc.pitch, disc.reach, _SMALL, _TERMS, _ENOUGH)
    return series if np.isfinite(series).all() else none


class Parts(NamedTuple):
    """Solutions of the module's equation for S radii, with three right-hand sides: 1 (for A), t² (the shape), and the
    factor of p.

    t, w : (S, T), points and weights
    phi, fall : (S, T, 3), phi and -phi'(t)/t
    load, middle, at_b : (S, 3), load, pressure in the middle, and phi at b
    equal : :class:`~.spot.CellSpots` of equal heights
    """

    t: np.ndarray
    w: np.ndarray
    phi: np.ndarray
    fall: np.ndarray
    load: np.ndarray
    middle: np.ndarray
    at_b: np.ndarray
    equal: CellSpots

    def spots(self, p):
        """:class:`~.spot.CellSpots` under the nominal pressures p (S,)."""
        of_shape, of_others = self.at_b[:, 1] / self.at_b[:, 0], self.at_b[:, 2] / self.at_b[:, 0]
        A = of_shape - p * of_others
        factors = np.stack([A, -np.ones_like(A), p], axis=1)
        phi, fall = ((values * factors[:, None]).sum(axis=2) for values in (self.phi, self.fall))
        load, middle = ((values * factors).sum(axis=1) for values in (self.load, self.middle))
        return CellSpots(self.equal.b, load, A, middle, self.t, self.w, phi, fall)


def parts(cell, b, of_lattice, lone):
    """:class:`Parts` for the radii b (S,). cell : a disc cell; of_lattice, lone : :func:`~.spot.pieces` of this cell
    and of a lone spot."""
    rule = points(cell, b.max(), sparing=True)
    t, w = (b[:, None] * values for values in rule)
    equal = spots(cell, b, of_lattice, rule)
    shape = (equal.phi / (2 * np.pi * (w * equal.phi).sum(axis=1)[:, None]))[..., None]
    ends = np.concatenate([t, b[:, None]], axis=1)
    of_lone, d_of_lone = kernels(lone, ends, t, w)
    lattice, d_lattice = kernels(of_lattice, ends, t, w)
    root = np.sqrt(1 / np.pi - ends**2)
    right = np.stack([np.ones_like(ends), ends**2, 2 * root - ((lattice - of_lone) @ shape)[..., 0]], axis=2)
    slopes = [np.zeros_like(t), 2 * t, -2 * t / root[:, :-1] - ((d_lattice - d_of_lone) @ shape)[:, :-1, 0]]
    phi = np.linalg.solve(np.pi * np.eye(t.shape[1]) + of_lone[:, :-1], right[:, :-1])
    at_b = (right[:, -1] - (of_lone[:, -1:] @ phi)[:, 0]) / np.pi
    load = 2 * np.pi * (w[:, None] @ phi)[:, 0]
    fall = (d_of_lone[:, :-1] @ phi - np.stack(slopes, axis=2)) / (np.pi * t[..., None])
    middle = (w[:, None] @ fall)[:, 0]
    return Parts(t, w, phi, fall, load, middle, at_b, equal)


def _corrections(cell, b, of_lattice, lone):
    """G, P, Q, B, F and D (6, S) at the radii b (S,)."""
    _, _, _, _, load, middle, at_b, _ = parts(cell, b, of_lattice, lone)
    # phi(b) = 0 gives A = (part of the shape) - p (part of the others)
    of_shape, of_others = at_b[:, 1] / at_b[:, 0], at_b[:, 2] / at_b[:, 0]
    logs = np.log([
        of_shape / b**2,
        (of_shape * load[:, 0] - load[:, 1]) / (4 / 3 * b**3),
        (of_shape * middle[:, 0] - middle[:, 1]) / (2 * b / np.pi),
    ])  # fmt: skip
    c = b * np.sqrt(np.pi)
    v, angle = np.sqrt(1 - c * c), np.arcsin(c)
    B = of_others * np.sqrt(np.pi) / 2 - v
    F = np.pi / 2 * (load[:, 2] - of_others * load[:, 0]) - (angle - v * c)
    D = np.pi / 2 * (middle[:, 2] - of_others * middle[:, 0]) - angle
    return np.concatenate([logs, [B, F, D]])


def clenshaw(coefficients, x):
    """Chebyshev series with the coefficients (B, N) at x (B, m), and their derivatives by x, by Clenshaw's
    recurrence."""
    value, before, slope, slope_before = np.zeros((4, *x.shape))
    twice = 2 * x
    for c in coefficients.T[:0:-1]:
        slope, slope_before = twice * slope - slope_before + 2 * value, slope
        value, before = twice * value - before + c[:, None], value
    return x * value - before + coefficients[:, :1], value + x * slope - slope_before


def at(rows, which, c):
    """The series with the index `which` of SERIES at c (B, m), and its derivative by ln c; rows (B, K) of B cases."""
    terms = (rows.shape[1] - len(SUMMIT_NUMBERS)) // len(SERIES)
    first = len(SUMMIT_NUMBERS) + which * terms
    scale, width, end, on = rows[:, : len(SUMMIT_NUMBERS)].T[..., None]
    beta, past_end = scale * np.minimum(c, end), np.log(np.maximum(c / end, 1.0))
    x, dx = 2 * width * np.arcsinh(beta) - 1, 2 * width * beta / np.hypot(1, beta)
    value, slope = clenshaw(rows[:, first : first + terms], x)
    slope = slope * dx
    return value + on * slope * past_end, np.where(c < end, slope, on * slope)


class Lookup:
    """Four of the SERIES, G, P, B and F, of one row (K,), as short polynomials: fast for many points."""

    def __init__(self, row):
        self.scale, self.width, self.end, self.on = row[: len(SUMMIT_NUMBERS)]
        nodes = np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
        series = row[len(SUMMIT_NUMBERS) :].reshape(len(SERIES), -1)
        self.count = _PIECES * series.shape[1]
        x = (2 * np.arange(self.count)[:, None] + 1 + nodes) / self.count - 1
        values = [clenshaw(series[None, i], x.ravel()[None])[0].reshape(x.shape) for i in (0, 1, 3, 4)]
        self.polynomials = np.linalg.solve(np.vander(nodes, increasing=True), np.stack(values).transpose(0, 2, 1))

    def at(self, c):
        """Two lists: G, P, B and F at c, which has any shape, and their derivatives by ln c."""
        beta = self.scale * np.minimum(c, self.end)
        place = self.width * np.arcsinh(beta) * self.count
        index = np.clip(place.astype(int), 0, self.count - 1)
        xi, dx = 2 * (place - index) - 1, 2 * self.count * self.width * beta / np.hypot(1, beta)
        values, slopes, dx = [], [], np.where(c < self.end, dx, self.on * dx)
        past_end = np.log(np.maximum(c / self.end, 1.0))
        for rows in self.polynomials:
            value, slope = rows[-1].take(index), 0.0
            for row in rows[-2::-1]:
                slope = slope * xi + value
                value = value * xi + row.take(index)
            slopes.append(slope * dx)
            values.append(value + slopes[-1] * past_end)
        return values, slopes

"""The spot of a periodic cell on a coated body: its load, approach and pressure at a given radius.

In units l = Ra = E = 1, with phi, the Abel transform of the pressure, q^(k) = int_0^b phi cos kt dt and phi(b) = 0,

    pi phi(t) + 2 int_0^b phi(s) N(t, s) ds = A - t²   (+ 2 p sqrt(Bbar² - t²) in the disc cell),
    N(t, s) = [N(t + s) + N(t - s)]/2,   N = M + K of :mod:`.sums`   (K alone in the disc cell),
    p = 2 pi int phi dt,   p_max = -int phi'(t)/t dt.

M is the part of the neighbours on a half-space, K that of the layer. The equation is linear in A, in the shape t² and
in p: each has its own right-hand side, and phi(b) = 0 gives A. phi' follows from the derivative of the equation by t.
"""

from typing import NamedTuple

import numpy as np

from ...numerics.quadrature import gauss_legendre
from .sums import LATTICES, lone_waves, neighbours, waves

__all__ = ["Cell", "CellSpots", "panels_of", "pieces", "spots"]

#: Points on a panel of the radius, smallest number of points, and the widest panel in h (tests/laws/cell/test_rows.py).
POINTS, _LEAST, _WIDEST = 24, 48, 5.0
#: N is a polynomial of this degree on each piece of x. A piece is at most half as long as h, since the waves of the
#: layer have a singularity at 2 h i, and at most a fifth of the distance to d, where the neighbours have theirs. The
#: next term is then below rounding.
_DEGREE, _OF_H, _OF_D = 11, 0.5, 0.2
#: (points, b/h): number of points on one panel, and the b/h up to which it is enough where speed counts. The error is
#: 1e-10 at n = 1000, where rounding is as large, and 1e-11 for other layers (tests/laws/cell/test_family.py).
FEW = ((16, 2.5), (24, 4.0), (32, 7.0))


class Cell(NamedTuple):
    """Cells of one lattice on one body.

    lattice : "square", "hex", or "disc", whose layer has the waves of "hex"; "lone" for a single spot, only in
        :func:`pieces`
    pitch : l/h
    L1 : function of u = kh (W,) -> L(u) - 1 (W,) of the body, over 1 + m under an elastic punch; None without a layer
    """

    lattice: str
    pitch: float
    L1: object = None


class CellSpots(NamedTuple):
    """Spots with the radii b (S,), in units E = Ra = l = 1.

    p, A, p_max : (S,), nominal pressure, approach, pressure in the middle
    t, w : (S, T), points of each spot and their weights
    phi, fall : (S, T), phi and -phi'(t)/t at these points
    """

    b: np.ndarray
    p: np.ndarray
    A: np.ndarray
    p_max: np.ndarray
    t: np.ndarray
    w: np.ndarray
    phi: np.ndarray
    fall: np.ndarray


class _Pieces(NamedTuple):
    """N and dN/dx as polynomials on pieces of x: `edges` (n + 1,), and coefficients (degree + 1, n). The variable is
    the distance from the middle of a piece over half of its width."""

    edges: np.ndarray
    coefficients: np.ndarray

    def at(self, x):
        """N and dN/dx at x; any shape."""
        index = np.clip(np.searchsorted(self.edges, x, side="right") - 1, 0, len(self.edges) - 2)
        half = np.diff(self.edges) / 2
        inverse = (1 / half)[index]
        xi = (x - self.edges[index]) * inverse - 1
        value, slope = self.coefficients[-1][index], np.zeros_like(x)
        for row in self.coefficients[-2::-1]:
            slope *= xi
            slope += value
            value *= xi
            value += row.take(index)
        return value, slope * inverse


def _edges(cell, most):
    """Edges of the pieces of x from 0 to `most`."""
    edges, d = [0.0], LATTICES.get(cell.lattice, np.inf)
    widest = most if cell.L1 is None else _OF_H / cell.pitch
    while edges[-1] < most:
        edges.append(min(edges[-1] + min(widest, _OF_D * (d - edges[-1])), most))
        if edges[-1] > most * (1 - 1e-9):
            edges[-1] = most
    return np.array(edges)


def pieces(cell, reach):
    """:class:`_Pieces` of N for x from 0 to twice the largest radius."""
    edges = _edges(cell, 2 * reach)
    nodes = np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
    half = np.diff(edges) / 2
    middle = edges[:-1] + half
    x = middle + half * nodes[:, None]
    N = neighbours(cell.lattice, x)[0] if cell.lattice in LATTICES else np.zeros_like(x)
    if cell.L1 is not None:
        if cell.lattice == "lone":
            k, c = lone_waves(cell.pitch, reach)
        else:
            k, c = waves("hex" if cell.lattice == "disc" else cell.lattice, cell.pitch, reach)
        if len(k):
            N = N + _summed(k, c * cell.L1(k / cell.pitch), middle, half, nodes)
    return _Pieces(edges, np.linalg.solve(np.vander(nodes, increasing=True), N))


def _summed(k, c, middle, half, nodes):
    """Sums (nodes, pieces) of c (W,) times cos kx at the nodes of all pieces. The addition theorem, for all pieces of
    one width together, saves nine tenths of the cosines."""
    total = np.empty((len(nodes), len(middle)))
    widths, of_width = np.unique(np.round(half / half.max(), 12), return_inverse=True)
    for i in range(len(widths)):
        here = np.flatnonzero(of_width == i)
        far, near = np.outer(middle[here], k), np.outer(half[here[0]] * nodes, k)
        total[:, here] = np.cos(near) @ (c * np.cos(far)).T - np.sin(near) @ (c * np.sin(far)).T
    return total


def points(cell, reach, sparing=False):
    """Points and weights (T,) on [0, 1] for radii up to `reach`; `sparing`: whether their number may be one of FEW."""
    if sparing:
        for count, most in FEW:
            if cell.L1 is None or reach * cell.pitch <= most:
                return gauss_legendre(count)
    n = -(-_LEAST // POINTS)
    if cell.L1 is not None:
        n = max(n, int(np.ceil(reach * cell.pitch / _WIDEST)))
    x, w = gauss_legendre(POINTS)
    return ((np.arange(n)[:, None] + x) / n).ravel(), np.tile(w / n, n)


def panels_of(count):
    """Number of panels on which `count` points of a spot lie, and number of points on each."""
    return (1, count) if any(count == few for few, _ in FEW) else (count // POINTS, POINTS)


def kernels(N, ends, t, w):
    """2 N(t, s) and its derivative by t, each times the weight of s, (S, T + 1, T). The first argument has the values
    `ends` (S, T + 1); the second has the points t (S, T) with the weights w (S, T)."""
    far, near = ends[:, :, None] + t[:, None, :], ends[:, :, None] - t[:, None, :]
    (sum_, d_sum), (difference, d_difference) = N.at(far), N.at(np.abs(near))
    return (sum_ + difference) * w[:, None, :], (d_sum + np.sign(near) * d_difference) * w[:, None, :]


def spots(cell, b, N=None, rule=None):
    """:class:`CellSpots` of a :class:`Cell` with the radii b (S,), in l, 0 < b < d/2.

    N : :func:`pieces` of the cell, at least up to the largest radius, for callers that solve many groups of radii.
        The radii then have only as many points as the largest of them needs
    rule : points and weights on [0, 1]; None: they are chosen here
    """
    b = np.asarray(b, dtype=float)
    (x, weights), N = rule or points(cell, b.max(), N is not None), N or pieces(cell, b.max())
    t, w = b[:, None] * x, b[:, None] * weights
    ends = np.concatenate([t, b[:, None]], axis=1)
    kernel, d_kernel = kernels(N, ends, t, w)
    right = np.stack([np.ones_like(ends), ends**2], axis=2)
    slopes = np.stack([np.zeros_like(t), 2 * t], axis=2)
    if disc := cell.lattice == "disc":
        root = np.sqrt(1 / np.pi - ends**2)[..., None]
        right = np.concatenate([right, 2 * root], axis=2)
        slopes = np.concatenate([slopes, -2 * t[..., None] / root[:, :-1]], axis=2)
    matrix = np.pi * np.eye(len(x)) + kernel[:, :-1]
    phi = np.linalg.solve(matrix, right[:, :-1])
    at_b = (right[:, -1] - np.einsum("st,stk->sk", kernel[:, -1], phi)) / np.pi
    load = 2 * np.pi * np.einsum("st,stk->sk", w, phi)
    if disc:
        # two equations for A and p: phi(b) = 0, and p equals the load of phi
        rest = at_b[:, 0] * (1 - load[:, 2]) + at_b[:, 2] * load[:, 0]
        A = (at_b[:, 1] * (1 - load[:, 2]) + at_b[:, 2] * load[:, 1]) / rest
        p = (A * load[:, 0] - load[:, 1]) / (1 - load[:, 2])
        parts = np.stack([A, -np.ones_like(A), p], axis=1)
    else:
        A = at_b[:, 1] / at_b[:, 0]
        parts = np.stack([A, -np.ones_like(A)], axis=1)
        p = np.einsum("sk,sk->s", load, parts)
    phi = np.einsum("stk,sk->st", phi, parts)
    slope = np.einsum("stk,sk->st", slopes, parts) - np.einsum("stu,su->st", d_kernel[:, :-1], phi)
    fall = -slope / (np.pi * t)
    return CellSpots(b, p, A, (w * fall).sum(axis=1), t, w, phi, fall)

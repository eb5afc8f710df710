"""Pressures p(r) of cases on one mesh (a = 1), and the transforms that the fields need: docs/stress_fields.md, Waves.

p is the sum of two parts. One is, on each panel, the polynomial in s = sqrt(1 - r²) through the values at the nodes.
The other is A/s, the edge of a flat punch, A > 0, or of a contact with adhesion, A < 0. The transform of 1/s is sin
k/k, so that its φ is δ(t - 1).
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legder, legvander

from ..body.tables import transform
from ..numerics import batch, special
from ..numerics.mesh import Mesh
from ..numerics.quadrature import gauss_legendre, lagrange, radau_nodes

#: Gauss points of ∫ p' db on a panel, in addition to half its number of nodes. With 16 a polynomial of degree 63 is
#: right to rounding, which grows in p' like the square of the degree (tests/fields/test_half_space.py).
_MORE = 16
#: Waves with k above _LONG come only from the pressure within _WINDOW/k of the edge, or of panels narrower than
#: _NARROW/k, as at a tip. A smooth window selects it; it ends like a normal distribution of the width _WIDE/k, whose
#: own waves and tails are 1e-14. So p^ takes the same time at any k. With _NARROW = 4 the same tests pass
#: (tests/fields/test_half_space.py).
_LONG, _WINDOW, _WIDE = 500.0, 120.0, 8.0
_NARROW = 40.0
#: Matrices of at most this many entries are cached for other cases and other points.
_LARGEST_CACHED = 250_000
#: Numbers in an array of basis functions.
_AT_ONCE = 2_000_000
#: An edge pressure below this part of the largest is rounding. It would make stresses infinite at the edge.
_ROUNDING = 1e-12


@batch.of_cases
class Pressure(NamedTuple):
    """The pressures of B cases: `values` (B, n) at the nodes of a mesh, and A (B,), the factor of 1/s; None: all 0."""

    mesh: Mesh
    values: np.ndarray
    A: np.ndarray | None = None

    def transform(self, k):
        """p^(k) = ∫ p J0(kr) r dr (B, K) at ascending k (K,)."""
        first = max(_LONG, self.mesh.order**2 / 50)  # above this, the polynomial has waves only at the edge
        octaves = first * 2.0 ** np.arange(max(np.ceil(np.log2(k[-1] / first)), 0))
        pieces = [piece for piece in np.split(k, np.searchsorted(k, octaves)) if len(piece)]
        rows = [
            self.values @ _kept_waves(self.mesh, piece.tobytes())
            if piece.size * self.mesh.n <= _LARGEST_CACHED
            else _waves(self.mesh, self.values, piece)
            for piece in pieces
        ]
        waves = np.concatenate(rows, axis=1)
        return waves if self.A is None else waves + self.A[:, None] * (np.sin(k) / k)

    def at(self, r):
        """p (B, R) at radii r (R,); 0 outside the contact, infinite at an edge with A."""
        s = np.sqrt(np.maximum((1 - r) * (1 + r), 0.0))
        p = self.values @ self.mesh.basis(s).T
        return np.where(r <= 1, p if self.A is None else p + self.A[:, None] / s, 0.0)

    def at_edge(self):
        """p (B,) at s = 0. It is rounding, and becomes 0, except for the polynomials of films."""
        p = self.values @ self.mesh.basis(np.zeros(1))[0]
        return np.where(np.abs(p) > _ROUNDING * np.abs(self.values).max(axis=1), p, 0.0)

    def mean(self, r):
        """∫₀^r p r' dr'/r² (B, R) at radii r (R,): p(0)/2 in the centre, and P/(2 pi r²) outside."""
        mean = self.values @ self._means(r)
        s = np.sqrt(np.maximum((1 - r) * (1 + r), 0.0))
        return mean if self.A is None else mean + self.A[:, None] / (1 + s) / np.maximum(r, 1.0) ** 2

    def of_each(self, case, r):
        """p and its :meth:`mean` (P,) each at radii r (P,) of the cases `case` (P,)."""
        s = np.sqrt(np.maximum((1 - r) * (1 + r), 0.0))
        p, mean = np.empty((2, len(r)))
        of_a_radius = self.mesh.n * (self.mesh.order // 2 + 2) * (len(self.mesh.breaks) - 1)
        for some in np.array_split(np.arange(len(r)), 1 + len(r) * of_a_radius // _AT_ONCE):
            values = self.values[case[some]]
            p[some] = np.einsum("pn,pn->p", values, self.mesh.basis(s[some]))
            mean[some] = np.einsum("pn,np->p", values, self._means(r[some]))
        if self.A is not None:
            p, mean = p + self.A[case] / s, mean + self.A[case] / (1 + s) / np.maximum(r, 1.0) ** 2
        return np.where(r <= 1, p, 0.0), mean

    def _means(self, r):
        """From values at the nodes to the :meth:`mean` at radii r (R,), without that of A: (n, R)."""
        breaks, order = np.array(self.mesh.breaks), self.mesh.order
        s = np.sqrt(np.maximum((1 - r) * (1 + r), 0.0))
        # s' = s + (1 - s) t; panels end at these t. If s = 1 there is only the last panel
        ends = np.clip((breaks - s[:, None]) / np.maximum(1 - s, np.finfo(float).tiny)[:, None], 0.0, 1.0)
        ends[:, -1] = 1.0
        t, weight = gauss_legendre(order // 2 + 2)
        width = np.diff(ends)[..., None]
        points = s[:, None, None] + (1 - s)[:, None, None] * (ends[:, :-1, None] + width * t)
        weights = width * weight * points / (1 + s)[:, None, None] / np.maximum(r, 1.0)[:, None, None] ** 2
        basis = self.mesh.basis(np.minimum(points, 1.0).ravel()).reshape(len(r), -1, self.mesh.n)
        return np.einsum("rgn,rg->nr", basis, weights.reshape(len(r), -1))

    def density(self, s):
        """φ/t (B, ...) of Abel's φ(t) at s = sqrt(1 - t²) (...), without the parts of :meth:`at_edge` and of A."""
        nodal = self.values @ _density(self.mesh).T
        return (nodal @ self.mesh.basis(s.ravel()).T).reshape(len(nodal), *s.shape)

    def density_of_each(self, s):
        """As :meth:`density`, (B, T), at the points s (B, T) of each case."""
        nodal = self.values @ _density(self.mesh).T
        return np.einsum("bn,btn->bt", nodal, self.mesh.basis(s.ravel()).reshape(*s.shape, -1))


@lru_cache(maxsize=64)
def _kept_waves(mesh, k_bytes):
    """The matrix (n, K) that makes p^ at k of one octave from values at the nodes."""
    return _waves(mesh, np.eye(mesh.n), np.frombuffer(k_bytes))


def _waves(mesh, values, k):
    """p^ (B, K) at k of one octave, from the windows alone if that is enough."""
    windows = _windows(mesh, k[0])
    if k[0] < _LONG or np.diff(windows).sum() > 0.5:
        return values @ transform(mesh, k).T
    s, weight = (np.concatenate(parts) for parts in zip(*(_rule(mesh, k, *ends) for ends in windows), strict=True))
    x, inside = np.sqrt((1 - s) * (1 + s)), (values @ mesh.basis(s).T * (weight * s)).T
    parts = np.array_split(k, len(k) // 1000 + 1)
    return np.concatenate([special.j0(part[:, None] * x) @ inside for part in parts]).T


def _windows(mesh, k):
    """Ends (m, 2) in x of the windows from which waves with this k and larger ones come: at the edge, and around narrow
    panels, such as those at a tip or a kink."""
    x = np.sqrt(1 - np.array(mesh.breaks) ** 2)
    narrow = -np.diff(x) < _NARROW / k
    low, high = np.append(1.0, x[1:][narrow])[::-1] - _WINDOW / k, np.append(1.0, x[:-1][narrow])[::-1] + _WINDOW / k
    separate = low[1:] > high[:-1]
    return np.clip(np.stack([low[np.append(True, separate)], high[np.append(separate, True)]], axis=1), 0.0, 1.0)


def edge_rule(mesh, k):
    """Rule of ∫ · ds, points s and weights (m,), over the window at the edge, for waves from k to 2k. None if it is not
    the only window, or is as wide as the contact."""
    windows = _windows(mesh, k)
    if len(windows) > 1 or windows[0, 0] <= 0:
        return None
    return _rule(mesh, np.array([k, 2 * k]), *windows[0])


def _rule(mesh, k, low, high):
    """Rule of ∫ · ds over a window in x with smooth ends, for waves k (K,): points s and weights (m,)."""
    pieces = int(np.ceil((high - low) * k[-1] / 16))
    ends = np.arccos(high - (high - low) * np.arange(pieces + 1) / pieces)
    breaks = np.arcsin(np.array(mesh.breaks))
    ends = np.union1d(ends, breaks[(breaks > ends[0]) & (breaks < ends[-1])])
    t, weight = gauss_legendre(20)
    angle, width = (ends[:-1, None] + np.diff(ends)[:, None] * t).ravel(), np.diff(ends)[:, None]
    x, steep = np.cos(angle), k[0] / _WIDE
    weight = (width * weight).ravel() * x
    weight *= special.ndtr((x - low) * steep - _WINDOW / (2 * _WIDE)) if low > 0 else 1.0
    return np.sin(angle), weight * (special.ndtr((high - x) * steep - _WINDOW / (2 * _WIDE)) if high < 1 else 1.0)


@lru_cache(maxsize=16)
def _density(mesh):
    """The matrix (n, n) that makes (2/pi) ∫ p'(s cos b) db, b from 0 to pi/2, at the nodes from values there."""
    breaks, order, nodes = np.array(mesh.breaks), mesh.order, radau_nodes(mesh.order)
    t, weight = gauss_legendre(order // 2 + _MORE)
    angles = np.arcsin(np.minimum(breaks / mesh.s[:, None], 1.0))  # where the path s' = s sin(angle) leaves a panel
    matrix = np.zeros((mesh.n, mesh.n))
    slope = _slopes(order)
    for i, (low, high) in enumerate(zip(breaks[:-1], breaks[1:], strict=True)):
        rows = np.flatnonzero(mesh.s > low)
        start, width = angles[rows, i, None], np.diff(angles[rows, i : i + 2])
        points = mesh.s[rows, None] * np.sin(start + width * t)
        local = np.clip((points - low) / (high - low), 0.0, 1.0)
        basis = lagrange(nodes, local.ravel()).reshape(*local.shape, order)
        summed = np.einsum("rg,rgj->rj", width * weight, basis)
        matrix[rows, i * order : (i + 1) * order] = summed @ slope * (2 / np.pi / (high - low))
    matrix.flags.writeable = False
    return matrix


@lru_cache(maxsize=64)
def _slopes(order):
    """The matrix (n, n) that makes the derivative of a polynomial at the Radau nodes from its values there."""
    inverse = np.linalg.inv(legvander(2 * radau_nodes(order) - 1, order - 1))
    return 2 * legvander(2 * radau_nodes(order) - 1, order - 1)[:, : order - 1] @ legder(inverse)

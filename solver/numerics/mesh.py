"""The nodes on the contact radius and the half-space operator on them, built once for each mesh and cached.

The variable is s = sqrt(1 - x²), x = r/a: the centre is s = 1, the edge s = 0. In s the pressure is smooth at the
centre, where it is a function of x², and at the edge, where it is a series in sqrt(1 - x). Hertz's pressure is the
polynomial s, the right-hand side of Eq. (4) is s², and x dx = -s ds. The pressure is one polynomial in s, or one on
each of several panels. The nodes are those of Gauss-Radau: the centre is a node, so that p(0) is an unknown.
"""

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from . import special
from .quadrature import against, gauss_legendre, lagrange, pieces, radau_nodes

WHOLE = (0.0, 1.0)


@dataclass(frozen=True)
class Mesh:
    """Discretisation of the contact radius with n nodes.

    The panels and the number of nodes on each determine everything else. Meshes that agree in these are equal: a table
    that is cached for one (solver/body/tables.py) serves the other.

    order : number of nodes of a panel
    breaks : ends of the panels in s, from 0 to 1
    s : (n,), the nodes sqrt(1 - x²), ascending; the last one is the centre, s = 1
    x : (n,), the radii x = r/a of the nodes
    w : (n,), weights of ∫₀¹ q x dx; exact for polynomials in s (on each panel)
    K : (n, n), half-space operator H[q](x_i) - H[q](1), where H[q](x) = ∫₀¹ q(x') K(μ)/(x + x') x' dx' of Eq. (3), K(μ)
        the complete elliptic integral of the first kind. For q = s it is (π²/16) s²
    edge : (n,), H[q](1): the displacement at the edge of the contact, which gives D without interpolation
    """

    order: int
    breaks: tuple
    s: np.ndarray = field(compare=False)
    x: np.ndarray = field(compare=False)
    w: np.ndarray = field(compare=False)
    K: np.ndarray = field(compare=False)
    edge: np.ndarray = field(compare=False)

    @property
    def n(self):
        return len(self.s)

    def basis(self, points):
        """The polynomials that are 1 at one node and 0 at the others: their values (m, n) at `points` (m,) in s."""
        points, order = np.asarray(points, dtype=float), self.order
        home = np.clip(np.searchsorted(self.breaks, points, side="left") - 1, 0, len(self.breaks) - 2)
        values = np.zeros((len(points), self.n))
        for i in np.unique(home):
            here, columns = np.flatnonzero(home == i), slice(i * order, (i + 1) * order)
            values[here, columns] = lagrange(self.s[columns], points[here])
        return values

    def rows(self, points):
        """H[q](x) - H[q](1) at `points` (m,) in s: (m, n)."""
        return half_space_rows(self.s, points, self.breaks) - self.edge


@lru_cache(maxsize=64)
def mesh_of(n):
    """The :class:`Mesh` of one panel with `n` nodes (n >= 2). These have a cache of their own, from which the many
    meshes of several panels do not drive them out."""
    return panel_mesh.__wrapped__(n, WHOLE)


@lru_cache(maxsize=16)
def panel_mesh(order, breaks):
    """The :class:`Mesh` with `order` nodes on each of the panels between `breaks`, a tuple from 0 to 1. It is cached,
    and its arrays are read-only."""
    ends = np.array(breaks)
    lengths = np.diff(ends)
    s = on_panels(radau_nodes(order), breaks)
    s[-1] = 1.0
    edge = half_space_rows(s, np.zeros(1), breaks)[0]
    K = half_space_rows(s, s, breaks) - edge
    points, weights = gauss_legendre(order)
    on_panel = lagrange(radau_nodes(order), points)
    w = ((lengths[:, None] * weights * (ends[:-1, None] + lengths[:, None] * points)) @ on_panel).ravel()
    x = np.sqrt((1 - s) * (1 + s))
    for array in (s, x, w, K, edge):
        array.flags.writeable = False
    return Mesh(order, breaks, s, x, w, K, edge)


def on_panels(points, breaks):
    """Points (m,) of [0, 1] repeated on each of the p panels: (p m,)."""
    return (np.array(breaks[:-1])[:, None] + np.diff(breaks)[:, None] * points).ravel()


def gauss_rule(order, breaks):
    """Gauss rule of ∫₀¹ · ds with `order` points between neighbouring `breaks`: points and weights (m,)."""
    points, weights = gauss_legendre(order)
    return on_panels(points, breaks), (np.diff(breaks)[:, None] * weights).ravel()


def half_space_rows(nodes, s_out, breaks=WHOLE):
    """Rows (m, n) that give the half-space operator H[q](x), Eq. (3), at the points s_out (m,) in s from q at `nodes`
    (n,) in s. Each of the panels between `breaks` has equally many nodes.

    Let x_< and x_> be the smaller and the larger of x, x'. Then K(μ)/(x + x') is K(x_</x_>)/x_> (Landen), and the only
    singularity of the integrand is log|s - s'| (a root at the centre). Panels farther from it than their length have a
    plain Gauss rule. The others have subpanels that shrink towards it from both sides (:func:`.quadrature.pieces`). The
    complementary parameter 1 - (x_</x_>)² is formed from the distance to the singularity, so that no digits are lost
    near it. Polynomial pressures are right to 1e-14 (tests/numerics/test_operator.py).

    Meshes of several panels need so many values of K that importing scipy's function pays.
    """
    panels = len(breaks) - 1
    order = len(nodes) // panels
    rows, local_nodes = np.zeros((len(s_out), panels, order)), nodes if panels == 1 else radau_nodes(order)
    for piece in pieces(s_out, breaks, order):
        values = piece.weight * _kernel(s_out[piece.row, None], piece.gap, piece.sign, panels > 1)
        rows[piece.row, piece.panel] += against(values, piece.basis(local_nodes))
    return rows.reshape(len(s_out), len(nodes))


def _kernel(s, gap, sign, many):
    """s' K(x_</x_>)/x_> at s' = s + sign·gap, where x_< and x_> are the smaller and the larger of x and x'; all
    arguments broadcast. `many` is an argument of :func:`.special.ellipkm1`."""
    point = s + sign * gap
    outer2 = (1 - s) * (1 + s) if sign > 0 else ((1 - s) + gap) * (1 + point)  # the larger x²
    return point * special.ellipkm1(np.minimum(gap * (s + point) / outer2, 1.0), many) / np.sqrt(outer2)

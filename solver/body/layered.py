"""The exact layer of E1* on an elastic half-space: the half-space of E1* plus a Hankel integral over L - 1.

    K q = H[q] + (π/2) Λ[q], both less their values at the edge,
    Λ_ij(η) = ∫₀^∞ (L(kη) - 1) J0(k x_i) φ_j(k) dk,   φ_j(k) = ∫₀¹ l_j J0(kx) x dx,

k in units of 1/a, η = h/a, l_j the Lagrange polynomials of the mesh. H carries the whole singularity. L - 1 decays
like e^(-2u), so Λ is smooth for every η. What depends on k and the mesh alone is tabulated for an octave of η
(:mod:`.tables`). For a batch, the matrix is then one product of the values of L - 1 with that table; the derivatives
by ln a come from u dL/du. The octaves agree to the error of the quadrature where they meet. Films, below the last
octave, all share one quadrature, which ends at k = CUT; what lies beyond is in :mod:`.film`.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.mesh import Mesh
from .film import MANY
from .kernel import whole
from .operator import fitted_nodes
from .part import join, parts_of
from .springs import layer_modulus, thin_layer
from .tables import between, felt, film_rows
from .wave_rule import CUT, FILM, LOOSE, place_of

#: Layers thinner than this times the radius are nearly thin layers.
_THIN = 0.02
#: Work of a lone case, of films and of thicker layers: on a mesh of its own, for a node of films and for an entry of
#: the matrix of others; for a Newton step on any mesh, and for an entry of the matrix in that step. They are processor
#: times of lone cases over that of an entry of a half-space's matrix, to a factor of two: BUDGET needs no more.
_MESH, _STEP, _ENTRY = (1000.0, 2.0), (4000.0, 600.0), (0.3, 0.1)
#: A loose operator is right to this part of rtol. What it leaves out may count up to so many times in a solution: more
#: than once in random cases, and less often than this (tests/body/test_loose.py).
_OF_RTOL, _COUNTS = 0.01, 3.0


class Layered(NamedTuple):
    """The :class:`~solver.body.operator.Body` of B layered cases, arrays (B,): thickness h in R, n = E1*/E2*, the
    Poisson ratios nu1, nu2 of layer and half-space, whether they are bonded, and m = E1*/E3*. `loose`, bool (B,) or
    None where none is: whether the operator is formed of fewer values of L (:meth:`within`).

    The punch yields as a half-space of E3* does, so that the kernel is L + m. In units of both surfaces, E of
    1/E = 1/E1* + 1/E3*, it is (L + m)/(1 + m), and its L - 1 is (L - 1)/(1 + m).
    """

    h: np.ndarray
    n: np.ndarray
    nu1: np.ndarray
    nu2: np.ndarray
    bonded: np.ndarray
    m: np.ndarray
    loose: np.ndarray | None = None

    @property
    def E(self):
        """Modulus (B,) in E2* of a half-space of the layer's material and the punch, to which K is relative."""
        return layer_modulus(self.n) / (1 + self.m)

    @property
    def material(self):
        """n, nu1, nu2, bonded."""
        return self[1:5]

    def whole(self, u):
        """The kernel (L + m)/(1 + m) (B,) at u (B,)."""
        return (whole(u, *self.material) + self.m) / (1 + self.m)

    @property
    def C(self):
        """0 (B,): no springs."""
        return 0 * self.n

    def take(self, index):
        """The sub-batch at `index`."""
        return Layered(*(None if field is None else field[index] for field in self))

    def within(self, rtol, a):
        """The body with an operator that is loose where it is still right to a hundredth of rtol (B,), for contacts of
        about the radius a."""
        every = self._replace(loose=np.ones(len(a), dtype=bool))
        may_be = place_of(every, a)[1] >= len(LOOSE)  # films may not: their class may change with the radius
        return self._replace(loose=may_be & (every.error(a, 1) <= _OF_RTOL * rtol))

    def at(self, a, mesh, near=None):
        """The :class:`LayeredOperator` at the radii a (B,); where those of `near` are the same, so is its kernel."""
        parts, far = [], np.ones(len(a), dtype=bool)
        for part in () if near is None else near.parts:
            same = np.flatnonzero(a[part.index] == part.radius)
            if len(same):
                far[part.index[same]] = False
                parts.append(part.take(same, part.index[same]))
        if near is not None and near.mesh == mesh and not far.any():
            return near
        parts += parts_of(self, a, np.flatnonzero(far))
        return LayeredOperator(mesh, parts, *_matrix_and_edge(parts, mesh))

    def softness(self, a):
        """L (B,) at the wave number 1.5/a: about what the contact feels."""
        return self.whole(1.5 * self.h / a)

    def error(self, a, nodes):
        """Error (B,) of the operator: rounding, what it leaves out if it is loose, and what the convolution of films
        does."""
        L, below = self.whole(10 * self.h / a), (self.n + self.m) / (1 + self.m)
        octave, stiffness = place_of(self, a)
        local = np.abs(L - below) / np.maximum(L, below)
        left_out = np.append(np.zeros(len(LOOSE)), LOOSE)[stiffness] * np.maximum(below, 1.0)
        return (1e-14 * nodes + _COUNTS * left_out) / np.minimum(L, 1.0) + np.where(octave == FILM, local / CUT**2, 0.0)

    def work(self, a, nodes):
        """Work (B,) of an operator on a mesh of its own, and of a step."""
        film = place_of(self, a)[0] == FILM
        mesh, least, entry = (np.where(film, *two) for two in (_MESH, _STEP, _ENTRY))
        return mesh * np.where(film, nodes, nodes**2), least + entry * nodes**2

    def order(self, a):
        """Permutation (B,) that puts cases with one table together: fewer, larger matrix products."""
        return np.lexsort(place_of(self, a))

    def alike(self, a):
        """The thin layer in place of a film, if there is one."""
        thin = thin_layer(*self[:6])
        return thin if np.all((self.h < _THIN * a) & (thin.C > 0)) else None

    def first_nodes(self, rtol, a, rise=None):
        """Number of nodes (B,): under asperities as on a half-space; of a smooth punch, the fewer the thicker."""
        smooth = 0.9 * np.clip(self.h / a, 0.0, 1.0), 2.3
        return fitted_nodes(rtol, *(smooth if rise is None else (rise, 1.1)))


class LayeredOperator(NamedTuple):
    """The :class:`~solver.body.operator.Operator` of layers: its mesh, the kernel (list of
    :class:`.part.Part`), the matrix K (B, n, n), of which the cases are neighbours in memory, and the row of the edge
    (B, n)."""

    mesh: Mesh
    parts: list
    K: np.ndarray
    edge: np.ndarray

    def take(self, index):
        """The sub-batch at `index`, ascending."""
        place = np.full(len(self.edge), -1)
        place[index] = np.arange(len(index))
        rows = [np.flatnonzero(place[part.index] >= 0) for part in self.parts]
        parts = [part.take(r, place[part.index[r]]) for part, r in zip(self.parts, rows, strict=True) if len(r)]
        K = np.take(self.K.transpose(1, 2, 0), index, axis=2).transpose(2, 0, 1)
        return LayeredOperator(self.mesh, parts, K, self.edge[index])

    def join(self, operators, places):
        """The batch of sub-batches, each at its places (b,)."""
        size, n = sum(len(place) for place in places), self.mesh.n
        K, edge, groups = np.empty((n, n, size)).transpose(2, 0, 1), np.empty((size, n)), {}
        for operator, place in zip(operators, places, strict=True):
            K[place], edge[place] = operator.K, operator.edge
            for part in operator.parts:
                groups.setdefault((part.stiffness, part.film is None), []).append(
                    part._replace(index=place[part.index])
                )
        return LayeredOperator(self.mesh, [join(parts) for parts in groups.values()], K, edge)

    def products(self, q):
        """K q (B, n) and edge @ q (B,)."""
        return np.einsum("bij,bj->bi", self.K, q), np.einsum("bj,bj->b", self.edge, q)

    def slopes(self, q):
        """Derivatives of the products by ln a: (B, n) and (B,)."""
        d_Kq, d_edge_q = np.empty(q.shape), np.empty(len(q))
        for part in self.parts:
            for tab, rows in part.tables(self.mesh):
                index = part.index[rows]
                own = q[index]
                moved = tab.weights(part.uL[rows]) * (own @ tab.phi.T)
                d_Kq[index], d_edge_q[index] = moved @ tab.J, moved @ tab.J_edge
                if part.film is not None:
                    K, edge = _film(part.d_film[rows], tab, self.mesh.n)
                    d_Kq[index] += np.matmul(K, own[..., None])[..., 0]
                    d_edge_q[index] += (edge * own).sum(axis=1)
        return d_Kq, d_edge_q

    def between(self, q, s, half_space):
        """K q (B, m) at points s (m,) between the nodes; half_space (B, m) is H[q] - H[q](edge) there."""
        out, x = np.empty(half_space.shape), np.sqrt((1 - s) * (1 + s))
        for part in self.parts:
            for tab, rows in part.tables(self.mesh):
                index = part.index[rows]
                J = between(int(part.octave[rows][0]), part.stiffness, x)
                out[index] = (tab.weights(part.L1[rows]) * (q[index] @ tab.phi.T)) @ J
            if part.film is not None:
                index, near = part.index, felt(self.mesh, x)
                away = film_rows(self.mesh, s[near].tobytes(), len(part.film) >= MANY).of(part.film)
                out[index] -= ((part.film @ tab.film[2]) * q[index]).sum(axis=1)[:, None]
                out[np.ix_(index, near)] += np.matmul(away, q[index][:, :, None])[..., 0]
            out[part.index] += part.share * half_space[part.index]
        return out


def _matrix_and_edge(parts, mesh):
    """K (B, n, n), its cases next to each other in memory, and the row of the edge (B, n)."""
    order, n = np.concatenate([np.arange(0), *(part.index for part in parts)]), mesh.n
    flat, edge, end = np.empty((n * n, len(order))), np.empty((len(order), n)), 0
    for part in parts:
        for tab, rows in part.tables(mesh):
            begin, end = end, end + rows.stop - rows.start
            L1, share = part.L1[rows], part.share if part.level is None else part.share[rows]
            own, row = flat[:, begin:end], L1 @ tab.edge + share * mesh.edge
            if tab.product is None:
                for one, w in zip(own.reshape(n, n, -1).transpose(2, 0, 1), tab.weights(L1), strict=True):
                    one[:] = (tab.J * w[:, None]).T @ tab.phi
            else:
                np.matmul(tab.product.T, L1.T, out=own)
            own += mesh.K.reshape(-1, 1) * np.transpose(share)
            if part.film is not None:
                K, at_edge = _film(part.film[rows], tab, n)
                own.reshape(n, n, -1).transpose(2, 0, 1)[:] += K
                row += at_edge
            edge[part.index[rows]] = row
    if np.any(np.diff(order) < 0):
        flat = np.take(flat, np.argsort(order), axis=1)
    return flat.reshape(n, n, -1).transpose(2, 0, 1), edge


def _film(c, tab, n):
    """What a convolution c (b, T) adds to the matrix (b, n, n) and to the row of the edge (b, n)."""
    nodes, near, edge = tab.film
    K, at_edge = np.zeros((len(c), n, n)), c @ edge
    K -= at_edge[:, None]
    K[:, nodes] += near.of(c)
    return K, at_edge

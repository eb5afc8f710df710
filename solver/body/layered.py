"""The layered operator: the half-space of E1* plus a Hankel integral over L - 1.

    (E1* π/(4a)) u = H[q] + (π/2) Λ[q],
    Λ_ij(η) = ∫₀^∞ (L(kη) - 1) J0(k x_i) φ_j(k) dk,   φ_j(k) = ∫₀¹ l_j J0(kx) x dx,

k in units of 1/a, η = h/a, l_j the Lagrange polynomials of the mesh. H carries the whole singularity; L - 1 decays
like e^(-2u), so Λ is a smooth kernel for every η. What depends on k and the mesh alone is tabulated for an
octave of η (:mod:`.tables`). For a batch, Λ is then one matrix product of the values of L - 1 with that table;
its products with q, and their derivatives by η from u dL/du, do without it. L - 1 of soft layers is evaluated at the
few nodes that determine it (:mod:`.wave_rule`). The octaves agree to the error of the quadrature where they
meet. Films, below the last octave, all share one quadrature, which ends at k = CUT; what lies beyond is in
:mod:`.film`.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from . import film
from .kernel import decaying_part, whole
from .tables import between, felt, table
from .wave_rule import COARSE, CUT, FILM, OCTAVES, few, quadrature

#: Numbers in one block of kernel values.
_BLOCK = 16384


class Layer(NamedTuple):
    """Material of layered cases, arrays (B,): h in R, n, nu1, nu2, bonded (bool), m.

    The punch yields as a half-space of E3* = E1*/m does, so that the kernel is L + m. In units of both surfaces, Ec of
    1/Ec = 1/E1* + 1/E3*, it is (L + m)/(1 + m), and its L - 1 is (L - 1)/(1 + m).
    """

    h: np.ndarray
    n: np.ndarray
    nu1: np.ndarray
    nu2: np.ndarray
    bonded: np.ndarray
    m: np.ndarray

    @property
    def material(self):
        """n, nu1, nu2, bonded."""
        return self[1:5]

    def whole(self, u):
        """The kernel (L + m)/(1 + m) (B,) at u (B,)."""
        return (whole(u, *self.material) + self.m) / (1 + self.m)

    def take(self, index):
        """The sub-batch at `index`."""
        return Layer(*(field[index] for field in self))


class Weights(NamedTuple):
    """Part of a batch in one octave: its cases `index` (b,), the key of its table, w (L - 1), -w u dL/du (b, G).

    They are those at `radius` (b,); the contact is `step` (b,) of ln a farther, where they hold to first order. Films
    have w χ (L - n') there; c of the convolution and its derivative (b, T), and n' - 1 (b, 1).
    """

    index: np.ndarray
    octave: int
    depth: int
    coarse: bool
    radius: np.ndarray
    step: np.ndarray
    W: np.ndarray
    dW: np.ndarray
    film: np.ndarray | None
    d_film: np.ndarray | None
    level: np.ndarray | None

    @property
    def table(self):
        """The key of its table, without the mesh."""
        return self.octave, self.depth, self.coarse

    def take(self, rows, index):
        """The sub-batch at `rows`, ascending, as the cases `index`."""
        if len(rows) == len(self.index):
            return self._replace(index=index)
        arrays = (None if v is None else v[rows] for v in self[4:])
        return Weights(index, *self.table, *arrays)

    def moved(self, nodes=slice(None)):
        """W at some nodes, and film, `step` farther."""
        if not self.step.any():
            return self.W[:, nodes], self.film
        step = self.step[:, None]
        film = None if self.film is None else self.film + step * self.d_film
        return self.W[:, nodes] + step * self.dW[:, nodes], film


class LayerProducts(NamedTuple):
    """Λ[q] less its value at the edge (B, n), that value (B,), and the derivatives of both by ln a."""

    rows_q: np.ndarray
    edge_q: np.ndarray
    d_rows_q: np.ndarray
    d_edge_q: np.ndarray


def octave_of(layer, a):
    """Octave of h/a, or FILM, and depth of the quadrature for the stiffness of the layer, (B,) int each."""
    eta = layer.h / a
    octave = np.clip(np.floor(np.nan_to_num(np.log2(eta))), FILM, OCTAVES[1]).astype(int)
    # a stiff layer is a plate, whose kernel falls at u ~ n^(-1/3), and, bonded, a membrane at u ~ 1/n
    ratio = np.maximum(np.where(layer.bonded, layer.n, np.cbrt(layer.n)), 1.0)
    ratio = np.where(octave == FILM, ratio * eta * 2.0**-FILM, ratio)
    wanted = np.ceil(np.log2(np.maximum(3.5 * ratio, 1.0)))  # 0.5 2^-depth <= 0.15/ratio
    return octave, np.where(layer.n > 2, 6 * np.ceil(wanted / 6), 0).astype(int)


def operator_error(layer, a, nodes, coarse=False):
    """Relative error (B,) of the operator itself: rounding, for films what the convolution leaves out, and that of the
    coarse quadrature, if it is."""
    L = layer.whole(10 * layer.h / a)
    octave, _ = octave_of(layer, a)
    below = (layer.n + layer.m) / (1 + layer.m)
    local = np.abs(L - below) / np.maximum(L, below)
    error = (1e-14 * nodes + np.where(coarse, COARSE * np.maximum(layer.n, 1.0), 0.0)) / np.minimum(L, 1.0)
    return error + np.where(octave == FILM, local / CUT**2, 0.0)


def layer_weights(layer, a, known=(), reach=0.0, coarse=False):
    """Weights of a batch at contact radii a (B,): a list of :class:`Weights`, one for each octave present.

    `known` are weights of cases of the batch: where ln a has changed by no more than `reach` (B,) they serve to
    first order; the others are formed anew. coarse (B,) bool: on half the nodes in k.
    """
    parts, far, reach = [], np.ones(len(a), dtype=bool), reach * np.ones(len(a))
    for part in known:
        step = np.log(a[part.index] / part.radius)
        near = np.flatnonzero(np.abs(step) <= reach[part.index])
        if len(near):
            far[part.index[near]] = False
            parts.append(part.take(near, part.index[near])._replace(step=step[near]))
    new = np.flatnonzero(far)
    octave, depth = octave_of(layer.take(new), a[new])
    coarse = (coarse & np.ones(len(a), dtype=bool))[new] & (octave != FILM)
    for o, d, c in sorted(set(zip(octave.tolist(), depth.tolist(), coarse.tolist(), strict=True))):
        parts.append(_weights(layer, a, o, d, c, new[(octave == o) & (depth == d) & (coarse == c)]))
    return parts


def take_weights(parts, index):
    """Weights of the sub-batch at `index`."""
    if not parts or not len(index):
        return []
    place = np.full(1 + max(index.max(), *(part.index.max() for part in parts)), -1)
    place[index] = np.arange(len(index))
    rows = [np.flatnonzero(place[part.index] >= 0) for part in parts]
    return [part.take(r, place[part.index[r]]) for part, r in zip(parts, rows, strict=True) if len(r)]


def place_weights(parts, index):
    """Weights of a sub-batch as those of the cases `index` of the whole."""
    return [part._replace(index=index[part.index]) for part in parts]


def _weights(layer, a, octave, depth, coarse, index):
    k, weight = quadrature(octave, depth, coarse)
    radius, part = a[index], layer.take(index)
    eta, key = part.h / radius, (index, octave, depth, coarse, radius, np.zeros(len(index)))
    own = few(octave, depth, coarse)
    if own is not None:
        values = _sampled(part, eta, k[own.nodes], np.ones(len(own.nodes)), 0.0)
        return Weights(*key, *(v @ own.spread for v in values), None, None, None)
    if octave != FILM:
        return Weights(*key, *_sampled(part, eta, k, weight, 0.0), None, None, None)
    level = part.whole(CUT * eta / 2)[:, None] - 1
    kappa, _, _ = film.waves()
    below = _sampled(part, eta, k, weight * film.step(k / CUT), level)
    beyond, d_beyond = _sampled(part, eta, CUT * kappa, 1 - film.step(kappa), level)
    p = CUT * eta[:, None]
    return Weights(*key, *below, film.transform(beyond, level, p), film.transform(d_beyond, 0 * level, p), level)


def _sampled(layer, eta, k, weight, level):
    """w (L - 1 - level) and -w u dL/du (b, G) at the nodes k."""
    W, dW = np.empty((len(eta), len(k))), np.empty((len(eta), len(k)))
    rows = max(1, _BLOCK // len(k))
    for low in range(0, len(eta), rows):  # a block at a time: the temporaries of the kernel stay in the cache
        part = slice(low, low + rows)
        L1, uL = decaying_part(k * eta[part, None], *(field[part, None] for field in layer.material))
        if layer.m[part].any():  # most punches are rigid, and this is the inner loop
            L1, uL = L1 / (1 + layer.m[part, None]), uL / (1 + layer.m[part, None])
        np.multiply(weight, L1 - (level[part] if np.ndim(level) else level), out=W[part])
        np.multiply(-weight, uL, out=dW[part])
    return W, dW


def layer_products(weights, q, grid):
    """:class:`LayerProducts` of a batch from its weights, for q (B, n) on a mesh."""
    out = LayerProducts(np.empty(q.shape), np.empty(len(q)), np.empty(q.shape), np.empty(len(q)))
    for part in weights:
        index, tab = part.index, table(grid, *part.table)
        qk = q[index] @ tab.phi.T
        here, moved = part.W * qk, np.multiply(part.dW, qk, out=qk)
        out.rows_q[index], out.edge_q[index] = here @ tab.J, here @ tab.J_edge
        out.d_rows_q[index], out.d_edge_q[index] = moved @ tab.J, moved @ tab.J_edge
        if part.film is not None:
            _add_film(out, part, tab, q[index])
        out.rows_q[index] += part.step[:, None] * out.d_rows_q[index]
        out.edge_q[index] += part.step * out.d_edge_q[index]
    return out


def _add_film(out, part, tab, q):
    """Add the convolution to the products of films, in place."""
    index, (nodes, near, edge) = part.index, tab.film
    here = np.ix_(index, nodes)
    for rows_q, edge_q, c in ((out.rows_q, out.edge_q, part.film), (out.d_rows_q, out.d_edge_q, part.d_film)):
        at_edge = ((c @ edge) * q).sum(axis=1)
        edge_q[index] += at_edge
        rows_q[index] -= at_edge[:, None]
        rows_q[here] += np.matmul(near.of(c), q[:, :, None])[..., 0]


def layer_edge(weights, grid):
    """Λ at the edge of a batch on a mesh, (B, n)."""
    row = np.empty((sum(len(part.index) for part in weights), grid.n))
    for part in weights:
        tab = table(grid, *part.table)
        W, film = part.moved(tab.nodes)
        row[part.index] = W @ tab.edge
        if film is not None:
            row[part.index] += film @ tab.film[2]
    return row


def layer_matrix(weights, grid):
    """Λ - Λ(edge) of a batch on a mesh, (B, n, n); the cases lie next to each other in memory."""
    order = np.concatenate([part.index for part in weights])
    flat, end = np.empty((grid.n**2, len(order))), 0
    for part in weights:
        tab = table(grid, *part.table)
        W, film = part.moved(tab.nodes)
        own = flat[:, end : end + len(W)]
        rows, end = own.reshape(grid.n, grid.n, -1).transpose(2, 0, 1), end + len(W)
        if tab.product is not None:
            np.matmul(tab.product.T, W.T, out=own)
        else:
            for row, w in zip(rows, W, strict=True):
                row[:] = (tab.J * w[:, None]).T @ tab.phi
        if film is not None:
            nodes, near, edge = tab.film
            rows -= (film @ edge)[:, None]
            rows[:, nodes] += near.of(film)
    if np.any(np.diff(order) < 0):
        flat = np.take(flat, np.argsort(order), axis=1)
    return flat.reshape(grid.n, grid.n, -1).transpose(2, 0, 1)


def half_space_share(weights):
    """The share (B,) of the half-space that stands beside Λ: 1 but for films."""
    share = np.ones(sum(len(part.index) for part in weights))
    for part in weights:
        if part.level is not None:
            share[part.index] += part.level[:, 0]
    return share


def layer_displacement(weights, q, grid, x, half_space):
    """K[q] = H[q] + (π/2) Λ[q], less its value at the edge, (B, m) at radii x (m,) for q (B, n) on a mesh.

    half_space (B, m) is H[q](x) - H[q](1).
    """
    out = np.empty((len(q), len(x)))
    for part in weights:
        index, tab, (W, film) = part.index, table(grid, *part.table), part.moved()
        out[index] = (W * (q[index] @ tab.phi.T)) @ between(grid, *part.table, x)
        if film is not None:
            near = felt(grid, x)
            rows = _film_rows(grid, np.sqrt((1 - x[near]) * (1 + x[near])).tobytes())
            out[index] -= ((film @ tab.film[2]) * q[index]).sum(axis=1)[:, None]
            out[np.ix_(index, near)] += np.matmul(rows.of(film), q[index][:, :, None])[..., 0]
    return half_space_share(weights)[:, None] * half_space + (np.pi / 2) * out


@lru_cache(maxsize=8)
def _film_rows(grid, s_bytes):
    return film.convolution(grid, np.frombuffer(s_bytes), CUT)

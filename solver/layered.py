"""The layered operator: the half-space of E1* plus a Hankel integral over L - 1.

    (E1* π/(4a)) u = H[q] + (π/2) Λ[q],   Λ_ij(η) = ∫₀^∞ (L(kη) - 1) J0(k x_i) φ_j(k) dk,   φ_j(k) = ∫₀¹ l_j J0(kx) x
    dx,

k in units of 1/a, η = h/a, l_j the Lagrange polynomials of the mesh. H carries the whole singularity; L - 1 decays
like e^(-2u), so Λ is a smooth kernel for every η. The quadrature in k is fixed for an octave of η: its panels
follow the oscillation of J0 J0 (whose frequency is 2) and the scale of L (1/η, and for stiff layers n^(-1/3)/η and
1/(nη)), so that it is accurate to rounding for every h/a and n of the octave, and J0 φ is tabulated once. For a
batch, Λ is then one matrix product of (L - 1)-values with that table, its derivative by η another one with u dL/du; no
interpolation is made, and the octaves agree to rounding where they meet. Films, below the last octave, all share
one quadrature, which ends at k = CUT; what lies beyond is in :mod:`.film`.
"""

from collections import OrderedDict
from functools import lru_cache
from threading import Lock
from typing import NamedTuple

import numpy as np
from scipy.special import j0

from . import film
from .kernel import decaying_part, whole
from .quadrature import gauss_legendre, lagrange

#: Octaves of h/a with tables of their own; below is the octave FILM, above nothing of the half-space is left.
OCTAVES = (-8, 40)
FILM = OCTAVES[0] - 1
#: Tables of J0 φ larger than this many numbers are not kept; the product is then formed case by case.
_KEEP = 4e6
#: Of those between the nodes, of which many are kept.
_KEEP_BETWEEN = 4e4
#: Bytes of tables kept.
_MOST_BYTES = 4e8
#: Widest panel in k: wider ones would need Gauss rules that are slow to make.
_WIDEST = 200.0
#: Numbers in one block of kernel values.
_BLOCK = 8192


class Layer(NamedTuple):
    """Material of layered cases, arrays (B,): h in R, n, nu1, nu2, bonded (bool)."""

    h: np.ndarray
    n: np.ndarray
    nu1: np.ndarray
    nu2: np.ndarray
    bonded: np.ndarray

    def take(self, index):
        """The sub-batch at `index`."""
        return Layer(*(field[index] for field in self))


class Table(NamedTuple):
    """Hankel transforms of one octave on one mesh: k (G,); J0(k x_i) - J0(k) and φ (G, n); J0(k) (G,); J0 φ (G, n²).

    `film`: the m nodes where the convolution is felt, what makes it there (T, m, n), and at the edge (T, n).
    """

    k: np.ndarray
    J: np.ndarray
    phi: np.ndarray
    J_edge: np.ndarray
    product: np.ndarray | None
    film: tuple | None


class Weights(NamedTuple):
    """Part of a batch in one octave: its cases `index` (b,), the key of its table, w (L - 1), -w u dL/du (b, G).

    They are those at `radius` (b,), moved to first order over `moved` (b,) of ln a. Films have w χ (L - n') there; c of
    the convolution and its derivative (b, T), and n' - 1 (b, 1).
    """

    index: np.ndarray
    octave: int
    depth: int
    coarse: bool
    radius: np.ndarray
    moved: np.ndarray
    W: np.ndarray
    dW: np.ndarray
    film: np.ndarray | None
    d_film: np.ndarray | None
    level: np.ndarray | None

    def take(self, rows, index):
        """The sub-batch at `rows`, ascending, as the cases `index`."""
        if len(rows) == len(self.index):
            return self._replace(index=index)
        arrays = (None if v is None else v[rows] for v in self[4:])
        return Weights(index, *self[1:4], *arrays)

    def at(self, radius):
        """The weights moved on to `radius` (b,)."""
        step = np.log(radius / self.radius)
        if not step.any():
            return self
        film = None if self.film is None else self.film + step[:, None] * self.d_film
        W = self.W + step[:, None] * self.dW
        return self._replace(radius=radius, moved=self.moved + step, W=W, film=film)


class LayerProducts(NamedTuple):
    """Λ[q] less its value at the edge (B, n), Λ(edge) (B, n), and the derivatives by ln a of both products with q."""

    rows_q: np.ndarray
    edge: np.ndarray
    d_rows_q: np.ndarray
    d_edge_q: np.ndarray


class Rule(NamedTuple):
    """Of the quadrature in k: nodes of a panel beside those its oscillation takes, factor of the root of its width,
    fewest nodes of panels below and above u = 1/2, where u ends, at most and at octave 0; nodes less a digit of e^-2u.
    """

    more: int
    root: float
    least: tuple
    end: tuple
    less: float


#: To rounding (1e-11 below h/a = 1/64, where it ends), and to COARSE of the larger of L(0) and L(inf) with half the
#: nodes (tests/test_layered_quadrature.py).
_RULES = {False: Rule(9, 3.0, (11, 15), (17.0, 15.0), 0.8), True: Rule(4, 2.5, (8, 10), (15.0, 14.5), 1.0)}
COARSE = 1e-9


def _end(octave, coarse=False):
    """Where the integral over u may end: L - 1 ~ u² e^(-2u), J0 φ ~ 1/k² for k > 1, their product below the error."""
    most, middle = _RULES[coarse].end
    return min(most, middle + 0.7 * octave)


#: Largest k of the quadrature of films.
CUT = _end(FILM) * 2.0**-FILM


@lru_cache(maxsize=128)
def quadrature(octave, depth, coarse=False):
    """Nodes k and weights (G,) for h/a in [2^octave, 2^(octave+1)], `depth` more dyadic panels towards k = 0."""
    rule, scale, cut = _RULES[coarse], 2.0**-octave, _end(octave, coarse)
    ends = [0.0, *(0.5 * 2.0 ** -np.arange(depth, -1, -1)), 1.0, 2.0, 4.0, *([8.0] if cut > 9 else []), cut]
    k, weight = [], []
    for low, high in zip(ends[:-1], ends[1:], strict=True):
        pieces = int(np.ceil((high - low) * scale / _WIDEST))
        width = (high - low) * scale / pieces
        order = max(rule.least[int(high >= 0.5)], int(width / 2 + rule.root * np.cbrt(width)) + rule.more)
        decayed = 2 * (low - np.log1p(low)) / np.log(10)
        t, w = gauss_legendre(max(7, order - int(rule.less * decayed)))
        for piece in range(pieces):
            k.append(low * scale + (piece + t) * width)
            weight.append(width * w)
    return np.concatenate(k), np.concatenate(weight)


_tables = OrderedDict()
_tables_lock = Lock()


def table(grid, octave, depth, coarse=False):
    """The :class:`Table` of a mesh; the latest used, up to _MOST_BYTES, are kept."""
    key = grid, octave, depth, coarse
    with _tables_lock:
        if key in _tables:
            _tables.move_to_end(key)
            return _tables[key]
    found = _table(*key)
    with _tables_lock:
        _tables[key] = found
        while len(_tables) > 1 and sum(_size(kept) for kept in _tables.values()) > _MOST_BYTES:
            _tables.popitem(last=False)
    return found


def _size(found):
    """Bytes of a table."""
    return sum(part.nbytes for part in (*found[:5], *(found.film or ())) if part is not None)


def _table(grid, octave, depth, coarse):
    k, _ = quadrature(octave, depth, coarse)
    n = grid.n
    J_edge = j0(k)
    J = j0(k[:, None] * grid.x) - J_edge[:, None]
    phi = _transform(grid, k)
    keep = J.shape[0] * n * n <= _KEEP
    product = (J[:, :, None] * phi[:, None, :]).reshape(len(k), n * n) if keep else None
    return Table(k, J, phi, J_edge, product, _film_table(grid) if octave == FILM else None)


def _film_table(grid):
    near = _felt(grid, grid.x)
    rows = film.convolution(grid, np.append(grid.s[near], 0.0), CUT)
    return near, rows[:, :-1], rows[:, -1]


def _felt(grid, x):
    """Indices of the radii x where the convolution is felt: near the edge, and where panels resolve more than CUT."""
    ends = np.sqrt(1 - np.array(grid.breaks) ** 2)
    home = np.clip(np.searchsorted(-ends, -x) - 1, 0, len(ends) - 2)
    fine = (ends[home] - ends[home + 1]) * CUT < 16 * grid.order
    return np.flatnonzero(((1 - x) * CUT < film.REACH) | (fine & (x * CUT > film.REACH)))


def _transform(grid, k):
    """φ_j(k) = ∫₀¹ l_j(s) J0(k sqrt(1 - s²)) s ds, (G, n)."""
    phi = np.empty((len(k), grid.n))
    ends = np.arcsin(grid.breaks)
    for part in np.array_split(np.arange(len(k)), -(-len(k) // 500)):
        # x = cos φ, s = sin φ: the phase k cos φ advances by at most 20 a piece
        for i, (low, high) in enumerate(zip(ends[:-1], ends[1:], strict=True)):
            pieces = int(k[part].max() * (high - low) / 20) + 1
            t, w = gauss_legendre(24 + grid.order // (2 * pieces))
            angle = low + (high - low) * ((np.arange(pieces)[:, None] + t) / pieces).ravel()
            sin, cos = np.sin(angle), np.cos(angle)
            weight = (high - low) * np.tile(w / pieces, pieces) * sin * cos
            own = slice(i * grid.order, (i + 1) * grid.order)
            phi[part, own] = j0(k[part, None] * cos) @ (weight[:, None] * lagrange(grid.s[own], sin))
    return phi


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
    L = whole(10 * layer.h / a, *layer[1:])
    octave, _ = octave_of(layer, a)
    local = np.abs(L - layer.n) / np.maximum(L, layer.n)
    error = (1e-14 * nodes + np.where(coarse, COARSE * np.maximum(layer.n, 1.0), 0.0)) / np.minimum(L, 1.0)
    return error + np.where(octave == FILM, local / CUT**2, 0.0)


def layer_weights(layer, a, known=(), reach=0.0, coarse=False):
    """Weights of a batch at contact radii a (B,): a list of :class:`Weights`, one for each octave present.

    `known` are weights of cases of the batch: where ln a has changed by no more than `reach` (B,) they are moved on,
    to first order; the others are formed anew. coarse (B,) bool: on half the nodes in k.
    """
    parts, far, reach = [], np.ones(len(a), dtype=bool), reach * np.ones(len(a))
    for part in known:
        near = np.flatnonzero(np.abs(part.moved + np.log(a[part.index] / part.radius)) <= reach[part.index])
        if len(near):
            part = part.take(near, part.index[near])
            far[part.index] = False
            parts.append(part.at(a[part.index]))
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
    if octave != FILM:
        return Weights(*key, *_sampled(part, eta, k, weight, 0.0), None, None, None)
    level = whole(CUT * eta / 2, *part[1:])[:, None] - 1
    kappa, _, _ = film.waves()
    below = _sampled(part, eta, k, weight * film.step(k / CUT), level)
    beyond, d_beyond = _sampled(part, eta, CUT * kappa, 1 - film.step(kappa), level)
    p = CUT * eta[:, None]
    return Weights(*key, *below, film.transform(beyond, level, p), film.transform(d_beyond, 0 * level, p), level)


def _sampled(layer, eta, k, weight, level):
    """w (L - 1 - level) and -w u dL/du (b, G) at the nodes k."""
    W, dW = np.empty((len(eta), len(k))), np.empty((len(eta), len(k)))
    rows, material = max(1, _BLOCK // len(k)), layer[1:]
    for low in range(0, len(eta), rows):  # a block at a time: the temporaries of the kernel stay in the cache
        part = slice(low, low + rows)
        L1, uL = decaying_part(k * eta[part, None], *(field[part, None] for field in material))
        np.multiply(weight, L1 - (level[part] if np.ndim(level) else level), out=W[part])
        np.multiply(-weight, uL, out=dW[part])
    return W, dW


def layer_products(weights, q, grid):
    """:class:`LayerProducts` of a batch from its weights, for q (B, n) on a mesh."""
    out = LayerProducts(*(np.empty(q.shape) for _ in range(3)), np.empty(len(q)))
    for part in weights:
        index, tab = part.index, table(grid, *part[1:4])
        qk = q[index] @ tab.phi.T
        moved = part.dW * qk
        out.rows_q[index] = (part.W * qk) @ tab.J
        out.edge[index] = (part.W * tab.J_edge) @ tab.phi
        out.d_rows_q[index], out.d_edge_q[index] = moved @ tab.J, moved @ tab.J_edge
        if part.film is not None:
            _add_film(out, part, tab, q[index])
    return out


def _add_film(out, part, tab, q):
    """Add the convolution to the products of films, in place."""
    index, (nodes, near, edge) = part.index, tab.film
    here = np.ix_(index, nodes)
    at_edge, d_at_edge = part.film @ edge, ((part.d_film @ edge) * q).sum(axis=1)
    out.edge[index] += at_edge
    out.rows_q[index] -= (at_edge * q).sum(axis=1)[:, None]
    out.d_rows_q[index] -= d_at_edge[:, None]
    out.d_edge_q[index] += d_at_edge
    for rows_q, c in ((out.rows_q, part.film), (out.d_rows_q, part.d_film)):
        rows_q[here] += np.matmul(_at_nodes(c, near), q[:, :, None])[..., 0]


def _at_nodes(c, near):
    """The convolution with c (b, T) at the nodes where it is felt: (b, m, n)."""
    steps, m, n = near.shape
    return (c @ near.reshape(steps, m * n)).reshape(len(c), m, n)


def layer_matrix(weights, grid):
    """Λ - Λ(edge) of a batch on a mesh, (B, n, n)."""
    size = sum(len(part.index) for part in weights)
    rows = np.empty((size, grid.n, grid.n))
    for part in weights:
        index, tab = part.index, table(grid, *part[1:4])
        if tab.product is not None:
            rows[index] = (part.W @ tab.product).reshape(-1, grid.n, grid.n)
        else:
            for i, w in zip(index, part.W, strict=True):
                rows[i] = (tab.J * w[:, None]).T @ tab.phi
        if part.film is not None:
            nodes, near, edge = tab.film
            rows[index] -= (part.film @ edge)[:, None]
            rows[np.ix_(index, nodes)] += _at_nodes(part.film, near)
    return rows


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
        index, tab = part.index, table(grid, *part[1:4])
        out[index] = (part.W * (q[index] @ tab.phi.T)) @ _between(grid, *part[1:4], x)
        if part.film is not None:
            near = _felt(grid, x)
            rows = _film_rows(grid, np.sqrt((1 - x[near]) * (1 + x[near])).tobytes())
            out[index] -= ((part.film @ tab.film[2]) * q[index]).sum(axis=1)[:, None]
            out[np.ix_(index, near)] += np.matmul(_at_nodes(part.film, rows), q[index][:, :, None])[..., 0]
    return half_space_share(weights)[:, None] * half_space + (np.pi / 2) * out


def _between(grid, octave, depth, coarse, x):
    """J0(k x) - J0(k), (G, m)."""
    key = grid, octave, depth, coarse, x.tobytes()
    small = len(x) * len(quadrature(octave, depth, coarse)[0]) <= _KEEP_BETWEEN
    return (_between_kept if small else _between_kept.__wrapped__)(*key)


@lru_cache(maxsize=256)
def _between_kept(grid, octave, depth, coarse, x_bytes):
    tab = table(grid, octave, depth, coarse)
    return j0(tab.k[:, None] * np.frombuffer(x_bytes)) - tab.J_edge[:, None]


@lru_cache(maxsize=8)
def _film_rows(grid, s_bytes):
    return film.convolution(grid, np.frombuffer(s_bytes), CUT)

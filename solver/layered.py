"""The layered operator: the half-space of E1* plus a Hankel integral over L - 1.

    (E1* π/(4a)) u = H[q] + (π/2) Λ[q],   Λ_ij(η) = ∫₀^∞ (L(kη) - 1) J0(k x_i) φ_j(k) dk,   φ_j(k) = ∫₀¹ l_j J0(kx) x
    dx,

k in units of 1/a, η = h/a, l_j the Lagrange polynomials of the mesh. H carries the whole singularity; L - 1 decays
like e^(-2kη), so Λ is a smooth kernel for every η. The quadrature in k is fixed for an octave of η: its panels
follow the oscillation of J0 J0 (whose frequency is 2) and the scale of L (1/η, and for stiff layers n^(-1/3)/η and
1/(nη)), so that it is accurate to rounding for every h/a and n of the octave, and J0 φ is tabulated once. For a
batch, Λ is then one matrix product of (L - 1)-values with that table, its derivative by η another one with u dL/du; no
interpolation is made, and the octaves agree to rounding where they meet.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.special import j0

from .kernel import decaying_part
from .quadrature import gauss_legendre

#: Octaves of h/a with tables, 2^-11 = 4.9e-4 to 2^40; their cost grows like a/h.
OCTAVES = (-11, 40)
#: Tables of J0 φ larger than this many numbers are not kept; the product is then formed case by case.
_KEEP = 4e6
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
    """Hankel transforms of one octave on one mesh: k (G,); J0(k x_i) - J0(k) and φ (G, n); J0(k) (G,); J0 φ (G, n²)."""

    k: np.ndarray
    J: np.ndarray
    phi: np.ndarray
    J_edge: np.ndarray
    product: np.ndarray | None


class Weights(NamedTuple):
    """Part of a batch in one octave: its cases `index` (b,), the key of its table, w (L - 1), -w u dL/du (b, G)."""

    index: np.ndarray
    octave: int
    depth: int
    W: np.ndarray
    dW: np.ndarray


class LayerRows(NamedTuple):
    """Λ - Λ(edge) (B, n, n), Λ(edge) (B, n), and the derivatives by ln a of their products with q: (B, n), (B,)."""

    rows: np.ndarray
    edge: np.ndarray
    d_rows_q: np.ndarray
    d_edge_q: np.ndarray


@lru_cache(maxsize=64)
def quadrature(octave, depth):
    """Nodes k and weights (G,) for h/a in [2^octave, 2^(octave+1)], `depth` more dyadic panels towards k = 0."""
    scale = 2.0**-octave
    # L - 1 ~ u² e^(-2u), and J0 φ ~ 1/k² for k > 1: their product is below rounding beyond
    cut = min(17.0, 15.0 + 0.7 * octave)
    ends = [0.0, *(0.5 * 2.0 ** -np.arange(depth, -1, -1)), 1.0, 2.0, 4.0, *([8.0] if cut > 9 else []), cut]
    k, weight = [], []
    for low, high in zip(ends[:-1], ends[1:], strict=True):
        pieces = int(np.ceil((high - low) * scale / _WIDEST))
        width = (high - low) * scale / pieces
        least = 12 if high < 0.5 else 18
        t, w = gauss_legendre(max(least, int(width / 2 + 3 * np.cbrt(width)) + 11))
        for piece in range(pieces):
            k.append(low * scale + (piece + t) * width)
            weight.append(width * w)
    return np.concatenate(k), np.concatenate(weight)


@lru_cache(maxsize=256)
def table(grid, octave, depth):
    """The :class:`Table` of a mesh; cached."""
    k, _ = quadrature(octave, depth)
    n = grid.n
    J_edge = j0(k)
    J = j0(k[:, None] * grid.x) - J_edge[:, None]
    phi = _transform(grid, k)
    keep = J.shape[0] * n * n <= _KEEP
    product = (J[:, :, None] * phi[:, None, :]).reshape(len(k), n * n) if keep else None
    return Table(k, J, phi, J_edge, product)


def _transform(grid, k):
    """φ_j(k) = ∫₀¹ l_j(s) J0(k sqrt(1 - s²)) s ds, (G, n)."""
    phi = np.empty((len(k), grid.n))
    ends = np.arcsin(grid.breaks)
    for part in np.array_split(np.arange(len(k)), -(-len(k) // 500)):
        # x = cos φ, s = sin φ: the phase k cos φ advances by at most 20 a piece
        pieces = [int(k[part].max() * (high - low) / 20) + 1 for low, high in zip(ends[:-1], ends[1:], strict=True)]
        starts = np.concatenate([np.linspace(*ends[i : i + 2], m + 1)[:-1] for i, m in enumerate(pieces)])
        width = np.repeat(np.diff(ends) / pieces, pieces)
        t, w = gauss_legendre(24 + grid.order // (2 * min(pieces)))
        angle = (starts[:, None] + width[:, None] * t).ravel()
        sin, cos = np.sin(angle), np.cos(angle)
        weight = (width[:, None] * w).ravel() * sin * cos
        phi[part] = j0(k[part, None] * cos) @ (weight[:, None] * grid.basis(sin))
    return phi


def octave_of(layer, a):
    """Octave of h/a and depth of the quadrature for the stiffness of the layer, (B,) int each."""
    octave = np.clip(np.floor(np.nan_to_num(np.log2(layer.h / a))), *OCTAVES).astype(int)
    # a stiff layer is a plate, whose kernel falls at u ~ n^(-1/3), and, bonded, a membrane at u ~ 1/n
    ratio = np.maximum(np.where(layer.bonded, layer.n, np.cbrt(layer.n)), 1.0)
    wanted = np.ceil(np.log2(3.5 * ratio))  # 0.5 2^-depth <= 0.15/ratio
    return octave, np.where(layer.n > 2, 6 * np.ceil(wanted / 6), 0).astype(int)


def layer_weights(layer, a):
    """Weights of a batch at contact radii a (B,): a list of :class:`Weights`, one for each octave present."""
    octave, depth = octave_of(layer, a)
    return [
        _weights(layer, a, o, d, np.flatnonzero((octave == o) & (depth == d)))
        for o, d in sorted(set(zip(octave.tolist(), depth.tolist(), strict=True)))
    ]


def _weights(layer, a, octave, depth, index):
    k, weight = quadrature(octave, depth)
    W, dW = np.empty((len(index), len(k))), np.empty((len(index), len(k)))
    eta, material = layer.h[index] / a[index], [field[index] for field in layer[1:]]
    rows = max(1, _BLOCK // len(k))
    for low in range(0, len(index), rows):  # a block at a time: the temporaries of the kernel stay in the cache
        part = slice(low, low + rows)
        L1, uL = decaying_part(k * eta[part, None], *(field[part, None] for field in material))
        np.multiply(weight, L1, out=W[part])
        np.multiply(-weight, uL, out=dW[part])
    return Weights(index, octave, depth, W, dW)


def layer_rows(weights, q, grid):
    """:class:`LayerRows` of a batch from its weights, for q (B, n) on a mesh."""
    size, n = q.shape
    out = LayerRows(np.empty((size, n, n)), np.empty((size, n)), np.empty((size, n)), np.empty(size))
    for index, octave, depth, W, dW in weights:
        tab = table(grid, octave, depth)
        if tab.product is not None:
            out.rows[index] = (W @ tab.product).reshape(-1, n, n)
        else:
            for i, w in zip(index, W, strict=True):
                out.rows[i] = (tab.J * w[:, None]).T @ tab.phi
        out.edge[index] = (W * tab.J_edge) @ tab.phi
        moved = dW * (q[index] @ tab.phi.T)
        out.d_rows_q[index], out.d_edge_q[index] = moved @ tab.J, moved @ tab.J_edge
    return out


def layer_displacement(weights, q, grid, x):
    """Λ[q](x) - Λ[q](1) (B, m) at radii x (m,) for q (B, n) on a mesh."""
    out = np.empty((len(q), len(x)))
    for index, octave, depth, W, _ in weights:
        tab = table(grid, octave, depth)
        out[index] = (W * (q[index] @ tab.phi.T)) @ (j0(tab.k[:, None] * x) - tab.J_edge[:, None])
    return out

"""Tables of the layered operator: the quadrature in k for each octave of h/a, and Hankel transforms at its nodes.

Its panels follow the oscillation of J0 J0 (whose frequency is 2) and the scale of L (1/η, and for stiff layers
n^(-1/3)/η and 1/(nη), η = h/a), so that it is as accurate for every h/a and n of the octave; J0 φ is tabulated once.
"""

from collections import OrderedDict
from functools import lru_cache
from itertools import pairwise
from threading import Lock
from typing import NamedTuple

import numpy as np
from scipy.special import j0

from . import film
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
#: Radians of J0 in a piece of its transform.
_PHASE = 120.0
#: Nodes k of a part of the transform that is kept.
_ROWS = 250
#: Widest panel in k: wider ones would need Gauss rules that are slow to make.
_WIDEST = 200.0


class Table(NamedTuple):
    """Hankel transforms of one octave on one mesh: k (G,); J0(k x_i) - J0(k) and φ (G, n); J0(k) (G,); J0 φ (G, n²).

    `film`: the m nodes where the convolution is felt, the :class:`film.Convolution` there, and at the edge (T, n).
    """

    k: np.ndarray
    J: np.ndarray
    phi: np.ndarray
    J_edge: np.ndarray
    product: np.ndarray | None
    film: tuple | None


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
    phi = transform(grid, k)
    keep = J.shape[0] * n * n <= _KEEP
    product = (J[:, :, None] * phi[:, None, :]).reshape(len(k), n * n) if keep else None
    return Table(k, J, phi, J_edge, product, _film_table(grid) if octave == FILM else None)


@lru_cache(maxsize=4)
def _film_table(grid):
    near = felt(grid, grid.x)
    edge = film.convolution(grid, np.zeros(1), CUT).of(np.eye(len(film.waves()[1])))
    return near, film.convolution(grid, grid.s[near], CUT), edge[:, 0]


def felt(grid, x):
    """Indices of the radii x where the convolution is felt: near the edge, and where panels resolve more than CUT."""
    ends = np.sqrt(1 - np.array(grid.breaks) ** 2)
    home = np.clip(np.searchsorted(-ends, -x) - 1, 0, len(ends) - 2)
    fine = (ends[home] - ends[home + 1]) * CUT < 16 * grid.order
    return np.flatnonzero(((1 - x) * CUT < film.REACH) | (fine & (x * CUT > film.REACH)))


def transform(grid, k):
    """φ_j(k) = ∫₀¹ l_j(s) J0(k sqrt(1 - s²)) s ds, (G, n)."""
    phi = np.empty((len(k), grid.n))
    for stop in range(len(k), 0, -_ROWS):  # from the end, which quadratures of an octave share
        part = slice(max(stop - _ROWS, 0), stop)
        for i, ends in enumerate(pairwise(grid.breaks)):
            own = slice(i * grid.order, (i + 1) * grid.order)
            phi[part, own] = _transform_kept(*ends, grid.s[own].tobytes(), k[part].tobytes())
    return phi


@lru_cache(maxsize=1024)
def _transform_kept(low, high, nodes_bytes, k_bytes):
    """Part of φ on a panel, which meshes and quadratures have in common: (G', order)."""
    nodes, k = np.frombuffer(nodes_bytes), np.frombuffer(k_bytes)
    angle, weight = _angles(low, high, k.max(), len(nodes))
    sin, cos = np.sin(angle), np.cos(angle)
    return j0(k[:, None] * cos) @ ((weight * sin * cos)[:, None] * lagrange(nodes, sin))


def _angles(low, high, k, order):
    """Nodes φ and weights (g,) of ∫ · dφ for s = sin φ on a panel: pieces of like phase k cos φ, the first of half."""
    x = np.sqrt(1 - np.array([low, high]) ** 2)
    pieces = int(k * (x[0] - x[1]) / _PHASE) + 1
    ends = np.arccos(x[0] + np.maximum(np.arange(pieces + 1) - 0.5, 0) / (pieces - 0.5) * (x[1] - x[0]))
    ends[[0, -1]] = np.arcsin([low, high])
    width, sin = np.diff(ends), np.sin(ends)
    # at most, of J0 and of a polynomial, which is fastest at the ends of its panel
    share = min(np.diff(sin).max() / (high - low), 1.0)
    phase = k * (width * sin[1:]).max() + 2 * order * np.arcsin(np.sqrt(share))
    t, w = gauss_legendre(8 * int(phase / 32 + np.cbrt(phase / 2) * 3 / 8 + 2))
    return (ends[:-1, None] + width[:, None] * t).ravel(), (width[:, None] * w).ravel()


def between(grid, octave, depth, coarse, x):
    """J0(k x) - J0(k), (G, m)."""
    key = grid, octave, depth, coarse, x.tobytes()
    small = len(x) * len(quadrature(octave, depth, coarse)[0]) <= _KEEP_BETWEEN
    return (_between_kept if small else _between_kept.__wrapped__)(*key)


@lru_cache(maxsize=256)
def _between_kept(grid, octave, depth, coarse, x_bytes):
    tab = table(grid, octave, depth, coarse)
    return j0(tab.k[:, None] * np.frombuffer(x_bytes)) - tab.J_edge[:, None]

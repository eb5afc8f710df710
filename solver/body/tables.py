"""Tables of a Hankel body: Hankel transforms at the nodes of the quadrature of each octave of h/a."""

from functools import lru_cache, wraps
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legvander

from ..numerics import special
from ..numerics.caches import Cache
from ..numerics.quadrature import gauss_legendre, radau_nodes
from . import film
from .wave_rule import CUT, FILM, STIFFEST, few, quadrature

#: Largest array of a table, in numbers. If it would be larger, the product of J0 and φ (of films) is formed case by
#: case, and J0 between the nodes is computed anew each time.
_KEEP = 4e6
#: Largest number of bytes of all tables in the cache.
_MOST_BYTES = 4e8
#: On meshes of up to this many nodes the product is formed even for a single case: it serves all later ones.
_SMALL = 22
#: The same limit for the convolution of films.
_WHOLE = 64
#: The integral of the transform φ is split into pieces. Along each the argument of J0 changes by at most this, in
#: radians.
_PHASE = 120.0
#: φ is formed, and its moments are cached, for this many nodes k at a time.
_ROWS = 250
#: The moments of a panel are formed for the first of these numbers of polynomials that is enough. J0 costs the most, so
#: that meshes of many orders share its values.
_COUNTS = (16, 48, 144)
#: Where s is below _NEAR, J0(kx) - J0(k) is a Taylor series of _TERMS terms: k (1 - x) is at most 0.03 there. Rounding
#: would change the difference itself by 2e-16/s², and the load of films of n = 300 to 3e6 on narrow panels by 1e-10 to
#: 6e-8 (tests/rough/errors/test_plates.py).
_NEAR, _TERMS = 3e-3, 5


class FilmTable(NamedTuple):
    """The table that makes an operator on one mesh of n nodes from a convolution c (b, T).

    nodes : (m,), indices of the nodes where the convolution is felt
    rows : :func:`film_rows` at these nodes
    edge : (T, n); c @ edge is the row of the edge
    """

    nodes: np.ndarray
    rows: film.Whole | film.Convolution
    edge: np.ndarray


class OctaveTable(NamedTuple):
    """The table that makes the operator from L - 1 (b, M) at the few nodes k, in one octave on one mesh of n nodes. G
    is the number of all nodes k of the quadrature.

    J : (G, n + 1), J0(k x_i) - J0(k) at the nodes of the mesh, and in the last column J0(k)
    phi : (G, n), the transforms of the basis
    spread : (M, G), which makes (π/2) w (L - 1) at all nodes from L - 1 at the few; w are the weights. Films and
        kernels without a sampler have no few nodes: it is (G,), the factors (π/2) w
    product : (M, (n + 1) n); L - 1 times this is the matrix and, under it, the row of the edge. None for few cases, or
        if it would be too large
    film : :class:`FilmTable` for films, else None
    """

    J: np.ndarray
    phi: np.ndarray
    spread: np.ndarray
    product: np.ndarray | None
    film: FilmTable | None

    @property
    def is_small(self):
        """Whether it takes fewer multiplications to form the matrix by `product` than to multiply by q with sums over
        all nodes k."""
        of_few = self.product is not None and self.spread.ndim == 2
        return of_few and self.product.size < self.spread.size + self.J.size + self.phi.size

    def weights(self, L1):
        """(π/2) w (L - 1), (b, G), at all nodes of the quadrature from L - 1 (b, M) at the few."""
        return L1 * self.spread if self.spread.ndim == 1 else L1 @ self.spread


_tables = Cache(_MOST_BYTES)


def _memo(make):
    """Decorator: the results of a function of hashable arguments are cached in `_tables`."""

    @wraps(make)
    def cached(*key):
        return _tables.get((make.__name__, *key), lambda: make(*key))

    return cached


@_memo
def table(mesh, sampler, octave, stiffness, many):
    """The :class:`OctaveTable` of a mesh in an octave and a class of stiffness. `sampler`: the
    :class:`~solver.kernels.kernel.Sampler` of the kernels, or None. `many`: whether the table is for many cases."""
    J, phi = _waves(mesh, octave, stiffness % len(STIFFEST))
    product, is_film = None, octave == FILM
    at_all = is_film or sampler is None
    spread = np.pi / 2 * quadrature(octave, stiffness)[1] if at_all else _spread(sampler, octave, stiffness)
    if at_all and many and J.size * mesh.n <= _KEEP:
        product = ((spread[:, None] * J)[:, :, None] * phi[:, None, :]).reshape(len(J), -1)
    elif not at_all and (many or mesh.n <= _SMALL):
        product = np.array([((J * row[:, None]).T @ phi).ravel() for row in spread])
    return OctaveTable(J, phi, spread, product, _film_table(mesh, many) if is_film else None)


@_memo
def _waves(mesh, octave, stiffness):
    """J and φ of an :class:`OctaveTable`, the same for many cases and for few."""
    k, _ = quadrature(octave, stiffness)
    return np.hstack([less_edge(k, mesh.s), special.j0(k)[:, None]]), transform(mesh, k)


@_memo
def _spread(sampler, octave, stiffness):
    """`spread` of an :class:`OctaveTable`, the same for all meshes."""
    return np.pi / 2 * few(sampler, octave, stiffness).spread


@_memo
def _film_table(mesh, many):
    nodes, edge = felt(mesh, mesh.x), np.zeros(1)
    rows = film_rows(mesh, mesh.s[nodes].tobytes(), many)
    return FilmTable(nodes, rows, film_rows(mesh, edge.tobytes(), True).table)


@_memo
def film_rows(mesh, s_bytes, many):
    """The convolution at any points s. For many cases, or on few nodes, it is a :class:`film.Whole`, which serves all
    later cases; otherwise a :class:`film.Convolution`."""
    convolution = film.convolution(mesh, np.frombuffer(s_bytes), CUT)
    return convolution.whole() if many or mesh.n <= _WHOLE else convolution


def felt(mesh, x):
    """Indices of the radii x where the convolution is felt: near the edge, and where panels resolve waves above CUT."""
    ends = np.sqrt(1 - np.array(mesh.breaks) ** 2)
    home = np.clip(np.searchsorted(-ends, -x) - 1, 0, len(ends) - 2)
    fine = (ends[home] - ends[home + 1]) * CUT < 16 * mesh.order
    return np.flatnonzero(((1 - x) * CUT < film.REACH) | (fine & (x * CUT > film.REACH)))


def transform(mesh, k):
    """φ_j(k) = ∫₀¹ l_j(s) J0(k sqrt(1 - s²)) s ds, (G, n)."""
    phi, order = np.empty((len(k), mesh.n)), mesh.order
    count = next((most for most in _COUNTS if order <= most), order)
    of_legendre = np.linalg.inv(legvander(2 * radau_nodes(order) - 1, order - 1))
    for stop in range(len(k), 0, -_ROWS):  # from the end, because all classes of an octave share the last nodes
        part = slice(max(stop - _ROWS, 0), stop)
        for i, ends in enumerate(pairwise(mesh.breaks)):
            moments = _moments(*ends, count, k[part].tobytes())
            phi[part, i * order : (i + 1) * order] = moments[:, :order] @ of_legendre
    return phi


@lru_cache(maxsize=1024)
def _moments(low, high, count, k_bytes):
    """∫ P_m J0(k sqrt(1 - s²)) s ds over a panel, with its Legendre polynomials P_m: (G', count) for G' nodes k. Meshes
    of all orders use the same moments."""
    k = np.frombuffer(k_bytes)
    angle, weight = _angles(low, high, k.max(), count)
    sin, cos = np.sin(angle), np.cos(angle)
    local = np.clip(2 * (sin - low) / (high - low) - 1, -1, 1)
    return special.j0(k[:, None] * cos) @ ((weight * sin * cos)[:, None] * legvander(local, count - 1))


def _angles(low, high, k, order):
    """Angles and weights (g,) of the integral over the angle, s = sin(angle), on a panel. The phase k cos(angle)
    changes by the same amount along each piece except the first, and by half of that along the first."""
    x = np.sqrt(1 - np.array([low, high]) ** 2)
    pieces = int(k * (x[0] - x[1]) / _PHASE) + 1
    ends = np.arccos(x[0] + np.maximum(np.arange(pieces + 1) - 0.5, 0) / (pieces - 0.5) * (x[1] - x[0]))
    ends[[0, -1]] = np.arcsin([low, high])
    width, sin = np.diff(ends), np.sin(ends)
    # the largest change of phase on a piece: that of J0, and that of a polynomial, largest at the ends of its panel
    share = min(np.diff(sin).max() / (high - low), 1.0)
    phase = k * (width * sin[1:]).max() + 2 * order * np.arcsin(np.sqrt(share))
    t, w = gauss_legendre(8 * int(phase / 32 + np.cbrt(phase / 2) * 3 / 8 + 2))
    return (ends[:-1, None] + width[:, None] * t).ravel(), (width[:, None] * w).ravel()


def less_edge(k, s):
    """J0(k sqrt(1 - s²)) - J0(k), (G, m) for k (G,) and s (m,). Near the edge it is a Taylor series around k."""
    edge, near = special.j0(k), s < _NEAR
    if not near.any():
        return special.j0(k[:, None] * np.sqrt((1 - s) * (1 + s))) - edge[:, None]
    values, far, s = np.empty((len(k), len(s))), s[~near], s[near]
    values[:, ~near] = special.j0(k[:, None] * np.sqrt((1 - far) * (1 + far))) - edge[:, None]
    # coefficients of t^-1, t^0, t^1, ... in J0(k + t), from Bessel's equation (k + t) y'' + y' + (k + t) y = 0
    terms = [0 * k, edge, -special.j1(k)]
    for m in range(_TERMS - 1):
        terms.append(-((m + 1) ** 2 * terms[-1] / k + terms[-2] + terms[-3] / k) / ((m + 1) * (m + 2)))
    t = -k[:, None] * (s * s / (1 + np.sqrt((1 - s) * (1 + s))))
    series = 0 * t
    for term in terms[:1:-1]:
        series = (series + term[:, None]) * t
    values[:, near] = series
    return values


def between(octave, stiffness, s):
    """J0(k x) - J0(k), (G, m), at points s = sqrt(1 - x²) (m,)."""
    small = len(s) * len(quadrature(octave, stiffness)[0]) <= _KEEP
    return (_between if small else _between.__wrapped__)(octave, stiffness % len(STIFFEST), s.tobytes())


@_memo
def _between(octave, stiffness, s_bytes):
    return less_edge(quadrature(octave, stiffness)[0], np.frombuffer(s_bytes))

"""The kernel of a batch of layers at the nodes of the quadrature: a part for each table that some of them share."""

from typing import NamedTuple

import numpy as np

from . import film
from .kernel import decaying_part
from .tables import table
from .wave_rule import CUT, FILM, few, octave_of, quadrature

#: Numbers in one block of kernel values: its temporaries stay in the cache.
_BLOCK = 16384


class Part(NamedTuple):
    """The kernel of cases that share a table: their places `index` (b,) in the batch, the table, the radius a (b,), and
    L - 1 and -u dL/du (b, M) at the few nodes k of the table.

    Films have χ (L - n') in place of L - 1, their convolution c and its derivative by ln a (b, T), and n' (b, 1).
    """

    index: np.ndarray
    octave: int
    depth: int
    radius: np.ndarray
    L1: np.ndarray
    uL: np.ndarray
    film: np.ndarray | None = None
    d_film: np.ndarray | None = None
    level: np.ndarray | None = None

    def table(self, mesh):
        """Its :class:`~solver.body.tables.Table` on a mesh."""
        return table(mesh, self.octave, self.depth)

    @property
    def share(self):
        """The share (b, 1) of the half-space that stands beside Λ: 1 but for films."""
        return 1.0 if self.level is None else self.level

    def take(self, rows, index):
        """The sub-batch at `rows`, at the places `index` in another batch."""
        return Part(index, self.octave, self.depth, *(None if v is None else v[rows] for v in self[3:]))


def parts_of(layer, a, index):
    """The kernel of the cases `index` at radii a (B,): a list of :class:`Part`, one for each table."""
    octave, depth = octave_of(layer.take(index), a[index])
    parts = []
    for key in sorted(set(zip(octave.tolist(), depth.tolist(), strict=True))):
        own = index[(octave == key[0]) & (depth == key[1])]
        make = _film_part if key[0] == FILM else _plain_part
        parts.append(Part(own, *key, a[own], *make(layer.take(own), layer.h[own] / a[own], *key)))
    return parts


def _plain_part(layer, eta, octave, depth):
    k, _ = quadrature(octave, depth)
    own = few(octave, depth)
    return _kernel(layer, eta, k if own is None else k[own.nodes])


def _film_part(layer, eta, octave, depth):
    k, _ = quadrature(octave, depth)
    level = layer.whole(CUT * eta / 2)[:, None]
    kappa, _, _ = film.waves()
    below = _kernel(layer, eta, k, level, film.step(k / CUT))
    beyond, d_beyond = _kernel(layer, eta, CUT * kappa, level, 1 - film.step(kappa))
    p, end = CUT * eta[:, None], level - 1
    return *below, np.pi / 2 * film.transform(beyond, end, p), np.pi / 2 * film.transform(d_beyond, 0 * end, p), level


def _kernel(layer, eta, k, level=None, factor=1.0):
    """L less `level` (b, 1), or less 1, and -u dL/du, both times a factor (M,), at the nodes k: (b, M) each."""
    L1, uL = np.empty((2, len(eta), len(k)))
    rows, material, yields = max(1, _BLOCK // len(k)), layer.material, layer.m.any()  # few punches do
    for low in range(0, len(eta), rows):
        part = slice(low, low + rows)
        above, slope = decaying_part(k * eta[part, None], *(field[part, None] for field in material))
        if yields:
            above, slope = above / (1 + layer.m[part, None]), slope / (1 + layer.m[part, None])
        np.multiply(factor, above if level is None else above - (level[part] - 1), out=L1[part])
        np.multiply(-factor, slope, out=uL[part])
    return L1, uL

"""The kernel L of a batch at nodes k of the quadrature, in parts: one for each class of stiffness, films apart.

:mod:`.wave_rule` defines the classes, the octaves of h/a, the few nodes, and which layers are films.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..kernels.kernel import Sampler
from ..numerics import batch
from . import film
from .tables import table
from .wave_rule import CUT, FILM, STIFFEST, few, place_of, quadrature

#: Kernel values are computed in blocks of this many numbers, so that intermediate arrays stay in the cache.
_BLOCK = 16384


@batch.of_cases
class Part(NamedTuple):
    """The kernel of b cases of one family and one class of stiffness; either all are films, or none. If the family has
    no `sampler`, they have one octave too.

    index : (b,), their places in the batch
    octave : (b,), octave of h/a; equal octaves are neighbours
    radius : (b,), the contact radius a
    L1, uL : (b, M), L - 1 and -u dL/du at the few nodes k of the tables, or at all of them. Films have χ (L - n') in
        place of L - 1, see :mod:`.film`
    film, d_film : (b, T), for films: the convolution c and its derivative by ln a
    level : (b, 1), for films: n'
    """

    sampler: Sampler | None
    stiffness: int
    index: np.ndarray
    octave: np.ndarray
    radius: np.ndarray
    L1: np.ndarray
    uL: np.ndarray
    film: np.ndarray | None = None
    d_film: np.ndarray | None = None
    level: np.ndarray | None = None

    def tables(self, mesh):
        """Yield each :class:`~solver.body.tables.OctaveTable` on a mesh with the slice of its cases."""
        for octave, rows in runs(self.octave):
            yield table(mesh, self.sampler, octave, self.stiffness, rows.stop - rows.start >= film.MANY), rows

    @property
    def kind(self):
        """What parts must have in common so that :func:`united` can unite them."""
        return self.stiffness, self.film is None, self.sampler or int(self.octave[0])

    @property
    def share(self):
        """The factor of the half-space's K that is added to Λ: 1, or n' (b, 1) for films."""
        return 1.0 if self.level is None else self.level


def runs(kinds):
    """Yield each run of equal neighbours in `kinds` (b,) int, such as octaves: the number and its slice; b > 0."""
    ends = (kinds[1:] != kinds[:-1]).nonzero()[0] + 1  # np.diff would take as long as the work on a small slice
    for low, high in pairwise([0, *ends.tolist(), len(kinds)]):
        yield int(kinds[low]), slice(low, high)


def united(parts):
    """One part made of several of the same kind."""
    _, _, *arrays = zip(*parts, strict=True)
    whole = Part(*parts[0][:2], *(None if v[0] is None else np.concatenate(v) for v in arrays))
    order = np.argsort(whole.octave, kind="stable")
    return whole.take(order)


def parts_of(body, a, index):
    """The kernel of the cases `index` at radii a (B,): a list of :class:`Part`."""
    octave, stiffness = place_of(body.take(index), a[index])
    order, parts, sampler = np.lexsort((octave, stiffness, octave == FILM)), [], body.kernel.sampler
    index, octave, stiffness = index[order], octave[order], stiffness[order]
    kinds = 2 * stiffness + (octave == FILM)
    if sampler is None:  # each octave has its own number of nodes
        kinds += 2 * len(STIFFEST) * (octave - FILM)
    for _, rows in runs(kinds) if len(index) else ():
        cases, stiffness_class = index[rows], int(stiffness[rows][0])
        make = _film_part if octave[rows][0] == FILM else _plain_part
        kernel = make(body.take(cases), body.h[cases] / a[cases], octave[rows], stiffness_class)
        parts.append(Part(sampler, stiffness_class, cases, octave[rows], a[cases], *kernel))
    return parts


def _plain_part(body, h_a, octave, stiffness):
    if body.kernel.sampler is None:
        return _kernel(body, h_a, quadrature(int(octave[0]), stiffness)[0])
    k = [few(body.kernel.sampler, first, stiffness).k for first, _ in runs(octave)]
    return _kernel(body, h_a, np.repeat(k, [rows.stop - rows.start for _, rows in runs(octave)], axis=0))


def _film_part(body, h_a, octave, stiffness):
    k, _ = quadrature(FILM, stiffness)
    level = body.whole(CUT * h_a / 2)[:, None]
    kappa, _, _ = film.waves()
    below = _kernel(body, h_a, k, level, film.step(k / CUT))
    above, d_above = _kernel(body, h_a, CUT * kappa, level, 1 - film.step(kappa))
    p, end = CUT * h_a[:, None], level - 1
    return *below, np.pi / 2 * film.transform(above, end, p), np.pi / 2 * film.transform(d_above, 0 * end, p), level


def _kernel(body, h_a, k, level=None, factor=1.0):
    """L - `level` (b, 1), or L - 1 if that is None, and -u dL/du. Both are (b, M), at the nodes k (b, M) or (M,), and
    multiplied by a `factor` (M,)."""
    size, count = len(h_a), k.shape[-1]
    L1, uL = np.empty((2, size, count))
    many, elastic_punch = max(1, _BLOCK // count), body.m.any()  # few punches are elastic
    for group in body.kernel.formulas():
        for low in range(0, len(group), many):
            rows = group[low : low + many]
            u = (k if k.ndim == 1 else k[rows]) * h_a[rows, None]
            above, slope = body.kernel.take(rows).decaying_part(u)
            if elastic_punch:
                above, slope = above / (1 + body.m[rows, None]), slope / (1 + body.m[rows, None])
            L1[rows] = factor * (above if level is None else above - (level[rows] - 1))
            uL[rows] = -factor * slope
    return L1, uL

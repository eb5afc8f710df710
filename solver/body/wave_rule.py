"""The quadrature in k of a Hankel body, one for each octave of h/a, and the few of its nodes that determine L.

k is in units of 1/a, and an octave is the interval of h/a from a power of two to the next. The panels follow the
oscillation of J0 J0, whose frequency is 2, and the scales of L: a/h, and if its stiffness n is large also
n^(-1/3) a/h and a/(nh). So the quadrature is equally accurate for every h/a and n of an octave. L - 1 itself does not
oscillate. For all kernels of a family, in one class of stiffness and one octave, its values at all nodes follow to
rounding from its values at a few of them.
"""

from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..numerics.quadrature import gauss_legendre

#: First and last octave of h/a (as powers of two) with tables of their own. All smaller h/a are films, the octave FILM.
#: Where h/a is larger, the body under the layer is not felt any more.
OCTAVES = (-8, 40)
FILM = OCTAVES[0] - 1
#: Width in k of the widest panel: a wider one would need a Gauss rule that is slow to make.
_WIDEST = 200.0
#: Largest n of each class of stiffness (:class:`~solver.kernels.kernel.Kernel`), and the number of panels that its
#: quadrature has towards k = 0, each half as wide as the one before. Except in the first class, the panel at k = 0 ends
#: below u = 0.15/n.
STIFFEST, _DEPTH = (2.0, 1e3, 1e6, 1e9), (0, 12, 22, 32)
#: A class of its own for the mild kernels of the second class (:class:`~solver.kernels.kernel.Sampler`). It has the
#: quadrature of the second class, and few nodes of its own.
MILD = 1 + len(STIFFEST)
#: The few nodes are chosen by L - 1 and u dL/du of random kernels. They are enough when the error at the other nodes is
#: at most this part of the largest of these functions, which is rounding.
_LEFT_OUT = 3e-16
#: A panel of the width w in k has _MORE + w/2 + _ROOT w^(1/3) points, and at least _LEAST: the first number if it ends
#: below u = 1/2, else the second, with u = kh/a at the lower end of the octave. It has _LESS points fewer for each
#: digit by which L - 1 has decayed at its beginning. The operator is then right to 1e-11
#: (tests/body/test_wave_rule.py).
_MORE, _ROOT, _LEAST, _LESS = 9, 3.0, (11, 15), 0.8
#: In octave 0 the integral over u ends at _END_MIDDLE. The end moves by 0.7 with each octave, up to _END. Beyond, L - 1
#: ~ u² e^(-2u) and J0 φ ~ 1/k² (k > 1) are too small to count, even under stiff layers, where they act more strongly on
#: the pressure (tests/rough/errors/test_error_bars.py). For films it ends at _END_FILM: :mod:`.film` adds the waves
#: beyond.
_END, _END_MIDDLE, _END_FILM = 20.0, 18.0, 8.7


def _end(octave):
    """The u at which the integral ends in an octave."""
    return _END_FILM if octave == FILM else min(_END, _END_MIDDLE + 0.7 * octave)


#: Largest k of the quadrature of films.
CUT = _end(FILM) * 2.0**-FILM


def place_of(body, a):
    """Octave of h/a, or FILM, and class of stiffness, an index of STIFFEST or MILD; (B,) int each."""
    h_a, n = body.h / a, body.kernel.stiffness
    octave = np.floor(np.log2(h_a))
    octave = np.clip(np.where(np.isnan(octave), 0.0, octave), FILM, OCTAVES[1]).astype(int)
    # all films share one quadrature, in which a film is as stiff as a layer of h/a = 2^FILM with the same n h/a
    stiffness = np.where(octave == FILM, n * h_a * 2.0**-FILM, n)
    place = np.minimum(np.searchsorted(STIFFEST, stiffness), len(STIFFEST) - 1)
    sampler = body.kernel.sampler
    if sampler is not None and sampler.mild:
        place = np.where((place == 1) & (octave != FILM) & (stiffness <= sampler.mild), MILD, place)
    return octave, place


@lru_cache(maxsize=256)
def quadrature(octave, stiffness):
    """Nodes k and weights (G,) for h/a in [2^octave, 2^(octave+1)] and a class of stiffness."""
    scale, cut, depth = 2.0**-octave, _end(octave), _DEPTH[stiffness % len(STIFFEST)]
    ends = [0.0, *(0.5 * 2.0 ** -np.arange(depth, -1, -1)), 1.0, 2.0, 4.0, *([8.0] if cut > 9 else []), cut]
    k, weight = [], []
    for low, high in pairwise(ends):
        pieces = int(np.ceil((high - low) * scale / _WIDEST))
        width = (high - low) * scale / pieces
        order = max(_LEAST[int(high >= 0.5)], int(width / 2 + _ROOT * np.cbrt(width)) + _MORE)
        decayed = 2 * (low - np.log1p(low)) / np.log(10)
        t, w = gauss_legendre(max(7, order - int(_LESS * decayed)))
        for piece in range(pieces):
            k.append(low * scale + (piece + t) * width)
            weight.append(width * w)
    return np.concatenate(k), np.concatenate(weight)


class Few(NamedTuple):
    """The few nodes k (M,) of a quadrature of G nodes, where M depends on the class of stiffness; and the matrix
    `spread` (M, G), which makes w (L - 1) at all nodes from L - 1 at the few; w are the weights."""

    k: np.ndarray
    spread: np.ndarray


@lru_cache(maxsize=256)
def few(sampler, octave, stiffness):
    """The :class:`Few` nodes of an octave other than FILM, by interpolative decomposition of random samples of
    w (L - 1)/(1 + k²) from the family of a :class:`~solver.kernels.kernel.Sampler`. J0 φ falls like 1/k², so that the
    error is small beside the operator (tests/body/test_wave_rule.py).

    The nodes are chosen without BLAS: its rounding may differ between machines, and these would choose other nodes.
    """
    k, weight = quadrature(octave, stiffness)
    scale = weight / (1 + k * k)
    rest, nodes, rows = _samples(sampler, octave, stiffness, k, scale), [], []
    left = np.sum(rest**2, axis=0)
    most = left.max()
    while left.max() > _LEFT_OUT**2 * most and len(nodes) < sampler.few[stiffness]:
        nodes.append(np.argmax(left))
        direction = rest[:, nodes[-1]] / np.sqrt(left[nodes[-1]])
        rows.append(np.einsum("i,ij->j", direction, rest))
        rest -= direction[:, None] * rows[-1]
        left = np.sum(rest**2, axis=0)
        left[nodes] = 0.0
    R = np.array(rows)
    spread = np.linalg.solve(np.triu(R[:, nodes]), R) * (1 + k * k)
    fill = sampler.few[stiffness] - len(nodes)  # nodes of weight 0 are added, so that all octaves have equally many
    return Few(np.pad(k[nodes], (0, fill), mode="edge"), np.pad(scale[nodes, None] * spread, ((0, fill), (0, 0))))


def _samples(sampler, octave, stiffness, k, scale):
    """L - 1 and u dL/du (2 S, G), times `scale` (G,), of random kernels of a class with h/a in an octave. Where the
    sum of |L - 1| over the nodes, which is about the size of the operator, is above 1, both are divided by it."""
    random, size = np.random.default_rng(0), sampler.samples[stiffness]
    share_n, share_h_a = 1.1 * np.sin(np.pi / 2 * random.random((2, size))) ** 2 - 0.05  # most at the ends, some beyond
    ends = (STIFFEST[0], sampler.mild) if stiffness == MILD else [1e-9, *STIFFEST][stiffness : stiffness + 2]
    low, high = np.log(ends)
    n = np.exp(low + (high - low) * share_n)
    if stiffness == 0:
        n = np.where(random.random(size) < 0.5, random.uniform(0, 2, size), n)
    L1, uL = sampler.draw(random, n).decaying_part(k * 2.0 ** (octave + share_h_a)[:, None])
    L1, uL = scale * L1, scale * uL
    whole = np.maximum(np.abs(L1).sum(axis=1), 1.0)
    return np.concatenate([L1, uL]) / np.tile(whole, 2)[:, None]

"""The quadrature in k of the layered operator for each octave of h/a, and the few nodes that determine L - 1 at all.

Its panels follow the oscillation of J0 J0 (whose frequency is 2) and the scale of L (1/η, and for stiff layers
n^(-1/3)/η and 1/(nη), η = h/a), so that it is as accurate for every h/a and n of the octave. L - 1 does not oscillate:
of all soft layers, at all h/a of an octave, it lies within rounding in a space of some 55 dimensions.
"""

from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..numerics.quadrature import gauss_legendre
from .kernel import decaying_part

#: Octaves of h/a with tables of their own; below is the octave FILM, above nothing of the half-space is left.
OCTAVES = (-8, 40)
FILM = OCTAVES[0] - 1
#: Widest panel in k: wider ones would need Gauss rules that are slow to make.
_WIDEST = 200.0
#: Random layers from whose L - 1 and u dL/du the few nodes are found, and what is left out of them, over the largest.
_SAMPLES, _LEFT_OUT = 200, 3e-16


#: The rule on a panel of the width w between low and high, in u at octave 0: _MORE + w/2 + _ROOT w^(1/3) points, the
#: fewest of _LEAST below and above u = 1/2, _LESS fewer a digit by which e^-2u has decayed there. With it the operator
#: is right to rounding, to 1e-11 below h/a = 1/64 (tests/body/test_wave_rule.py).
_MORE, _ROOT, _LEAST, _LESS = 9, 3.0, (11, 15), 0.8
#: Where the integral over u may end, at most and at octave 0: L - 1 ~ u² e^(-2u), J0 φ ~ 1/k² for k > 1.
_END, _END_MIDDLE = 17.0, 15.0


def _end(octave):
    """Where the integral over u ends: what lies beyond is below the error."""
    return min(_END, _END_MIDDLE + 0.7 * octave)


#: Largest k of the quadrature of films.
CUT = _end(FILM) * 2.0**-FILM


def octave_of(layer, a):
    """Octave of h/a, or FILM, and depth of the quadrature for the stiffness of the layer, (B,) int each."""
    eta = layer.h / a
    octave = np.clip(np.floor(np.nan_to_num(np.log2(eta))), FILM, OCTAVES[1]).astype(int)
    # a stiff layer is a plate, whose kernel falls at u ~ n^(-1/3), and, bonded, a membrane at u ~ 1/n
    ratio = np.maximum(np.where(layer.bonded, layer.n, np.cbrt(layer.n)), 1.0)
    ratio = np.where(octave == FILM, ratio * eta * 2.0**-FILM, ratio)
    wanted = np.ceil(np.log2(np.maximum(3.5 * ratio, 1.0)))  # 0.5 2^-depth <= 0.15/ratio
    return octave, np.where(layer.n > 2, 6 * np.ceil(wanted / 6), 0).astype(int)


@lru_cache(maxsize=128)
def quadrature(octave, depth):
    """Nodes k and weights (G,) for h/a in [2^octave, 2^(octave+1)], `depth` more dyadic panels towards k = 0."""
    scale, cut = 2.0**-octave, _end(octave)
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
    """Indices (M,) of nodes of a quadrature, and (M, G) what makes w (L - 1) at all nodes of L - 1 at those."""

    nodes: np.ndarray
    spread: np.ndarray


@lru_cache(maxsize=64)
def few(octave, depth):
    """The :class:`Few` nodes for n <= 2, by interpolative decomposition of random samples; None for others.

    What is left out of L - 1 is below 2e-14 (tests/body/test_wave_rule.py). A batch of 4,000 such layers is solved in
    two thirds of the time that it takes without. They are chosen without BLAS: with its rounding on another worker the
    choice might be another.
    """
    if depth or octave == FILM:
        return None
    _, weight = quadrature(octave, depth)
    rest, nodes, rows = _samples(octave), [], []
    left = np.sum(rest**2, axis=0)
    most = left.max()
    while left.max() > _LEFT_OUT**2 * most:
        nodes.append(np.argmax(left))
        direction = rest[:, nodes[-1]] / np.sqrt(left[nodes[-1]])
        rows.append(np.einsum("i,ij->j", direction, rest))
        rest -= direction[:, None] * rows[-1]
        left = np.sum(rest**2, axis=0)
        left[nodes] = 0.0
    R = np.array(rows)
    return Few(np.array(nodes), np.linalg.solve(np.triu(R[:, nodes]), R) * weight)


def _samples(octave):
    """L - 1 and u dL/du (2 _SAMPLES, G) of random layers with n <= 2 and h/a in an octave."""
    random, size = np.random.default_rng(0), _SAMPLES
    n = np.where(random.random(size) < 0.5, random.uniform(0, 2, size), 10 ** random.uniform(-4, 0, size))
    eta, bonded = 2.0 ** (octave + random.random(size)), random.random(size) < 0.67
    material = n, *random.uniform(0, 0.5, (2, size)), bonded
    k, _ = quadrature(octave, 0)
    return np.concatenate(decaying_part(k * eta[:, None], *(v[:, None] for v in material)))

"""The basis in which a smooth contact is solved, and its products with the kernel, tabulated for each octave of h/a.

On 0 <= τ <= 1, τ = t/a, the basis is e_m = sqrt(4m + 1) P_2m(τ), the even Legendre polynomials, which are orthonormal
there. With κ = ka their cosine transforms are ê_m = (-1)^m sqrt(4m + 1) j_2m(κ). Those of the difference cos κτ - cos κ
of :mod:`.equation` are the same but for m = 0, where it is

    d_0 = sin κ/κ - cos κ = κ j_1(κ),       d_m = ê_m for m > 0.

So no digits are lost where waves are long, and that is where the kernel of a stiff layer is large.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.special import spherical_jn

from ..body.wave_rule import few, quadrature
from ..numerics.kept import Kept

#: Numbers N of functions in the basis for octaves of h/a from 3 downwards, of shapes that are smooth in r², and of all
#: others; of thicker layers, as for octave 3.
_SIZES = {
    True: (6, 8, 10, 12, 16, 22, 28, 38, 52, 70, 96, 130),
    False: (6, 8, 11, 15, 21, 28, 40, 54, 72, 100, 144, 196),
}
#: Bytes of tables that are kept.
_MOST = 256_000_000
_TABLES = Kept(_MOST)


def size_of(octave, even):
    """The number N of functions of the basis in an octave of h/a."""
    return _SIZES[even][min(max(3 - octave, 0), len(_SIZES[even]) - 1)]


def coarser(size):
    """The number of functions with which the result is compared, for the error."""
    return size - max(2, size // 5)


class Products(NamedTuple):
    """(2/π) ∫ (L - 1) f g dκ for pairs of functions f, g of κ, B cases, as the equation needs them.

    differences : (B, N, N), f and g are d_m and d_n
    edge : (B, N), d_m and cos κ
    corner : (B,), cos κ and cos κ
    slope : (B, N), ê_m and κ sin κ
    """

    differences: np.ndarray
    edge: np.ndarray
    corner: np.ndarray
    slope: np.ndarray

    @classmethod
    def of(cls, L1, sampler, octave, stiffness, size):
        """L1 (B, M) : L - 1 at the few nodes of an octave and class of stiffness, or where `sampler` is None at all."""
        key = sampler, octave, stiffness, size
        flat = in_blocks(L1, _TABLES.get(key, lambda: _table(*key)))
        places = _places(size)
        count = (size + 1) * (size + 2) // 2
        return cls(flat[:, places[:-1, :-1]], flat[:, places[:-1, -1]], flat[:, places[-1, -1]], flat[:, count:])


def in_blocks(rows, matrix, block=16):
    """rows @ matrix, as products of `block` rows each: so a row has the same result in any company."""
    padded = np.zeros((-(-len(rows) // block) * block, rows.shape[1]))
    padded[: len(rows)] = rows
    product = np.matmul(padded.reshape(-1, block, rows.shape[1]), matrix)
    return product.reshape(len(padded), -1)[: len(rows)]


@lru_cache(maxsize=64)
def _places(size):
    """Where the product of two functions stands in a row of a table, (N + 1, N + 1)."""
    places = np.zeros((size + 1, size + 1), dtype=int)
    places[np.triu_indices(size + 1)] = np.arange((size + 1) * (size + 2) // 2)
    return np.maximum(places, places.T)


def _table(sampler, octave, stiffness, size):
    """(M, C): what L - 1 at the nodes is multiplied with, for the upper triangle of the products of d_0 ... d_(N - 1),
    cos κ, row by row, and then for those of ê_n and κ sin κ."""
    k, weight = quadrature(octave, stiffness)
    spread = np.diag(weight) if sampler is None else few(sampler, octave, stiffness).spread
    functions = np.vstack([differences(size, k), np.cos(k)])
    sums, column = 2 / np.pi * spread, 0
    table = np.empty((len(spread), (size + 1) * (size + 2) // 2 + size))
    for m in range(size + 1):
        table[:, column : column + size + 1 - m] = (sums * functions[m]) @ functions[m:].T
        column += size + 1 - m
    table[:, column:] = (sums * (k * np.sin(k))) @ transforms(size, k).T
    return table


def transforms(size, k):
    """ê_m (N, G) at κ (G,)."""
    m = np.arange(size)[:, None]
    return (-1.0) ** m * np.sqrt(4 * m + 1) * spherical_jn(2 * m, k)


def differences(size, k):
    """d_m (N, G) at κ (G,)."""
    values = transforms(size, k)
    values[0] = k * spherical_jn(1, k)
    return values

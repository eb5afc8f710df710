"""The basis in which a smooth contact is solved, and its products with the kernel, tabulated for each octave of h/a.

On 0 <= τ <= 1, τ = t/a, the basis is e_m = sqrt(4m + 1) P_2m(τ), the even Legendre polynomials, which are orthonormal
there. With κ = ka their cosine transforms are ê_m = (-1)^m sqrt(4m + 1) j_2m(κ). Their transforms with the difference
cos κτ - cos κ of :mod:`.galerkin` are the same except for m = 0, where it is

    d_0 = sin κ/κ - cos κ = κ j_1(κ),       d_m = ê_m for m > 0.

So no digits are lost for long waves, for which the kernel of a stiff layer is large.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..body.film import step
from ..body.wave_rule import CUT, FILM, few, quadrature
from ..numerics import special
from ..numerics.caches import Cache
from ..numerics.quadrature import gauss_legendre

#: Number N of functions in the basis for each octave of h/a from 3 downwards: for shapes that are smooth in r² (True),
#: and for all others (False). Thicker layers have that of octave 3. Films have the first row for all shapes. No basis
#: resolves the edge of a film thinner than 1e-4 a: so the thinnest have fewer functions, which take less time.
_SIZES = {
    True: (6, 8, 10, 12, 16, 22, 28, 38, 52, 70, 96, 130, 130, 150, 170, 190, 190, 190, 130),
    False: (6, 8, 11, 15, 21, 28, 40, 54, 72, 100, 144, 196),
}
#: The last of these octaves: thinner films have as many functions.
LAST = 4 - len(_SIZES[True])
#: Most bytes of each cache.
_MOST = 256_000_000
_TABLES, _WAVES = Cache(_MOST), Cache(_MOST)
#: Octave of h/a below which the few nodes are not enough: they are chosen for functions that fall like 1/κ², and the
#: cos κ of the edge does not fall. A table would also be large.
_THINNEST = -4
#: The recurrence for ratios of j_n starts _MILLER (1 + N^(1/3)) orders beyond the last function.
_MILLER = 14
#: Octaves of far waves, and nodes in each. The phase of the last of N functions relative to the first changes by N²/κ
#: in the octave that begins at κ: there are _TURNS nodes more for each radian of it.
_OCTAVES, _FAR, _TURNS = 30, 12, 0.7


def size_of(octave, even):
    """The number N of functions of the basis in an octave of h/a."""
    return _SIZES[even or octave <= FILM][3 - min(max(octave, LAST), 3)]


def coarser(size):
    """The number of functions with which the result is compared, for the error."""
    return size - max(2, size // 5)


class Products(NamedTuple):
    """(2/π) ∫ (L - 1) f g dκ of B cases, for the pairs of functions f, g of κ that the equation needs.

    differences : (B, N, N), f = d_m and g = d_n
    edge : (B, N), f = d_m and g = cos κ
    corner : (B,), f = g = cos κ
    slope : (B, N), f = ê_m and g = κ sin κ
    """

    differences: np.ndarray
    edge: np.ndarray
    corner: np.ndarray
    slope: np.ndarray

    @classmethod
    def of(cls, L1, sampler, octave, stiffness, size, by_recurrence=False):
        """The products of a kernel.

        L1 : (B, M), L - 1 at :func:`wave_nodes`
        by_recurrence : see :func:`~.galerkin.respond`; it has an effect where few nodes do not determine the kernel
        """
        if not has_few(sampler, octave):
            return cls._summed(L1, octave, stiffness, size, by_recurrence)
        key = sampler, octave, stiffness, size
        flat = in_blocks(L1, _TABLES.get(key, lambda: _table(*key)))
        places = _places(size)
        count = (size + 1) * (size + 2) // 2
        return cls(flat[:, places[:-1, :-1]], flat[:, places[:-1, -1]], flat[:, places[-1, -1]], flat[:, count:])

    @classmethod
    def summed(cls, d, cosine, q):
        """The products from d_m (B, N, G), cos κ and the weighted L - 1, (B, G) each. `slope` is not computed: `edge`
        stands in its place."""
        edge = np.einsum("bng,bg->bn", d, q * cosine)
        return cls((d * q[:, None]) @ np.swapaxes(d, 1, 2), edge, (q * cosine**2).sum(axis=1), edge)

    @classmethod
    def _summed(cls, L1, octave, stiffness, size, by_recurrence):
        """The products by sums over all nodes, case by case, where a table would be too large."""
        key = octave, stiffness, size, by_recurrence
        waves = _WAVES.get(key, lambda: _waves(*key))
        near, far, count = waves.near, waves.far, waves.near.shape[1]
        out = np.empty((len(L1), size + 2, size + 2))
        for sums, values in zip(out, 2 / np.pi * waves.weight * L1, strict=True):
            sums[...] = (near * values[:count]) @ near.T
            if far.shape[1]:
                sums += ((far * values[count:]) @ far.conj().T).real / 2
        slope = out[:, -1, :size].copy()
        slope[:, 0] += out[:, -1, size]
        return cls(out[:, :size, :size], out[:, :size, size], out[:, size, size], slope)


class WaveFunctions(NamedTuple):
    """The functions d_0 ... d_(N-1), cos κ, κ sin κ at G near and G' far nodes κ.

    Far waves oscillate so often that only the means of products count. There a function is the real part of A e^iκ with
    a smooth A, and the mean of a product is half the real part of one A times the conjugate of the other.

    near : (N + 2, G), the functions
    far : (N + 2, G'), A
    weight : (G + G',), weights of the nodes
    """

    near: np.ndarray
    far: np.ndarray
    weight: np.ndarray


def wave_nodes(sampler, octave, stiffness, size):
    """κ (M,) at which L - 1 is needed in an octave of h/a and a class of stiffness, for `size` functions."""
    if octave == FILM:
        return np.concatenate([_film_rule(stiffness)[0], _far_rule(size)[0]])
    return few(sampler, octave, stiffness).k if has_few(sampler, octave) else quadrature(octave, stiffness)[0]


def has_few(sampler, octave):
    """Whether L - 1 is needed only at the few nodes."""
    return sampler is not None and octave >= _THINNEST


def _film_rule(stiffness):
    k, weight = quadrature(FILM, stiffness)
    return k, weight * step(k / CUT)


@lru_cache(maxsize=8)
def _far_rule(size):
    """Nodes and weights of the waves beyond the quadrature of films, for `size` functions: Gauss rules in log2 κ on
    each octave."""
    k, weight = [], []
    for start in CUT * 2.0 ** np.arange(-2, _OCTAVES):
        t, w = gauss_legendre(_FAR + int(_TURNS * size**2 / start))
        k.append(start * 2.0**t)
        weight.append(k[-1] * np.log(2) * w)
    k = np.concatenate(k)
    return k, np.concatenate(weight) * (1 - step(k / CUT))


def _waves(octave, stiffness, size, by_recurrence=False):
    if octave == FILM:
        k, weight = _film_rule(stiffness)
        far, far_weight = _far_rule(size)
    else:
        (k, weight), (far, far_weight) = quadrature(octave, stiffness), np.empty((2, 0))
    rows = differences_at(size, k[None])[0] if by_recurrence else differences(size, k)
    near = np.vstack([rows, np.cos(k), k * np.sin(k)])
    amplitudes = _far_by_recurrence(size, far) if by_recurrence else _far(size, far)
    if len(far):
        amplitudes[0] = -1 - 1j / far
    return WaveFunctions(near, np.vstack([amplitudes, np.ones_like(far), -1j * far]), np.append(weight, far_weight))


def _far(size, far):
    """A (N, G') of ê_m at far waves."""
    m = np.arange(size)[:, None]
    waves = special.spherical_jn(2 * m, far) + 1j * special.spherical_yn(2 * m, far)
    return (-1.0) ** m * np.sqrt(4 * m + 1) * waves * np.exp(-1j * far)


def _far_by_recurrence(size, far):
    """The same by recurrence over the order: upwards, since far waves are beyond all orders."""
    out = np.empty((size, len(far)), complex)
    before, now = 1 / far, -1j / far  # of e^iκ/κ and -i e^iκ/κ
    for n in range(2 * size - 1):
        if n % 2 == 0:
            out[n // 2] = (-1.0) ** (n // 2) * np.sqrt(2 * n + 1) * now
        before, now = now, (2 * n + 1) / far * now - before
    return out


def in_blocks(rows, matrix, block=16):
    """rows @ matrix, as products of `block` rows each, so that a row has the same result in any company."""
    padded = np.zeros((-(-len(rows) // block) * block, rows.shape[1]))
    padded[: len(rows)] = rows
    product = np.matmul(padded.reshape(-1, block, rows.shape[1]), matrix)
    return product.reshape(len(padded), -1)[: len(rows)]


@lru_cache(maxsize=64)
def _places(size):
    """(N + 1, N + 1): the place of the product of two functions in a row of a table."""
    places = np.zeros((size + 1, size + 1), dtype=int)
    places[np.triu_indices(size + 1)] = np.arange((size + 1) * (size + 2) // 2)
    return np.maximum(places, places.T)


def _table(sampler, octave, stiffness, size):
    """The matrix (M, C) that makes the products from L - 1 at the nodes: the upper triangle of those of d_0 ...
    d_(N - 1) and cos κ, row by row, and then those of ê_n and κ sin κ."""
    k, _ = quadrature(octave, stiffness)
    spread = few(sampler, octave, stiffness).spread
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
    return (-1.0) ** m * np.sqrt(4 * m + 1) * special.spherical_jn(2 * m, k)


def differences(size, k):
    """d_m (N, G) at κ (G,)."""
    values = transforms(size, k)
    values[0] = k * special.spherical_jn(1, k)
    return values


def differences_at(size, k):
    """d_m (B, N, G) at κ (B, G) > 0, by recurrence over the order n of j_n: upwards where n < κ, and beyond by ratios
    from a downward recurrence."""
    last = 2 * size + int(_MILLER * np.cbrt(size)) + _MILLER
    ratios, ratio = np.empty((2 * size, *k.shape)), np.zeros_like(k)  # j_(n+1)/j_n
    for n in reversed(range(last)):
        ratio = 1 / ((2 * n + 3) / k - ratio)
        if n < 2 * size:
            ratios[n] = ratio
    out = np.empty((len(k), size, k.shape[1]))
    before, now = np.cos(k) / k, np.sin(k) / k  # j_(-1), j_0
    for n in range(2 * size - 1):
        if n % 2 == 0:
            out[:, n // 2] = (-1.0) ** (n // 2) * np.sqrt(2 * n + 1) * now
        before, now = now, np.where(n < k, (2 * n + 1) / k * now - before, now * ratios[n])
        if n == 0:
            out[:, 0] = k * now
    return out

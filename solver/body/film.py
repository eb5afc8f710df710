"""Films far thinner than the contact: the part of the layered operator that only the edge of the contact feels.

With n' = L(cut η/2) times the half-space taken out, η = h/a, the rest L(kη) - n' is split by a smooth step χ: what lies
below k = cut (in 1/a) is summed as for any layer; beyond, the Bessel functions are plane waves, and the kernel a
convolution:

    ∫ (L(kη) - n')(1 - χ) J0(kx) J0(kx') dk ≈ c(cut |x - x'|)/sqrt(x x'),
    c(τ) = (1/π) ∫ (L(κ cut η) - n')(1 - χ) cos(κτ) dκ/κ.

What is left out is of the order cut⁻² of the effect. Inside the contact the convolution sees a smooth pressure, and
nothing of it remains. It is linear in c, so that it is tabulated like the rest.
"""

from functools import lru_cache
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
from scipy.sparse import csc_array
from scipy.special import erfc, spherical_jn

from ..numerics.quadrature import gauss_legendre, lagrange, log_rule

#: Octaves of κ = k/cut above 1 and of τ below 1; the step χ falls between κ = 1/4 and 1.
_OCTAVES = 24
#: Nodes in each half-octave of κ and in each octave of τ: under a film n times stiffer than its base, what is wrong in
#: c comes back in the pressure more than n times as large.
_KAPPA, _TAU = 14, 20
_STEP = 3.4
#: Beyond this τ the convolution is left out.
REACH = 128.0
#: Columns of a block, about; more points are taken in several.
_COLUMNS = 1536


def step(kappa):
    """χ(κ): 1 below κ = 1/4, 0 above κ = 1."""
    return erfc(_STEP * (np.log2(np.maximum(kappa, 1e-9)) + 1)) / 2


@lru_cache(maxsize=1)
def waves():
    """Nodes κ (G,) of half-octaves, τ (T,) of octaves, and the matrix (T, G) of (1/π) ∫ · cos(κτ) dκ/κ.

    The integral is exact for polynomials over κ on each panel (Filon).
    """
    t, _ = gauss_legendre(_KAPPA)
    ends = np.append(0.0, 2.0 ** np.arange(-2, _OCTAVES + 0.25, 0.5))
    low, width = ends[:-1], np.diff(ends)
    kappa = (low[:, None] + width[:, None] * t).ravel()
    stop = 2.0 ** np.arange(-_OCTAVES, np.log2(REACH) + 1)
    start = np.append(0.0, stop[:-1])
    tau = (start[:, None] + (stop - start)[:, None] * _chebyshev_nodes()).ravel()
    degree = np.arange(_KAPPA)
    legendre = np.linalg.inv(np.polynomial.legendre.legvander(2 * t - 1, _KAPPA - 1))
    bessel = spherical_jn(degree[:, None, None], tau[:, None] * width / 2)
    wave = np.real(np.exp(1j * tau[:, None] * (low + width / 2)) * (1j**degree)[:, None, None])
    matrix = np.einsum("lto,lg->tog", width * bessel * wave, legendre).reshape(len(tau), -1)
    return kappa, tau, matrix / (np.pi * kappa)


def transform(f, level, p):
    """c (b, T) at the nodes τ, from f = (L - n')(1 - χ) (b, G) at the nodes κ, which ends as 1 - n' = -level (b, 1).

    p (b, 1) is the thickness in 1/cut: the end -level (1 - e^-pκ)/κ has the transform -level ln(1 + p²/τ²)/2.
    """
    kappa, tau, matrix = waves()
    return (f - level * np.expm1(-p * kappa)) @ matrix.T - level / (2 * np.pi) * np.log1p((p / tau) ** 2)


class Convolution(NamedTuple):
    """The convolution at m points, as a matrix, of anything that is linear in c.

    `shape` is (m, n); `blocks` are points (r,) that share the octaves of τ, columns of a panel, nodes τ of these
    octaves, and what makes the entries there of c at these nodes, (nodes, r order). What is in no block is nought.
    """

    shape: tuple
    blocks: list

    @property
    def nbytes(self):
        """Size in bytes."""
        return sum(block.nbytes for *_, block in self.blocks)

    def of(self, c):
        """The matrices (b, m, n) for c (b, T)."""
        out = np.zeros((len(c), *self.shape))
        for points, columns, nodes, block in self.blocks:
            out[:, points, columns] = (c[:, nodes] @ block).reshape(len(c), len(points), -1)
        return out


def convolution(grid, points, cut):
    """The :class:`Convolution` at `points` (m,) in s, for the basis of a mesh.

    Panel by panel: a rule that runs across the ends of panels is good for smooth pressures only, and what it makes of
    the others leaves the discrete equation of a stiff film with pressures that are not there.
    """
    blocks, most = [], -(-_COLUMNS // grid.order)
    for panel, (low, high) in enumerate(pairwise(grid.breaks)):
        gap = np.maximum(low - points, points - high)  # negative inside
        shift = np.maximum(gap, 0.0) * np.where(points < low, 1, -1)
        tau, near = _tau(points, points + shift, shift, cut), gap < high - low
        octave = _octave(np.maximum(tau, 1e-99))
        for first, rule in product(np.unique(octave[tau < REACH]), (_near_rule, _plain_rule)):
            chosen = np.flatnonzero((tau < REACH) & (octave == first) & (near == (rule is _near_rule)))
            for i in range(0, len(chosen), most):
                blocks.append(_block(grid, panel, points, chosen[i : i + most], rule, cut, first))
    return Convolution((len(points), grid.n), blocks)


def _block(grid, panel, points, chosen, rule, cut, first):
    """A block of the convolution: on one panel, at the points `chosen` (r,), by a rule, from the octave `first` on."""
    own, s = slice(panel * grid.order, (panel + 1) * grid.order), points[chosen, None]
    point, shift, weight = rule(s, *grid.breaks[panel : panel + 2], grid.order)
    tau = _tau(s, point, shift, cut)
    row, used = np.nonzero((weight > 0) & (tau < REACH))
    point, tau = point[row, used], tau[row, used]
    other = np.sqrt((1 - point) * (1 + point))
    values = weight[row, used] * point / np.sqrt(other * np.sqrt((1 - s) * (1 + s))[row, 0])  # of ∫ · sqrt(x'/x) dx'
    octave, interpolation = _interpolation(tau)
    count = octave.max(initial=first) + 1 - first
    place = ((row * count + octave - first) * _TAU)[:, None] + np.arange(_TAU)
    ends = np.arange(len(tau) + 1) * _TAU
    spread = csc_array((interpolation.ravel(), place.ravel(), ends), shape=(len(chosen) * count * _TAU, len(tau)))
    block = spread @ (values[:, None] * lagrange(grid.s[own], point))
    block = block.reshape(len(chosen), count * _TAU, -1).transpose(1, 0, 2).reshape(count * _TAU, -1)
    return chosen, own, slice(first * _TAU, (first + count) * _TAU), block


def _tau(s, point, shift, cut):
    """τ = cut |x' - x| between s and s' = `point` = s + shift."""
    return cut * np.abs(shift) * (s + point) / (np.sqrt((1 - s) * (1 + s)) + np.sqrt((1 - point) * (1 + point)))


def _plain_rule(s, low, high, order):
    """Points s', shifts s' - s and weights (r, g) of ∫ · ds' over a panel farther from s (r, 1) than its length."""
    t, weight = gauss_legendre(12 + order // 2)
    point = np.broadcast_to(low + (high - low) * t, (len(s), len(t)))
    return point, point - s, np.broadcast_to((high - low) * weight, point.shape)


def _near_rule(s, low, high, order):
    """The same over a panel that contains s, or is near: for a singularity at s, no weight on a side not there."""
    distance, weight = log_rule(14 + order // 2, everywhere=True)
    parts = []
    for sign, start, stop in ((-1, np.maximum(s - high, 0.0), s - low), (1, np.maximum(low - s, 0.0), high - s)):
        length = np.maximum(stop - start, 0.0)
        parts.append((sign * (start + length * distance), length * weight))
    shift, weight = (np.concatenate(part, axis=1) for part in zip(*parts, strict=True))
    return s + shift, shift, weight


def _chebyshev_nodes():
    return (1 - np.cos(np.pi * (np.arange(_TAU) + 0.5) / _TAU)) / 2


def _octave(tau):
    """Octave of τ > 0, 0 the one that begins at 0."""
    return np.maximum(np.floor(np.log2(tau)).astype(int) + _OCTAVES + 1, 0)


def _interpolation(tau):
    """Octave (m,) of each τ (m,), and the Chebyshev basis there (m, _TAU)."""
    octave = _octave(tau)
    stop = 2.0 ** (octave - _OCTAVES)
    start = np.where(octave == 0, 0.0, stop / 2)
    distance = ((tau - start) / (stop - start))[:, None] - _chebyshev_nodes()
    distance[distance == 0] = 1e-300
    weights = (-1.0) ** np.arange(_TAU) * np.sin(np.pi * (np.arange(_TAU) + 0.5) / _TAU)
    terms = weights / distance
    return octave, terms / terms.sum(axis=1, keepdims=True)

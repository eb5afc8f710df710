"""Films far thinner than the contact: the part of the layered operator that only the edge of the contact feels.

The half-space times n' = L(cut η/2), η = h/a, is taken out. The rest, L(kη) - n', is split by a smooth step χ. What
lies below k = cut (in 1/a) is summed as for any layer; beyond, the Bessel functions are plane waves, and the kernel is
a convolution:

    ∫ (L(kη) - n')(1 - χ) J0(kx) J0(kx') dk ≈ c(cut |x - x'|)/sqrt(x x'),
    c(τ) = (1/π) ∫ (L(κ cut η) - n')(1 - χ) cos(κτ) dκ/κ.

What is left out is of the order cut⁻² of the effect. Inside the contact the convolution sees a smooth pressure, and
nothing of it remains. The convolution is linear in c, so that it is tabulated like the rest.
"""

from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebval, chebvander
from scipy.sparse import csc_array
from scipy.special import erfc, spherical_jn

from ..numerics.pieces import against, pieces
from ..numerics.quadrature import gauss_legendre, radau_nodes

#: Octaves of κ = k/cut above 1 and of τ below 1; the step χ falls between κ = 1/4 and 1.
_OCTAVES = 24
#: Nodes in each half-octave of κ and in each octave of τ: under a film n times stiffer than its base, what is wrong in
#: c comes back in the pressure more than n times as large.
_KAPPA, _TAU = 14, 20
#: Steepness of χ: it is within erfc(_STEP)/2, below 1e-6, of 1 at κ = 1/4 and of 0 at κ = 1.
_STEP = 3.4
#: Beyond this τ the convolution is left out.
REACH = 128.0
#: Up to this τ c is smooth, except at 0. Beyond, it swings with the period of the step, and it ends at REACH: a panel
#: there needs as many points as one that contains the target (tests/body/test_work.py).
_SMOOTH = 12.0
#: From so many cases on their matrices are products with one table.
MANY = 8


def step(kappa):
    """χ(κ): 1 below κ = 1/4, 0 above κ = 1, to 1e-6."""
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


class Share(NamedTuple):
    """The part of a convolution of r pairs of a point and a panel, `row` and `panel` (r,). At the g points of the rule
    of each pair: the `weight` of c (r, g), and the basis of the panel, `columns` (r or 1, g, order)."""

    row: np.ndarray
    panel: np.ndarray
    weight: np.ndarray
    columns: np.ndarray


class Convolution(NamedTuple):
    """The convolution at m points: a matrix, as a linear function of c.

    `shape` is (m, p, order), of p panels; `shares` are all :class:`Share` that are not zero. The N points of all their
    rules are sorted by octaves of τ: `place` (N,) is the place of each among the points of all shares, `local` (N,)
    where it is in its octave, from -1 to 1; `ends` are the ends of the octaves in both.
    """

    shape: tuple
    shares: list
    place: np.ndarray
    local: np.ndarray
    ends: list

    def of(self, c):
        """The matrices (b, m, n) for c (b, T)."""
        size = len(c), self.shape[0], self.shape[1] * self.shape[2]
        out, values = np.zeros((len(c), *self.shape)), np.empty((len(c), len(self.place)))
        series = _series() @ c.reshape(len(c), -1, _TAU, 1)
        for octave, (low, high) in enumerate(pairwise(self.ends)):
            values[:, self.place[low:high]] = chebval(self.local[low:high], series[:, octave, :, 0].T)
        for share, rows in self._parts():
            for one, value in zip(out, values[:, rows], strict=True):
                one[share.row, share.panel] += against(share.weight * value.reshape(share.weight.shape), share.columns)
        return out.reshape(size)

    def whole(self):
        """The same as a :class:`Whole`."""
        m, panels, order = self.shape
        count, first = len(waves()[1]), np.repeat(np.arange(len(self.ends) - 1) * _TAU, np.diff(self.ends))
        back = np.argsort(self.place)
        first, basis = first[back], (chebvander(self.local, _TAU - 1) @ _series())[back]
        out = np.zeros((count, m, panels, order))
        for (row, panel, weight, columns), rows in self._parts():
            pair = np.arange(len(row)).repeat(weight.shape[1]) * count
            place = (pair + first[rows])[:, None] + np.arange(_TAU)
            shape, ends = (len(row) * count, weight.size), np.arange(weight.size + 1) * _TAU
            spread = csc_array((basis[rows].ravel(), place.ravel(), ends), shape=shape)
            own = spread @ (weight[..., None] * columns).reshape(weight.size, order)
            out[:, row, panel] += own.reshape(len(row), count, order).transpose(1, 0, 2)
        return Whole((m, panels * order), out.reshape(count, -1))

    def _parts(self):
        """Pairs of a share and the slice of its points among those of all shares."""
        end = 0
        for share in self.shares:
            begin, end = end, end + share.weight.size
            yield share, slice(begin, end)


class Whole(NamedTuple):
    """A :class:`Convolution` at m points for many c together: the matrices of all unit vectors c, `table` (T, m n);
    `shape` is (m, n)."""

    shape: tuple
    table: np.ndarray

    def of(self, c):
        """The matrices (b, m, n) for c (b, T)."""
        return (c @ self.table).reshape(len(c), *self.shape)


def convolution(grid, points, cut):
    """The :class:`Convolution` at `points` (m,) in s, for the basis of a mesh.

    Panel by panel: a rule that runs across the ends of panels is right for smooth pressures only. What it makes of
    others would let the discrete equation of a stiff film have false solutions.
    """
    low, high = np.array(grid.breaks[:-1]), np.array(grid.breaks[1:])
    s = points[:, None]
    nearest = np.clip(s, low, high)
    farthest, shares, taus = np.where(s - low > high - s, low, high), [], []
    within, rough = _tau(s, nearest, nearest - s, cut) < REACH, _tau(s, farthest, farthest - s, cut) > _SMOOTH
    for piece in pieces(points, grid.breaks, grid.order, within, rough):
        s = points[piece.row, None]
        point = s + piece.sign * piece.gap
        tau = _tau(s, point, piece.gap, cut)
        felt = np.flatnonzero((tau < REACH).any(axis=0))
        point, tau, weight = (v[:, felt] for v in (point, tau, piece.weight))
        other = np.sqrt((1 - point) * (1 + point))
        values = weight * point / np.sqrt(other * np.sqrt((1 - s) * (1 + s)))  # of ∫ · sqrt(x'/x) dx'
        values, tau = np.where(tau < REACH, values, 0.0), np.where(tau < REACH, tau, 1.0)
        columns = piece._replace(local=piece.local[:, felt]).basis(radau_nodes(grid.order))
        shares.append(Share(piece.row, piece.panel, values, columns))
        taus.append(tau.ravel())
    return Convolution((len(points), len(low), grid.order), shares, *_in_octaves(np.concatenate([[], *taus])))


def _tau(s, point, shift, cut):
    """τ = cut |x' - x| between s and s' = `point` = s + shift."""
    return cut * np.abs(shift) * (s + point) / (np.sqrt((1 - s) * (1 + s)) + np.sqrt((1 - point) * (1 + point)))


def _chebyshev_nodes():
    return (1 - np.cos(np.pi * (np.arange(_TAU) + 0.5) / _TAU)) / 2


def _in_octaves(tau):
    """Of τ > 0 (N,), octave by octave: their places (N,), where in their octave they are, from -1 to 1 (N,), and the
    ends of the octaves. The first octave begins at 0."""
    octave = np.maximum(np.floor(np.log2(tau)) + (_OCTAVES + 1), 0).astype(np.int8)
    place = np.argsort(octave, kind="stable")
    octave = octave[place]
    stop = 2.0 ** (octave.astype(float) - _OCTAVES)
    start = np.where(octave == 0, 0.0, stop / 2)
    ends = np.searchsorted(octave, np.arange(len(waves()[1]) // _TAU + 1)).tolist()
    return place, 2 * (tau[place] - start) / (stop - start) - 1, ends


@lru_cache(maxsize=1)
def _series():
    """The matrix (_TAU, _TAU) from values at the nodes of an octave to the coefficients of its Chebyshev series."""
    return np.linalg.inv(chebvander(2 * _chebyshev_nodes() - 1, _TAU - 1))

"""Films, layers far thinner than the contact: the part of the operator that only the edge of the contact feels.

k is in 1/a, and cut is the largest k of the quadrature that all films share (CUT of :mod:`.wave_rule`). The constant
n' = L(cut h/2a) is subtracted from L(kh/a): it acts as n' times a half-space. The rest, L(kh/a) - n', is split by a
smooth step χ, which falls from 1 to 0 below k = cut. χ (L - n') is integrated over k as for any layer. In
(1 - χ)(L - n') the Bessel functions are plane waves, and the kernel is a convolution: with κ = k/cut and
τ = cut |x - x'|,

    ∫ (L(kh/a) - n')(1 - χ) J0(kx) J0(kx') dk ≈ c(τ)/sqrt(x x'),
    c(τ) = (1/π) ∫ (L(κ cut h/a) - n')(1 - χ) cos(κτ) dκ/κ.

The relative error of this approximation is of the order cut⁻². Inside the contact, where the pressure is smooth, the
convolution vanishes. It is linear in c, and so it is tabulated like the rest.
"""

from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebval, chebvander

from ..numerics import special
from ..numerics.quadrature import against, gauss_legendre, pieces, radau_nodes

#: Number of octaves of κ above 1, and of τ below 1.
_OCTAVES = 24
#: Nodes in each half-octave of κ and in each octave of τ. They must be many: if a film is n times stiffer than its
#: base, an error of c becomes an error of the pressure that is more than n times as large.
_KAPPA, _TAU = 14, 20
#: Steepness of χ. At κ = 1/4 it differs from 1, and at κ = 1 from 0, by erfc(_STEP)/2, below 1e-6.
_STEP = 3.4
#: Beyond this τ the convolution is left out.
REACH = 128.0
#: c is smooth for τ up to this, except at 0. From there up to REACH it oscillates with the period of the step. A panel
#: there needs as many points as a panel that contains the target (tests/body/test_work.py).
_SMOOTH = 12.0
#: From this many cases on, their matrices are products with one table.
MANY = 8
#: The Chebyshev nodes of an octave, from 0 to 1; and the matrix (_TAU, _TAU) that makes the coefficients of a Chebyshev
#: series from values at the nodes.
_NODES = (1 - np.cos(np.pi * (np.arange(_TAU) + 0.5) / _TAU)) / 2
_SERIES = np.linalg.inv(chebvander(2 * _NODES - 1, _TAU - 1))


def step(kappa):
    """χ(κ). To 1e-6 it is 1 below κ = 1/4 and 0 above κ = 1."""
    return special.erfc(_STEP * (np.log2(np.maximum(kappa, 1e-9)) + 1)) / 2


@lru_cache(maxsize=1)
def waves():
    """Nodes κ (G,) of the half-octaves, nodes τ (T,) of the octaves, and the matrix (T, G) of (1/π) ∫ · cos(κτ) dκ/κ.

    The integral is exact for functions that, divided by κ, are a polynomial on each half-octave (Filon's rule).
    """
    t, _ = gauss_legendre(_KAPPA)
    ends = np.append(0.0, 2.0 ** np.arange(-2, _OCTAVES + 0.25, 0.5))
    low, width = ends[:-1], np.diff(ends)
    kappa = (low[:, None] + width[:, None] * t).ravel()
    stop = 2.0 ** np.arange(-_OCTAVES, np.log2(REACH) + 1)
    start = np.append(0.0, stop[:-1])
    tau = (start[:, None] + (stop - start)[:, None] * _NODES).ravel()
    degree = np.arange(_KAPPA)
    legendre = np.linalg.inv(np.polynomial.legendre.legvander(2 * t - 1, _KAPPA - 1))
    bessel = special.spherical_jn(degree[:, None, None], tau[:, None] * width / 2)
    wave = np.real(np.exp(1j * tau[:, None] * (low + width / 2)) * (1j**degree)[:, None, None])
    matrix = np.einsum("lto,lg->tog", width * bessel * wave, legendre).reshape(len(tau), -1)
    return kappa, tau, matrix / (np.pi * kappa)


def transform(f, end, p):
    """c (b, T) at the nodes τ, from f = (L - n')(1 - χ) (b, G) at the nodes κ. f tends to 1 - n' = -`end` (b, 1).

    p (b, 1) is the thickness in a/cut. -end (1 - e^-pκ) is subtracted from f, so that the rest tends to 0, and its
    transform, -end ln(1 + p²/τ²)/(2π), is added.
    """
    kappa, tau, matrix = waves()
    return (f - end * np.expm1(-p * kappa)) @ matrix.T - end / (2 * np.pi) * np.log1p((p / tau) ** 2)


class Share(NamedTuple):
    """The contribution to a convolution of r pairs of a target and a panel, `row` and `panel` (r,). Each pair has a
    rule of g points. `weight` (r, g) is the weight of c at these points, and `columns` (r or 1, g, order) is the basis
    of the panel there."""

    row: np.ndarray
    panel: np.ndarray
    weight: np.ndarray
    columns: np.ndarray


class Convolution(NamedTuple):
    """The convolution at m points as a linear function of c: for each c a matrix (m, n).

    `shape` is (m, p, order), for p panels; `shares` has each :class:`Share` that is not zero. The N points of all their
    rules are sorted by octaves of τ. `place` (N,) is the index of a point before they were sorted, and `local` (N,) its
    place in its octave, from -1 to 1. In both arrays, octave i begins at ends[i].
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
        series = _SERIES @ c.reshape(len(c), -1, _TAU, 1)
        for octave, (low, high) in enumerate(pairwise(self.ends)):
            values[:, self.place[low:high]] = chebval(self.local[low:high], series[:, octave, :, 0].T)
        for share, rows in self._parts():
            for matrix, at_points in zip(out, values[:, rows], strict=True):
                matrix[share.row, share.panel] += against(
                    share.weight * at_points.reshape(share.weight.shape), share.columns
                )
        return out.reshape(size)

    def whole(self):
        """The same convolution as a :class:`Whole`."""
        m, panels, order = self.shape
        from scipy.sparse import csc_array  # imported here: it takes a while, and few contacts are on films

        count, first = len(waves()[1]), np.repeat(np.arange(len(self.ends) - 1) * _TAU, np.diff(self.ends))
        back = np.argsort(self.place)
        first, basis = first[back], (chebvander(self.local, _TAU - 1) @ _SERIES)[back]
        out = np.zeros((count, m, panels, order))
        for (row, panel, weight, columns), rows in self._parts():
            pair = np.arange(len(row)).repeat(weight.shape[1]) * count
            place = (pair + first[rows])[:, None] + np.arange(_TAU)
            shape, ends = (len(row) * count, weight.size), np.arange(weight.size + 1) * _TAU
            spread = csc_array((basis[rows].ravel(), place.ravel(), ends), shape=shape)
            added = spread @ (weight[..., None] * columns).reshape(weight.size, order)
            out[:, row, panel] += added.reshape(len(row), count, order).transpose(1, 0, 2)
        return Whole((m, panels * order), out.reshape(count, -1))

    def _parts(self):
        """Yield each share with the slice of its points among the points of all shares."""
        end = 0
        for share in self.shares:
            begin, end = end, end + share.weight.size
            yield share, slice(begin, end)


class Whole(NamedTuple):
    """A :class:`Convolution` at m points for many c. `table` (T, m n) has a row for each node of τ: the matrix of the c
    that is 1 at this node and 0 at the others. `shape` is (m, n)."""

    shape: tuple
    table: np.ndarray

    def of(self, c):
        """The matrices (b, m, n) for c (b, T)."""
        return (c @ self.table).reshape(len(c), *self.shape)


def convolution(mesh, points, cut):
    """The :class:`Convolution` at `points` (m,) in s, for the basis of a mesh.

    Each panel has rules of its own. A rule across the ends of panels would be right only for smooth pressures, and the
    discrete equation of a stiff film would have false solutions.
    """
    low, high = np.array(mesh.breaks[:-1]), np.array(mesh.breaks[1:])
    s = points[:, None]
    nearest = np.clip(s, low, high)
    farthest, shares, taus = np.where(s - low > high - s, low, high), [], []
    within, swings = _tau(s, nearest, nearest - s, cut) < REACH, _tau(s, farthest, farthest - s, cut) > _SMOOTH
    for piece in pieces(points, mesh.breaks, mesh.order, within, swings):
        s = points[piece.row, None]
        point = s + piece.sign * piece.gap
        tau = _tau(s, point, piece.gap, cut)
        felt = np.flatnonzero((tau < REACH).any(axis=0))
        point, tau, weight = (v[:, felt] for v in (point, tau, piece.weight))
        other = np.sqrt((1 - point) * (1 + point))
        values = weight * point / np.sqrt(other * np.sqrt((1 - s) * (1 + s)))  # of ∫ · sqrt(x'/x) dx'
        values, tau = np.where(tau < REACH, values, 0.0), np.where(tau < REACH, tau, 1.0)
        columns = piece._replace(local=piece.local[:, felt]).basis(radau_nodes(mesh.order))
        shares.append(Share(piece.row, piece.panel, values, columns))
        taus.append(tau.ravel())
    return Convolution((len(points), len(low), mesh.order), shares, *_in_octaves(np.concatenate([[], *taus])))


def _tau(s, point, shift, cut):
    """τ = cut |x' - x| between s and s' = `point` = s + shift."""
    return cut * np.abs(shift) * (s + point) / (np.sqrt((1 - s) * (1 + s)) + np.sqrt((1 - point) * (1 + point)))


def _in_octaves(tau):
    """`place`, `local` and `ends` of a :class:`Convolution` for τ > 0 (N,). The first octave begins at 0."""
    octave = np.maximum(np.floor(np.log2(tau)) + (_OCTAVES + 1), 0).astype(np.int8)
    place = np.argsort(octave, kind="stable")
    octave = octave[place]
    stop = 2.0 ** (octave.astype(float) - _OCTAVES)
    start = np.where(octave == 0, 0.0, stop / 2)
    ends = np.searchsorted(octave, np.arange(len(waves()[1]) // _TAU + 1)).tolist()
    return place, 2 * (tau[place] - start) / (stop - start) - 1, ends

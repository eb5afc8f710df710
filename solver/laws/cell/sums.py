"""Sums over a lattice of spots: the part of the neighbours in the kernel of a spot, and the waves of the lattice.

Lengths are in units of the pitch l = 1/sqrt(Nbar). On a half-space the spots of the lattice, except the one at the
origin, and less the uniform pressure, move the surface at x = t + s or t - s by

    M(x) = sum over R != 0 of (R² - x²)^(-1/2),   x < d, the distance of neighbours,

from which the uniform pressure removes the divergent part. The shells up to 3 d are summed in closed form, the others
by their series in x². Its coefficients are C(2j, j)/4^j times sums of |R|^-(2j + 1), which zeta functions give.
"""

from functools import cache, lru_cache
from typing import NamedTuple

import numpy as np

from ...numerics import special
from ...numerics.quadrature import gauss_legendre

__all__ = ["LATTICES", "CellWaves", "lattice_waves", "lone_waves", "neighbours", "waves"]

#: Distance d of neighbours over l.
LATTICES = {"square": 1.0, "hex": (4 / 3) ** 0.25}
#: The sum of 1/|R| in the unit 1/d, without its divergent part: the analytic continuation of zeta functions, which
#: scipy does not have.
_FIRST = {"square": -3.90026492000195588284547533661, "hex": -4.21342263613690689002954627586}
#: Shells up to this many d have the closed form; for the others, this many terms of the series are enough up to
#: x = 0.997 d.
_NEAR, _TERMS = 3, 60
#: Waves above u = Gh = CUT feel only the layer. Without them p_max changes by 1e-11, p and A by less.
CUT = 19.0
#: From the pitch over h SPLIT on, only the waves of the lattice up to _WIDTHS D are summed, where D is the width of the
#: split, and an integral stands for the others: its difference from the sum decays as a Gaussian
#: (tests/laws/cell/test_rows.py). The middle of the split, k0, is _MIDDLE D.
SPLIT, _MIDDLE, _WIDTHS = 30.0, 6.0, 12.0
#: Points on each panel of the integral, and three limits of the width of a panel in k: times h, times the largest
#: radius, and over D.
_POINTS, _PANEL = 16, (0.6, 4.0, 1.0)
#: Number of panels towards k = 0, each half as wide as the one before: the kernel of a plate of n = 1e3 changes at u =
#: 1e-3.
_HALVINGS = 24


class CellWaves(NamedTuple):
    """Waves k (W,), in 1/l, and weights c (W,), with which the layer adds K(x) = sum c (L(kh) - 1) cos kx."""

    k: np.ndarray
    c: np.ndarray


@lru_cache(maxsize=64)  # each pitch over h has its own shells
def _shells(lattice, most):
    """Squares of the distances up to `most`, and the number of lattice points at each. The unit of length is the
    smallest distance."""
    i = np.arange(-int(1.16 * most) - 2, int(1.16 * most) + 3)
    square = (i * i)[:, None] + i * i + (np.outer(i, i) if lattice == "hex" else 0)
    return np.unique(square[(square > 0) & (square <= most**2 * (1 + 1e-12))], return_counts=True)


@cache
def _series(lattice):
    """Coefficients (_TERMS,) of M - (shells up to _NEAR) as a series in (x/d)², in the unit 1/d."""
    j = np.arange(1, _TERMS)
    s = j + 0.5
    if lattice == "square":
        sums = 4 * special.zeta(s) * 4.0**-s * (special.zeta(s, 0.25) - special.zeta(s, 0.75))
    else:
        sums = 6 * special.zeta(s) * 3.0**-s * (special.zeta(s, 1 / 3) - special.zeta(s, 2 / 3))
    sums = np.append(_FIRST[lattice], sums)
    square, count = _shells(lattice, _NEAR)
    near = (count * square ** -(np.arange(_TERMS)[:, None] + 0.5)).sum(axis=1)
    return np.append(1.0, np.cumprod((2 * j - 1) / (2 * j))) * (sums - near)


def neighbours(lattice, x):
    """M(x), in 1/l, and dM/dx, in 1/l², at x of any shape, 0 <= x < d."""
    d = LATTICES[lattice]
    z, value, slope = (x / d) ** 2, np.zeros_like(x), np.zeros_like(x)
    for coefficient in _series(lattice)[::-1]:
        slope = slope * z + value
        value = value * z + coefficient
    slope = 2 * slope
    for square, count in zip(*_shells(lattice, _NEAR), strict=True):
        root = 1 / np.sqrt(square - z)
        value, slope = value + count * root, slope + count * root**3
    return value / d, slope * (x / d) / d**2


@lru_cache(maxsize=32)
def waves(lattice, pitch, reach):
    """:class:`CellWaves` of a lattice on a layer of h = l/`pitch`, for x up to twice the radius `reach` (in l).

    Up to the pitch SPLIT they are the waves of the lattice. Beyond, the number of these would grow as the square of the
    pitch. There they are weighted by w(k) = erfc((k - k0)/D)/2, and an integral over k with the weight 1 - w stands for
    the rest.
    """
    k, c = _split(lattice, CUT * pitch, 2 * reach, pitch < SPLIT)
    return CellWaves(k, c / k)


@lru_cache(maxsize=32)
def lone_waves(pitch, reach):
    """:class:`CellWaves` of a lone spot on a layer of h = l/`pitch`: sum c f(k) is the integral of f over all k up to
    kh = CUT. f may vary as L does, and as cos kx for x up to 2 `reach`."""
    widest = min(_PANEL[0], _PANEL[1] / (reach * pitch))
    even = np.linspace(widest, CUT, max(2, int(np.ceil((CUT - widest) / widest)) + 1))
    edges = np.concatenate([[0.0], widest * 0.5 ** np.arange(_HALVINGS, 0, -1.0), even])
    nodes, weights = gauss_legendre(_POINTS)
    width = np.diff(edges)[:, None]
    return CellWaves((edges[:-1, None] + width * nodes).ravel() * pitch, (width * weights).ravel() * pitch)


@lru_cache(maxsize=32)
def lattice_waves(lattice, most, reach):
    """Waves k (W,) up to `most` and weights c. sum c f(k) is 2 pi times the sum of f over the waves of the lattice, if
    the transform of f vanishes at distances above `reach`.

    most : 0 stands for only the long waves of the split, with their weight w
    """
    width = 12 / (LATTICES[lattice] - reach)
    return _split(lattice, most, reach, 0 < most < _WIDTHS * width, most == 0)


def _split(lattice, most, reach, plain, long_alone=False):
    """As :func:`lattice_waves`. `plain`: all waves of the lattice, without an integral. `long_alone`: only the long
    waves of the split."""
    first = 2 * np.pi / LATTICES[lattice] * (1 if lattice == "square" else 2 / np.sqrt(3))
    if plain:
        square, count = _shells(lattice, most / first)
        return first * np.sqrt(square), 2 * np.pi * count
    D = 12 / (LATTICES[lattice] - reach)
    square, count = _shells(lattice, _WIDTHS * D / first)
    k = first * np.sqrt(square)
    low = 2 * np.pi * count * special.erfc((k - _MIDDLE * D) / D) / 2
    if long_alone:
        return k, low
    most = max(most, 2 * _WIDTHS * D)
    panels = int(np.ceil(most / min(_PANEL[0] * most / CUT, _PANEL[1] * 2 / reach, _PANEL[2] * D)))
    nodes, weights = gauss_legendre(_POINTS)
    between = ((np.arange(panels)[:, None] + nodes) * (most / panels)).ravel()
    high = special.erfc((_MIDDLE * D - between) / D) / 2
    rest = np.tile(weights * (most / panels), panels) * high * between
    return np.append(k, between), np.append(low, rest)

"""Sums over a lattice of spots: the part of the neighbours in the kernel of a spot, and the waves of the lattice.

In units of the pitch l = 1/sqrt(Nbar). On a half-space the spots of the lattice, without the one at the origin and
without the uniform pressure, move the surface at x = t + s or t - s by

    M(x) = sum over R != 0 of (R² - x²)^(-1/2),   x < d, the distance of neighbours,

whose divergent part the uniform pressure takes away. The shells up to 3 d are summed in closed form, the others by
their series in x², with the coefficients C(2j, j)/4^j times sums of |R|^-(2j + 1) by the zeta functions.
"""

from functools import cache, lru_cache
from typing import NamedTuple

import numpy as np

from ...numerics import special
from ...numerics.quadrature import gauss_legendre

__all__ = ["LATTICES", "CellWaves", "lattice_waves", "lone_waves", "neighbours", "waves"]

#: Distance d of neighbours over l.
LATTICES = {"square": 1.0, "hex": (4 / 3) ** 0.25}
#: The sum of 1/|R| in the unit of d, without its divergent part: the zeta functions continue it, which scipy's do not.
_FIRST = {"square": -3.90026492000195588284547533661, "hex": -4.21342263613690689002954627586}
#: Shells up to this many d have the closed form; so many terms of the series serve the rest up to x = 0.997 d.
_NEAR, _TERMS = 3, 60
#: Waves above u = Gh = CUT feel the layer alone: they leave out 1e-11 of p_max, and less of p and A (CELL.md: 17).
CUT = 19.0
#: From this pitch over h on the waves of the lattice are summed up to _WIDTHS widths D of the split alone, and an
#: integral stands for the others: its difference from the sum decays as a Gaussian (tests/laws/cell/test_rows.py).
SPLIT, _MIDDLE, _WIDTHS = 30.0, 6.0, 12.0
#: Points on each panel of the integral, and the widest panel: in units of h, over the largest radius, and over D.
_POINTS, _PANEL = 16, (0.6, 4.0, 1.0)
#: Panels towards k = 0, each half as wide as the one before: a plate of n = 1e3 has its kernel change at u = 1e-3.
_HALVINGS = 24


class CellWaves(NamedTuple):
    """Waves k (W,), in 1/l, and weights c (W,): the layer adds K(x) = sum c (L(kh) - 1) cos kx."""

    k: np.ndarray
    c: np.ndarray


@lru_cache(maxsize=64)  # each pitch over h has its own
def _shells(lattice, most):
    """Squares of the distances up to `most` times the least, in its unit, and how many points have each."""
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
    """M(x) and dM/dx at x of any shape, 0 <= x < d; in 1/l and 1/l²."""
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

    Up to the pitch SPLIT they are those of the lattice. Beyond, their number would grow as its square: there they are
    weighted by w(k) = erfc((k - k0)/D)/2, and an integral over k with the weight 1 - w stands for the rest.
    """
    k, c = _split(lattice, CUT * pitch, 2 * reach, pitch < SPLIT)
    return CellWaves(k, c / k)


@lru_cache(maxsize=32)
def lone_waves(pitch, reach):
    """:class:`CellWaves` of one spot alone on a layer of h = l/`pitch`: sum c f(k) is the integral over all k up to
    CUT, of an f that changes as L does and as cos kx up to x = 2 `reach`."""
    widest = min(_PANEL[0], _PANEL[1] / (reach * pitch))
    even = np.linspace(widest, CUT, max(2, int(np.ceil((CUT - widest) / widest)) + 1))
    edges = np.concatenate([[0.0], widest * 0.5 ** np.arange(_HALVINGS, 0, -1.0), even])
    nodes, weights = gauss_legendre(_POINTS)
    width = np.diff(edges)[:, None]
    return CellWaves((edges[:-1, None] + width * nodes).ravel() * pitch, (width * weights).ravel() * pitch)


@lru_cache(maxsize=32)
def lattice_waves(lattice, most, reach):
    """Waves k (W,) up to `most` and weights c: sum c f(k) is 2 pi times the sum of f over the waves of the lattice, of
    a function f that does not act farther than `reach` beside a point.

    most : 0 stands for the long waves of the split alone, with their weight w
    """
    width = 12 / (LATTICES[lattice] - reach)
    return _split(lattice, most, reach, 0 < most < _WIDTHS * width, most == 0)


def _split(lattice, most, reach, plain, long_alone=False):
    """As :func:`lattice_waves`; `plain` : all waves of the lattice, and no integral."""
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

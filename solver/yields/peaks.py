"""The largest value of a function of the stresses of one case, near a point: patches that shrink about it."""

from functools import lru_cache

import numpy as np

#: Nodes of a patch in each direction (Chebyshev's, with both ends), and points between which the polynomials through
#: them are searched.
_NODES, _POINTS = 7, 33
#: A patch shrinks so much once the largest value is inside it, until that has changed by less than _SAME of itself,
#: which is far below the 1e-6 that is promised; or until a patch is smaller than _SMALLEST. It moves or shrinks at most
#: _MOST times (tests/yields/test_largest_stresses.py).
_SHRINK, _SAME, _SMALLEST, _MOST = 5.0, 1e-9, 1e-7, 40


def peak(stresses, value, start, half, region):
    """The largest value, and its place (u, v).

    stresses : ``stresses(u, v)`` at u (U,) and v (V,), (4, V, U)
    value : ``value(sr, st, sz, trz)``, elementwise
    start, half : (u, v), the centre of the first patch and half of its widths
    region : ((least u, largest u), (least v, largest v)); the same twice is a line
    """
    centre, half, (low, high) = np.array(start, dtype=float), np.array(half, dtype=float), np.array(region).T
    before = np.nan
    for _ in range(_MOST):
        ends = np.maximum(centre - half, low), np.minimum(centre + half, high)
        axes = [_on(*end, chebyshev_nodes(_NODES)) if end[1] > end[0] else end[:1] for end in zip(*ends, strict=True)]
        largest, place = in_patch(stresses(*axes), value)
        centre = np.array([_on(*end, p) for *end, p in zip(*ends, place, strict=True)])
        outside = (np.abs(place) == 1) & (centre > low) & (centre < high)
        if not np.isfinite(largest) or (not outside.any() and abs(largest - before) <= _SAME * abs(largest)):
            break
        before = largest
        if not outside.any():
            half = half / _SHRINK
        if np.all(half < _SMALLEST):
            break
    return largest, centre


def _on(low, high, place):
    """What is at `place` in [-1, 1] of an interval."""
    return np.where(place == 1, high, low + (high - low) * (1 + place) / 2)


@lru_cache(maxsize=8)
def chebyshev_nodes(count):
    """Chebyshev's nodes in [-1, 1], with both ends."""
    return -np.cos(np.pi * np.arange(count) / (count - 1))


@lru_cache(maxsize=8)
def _inverse(count):
    return np.linalg.inv(np.polynomial.chebyshev.chebvander(chebyshev_nodes(count), count - 1))


def between(points, count):
    """From values at the nodes to those at points in [-1, 1] of the polynomial through them."""
    return np.polynomial.chebyshev.chebvander(points, count - 1) @ _inverse(count)


def in_patch(values, value):
    """The largest value, and its place (u, v) in [-1, 1], of polynomials through stresses (4, V, U) at the nodes."""
    centre, half = np.zeros(2), 1.0
    for _ in range(4):
        points = [np.clip(c + half * np.linspace(-1, 1, _POINTS), -1, 1) for c in centre]
        u, v = (between(p, n) if n > 1 else np.ones((1, 1)) for p, n in zip(points, values.shape[:0:-1], strict=True))
        made = value(*(v @ values @ u.T))
        if not np.all(np.isfinite(made)):
            return np.nan, centre
        row, column = np.unravel_index(np.argmax(made), made.shape)
        place = [p[i] if m.shape[0] > 1 else 0.0 for p, i, m in zip(points, (column, row), (u, v), strict=True)]
        centre, half = np.array(place), half * 4 / _POINTS
    return made[row, column], centre

"""The largest value of a function of the stresses of one case in a patch, of polynomials through its nodes."""

from functools import lru_cache

import numpy as np

#: Points between Chebyshev nodes among which polynomials through them are searched.
_POINTS = 33


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

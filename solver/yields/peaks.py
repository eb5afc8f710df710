"""The largest value of a function of the stresses of one case in a patch, by polynomials through its nodes."""

from functools import lru_cache

import numpy as np

#: Points between Chebyshev nodes among which polynomials through them are searched.
_POINTS = 33


@lru_cache(maxsize=8)
def chebyshev_nodes(count):
    """Chebyshev's nodes in [-1, 1]; both ends are nodes."""
    return -np.cos(np.pi * np.arange(count) / (count - 1))


@lru_cache(maxsize=8)
def _inverse(count):
    return np.linalg.inv(np.polynomial.chebyshev.chebvander(chebyshev_nodes(count), count - 1))


def between(points, count):
    """The matrix that makes values of a polynomial at points in [-1, 1] from its values at the nodes."""
    return np.polynomial.chebyshev.chebvander(points, count - 1) @ _inverse(count)


def in_patch(values, value):
    """The largest value, and its place (u, v) in [-1, 1], of polynomials through stresses (4, V, U) at the nodes."""
    centre, half = np.zeros(2), 1.0
    for _ in range(4):
        points = [np.clip(c + half * np.linspace(-1, 1, _POINTS), -1, 1) for c in centre]
        u, v = (between(p, n) if n > 1 else np.ones((1, 1)) for p, n in zip(points, values.shape[:0:-1], strict=True))
        on_grid = value(*(v @ values @ u.T))
        if not np.all(np.isfinite(on_grid)):
            return np.nan, centre
        row, column = np.unravel_index(np.argmax(on_grid), on_grid.shape)
        place = [p[i] if m.shape[0] > 1 else 0.0 for p, i, m in zip(points, (column, row), (u, v), strict=True)]
        centre, half = np.array(place), half * 4 / _POINTS
    return on_grid[row, column], centre

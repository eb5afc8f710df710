"""The sphere f = 1 - sqrt(1 - r²), in R: the ball itself, unlike the paraboloid, which is its shape near the axis."""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from .shape import Kind, column, no_kinks

#: If a is below _SERIES, artanh(a) - a is the sum of its series, Σ a^(2j + 1)/(2j + 1), j = 1 to _TERMS - 1.
_SERIES, _TERMS = 0.3, 16


@batch.of_cases
class Sphere(NamedTuple):
    """The :class:`~.shape.Shape` of balls, one for each entry of `ones` (B,)."""

    ones: np.ndarray

    @property
    def pointed(self):
        return self.ones < 0

    @property
    def even(self):
        return self.ones > 0

    def height(self, r):
        return r**2 / (1 + _side(r))

    def slope(self, r):
        return r / _side(r)

    def lifted(self, t):
        return t * np.arctanh(t)

    def lifted_slope(self, t):
        return np.arctanh(t) + t / ((1 - t) * (1 + t))

    def lifted_load(self, a):
        rest = np.where(a < _SERIES, _series(a), np.arctanh(a) - a)
        return (rest + a**2 * np.arctanh(a)) / 2

    def drop(self, a, s):
        # 1 - r² = (1 - a²) + a² s²
        edge = _side(column(a))
        return 2 * s**2 / (edge + np.sqrt(edge**2 + (column(a) * s) ** 2))

    def kinks(self):
        return no_kinks(self.ones)

    def least(self):
        return 0 * self.ones

    def most(self):
        return 1 * self.ones


def _side(r):
    """sqrt(1 - r²); NaN beyond the equator."""
    return np.sqrt((1 - r) * (1 + r))


def _series(a):
    """artanh(a) - a, by its series."""
    total = np.zeros_like(a)
    for j in reversed(range(1, _TERMS)):
        total = a**2 * (1 / (2 * j + 1) + total)
    return a * total


KIND = Kind("sphere", {}, lambda size: Sphere(np.ones(size)), "a ball of radius R", round=True)

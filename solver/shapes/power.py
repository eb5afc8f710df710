"""The power f = c r^k, k >= 1."""

from math import lgamma
from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..parameters import Parameter
from .shape import Kind, column, no_kinks

#: The exponent k, and the coefficient c of f/R = c (r/R)^k, a pure number.
SHAPE_POWER, SHAPE_COEFFICIENT = Parameter(interval="[1, 100]"), Parameter(interval="[1e-12, 1e12]")


@batch.of_cases
class Power(NamedTuple):
    """The :class:`~.shape.Shape` of powers with coefficients c and exponents k, (B,); `B` (B,) is F/f."""

    c: np.ndarray
    k: np.ndarray
    B: np.ndarray

    @property
    def pointed(self):
        return self.k == 1

    @property
    def even(self):
        return self.k % 2 == 0

    def height(self, r):
        return column(self.c) * r ** column(self.k)

    def slope(self, r):
        return column(self.c * self.k) * r ** column(self.k - 1)

    def lifted(self, t):
        return column(self.B) * self.height(t)

    def lifted_slope(self, t):
        return column(self.B) * self.slope(t)

    def lifted_load(self, a):
        return self.c * self.B * self.k / (self.k + 1) * a ** (self.k + 1)

    def drop(self, a, s):
        # 1 - x^k, and ln x = ln(1 - s²)/2
        return column(2 * self.c * a ** (self.k - 2)) * -np.expm1(column(self.k) * np.log1p(-(s**2)) / 2)

    def kinks(self):
        return no_kinks(self.k)

    def least(self):
        return 0 * self.k

    def most(self):
        return np.inf * self.k


def _over_height(k):
    """F/f = sqrt(π) k Γ(k/2)/(2 Γ((k + 1)/2))."""
    return np.sqrt(np.pi) * k / 2 * np.exp(lgamma(k / 2) - lgamma((k + 1) / 2))


def _of_numbers(shape_coefficient, shape_power, size):
    k = np.asarray(shape_power, dtype=float)
    values, place = np.unique(k, return_inverse=True)
    usable = [value if value >= 1 else np.nan for value in values.tolist()]
    ratios = np.array([_over_height(value) for value in usable]).reshape(-1)
    return Power(np.asarray(shape_coefficient, dtype=float), k, ratios[place.reshape(-1)])


KIND = Kind(
    "power",
    {"shape_coefficient": SHAPE_COEFFICIENT, "shape_power": SHAPE_POWER},
    _of_numbers,
    "a body of revolution f/R = c (r/R)^k",
)

"""A ball that is worn to a blunter point: a shape in one file.

f = r²/2 + c r^(3/2), c = `wear` > 0 in R^(-1/2). A power r^k is lifted to F = B t^k with B = sqrt(π) k Γ(k/2)/(2 Γ((k +
1)/2)), which is 2 for k = 2, and its ∫₀ᵃ (F(a) - F(t)) dt is B k/(k + 1) a^(k + 1) (docs/shapes.md).
"""

from math import gamma, pi, sqrt
from typing import NamedTuple

import numpy as np

from solver import Parameter
from solver.shapes import Kind
from solver.shapes.shape import column, no_kinks

B = sqrt(pi) * 1.5 * gamma(0.75) / (2 * gamma(1.25))


class WornTip(NamedTuple):
    """The shapes of `c` (B,)."""

    c: np.ndarray

    @property
    def pointed(self):
        """f'(0) = 0."""
        return self.c < 0

    @property
    def even(self):
        """r^(3/2) is no smooth function of r²."""
        return self.c < 0

    def take(self, index):
        return WornTip(self.c[index])

    def height(self, r):
        return r**2 / 2 + column(self.c) * r**1.5

    def slope(self, r):
        return r + 1.5 * column(self.c) * r**0.5

    def lifted(self, t):
        return t**2 + column(self.c) * B * t**1.5

    def lifted_slope(self, t):
        return 2 * t + 1.5 * column(self.c) * B * t**0.5

    def lifted_load(self, a):
        return 2 / 3 * a**3 + 0.6 * B * self.c * a**2.5

    def drop(self, a, s):
        """1 - x² = s², and 1 - x^(3/2) is formed from ln(1 - s²): no digits are lost next to the edge."""
        return s**2 - column(2 * self.c / np.sqrt(a)) * np.expm1(0.75 * np.log1p(-(s**2)))

    def kinks(self):
        return no_kinks(self.c)

    def least(self):
        return 0 * self.c

    def most(self):
        return np.inf * self.c


KIND = Kind(
    name="worn_tip",
    parameters={"wear": Parameter(interval="[1e-9, 1e9]")},
    of=lambda wear, size: WornTip(wear),
    words="a ball that is worn to a blunter point",
)

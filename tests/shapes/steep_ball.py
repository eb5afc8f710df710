"""A ball whose side is steeper than a paraboloid's: a shape in one file.

f = r²/2 + c r³, c = `steepness` > 0 in R⁻². From the definitions of docs/shapes.md, with ∫₀ᵗ r²/sqrt(t² - r²) dr =
π t²/4, F = t² + (3π/4) c t³ and ∫₀ᵃ (F(a) - F(t)) dt = (2/3) a³ + (9π/16) c a⁴.
"""

from typing import NamedTuple

import numpy as np

from solver import Parameter
from solver.shapes import Kind
from solver.shapes.shape import column, no_kinks


class SteepBall(NamedTuple):
    """The shapes of `c` (B,)."""

    c: np.ndarray

    @property
    def pointed(self):
        """f'(0) = 0."""
        return self.c < 0

    @property
    def even(self):
        """r³ is no smooth function of r²."""
        return self.c < 0

    def take(self, index):
        return SteepBall(self.c[index])

    def height(self, r):
        return r**2 / 2 + column(self.c) * r**3

    def slope(self, r):
        return r + 3 * column(self.c) * r**2

    def lifted(self, t):
        return t**2 + 3 * np.pi / 4 * column(self.c) * t**3

    def lifted_slope(self, t):
        return 2 * t + 9 * np.pi / 4 * column(self.c) * t**2

    def lifted_load(self, a):
        return 2 / 3 * a**3 + 9 * np.pi / 16 * self.c * a**4

    def drop(self, a, s):
        """1 - x² = s², and 1 - x³ is formed from ln(1 - s²): no digits are lost next to the edge."""
        return s**2 - column(2 * self.c * a) * np.expm1(1.5 * np.log1p(-(s**2)))

    def kinks(self):
        return no_kinks(self.c)

    def least(self):
        return 0 * self.c

    def most(self):
        return np.inf * self.c


KIND = Kind(
    name="steep_ball",
    parameters={"steepness": Parameter(interval="[1e-9, 1e9]")},
    of=lambda steepness, size: SteepBall(steepness),
    words="a ball with a steep side",
)

"""The paraboloid f = r²/2, in R, by which the model replaces a sphere. Its drop is s² at every contact radius.

It has closed forms of everything that a rough contact needs of a shape (:mod:`..rough.punch`).
"""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from .shape import Kind, column, no_kinks

#: For Hertz's pressure the operator is (H[s])(x) - (H[s])(1) = HERTZ s², so that the first guess is exact for it.
HERTZ = np.pi**2 / 16


@batch.of_cases
class Paraboloid(NamedTuple):
    """The :class:`~.shape.Shape` of B paraboloids, and their :class:`~solver.rough.punch.Punch`. `power` (B,) is always
    2. It is an array, so that numpy rounds r² as it rounds the powers of :mod:`.power`."""

    power: np.ndarray

    polynomial = True

    @property
    def pointed(self):
        return self.power < 0

    @property
    def even(self):
        return self.power > 0

    def height(self, r):
        return 0.5 * r ** column(self.power)

    def slope(self, r):
        return r + 0 * column(self.power)

    def lifted(self, t):
        return 2 * self.height(t)

    def lifted_slope(self, t):
        return 2 * self.slope(t)

    def lifted_load(self, a):
        return 2 / 3 * a ** (self.power + 1)

    def drop(self, a, s):
        return (s**2)[None]

    def kinks(self):
        return no_kinks(self.power)

    def least(self):
        return 0 * self.power

    def most(self):
        return np.inf * self.power

    def drop_slope(self, a, s):
        return 0.0

    def depth(self, a):
        return 1.0

    def depth_slope(self, a):
        return 0.0

    def radius_at_depth(self, D):
        """a² is D on a half-space, and 2 D where the displacement is local; here it is the mean of both."""
        return np.sqrt(1.5 * D)

    def on_half_space(self, P, E, softness):
        return np.cbrt(0.75 * P / E) * np.cbrt(softness)

    def on_springs(self, P, C):
        return (4 * C * P / np.pi) ** 0.25

    def on_asperities(self, P, p_star, A_star, e):
        alone = P / (2 * np.pi * p_star) * (2 * A_star) ** e * (2 * e + 2)
        return alone ** (1 / (2 + 2 * e))

    def stiffness(self, a, s, half_space, springs):
        return (half_space * HERTZ * s + springs) / s**2


KIND = Kind("paraboloid", {}, lambda size: Paraboloid(np.full(size, 2.0)), "a paraboloid r²/(2R)", round=True)

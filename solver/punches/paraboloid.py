"""The paraboloid f = r²/2, in R, for which the model takes a sphere. Its drop is s² at every radius."""

from typing import NamedTuple

import numpy as np

#: For Hertz's pressure the operator is (H[s])(x) - (H[s])(1) = HERTZ s², which makes the first guess exact there.
HERTZ = np.pi**2 / 16


class Paraboloid(NamedTuple):
    """The :class:`~solver.punches.punch.Punch` of all cases: it has no numbers."""

    def take(self, index):
        return self

    def drop(self, a, s):
        return (s**2)[None]

    def drop_slope(self, a, s):
        return 0.0

    def depth(self, a):
        return 1.0

    def depth_slope(self, a):
        return 0.0

    def radius_at_depth(self, D):
        """a² is D for a half-space and 2 D where the displacement is local."""
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


PARABOLOID = Paraboloid()

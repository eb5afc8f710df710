"""The protocol of a punch: the shape f(r) of the indenter. One file has one shape: :mod:`.paraboloid`.

The contact asks a punch for nothing else, nor which punch it is. Lengths are in R; a is the contact radius, x = r/a
and s = sqrt(1 - x²). What the surface must yield at x, less that at the edge, is f(a) - f(ax). The equation of the
contact is divided by a²/2, and so is this:

    X K[q] + Y q + Z g = drop,              drop = (2/a²) [f(a) - f(ax)],
    D = (a²/2) (depth + X edge @ q),        depth = 2 f(a)/a².
"""

from typing import Protocol

import numpy as np


class Punch(Protocol):
    """The shape of the punch in B cases. What is the same for all cases may have one row in place of B."""

    def take(self, index):
        """The punch of the sub-batch at `index`."""

    def drop(self, a, s):
        """(2/a²) [f(a) - f(ax)] at the points s (m,), for contact radii a (B,): (B or 1, m). It is formed from s, not
        as a difference: next to the edge no digits are lost."""

    def drop_slope(self, a, s):
        """Derivative of :meth:`drop` by ln a at fixed x."""

    def depth(self, a):
        """2 f(a)/a², (B,) or one number."""

    def depth_slope(self, a):
        """Derivative of :meth:`depth` by ln a."""

    def radius_at_depth(self, D):
        """First guess (B,) of the contact radius at the depth D (B,), between those on a half-space and on springs."""

    def on_half_space(self, P, E, softness):
        """Contact radius (B,) under the load P (B,) on a half-space of modulus E/softness."""

    def on_springs(self, P, C):
        """Contact radius (B,) under the load P (B,) on springs of compliance C (B,) alone."""

    def on_asperities(self, P, p_star, A_star, e):
        """Contact radius (B,) under the load P (B,) where asperities alone yield, by A = A* (p/p*)^(1/e)."""

    def stiffness(self, a, s, half_space, springs):
        """First guess of 1/q, (B, m) at s (m,) > 0, where asperities do not yield: it is nearly the sum of the 1/q on a
        half-space, whose X is `half_space` (B, 1), and on springs, whose Y is `springs` (B, 1)."""


def largest(punch, a):
    """Largest right-hand side (B or 1,) of the equation: the drop in the centre."""
    return punch.drop(a, np.ones(1))[..., 0]

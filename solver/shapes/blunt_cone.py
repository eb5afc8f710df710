"""The blunt cone: a round tip, which passes smoothly into a cone at r = b.

The tip is a paraboloid r²/(2ρ), which has the slope of the cone at b = ρ cot α; or a ball of radius ρ, which has it at
b = ρ cos α.
"""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..parameters import Parameter
from .cone import HALF_ANGLE, cotangent
from .shape import Kind, angle, column, half_chord, load_by_quadrature, radii_at

#: Radius ρ of the tip, and the shape of the tip.
TIP_RADIUS = Parameter(interval="[1e-12, 1e6]", powers=(0, 1))
TIP = Parameter("paraboloid", ("paraboloid", "sphere"))


@batch.of_cases
class BluntCone(NamedTuple):
    """The :class:`~.shape.Shape` of blunt cones: radius `rho` of the tip and slope `cot` of the cone, (B,); `ball` (B,)
    bool, whether the tip is a ball."""

    rho: np.ndarray
    cot: np.ndarray
    ball: np.ndarray

    @property
    def pointed(self):
        return self.rho < 0

    @property
    def even(self):
        return self.rho < 0

    @property
    def b(self):
        """The radius r (B,) at which the tip ends."""
        return self.rho * self.cot / np.where(self.ball, np.hypot(1.0, self.cot), 1.0)

    @property
    def side(self):
        """sqrt(ρ² - b²), (B,), for a ball."""
        return self.rho / np.hypot(1.0, self.cot)

    def height(self, r):
        tip = np.minimum(r, column(self.b))
        return self._tip(tip) + column(self.cot) * (r - tip)

    def slope(self, r):
        rho, b = column(self.rho), column(self.b)
        tip = np.minimum(r, b)
        ball = tip / np.sqrt((rho - tip) * (rho + tip))
        return np.where(r > b, column(self.cot), np.where(column(self.ball), ball, tip / rho))

    def lifted(self, t):
        rho, cot, b = (column(values) for values in (self.rho, self.cot, self.b))
        q, theta = half_chord(t, b), angle(t, b)
        paraboloid = t / rho * (t - q + b * theta)
        return np.where(column(self.ball), t * (self._logarithm(t, q) + cot * theta), paraboloid)

    def lifted_slope(self, t):
        rho, cot, b, side = (column(values) for values in (self.rho, self.cot, self.b, self.side))
        q, theta = half_chord(t, b), angle(t, b)
        paraboloid = (2 * (t - q) + b * theta) / rho
        inner = np.minimum(t, b)
        on_ball = inner * rho / ((rho - inner) * (rho + inner))
        on_cone = t / (rho + t) + (b**2 - side * q) / (side * (side + q))
        ball = self._logarithm(t, q) + cot * theta + np.where(t > b, on_cone, on_ball)
        return np.where(column(self.ball), ball, paraboloid)

    def lifted_load(self, a):
        rho, b, q, theta = self.rho, self.b, half_chord(a, self.b), angle(a, self.b)
        closed = (2 / 3 * a**3 - a**2 * q + q**3 / 3 + (a**2 * b * theta + b**2 * q) / 2) / rho
        return np.where(self.ball, load_by_quadrature(self, a), closed)

    def drop(self, a, s):
        r, inwards = radii_at(a, s)
        b, radius = column(self.b), column(a)
        outer = np.minimum(radius, b)  # the radius at which the tip or the contact ends
        cone = np.minimum(inwards, np.maximum(radius - b, 0.0))
        along = np.where(r < outer, np.where(radius < b, inwards, b - r), 0.0)  # outer - r
        chord = along * (outer + np.minimum(r, outer))  # outer² - r²
        tip = np.where(column(self.ball), chord / (self._side(outer) + self._side(np.minimum(r, outer))), 0.0)
        tip = np.where(column(self.ball), tip, chord / (2 * column(self.rho)))
        return column(2 / a**2) * (tip + column(self.cot) * cone)

    def kinks(self):
        return column(self.b)

    def least(self):
        return 0 * self.rho

    def most(self):
        return np.inf * self.rho

    def _tip(self, r):
        """f at r <= b."""
        rho = column(self.rho)
        return np.where(column(self.ball), r**2 / (rho + self._side(r)), r**2 / (2 * rho))

    def _side(self, r):
        """sqrt(ρ² - r²) at r <= b."""
        rho = column(self.rho)
        return np.sqrt(np.maximum((rho - r) * (rho + r), 0.0))

    def _logarithm(self, t, q):
        """artanh(t/ρ) on the ball, and ln[(ρ + t)/(sqrt(ρ² - b²) + q)] beyond it."""
        rho, b = column(self.rho), column(self.b)
        return np.where(t > b, np.log((rho + t) / (column(self.side) + q)), np.arctanh(np.minimum(t, b) / rho))


def _of_numbers(tip_radius, half_angle, tip, size):
    return BluntCone(tip_radius, cotangent(half_angle), tip == "sphere")


KIND = Kind(
    "blunt_cone",
    {"tip_radius": TIP_RADIUS, "half_angle": HALF_ANGLE, "tip": TIP},
    _of_numbers,
    "a cone with a round tip",
)

"""The frustum, a cone whose tip is cut off: f = 0 up to r = b, and (r - b) cot α beyond."""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..parameters import Parameter
from .cone import HALF_ANGLE, cotangent
from .shape import Kind, angle, column, half_chord, radii_at

#: The radius b of the flat part around the axis.
FLAT_RADIUS = Parameter(interval="[1e-9, 1e3]", powers=(0, 1))


@batch.of_cases
class Frustum(NamedTuple):
    """The :class:`~.shape.Shape` of frustums: radius `b` of the flat part and slope `cot` of the cone, (B,)."""

    b: np.ndarray
    cot: np.ndarray

    @property
    def pointed(self):
        return self.b < 0

    @property
    def even(self):
        return self.b < 0

    def height(self, r):
        return column(self.cot) * np.maximum(r - column(self.b), 0.0)

    def slope(self, r):
        return column(self.cot) * (r > column(self.b))

    def lifted(self, t):
        return column(self.cot) * t * angle(t, column(self.b))

    def lifted_slope(self, t):
        b = column(self.b)
        return column(self.cot) * np.where(t < b, 0.0, angle(t, b) + b / half_chord(t, b))

    def lifted_load(self, a):
        return self.cot / 2 * (a**2 * angle(a, self.b) + self.b * half_chord(a, self.b))

    def drop(self, a, s):
        _, inwards = radii_at(a, s)
        return column(2 * self.cot / a**2) * np.minimum(inwards, column(np.maximum(a - self.b, 0.0)))

    def kinks(self):
        return column(self.b)

    def least(self):
        return self.b

    def most(self):
        return np.inf * self.b


def _of_numbers(flat_radius, half_angle, size):
    return Frustum(flat_radius, cotangent(half_angle))


KIND = Kind(
    "frustum", {"flat_radius": FLAT_RADIUS, "half_angle": HALF_ANGLE}, _of_numbers, "a cone that is cut off flat"
)

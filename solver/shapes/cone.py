"""The cone f = r cot α, and the pyramids that are modelled as cones of the same area, A = π tan²α f²."""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..parameters import Parameter
from .shape import Kind, column, no_kinks, radii_at

#: Angle α from the axis to the side of a cone, in degrees.
HALF_ANGLE = Parameter(interval="(0, 90)")
#: Area of the Berkovich and Vickers pyramids over the square of the depth; and the angle, in degrees, of the cone with
#: the area of the corner of a cube, atan(sqrt(2.598/π)).
_AREA, _CUBE_CORNER = 24.5, 42.2784


@batch.of_cases
class Cone(NamedTuple):
    """The :class:`~.shape.Shape` of cones of slope `cot` (B,)."""

    cot: np.ndarray

    @property
    def pointed(self):
        return self.cot > 0

    @property
    def even(self):
        return self.cot < 0

    def height(self, r):
        return column(self.cot) * r

    def slope(self, r):
        return column(self.cot) + 0 * r

    def lifted(self, t):
        return np.pi / 2 * column(self.cot) * t

    def lifted_slope(self, t):
        return np.pi / 2 * column(self.cot) + 0 * t

    def lifted_load(self, a):
        return np.pi / 4 * self.cot * a**2

    def drop(self, a, s):
        _, inwards = radii_at(a, s)
        return column(2 * self.cot / a**2) * inwards

    def kinks(self):
        return no_kinks(self.cot)

    def least(self):
        return 0 * self.cot

    def most(self):
        return np.inf * self.cot


def cotangent(degrees):
    """cot of an angle in degrees."""
    return 1 / np.tan(np.radians(degrees))


def _of_angle(half_angle, size):
    return Cone(cotangent(half_angle))


def _pyramid(name, degrees, words):
    """The kind of a pyramid that is modelled as a cone of a fixed angle."""
    return Kind(name, {}, lambda size: Cone(np.full(size, cotangent(degrees))), words)


_SHARP = np.degrees(np.arctan(np.sqrt(_AREA / np.pi)))
KIND = Kind("cone", {"half_angle": HALF_ANGLE}, _of_angle, "a cone")
PYRAMIDS = (
    _pyramid("berkovich", _SHARP, "a Berkovich pyramid, replaced by the cone of the same area"),
    _pyramid("vickers", _SHARP, "a Vickers pyramid, replaced by the cone of the same area"),
    _pyramid("cube_corner", _CUBE_CORNER, "the corner of a cube, replaced by the cone of the same area"),
)

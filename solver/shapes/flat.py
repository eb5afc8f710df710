"""The flat punch: a cylinder of radius b. The contact radius is b; the control is the load or the depth."""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from .frustum import FLAT_RADIUS
from .shape import Kind, column


@batch.of_cases
class Flat(NamedTuple):
    """The :class:`~.shape.Shape` of flat punches with the radii `b` (B,): f = 0."""

    b: np.ndarray

    @property
    def pointed(self):
        return self.b < 0

    @property
    def even(self):
        return self.b > 0

    def height(self, r):
        return 0 * column(self.b) * r

    def slope(self, r):
        return 0 * column(self.b) * r

    def lifted(self, t):
        return 0 * column(self.b) * t

    def lifted_slope(self, t):
        return 0 * column(self.b) * t

    def lifted_load(self, a):
        return 0 * a

    def drop(self, a, s):
        return 0 * column(a) * s

    def kinks(self):
        return np.empty((len(self.b), 0))

    def least(self):
        return self.b

    def most(self):
        return self.b


KIND = Kind("flat", {"flat_radius": FLAT_RADIUS}, lambda flat_radius, size: Flat(flat_radius), "a flat cylinder")

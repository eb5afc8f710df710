"""The flat punch with a round edge: f = 0 up to r = b, and (r - b)²/(2ρ) beyond."""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..parameters import Parameter
from .frustum import FLAT_RADIUS
from .shape import Kind, column, half_chord, radii_at

#: Radius ρ of the edge.
EDGE_RADIUS = Parameter(interval="[1e-12, 1e6]", powers=(0, 1))
#: If z is below _SERIES, z - arctan z is the sum of its series, Σ (-1)^(j + 1) z^(2j + 1)/(2j + 1), j = 1 to
#: _TERMS - 1.
_SERIES, _TERMS = 0.3, 16


@batch.of_cases
class RoundedFlat(NamedTuple):
    """The :class:`~.shape.Shape` of punches with the radii `b` of the flat part and `rho` of the edge, (B,)."""

    b: np.ndarray
    rho: np.ndarray

    @property
    def pointed(self):
        return self.b < 0

    @property
    def even(self):
        return self.b < 0

    def height(self, r):
        return np.maximum(r - column(self.b), 0.0) ** 2 / (2 * column(self.rho))

    def slope(self, r):
        return np.maximum(r - column(self.b), 0.0) / column(self.rho)

    def lifted(self, t):
        # q - b arccos(b/t), with q = sqrt(t² - b²), and arccos(b/t) = arctan(q/b)
        b = column(self.b)
        return t / column(self.rho) * b * _over_arctangent(half_chord(t, b) / b)

    def lifted_slope(self, t):
        b = column(self.b)
        q = half_chord(t, b)
        return (q + b * _over_arctangent(q / b)) / column(self.rho)

    def lifted_load(self, a):
        z = half_chord(a, self.b) / self.b
        return self.b**3 / self.rho * (z**3 / 6 + (1 + z**2) / 2 * _over_arctangent(z))

    def drop(self, a, s):
        r, inwards = radii_at(a, s)
        b, over = column(self.b), column(np.maximum(a - self.b, 0.0))
        # (a - b)² - (r - b)² = (a - r) (a + r - 2 b)
        rise = np.where(r > b, inwards * (over + r - b), over**2)
        return column(1 / (a**2 * self.rho)) * rise

    def kinks(self):
        return column(self.b)

    def least(self):
        return self.b

    def most(self):
        return np.inf * self.b


def _over_arctangent(z):
    """z - arctan z, z >= 0, without cancellation where z is small."""
    total, y = 0.0, np.minimum(z, _SERIES) ** 2
    for j in reversed(range(1, _TERMS)):
        total = y * (1 / (2 * j + 1) - total)
    return np.where(z < _SERIES, z * total, z - np.arctan(z))


def _of_numbers(flat_radius, edge_radius, size):
    return RoundedFlat(flat_radius, edge_radius)


KIND = Kind(
    "rounded_flat",
    {"flat_radius": FLAT_RADIUS, "edge_radius": EDGE_RADIUS},
    _of_numbers,
    "a flat cylinder with a round edge",
)

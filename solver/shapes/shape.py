"""The protocol of an indenter's shape: its profile f(r). One file has one shape, such as :mod:`.cone`.

f(0) = 0, and f is convex. Lengths are in R. A smooth contact needs

    F(t) = t ∫₀ᵗ f'(r)/sqrt(t² - r²) dr,

which is the depth at which the contact radius on a half-space is t (docs/shapes.md). The contact radius is a under the
load

    P = 2 E ∫₀ᵃ (F(a) - F(t)) dt = 2 E lifted_load(a).

A rough contact needs the drop (2/a²) [f(a) - f(ax)] of :mod:`..rough.punch`.
"""

from collections.abc import Callable, Mapping
from typing import NamedTuple, Protocol

import numpy as np

from ..numerics.quadrature import gauss_legendre
from ..parameters import Parameter

#: Points of the quadrature of :func:`load_by_quadrature` between two kinks: the integrand is smooth there.
_POINTS = 24


class Shape(Protocol):
    """The profiles of B indenters; r, t (B, m) are radii >= 0, and a (B,) is the contact radius.

    pointed : (B,) bool, whether f'(0+) > 0: the pressure on the axis is then infinite
    even : (B,) bool, whether f is a smooth function of r²: the pressure is then a smooth function of s
    take : the shapes of a sub-batch, :func:`~solver.numerics.batch.take`
    """

    pointed: np.ndarray
    even: np.ndarray
    take: Callable

    def height(self, r):
        """f at r."""

    def slope(self, r):
        """df/dr at r."""

    def lifted(self, t):
        """F at t."""

    def lifted_slope(self, t):
        """dF/dt at t; infinite at the kink of a frustum."""

    def lifted_load(self, a):
        """∫₀ᵃ (F(a) - F(t)) dt, (B,)."""

    def drop(self, a, s):
        """(2/a²) [f(a) - f(ax)], (B, m), at the points s = sqrt(1 - x²), (m,). It is formed from s without
        cancellation: no digits are lost near the edge."""

    def kinks(self):
        """Radii (B, K) > 0 at which f is not smooth; NaN where a case has fewer of them."""

    def least(self):
        """(B,): the lower bound of a, which is the radius of a flat part around the axis; 0 if there is none."""

    def most(self):
        """(B,): the upper bound of a, where the profile ends; infinite if it does not end."""


class Kind(NamedTuple):
    """A shape that a case may have, by its `name`.

    parameters : name -> :class:`~solver.parameters.Parameter`, for each of its numbers
    of : function of these numbers, arrays (B,) by their names, and of `size`, B; it returns the :class:`Shape`
    words : a description for messages and tables
    round : whether its profile is that of a ball of radius R, at least near the axis. For all other shapes R is only
        the unit of length
    """

    name: str
    parameters: Mapping[str, Parameter]
    of: Callable[..., Shape]
    words: str
    round: bool = False


def has_radius(shape):
    """(B,) bool: whether the contact radius is that of the punch under any load, as for a flat punch."""
    return shape.least() == shape.most()


def column(values):
    """The numbers of the cases (B,) as a column (B, 1), which broadcasts against their radii (B, m)."""
    return values[:, None]


def no_kinks(values):
    """:meth:`Shape.kinks` (B, 0) of a shape without kinks; `values` is (B,)."""
    return np.empty((len(values), 0))


def half_chord(t, b):
    """sqrt(t² - b²), or 0 where t < b, without a difference of squares. The arguments broadcast."""
    return np.sqrt(np.maximum(t - b, 0.0) * (t + b))


def angle(t, b):
    """arccos(b/t), or 0 where t < b. It has all digits even where t is just above b > 0. The arguments broadcast."""
    return np.arctan2(half_chord(t, b), b)


def radii_at(a, s):
    """r = a x (B, m) and a - r (B, m) at s = sqrt(1 - x²) (m,), for a (B,); a - r is formed without cancellation."""
    x = np.sqrt((1 - s) * (1 + s))
    return column(a) * x, column(a) * (s**2 / (1 + x))


def load_by_quadrature(shape, a):
    """:meth:`Shape.lifted_load` as ∫₀ᵃ t F'(t) dt, (B,), for shapes without a closed form.

    From a kink b to the next kink c the variable is y, t = b + (c - b) y²: F' may behave like sqrt(t - b) there.
    """
    y, w = gauss_legendre(_POINTS)
    ends = np.minimum(np.nan_to_num(shape.kinks(), nan=np.inf), column(a))
    ends = np.hstack([np.zeros((len(a), 1)), np.sort(ends, axis=1), column(a)])
    low, width = ends[:, :-1, None], np.diff(ends, axis=1)[:, :, None]
    t = (low + width * y**2).reshape(len(a), -1)
    weights = (width * (2 * y * w)).reshape(len(a), -1)
    return np.where(weights > 0, t * shape.lifted_slope(t) * weights, 0.0).sum(axis=1)

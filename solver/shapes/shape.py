"""The protocol of an indenter's shape: its profile f(r). One file has one shape, such as :mod:`.cone`.

f(0) = 0, and f is convex. Lengths are in R. A smooth contact needs

    F(t) = t ∫₀ᵗ f'(r)/sqrt(t² - r²) dr,

the depth at which a half-space is touched up to the radius t (docs/shapes.md). Under the load

    P = 2 E ∫₀ᵃ (F(a) - F(t)) dt = 2 E lifted_load(a)

it is touched up to a. A rough contact needs the drop (2/a²) [f(a) - f(ax)] of :mod:`..rough.punch`.
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

    pointed : (B,) bool, f'(0+) > 0: the pressure on the axis is infinite
    even : (B,) bool, f is a smooth function of r²: then the pressure is smooth in s too
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
        """(2/a²) [f(a) - f(ax)] at the points s = sqrt(1 - x²), (m,), (B, m). It is formed from s, not as a difference:
        next to the edge no digits are lost."""

    def kinks(self):
        """Radii (B, K) > 0 at which f is not smooth; NaN where a case has fewer of them."""

    def least(self):
        """(B,): a is larger than this: the radius of the flat part around the axis, else 0."""

    def most(self):
        """(B,): a is less than this, where the profile ends; else infinite."""


class Kind(NamedTuple):
    """A shape that a case may have, by its `name`.

    parameters : name -> :class:`~solver.parameters.Parameter` of its numbers
    of : function of these numbers, arrays (B,) by their names, that makes the :class:`Shape`
    words : what it is, for messages and tables
    round : whether its profile is that of a ball of radius R, or of one near its axis; R is the mere unit of length of
        all others
    """

    name: str
    parameters: Mapping[str, Parameter]
    of: Callable[..., Shape]
    words: str
    round: bool = False


def has_radius(shape):
    """(B,) bool: the contact radius is that of the punch whatever the load, as under a flat one."""
    return shape.least() == shape.most()


def column(values):
    """(B, 1) of (B,): the numbers of cases beside their radii."""
    return values[:, None]


def no_kinks(values):
    """:meth:`Shape.kinks` (B, 0) of a shape that has none, of the length of `values` (B,)."""
    return np.empty((len(values), 0))


def half_chord(t, b):
    """sqrt(t² - b²), or 0 where t < b: without a difference of squares. The arguments broadcast."""
    return np.sqrt(np.maximum(t - b, 0.0) * (t + b))


def angle(t, b):
    """arccos(b/t), or 0 where t < b: right also where t is just above b > 0. The arguments broadcast."""
    return np.arctan2(half_chord(t, b), b)


def radii_at(a, s):
    """r = a x (B, m) and a - r (B, m) at s = sqrt(1 - x²) (m,), for a (B,): the second without a difference."""
    x = np.sqrt((1 - s) * (1 + s))
    return column(a) * x, column(a) * (s**2 / (1 + x))


def load_by_quadrature(shape, a):
    """:meth:`Shape.lifted_load` as ∫₀ᵃ t F'(t) dt, (B,), for shapes without a closed form.

    Beyond a kink b the variable is y in t = b + (c - b) y², c the next one: there F' may be like sqrt(t - b).
    """
    y, w = gauss_legendre(_POINTS)
    ends = np.minimum(np.nan_to_num(shape.kinks(), nan=np.inf), column(a))
    ends = np.hstack([np.zeros((len(a), 1)), np.sort(ends, axis=1), column(a)])
    low, width = ends[:, :-1, None], np.diff(ends, axis=1)[:, :, None]
    t = (low + width * y**2).reshape(len(a), -1)
    weights = (width * (2 * y * w)).reshape(len(a), -1)
    return np.where(weights > 0, t * shape.lifted_slope(t) * weights, 0.0).sum(axis=1)

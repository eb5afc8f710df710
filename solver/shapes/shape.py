"""The protocol of an indenter's shape: its profile f(r). One file has one shape, such as :mod:`.cone`.

f(0) = 0, and f is convex. Lengths are in R. A smooth contact needs

    F(t) = t ∫₀ᵗ f'(r)/sqrt(t² - r²) dr,

the depth at which a half-space is touched up to the radius t (docs/shapes.md). Under the load

    P = 2 E ∫₀ᵃ (F(a) - F(t)) dt = 2 E lifted_load(a)

it is touched up to a. A rough contact needs the drop (2/a²) [f(a) - f(ax)] of :mod:`..punches.punch`.
"""

from collections.abc import Callable, Mapping
from typing import NamedTuple, Protocol

import numpy as np

from ..parameters import Parameter


class Shape(Protocol):
    """The profiles of B indenters; r, t (B, m) or (B, 1) are radii >= 0, and a (B,) is the contact radius.

    pointed : bool, f'(0+) > 0: the pressure on the axis is infinite
    even : bool, f is a smooth function of r²: then no polynomial in s misses anything
    """

    pointed: bool
    even: bool

    def take(self, index):
        """The shapes of the sub-batch at `index`."""

    def height(self, r):
        """f at r."""

    def slope(self, r):
        """df/dr at r."""

    def lifted(self, t):
        """F at t."""

    def lifted_slope(self, t):
        """dF/dt at t."""

    def lifted_load(self, a):
        """∫₀ᵃ (F(a) - F(t)) dt, (B,)."""

    def drop(self, a, s):
        """(2/a²) [f(a) - f(ax)] at the points s = sqrt(1 - x²), (m,), (B, m). It is formed from s, not as a difference:
        next to the edge no digits are lost."""

    def kinks(self):
        """Radii (B, K) inside which and outside which f has other formulas; NaN where a case has fewer of them."""

    def least(self):
        """(B,): a is larger than this: the radius of what is flat around the axis, else 0."""

    def most(self):
        """(B,): a is less than this, where the profile ends; else infinite."""


class Kind(NamedTuple):
    """A shape that a case may have, by its `name`.

    parameters : name -> :class:`~solver.parameters.Parameter` of its numbers
    of : function of these numbers as arrays (B,), by their names, and of the number of cases, `size`: the
        :class:`Shape`
    words : what it is, for messages
    """

    name: str
    parameters: Mapping[str, Parameter]
    of: Callable[..., Shape]
    words: str


def column(values) -> np.ndarray:
    """(B, 1) of (B,): the numbers of cases beside their radii."""
    return values[:, None]

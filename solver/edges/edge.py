"""The protocol of an edge: how the pressure ends at r = a, which is what closes the contact radius.

The equation holds for any radius, and the edge says which it is. At a free edge there is no pressure, p(a) = 0, which
polynomials in s = sqrt(1 - x²) obey by themselves (:mod:`.free`). An edge of another kind adds a pressure that follows
from the radius:

    p = p* (q + strength(a) shape(x)),        q a polynomial in s as at a free edge.

An edge that holds tension, for example, adds 1/s. What the added pressure does to the surface is one more column of the
operator (:mod:`.added`): so the right-hand side of the equation changes, and its matrix does not. The contact asks an
edge for nothing else, nor which edge it is. All pressures here are over p*.
"""

from typing import Protocol

import numpy as np

from ..body.operator import Body, Operator
from ..numerics.mesh import Mesh


class Edge(Protocol):
    """The edge of B cases.

    pulls : bool, whether it may hold tension: then tension inside the contact does not mean that the punch lifts off
    """

    pulls: bool

    def take(self, index):
        """The edge of the sub-batch at `index`."""

    def at(self, body: Body, a, mesh: Mesh, near: Operator | None = None) -> Operator:
        """The operator of `body` at the radii a (B,), of q and of the added pressure together; arguments as those of
        :meth:`~solver.body.operator.Body.at`."""

    def load(self, a: np.ndarray):
        """∫₀¹ · x dx of the added pressure, and its derivative by ln a; (B,) each, or numbers."""

    def pressure(self, a: np.ndarray, s: np.ndarray):
        """The added pressure at s (m,), (B, m), or a number."""

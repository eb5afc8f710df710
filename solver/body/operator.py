"""The protocol of a body under the punch. One file has one body: :mod:`.half_space`, :mod:`.hankel`.

The contact uses nothing of a body except this protocol. Lengths are in R, moduli in E2*; a is the contact radius, and
x = r/a. The displacement of the surface under the pressure p = p* q, less that at the edge, is

    u(x) - u(1) = 4 a/(π E) p* (K q)(x) + C p* q(x).
"""

from collections.abc import Callable
from typing import Protocol

import numpy as np

from ..kernels.kernel import Kernel
from ..numerics.mesh import Mesh


class Operator(Protocol):
    """K of B cases at given radii, on a mesh of n nodes.

    K : (B, n, n), or (1, n, n) where all cases share it: the displacement at the nodes less that at the edge
    edge : (B or 1, n), the row that gives the displacement at the edge itself, edge @ q
    take : the operator of a sub-batch, :func:`~solver.numerics.batch.take`. An operator whose rows are in groups has a
        `take` of its own, and a classmethod ``assemble(operators, places)`` in place of
        :func:`~solver.numerics.batch.join`
    """

    mesh: Mesh
    K: np.ndarray
    edge: np.ndarray
    take: Callable

    def at_edge(self, q):
        """edge @ q (B,)."""

    def products(self, q):
        """K q (B, n) and edge @ q (B,) for q (B, n)."""

    def slopes(self, q):
        """Derivatives of both :meth:`products` by ln a at fixed q: (B, n) and (B,)."""

    def between(self, q, s, half_space):
        """K q (B, m) at points s = sqrt(1 - x²) (m,) > 0 between the nodes; `half_space` (B, m) is what K of a
        half-space gives there."""


class Body(Protocol):
    """The bodies under the punches of B cases.

    E : (B,), modulus of the half-space to which K is relative
    C : (B,), compliance of springs on the surface, in R/E2*; 0: none
    take : the body of a sub-batch, :func:`~solver.numerics.batch.take`
    kernel : the :class:`~solver.kernels.kernel.Kernel` L of the Hankel integral over L - 1; None: there is no such
        integral
    """

    E: np.ndarray
    C: np.ndarray
    kernel: Kernel | None
    take: Callable

    def at(self, a, mesh, near=None):
        """The :class:`Operator` at the radii a (B,). `near`: an operator of the same cases, perhaps at other radii or
        on another mesh, from which everything that is still valid is reused."""

    def softness(self, a):
        """Approximate compliance (B,) of the body under a contact of radius a, over that of a half-space of E."""

    def error(self, a, nodes):
        """Relative error (B,) of the operator itself on `nodes` nodes, which a finer mesh does not reduce."""

    def rounding(self):
        """Rounding error (B,) of the pressure at any radius, over the largest pressure."""

    def unseen(self, a, s1):
        """Possible error (B,) of the place of the edge of a smooth contact, over the radius, on a mesh whose first node
        is s1. Short waves of the body move the edge, and only the ring between that node and the edge feels them."""

    def work(self, a, nodes):
        """Work of a case that is solved alone: (B,) to make a mesh of `nodes` nodes and the operator on it, and (B,)
        for one Newton step there. The unit is the work for one entry of the matrix of a half-space on a new mesh."""

    def order(self, a):
        """Permutation (B,) that makes cases that share work neighbours; None: the order does not matter."""

    def alike(self, a):
        """A body that is displaced nearly as this one under contacts of radius a, and is much cheaper to solve; or
        None."""

    def first_nodes(self, rtol, a, rise=None):
        """Number of nodes (B,) that just about meets rtol (B,) for contacts of radius a. `rise` (B,), from 0 to about
        1, says how gently the pressure rises from the edge under asperities (:class:`~solver.laws.Law`); None: a smooth
        punch."""


def fitted_nodes(rtol, rise, digits, factor=0.93):
    """Number of nodes (B,) by a formula that was fitted to random cases. At rise 0 it is 0 for rtol = 10^-digits, and
    grows by factor/0.25 with each further digit."""
    return factor * (-np.log10(rtol) - digits + 3.6 * rise) / (0.25 + rise)

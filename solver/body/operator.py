"""The protocol of a body: what lies under the punch. One file has one body: :mod:`.half_space`, :mod:`.layered`.

The contact asks for nothing else, and never which body it has. Lengths are in R, moduli in E2*; a is the radius.
The displacement of the surface under the pressure p = p* q, less that of the edge, is

    u(x) - u(1) = 4 a/(π E) p* (K q)(x) + C p* q(x),      x = r/a.
"""

from typing import Protocol

import numpy as np

from ..numerics.mesh import Mesh


class Operator(Protocol):
    """K of B cases at given radii, on a mesh of n nodes.

    Attributes
    ----------
    K : (B, n, n), or (1, n, n) where all cases share it
        The matrix of K. K q at the nodes is without the displacement of the edge.
    edge : (B or 1, n)
        The row of the displacement at the edge: edge @ q.
    """

    mesh: Mesh
    K: np.ndarray
    edge: np.ndarray

    def take(self, index):
        """The operator of the sub-batch at `index`."""

    def join(self, operators, places):
        """The operator of a batch from those of its sub-batches, each at its `places` (b,) in the batch."""

    def products(self, q):
        """K q (B, n) and edge @ q (B,) for q (B, n)."""

    def slopes(self, q):
        """Derivatives of both :meth:`products` by ln a at fixed q: (B, n) and (B,)."""

    def between(self, q, s, half_space):
        """K q (B, m) at points s (m,) > 0 between the nodes; half_space (B, m) is the same of a half-space."""


class Body(Protocol):
    """What lies under the punch in B cases.

    Attributes
    ----------
    E : (B,)
        Modulus of the half-space to which K is relative.
    C : (B,)
        Compliance of springs on the surface, in R/E2*; 0: none.
    """

    E: np.ndarray
    C: np.ndarray

    def take(self, index):
        """The body of the sub-batch at `index`."""

    def within(self, rtol, a):
        """The body with an operator right to a hundredth of rtol (B,), if that is cheaper, for contacts of about the
        radius a."""

    def at(self, a, mesh, near=None):
        """The :class:`Operator` at the radii a (B,). `near`: one of these cases, perhaps at other radii or on another
        mesh; what of it holds here is not computed again."""

    def softness(self, a):
        """Compliance (B,) under a contact of radius a over that of a half-space of E, about."""

    def error(self, a, nodes):
        """Relative error (B,) of the operator itself on `nodes` nodes, that no mesh takes away."""

    def work(self, a, nodes):
        """What is computed for a case alone at the radius a, in entries of a half-space's matrix made anew: (B,) for
        the operator on a mesh of `nodes` nodes that is made for it, and (B,) for one Newton step on it."""

    def order(self, a):
        """Permutation (B,) in which cases that share work stand together; None: the order does not matter."""

    def alike(self, a):
        """A body of nearly the same displacement that is much cheaper to solve for contacts of radius a; or None."""

    def first_nodes(self, rtol, a, rise=None):
        """Number of nodes (B,) that just about meet rtol (B,) for contacts of radius a. `rise` (B,), from 0 to about 1,
        says how gently asperities let the pressure begin at the edge; None: a smooth punch."""


def fitted_nodes(rtol, rise, digits, factor=0.93):
    """The fit of :meth:`Body.first_nodes` to random cases; `digits`: of the error, at no nodes and rise 0."""
    return factor * (-np.log10(rtol) - digits + 3.6 * rise) / (0.25 + rise)

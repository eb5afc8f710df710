"""The half-space, Eq. (4), and the thin layer, Eq. (3): a half-space that carries springs.

K is that of a :class:`~solver.numerics.mesh.Mesh`. :mod:`.operator` says what the methods return.

The displacement of a layer's surface under an axisymmetric pressure is (2/E1*) ∫ L(kh) p̂ J0 dk. The thin-layer model
takes L(u) ≈ A1 + A2 u, Eq. (2): the displacement is then (4 A1/(π E1*)) a H[p] + C p with C = 2 A2 h/E1*, Eq. (3).
"""

from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..numerics.mesh import Mesh
from .operator import fitted_nodes

#: For an rtol below _FINE a case on springs begins on at least _SECOND nodes, the second coarsest mesh: on the coarsest
#: mesh few random cases met their rtol.
_FINE, _SECOND = 3e-5, 8
#: Work of one Newton step of a lone case, in the unit of :meth:`~solver.body.operator.Body.work`.
_STEP = 150
#: The n that stands for a rigid base under the thin layer: the equation divides by the part X of the half-space, which
#: must not be 0. With this n, X is below 1e-20 of the part Y of the springs for every h and a within the bounds, and n³
#: does not underflow.
STIFF = 1e-50


@batch.of_cases
class HalfSpaceOperator(NamedTuple):
    """The :class:`~solver.body.operator.Operator` of a half-space on a mesh. It is the same for all cases and radii:
    each sub-batch is the operator itself, and its slopes are 0."""

    mesh: Mesh

    @property
    def K(self):
        return self.mesh.K[None]

    @property
    def edge(self):
        return self.mesh.edge[None]

    def at_edge(self, q):
        return (self.edge * q).sum(axis=1)

    def products(self, q):
        return q @ self.mesh.K.T, q @ self.mesh.edge

    def slopes(self, q):
        zeros = np.broadcast_to(0.0, q.shape)  # takes no memory
        return zeros, zeros[:, 0]

    def between(self, q, s, half_space):
        return half_space


@batch.of_cases
class HalfSpace(NamedTuple):
    """The :class:`~solver.body.operator.Body` that is a half-space of modulus E (B,), in E2*, with springs of
    compliance C (B,); C = 0 stands for no springs. Its operator is exact to rounding."""

    E: np.ndarray
    C: np.ndarray

    kernel = None

    def at(self, a, mesh, near=None):
        return HalfSpaceOperator(mesh)

    def softness(self, a):
        return np.ones_like(a)

    def error(self, a, nodes):
        return np.zeros_like(a)

    def rounding(self):
        return np.zeros_like(self.E)

    def unseen(self, a, s1):
        """A half-space has no length of its own, and so no short waves. Smooth contacts on springs have the bound of
        :mod:`..smooth.paraboloids`."""
        return np.zeros_like(a)

    def work(self, a, nodes):
        return np.full_like(a, nodes**2), np.full_like(a, _STEP)

    def order(self, a):
        return None

    def alike(self, a):
        return None

    def first_nodes(self, rtol, a, rise=None):
        """On springs the pressure begins more gently at the edge than on a half-space."""
        springs = self.C > 0
        digits, factor = np.where(springs, 3.4, 1.1), np.where(springs, 0.97, 0.93)
        nodes = fitted_nodes(rtol, 0.0 if rise is None else rise, digits, factor)
        return np.maximum(nodes, np.where(springs & (rtol < _FINE), _SECOND, 0))


def half_space(m):
    """The half-space alone, of E2* = 1, under a punch of m (B,) = E2*/E3*."""
    return HalfSpace(1 / (1 + m), 0 * m)


def local_compliance(h, kernel):
    """C = 2 A2 h/E1* of Eq. (3), (B,) in R/E2*; h (B,) in R, A2 the slope of the :class:`~solver.kernels.kernel.Kernel`
    of the layer. Where C <= 0 the thin-layer equation does not apply."""
    return 2 * kernel.slope * h / kernel.E1


def thin_layer(h, kernel, m):
    """The thin layer, Eq. (3): a half-space that carries springs, under a punch of m = E1*/E3*; arrays (B,)."""
    return HalfSpace(kernel.E1 / np.maximum(kernel.L0 + m, STIFF), local_compliance(h, kernel))

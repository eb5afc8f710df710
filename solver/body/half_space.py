"""The half-space, Eq. (4), and the thin layer, Eq. (3): a half-space that carries springs.

K is that of a :class:`~solver.numerics.mesh.Mesh`. What the methods return is said in :mod:`.operator`.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.mesh import Mesh
from .operator import fitted_nodes

#: Below the rtol _FINE a case on springs begins on at least _SECOND nodes, the second coarsest mesh: on the coarsest,
#: few random cases met their rtol.
_FINE, _SECOND = 3e-5, 8
#: Work of one Newton step of a lone case, in the unit of :meth:`~solver.body.operator.Body.work`.
_STEP = 150


class HalfSpaceOperator(NamedTuple):
    """The :class:`~solver.body.operator.Operator` of a half-space on a mesh: one for all cases and radii, so that its
    sub-batches are itself and its slopes 0."""

    mesh: Mesh

    @property
    def K(self):
        return self.mesh.K[None]

    @property
    def edge(self):
        return self.mesh.edge[None]

    def take(self, index):
        return self

    def join(self, operators, places):
        return self

    def products(self, q):
        return q @ self.mesh.K.T, q @ self.mesh.edge

    def slopes(self, q):
        none = np.broadcast_to(0.0, q.shape)  # takes no memory
        return none, none[:, 0]

    def between(self, q, s, half_space):
        return half_space


class HalfSpace(NamedTuple):
    """The :class:`~solver.body.operator.Body` of modulus E (B,), in E2*, with springs of compliance C (B,), or 0. Its
    operator is exact to rounding, and there is no cheaper one."""

    E: np.ndarray
    C: np.ndarray

    def take(self, index):
        return HalfSpace(self.E[index], self.C[index])

    def within(self, rtol, a):
        return self

    def at(self, a, mesh, near=None):
        return HalfSpaceOperator(mesh)

    def softness(self, a):
        return np.ones_like(a)

    def error(self, a, nodes):
        return np.zeros_like(a)

    def rounding(self):
        return np.zeros_like(self.E)

    def unseen(self, a, s1):
        """It has no length of its own. Smooth contacts on springs have a bound of :mod:`..contact.smooth`."""
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

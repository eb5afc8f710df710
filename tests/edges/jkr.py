"""An edge that holds tension, after Johnson, Kendall and Roberts: an edge in one file.

At the edge the pressure goes like φ(a)/sqrt(a² - r²), and the energy that a growing contact sets free is the work of
adhesion w of what touches: φ(a) = -sqrt(2 a w E/π), with the modulus E of what lies at the surface and of the punch.
"""

from typing import NamedTuple

import numpy as np

from solver.edges.added import FLAT, WithAdded


class JKR(NamedTuple):
    """The :class:`~solver.edges.edge.Edge` of smooth contacts, p* = E: work of adhesion w in E2* R and E (B,)."""

    w: np.ndarray
    E: np.ndarray

    pulls = True

    def take(self, index):
        return JKR(self.w[index], self.E[index])

    def at(self, body, a, mesh, near=None):
        plain = body.at(a, mesh, None if near is None else near.plain)
        return WithAdded.of(plain, FLAT, *self.load(a))

    def load(self, a):
        strength = -np.sqrt(2 * self.w / (np.pi * a * self.E))
        return strength * FLAT.load, -strength / 2 * FLAT.load

    def pressure(self, a, s):
        return self.load(a)[0][:, None] * FLAT.pressure(s)

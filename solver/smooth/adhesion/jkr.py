"""Adhesion at the edge of a contact after Johnson, Kendall and Roberts, on any kernel.

An edge that gives way when it gains the work of adhesion w for each area has the edge value

    A = -sqrt(2π a w/E),

where E is the modulus of what touches: of the layer at the surface and of the punch. So a radius has one load and one
depth. The slopes of both along the curve are

    dD/da = dD₀/da + A (flat_D/(2a) + d flat_D/da),       dP/da = S dD/da + 2 E A/flat_D,

the second because dS/da = 2 E/flat_D², the energy that is released.
"""

from typing import NamedTuple

import numpy as np

from ...numerics import batch
from ..galerkin import respond
from ..state import State

#: Numbers above this have all their digits.
_SMALL = 1e-290


@batch.of_cases
class Jkr(NamedTuple):
    """The law of adhesion of B cases: shapes, the body, and the work of adhesion w (B,)."""

    shape: object
    body: object
    w: np.ndarray
    reaches_axis = False  # at small radii the edge pulls more than the shape presses

    def taken(self, state):
        """What adhesion takes from load, depth and p(0) of states, as of a half-space, (3, B)."""
        pull = np.abs(state.A)
        r = state.response
        return np.array([pull * r.flat_P, pull * r.flat_D, pull * r.E / (np.pi * state.a)])

    def at(self, a):
        """The :class:`State` at the radii a (B,)."""
        r = respond(self.shape, self.body, a)
        unit = 2 * np.pi * a * self.w / r.E
        A = -np.where(unit > _SMALL, np.sqrt(unit), np.sqrt(2 * np.pi * a / r.E) * np.sqrt(self.w))  # if it underflows
        dD = r.slope + A * (r.flat_D / (2 * a) + r.flat_slope)
        dP = r.S * dD + 2 * r.E * A / r.flat_D
        errors = (getattr(r, f"{v}_error") + np.abs(A) * getattr(r, f"flat_{v}_error") for v in "PD")
        return State(a, A, r.P + A * r.flat_P, r.D + A * r.flat_D, dP, dD, *errors, 1 + 0 * a, r)

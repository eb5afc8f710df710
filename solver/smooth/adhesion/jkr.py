"""Adhesion at the edge of a contact after Johnson, Kendall and Roberts, on any kernel.

An edge that gives way when each opened area releases the energy w, the work of adhesion, has the edge value

    A = -sqrt(2π a w/E),

where E is the modulus of the two bodies that touch, the layer at the surface and the punch. So each radius has one load
and one depth. Their slopes along the curve are

    dD/da = dD₀/da + A (flat_D/(2a) + d flat_D/da),       dP/da = S dD/da + 2 E A/flat_D,

The second follows from dS/da = 2 E/flat_D², the energy release of a flat punch.
"""

from typing import NamedTuple

import numpy as np

from ...numerics import batch
from ..galerkin import respond
from ..state import State

#: Numbers above this have all their digits; those below may underflow.
_SMALL = 1e-290


@batch.of_cases
class Jkr(NamedTuple):
    """The law of adhesion of B cases: shapes, the body, and the work of adhesion w (B,)."""

    shape: object
    body: object
    w: np.ndarray
    reaches_axis = False  # the curve turns before a = 0: at small radii the edge pulls more than the shape presses

    def taken(self, state):
        """The amounts (3, B) that adhesion takes from load, depth and p(0) of states; that of p(0) is the one on a
        half-space."""
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

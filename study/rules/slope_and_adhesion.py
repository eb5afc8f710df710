"""Rules about the shape of the punch and about contacts with adhesion."""

import numpy as np

from solver.bases import is_bare
from solver.shapes import PARABOLOID
from solver.solve import solve_at_radii

from .rule import rule
from .strength import problem_of

SLOPE = 0.4
"""Largest slope f'(a) of a shape other than the paraboloid: Tabor's representative strain 0.2 f'(a) is then 8 %. A
sphere exceeds it at a = 0.37 R, cones sharper than 68 degrees everywhere. A judgement, not a computation."""
ZONE = 0.1
"""Largest width of the ring in which the surfaces still attract each other, over a and over the thickness of the layer:
the model of Johnson, Kendall and Roberts neglects this ring. A judgement, not a computation."""
#: Radii r/a at which the pressure is examined; at the edge itself it is infinite.
_RADII = np.linspace(0.0, 1.0, 65)[:-1]
#: The stress of adhesion is w/(0.97 z0) where the range z0 is given: Maugis' step with the work of Lennard-Jones.
STEP = 0.97


@rule(2048, rf"slope $f'(a) > {SLOPE:g}$", "0.88")
def slope_not_small(v, times):
    """The punch is steep at the edge of the contact (slope f'(a) > {SLOPE:g}): the strain is not small, and linear
    elasticity is roughly right at best. Metals have yielded long before."""
    if "shape" not in v:
        return np.False_
    return (v["shape"] != PARABOLOID) & (v["slope"] > times * SLOPE)


def stress_of_adhesion(v):
    """sigma0, by z0 where only z0 is given; NaN where neither is."""
    return np.where(np.isnan(v["sigma0"]), v["w_adhesion"] / (STEP * v["z0"]), v["sigma0"])


@rule(4096, r"not JKR", "0.82")
def not_jkr(v, times):
    """The attraction reaches too far for the model of Johnson, Kendall and Roberts: the ring in which it acts is wider
    than {ZONE:g} of the contact radius or of the layer. adhesion = "maugis" includes it."""
    if "w_adhesion" not in v:
        return np.False_
    E = np.where(is_bare(v["base"]), 1.0, v["E1*"]) / (1 + v["m"])
    zone = np.pi * E * v["w_adhesion"] / (4 * stress_of_adhesion(v) ** 2)
    size = np.where(is_bare(v["base"]), v["a"], np.fmin(v["a"], v["h"]))
    return (v["adhesion"] == "jkr") & (v["w_adhesion"] > 0) & (zone > times * ZONE * size)


@rule(8192, "tension inside", "0.86")
def interior_tension(v, times):
    """There is tension inside the contact, away from its edge: the surfaces may part there, which the model leaves
    out."""
    if "w_adhesion" not in v:
        return np.False_
    shape = v["status"].shape
    index = np.flatnonzero(np.broadcast_to((v["w_adhesion"] > 0) & (v["status"] == 0), shape))
    has_tension = np.zeros(shape, bool)
    if len(index):
        has_tension.flat[index] = rises_from_tension(solve_at_radii(problem_of(v, index), _RADII).p)
    return has_tension


def rises_from_tension(p):
    """(B,) bool: the pressure (B, m) is negative at some radius, and higher at a larger radius."""
    highest = np.maximum.accumulate(p[:, ::-1], axis=1)[:, ::-1]  # the highest at or outside each radius
    return ((p[:, :-1] < 0) & (highest[:, 1:] > p[:, :-1])).any(axis=1)

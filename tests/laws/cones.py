"""Conical asperities that do not feel each other: a micro law in one file.

A rigid cone of half-opening angle α, pressed by δ into a half-space of modulus E, touches it on a circle of radius b
(Sneddon 1965): b = (2/π) δ tan α, F = (2/π) E tan α δ². With Nbar cones on the unit area, A = δ, p = Nbar F and
λ = Nbar π b². At full contact, λ = 1, these are A* = (π/2) B̄ cot α and p* = (E/2) cot α, where B̄ = 1/sqrt(π Nbar);
with y² = A/A* all else is a power of y. The pressure is infinite at an apex: p_max is here the mean pressure of a
spot, which is p* under any load.
"""

import numpy as np

from solver import Curve, Law, Parameter
from solver.laws.disc_cell import PARAMETERS


def scales(E, Nbar, alpha):
    """p*, A* of the modulus E, the density Nbar and the angle alpha."""
    return E / (2 * np.tan(alpha)), np.pi / 2 / np.tan(alpha) / np.sqrt(np.pi * Nbar)


def curve(y):
    """q = p/p*, g = A/A* and their derivatives."""
    return Curve(q=y**4, g=y**2, dq=4 * y**3, dg=2 * y)


def area(y, q):
    """λ."""
    return q


def peak(y, q):
    """p_max/p*, of the mean pressure of a spot."""
    return np.ones_like(q)


def edge():
    """gamma, beta of g = gamma q^beta for small q."""
    return 1.0, 0.5


CONES = Law(
    name="cones",
    version="1",
    parameters={
        "Nbar": PARAMETERS["Nbar"],
        "alpha": Parameter(interval="(0, 1.57)", symbol="α", long_name="half-opening angle of a cone, in radians"),
    },
    scales=scales,
    curve=curve,
    area=area,
    peak=peak,
    edge=edge,
)

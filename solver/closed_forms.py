"""Closed-form solutions: for users, for first guesses and for tests. Smooth punches only.

References
----------
Johnson, Contact Mechanics (1985), ch. 4 (Hertz) and 5.8 (elastic layers); Popov, Heß & Willert, Handbook of Contact
Mechanics (2019).
"""

from typing import NamedTuple

import numpy as np


class Hertz(NamedTuple):
    """Hertz's contact: P in E R², a and D in R, p0 = p(0) in E; arrays of one shape."""

    P: np.ndarray
    a: np.ndarray
    D: np.ndarray
    p0: np.ndarray


def hertz(P=None, a=None, D=None, p0=None, R=1.0, E=1.0):
    """Smooth sphere on a homogeneous half-space: P, a, D and p(0) from any one of them.

    Parameters
    ----------
    P, a, D, p0 : array, > 0; exactly one
        Load (E R²), contact radius (R), indentation depth (R), largest pressure (E).
    R, E : array, > 0
        Radius of the sphere and E* of the half-space; any consistent units.

    Returns
    -------
    Hertz
        P = 4 E a³/(3 R), D = a²/R, p0 = 2 E a/(pi R).

    Raises
    ------
    ValueError
        If not exactly one of P, a, D, p0 is given.

    Examples
    --------
    >>> print(f"{hertz(P=2.70408e-5).D:.5e}")
    7.43681e-04
    """
    if sum(v is not None for v in (P, a, D, p0)) != 1:
        raise ValueError("hertz: give exactly one of P, a, D, p0")
    if P is not None:
        a = np.cbrt(0.75 * np.asarray(P, float) * R / E)
    elif D is not None:
        a = np.sqrt(np.asarray(D, float) * R)
    elif p0 is not None:
        a = np.pi * np.asarray(p0, float) * R / (2 * E)
    a = np.asarray(a, dtype=float)
    return Hertz(P=4 / 3 * E * a**3 / R, a=a, D=a * a / R, p0=2 / np.pi * E * a / R)


def hertz_pressure(x, p0):
    """Hertz's pressure p0 sqrt(1 - x²), x = r/a in [0, 1], broadcast against p0; in the unit of p0."""
    x = np.asarray(x, dtype=float)
    return p0 * np.sqrt((1 - x) * (1 + x))


class Layer(NamedTuple):
    """Thin layer on a rigid base: P in E R², a and D in R, p0 = p(0) in E; arrays of one shape."""

    P: np.ndarray
    a: np.ndarray
    D: np.ndarray
    p0: np.ndarray


def thin_layer_on_rigid_base(P=None, a=None, D=None, h=1.0, nu1=0.3, bonded=False, R=1.0, E=1.0):
    """Smooth sphere on a thin compressible layer on a rigid base (a foundation of springs): leading order in h/a.

    Parameters
    ----------
    P, a, D : array, > 0; exactly one
        Load (E R²), contact radius (R), indentation depth (R).
    h : array, > 0
        Thickness of the layer (R).
    nu1 : array, (-1, 0.5); used when bonded
        Poisson ratio of the layer; the bonded incompressible layer (0.5) has no such limit and gives inf.
    bonded : bool
        Perfect bond or frictionless interface.
    R, E : array, > 0
        Radius of the sphere and E1* of the layer.

    Returns
    -------
    Layer
        p = (a² - r²)/(2 R C), C = 2 A2 h/E with A2 of Eq. (2) at n = 0; P = pi a⁴/(4 R C), D = a²/(2 R), p0 = a²/(2
        R C).

    Raises
    ------
    ValueError
        If not exactly one of P, a, D is given.
    """
    if sum(v is not None for v in (P, a, D)) != 1:
        raise ValueError("thin_layer_on_rigid_base: give exactly one of P, a, D")
    A2 = (1 - 2 * np.asarray(nu1, float)) / (2 * (1 - np.asarray(nu1, float)) ** 2) if bonded else 0.5
    C = 2 * A2 * h / E
    if P is not None:
        a = (4 * C * R * np.asarray(P, float) / np.pi) ** 0.25
    elif D is not None:
        a = np.sqrt(2 * R * np.asarray(D, float))
    a = np.asarray(a, dtype=float)
    with np.errstate(divide="ignore"):
        return Layer(P=np.pi * a**4 / (4 * R * C), a=a, D=a * a / (2 * R), p0=a * a / (2 * R * C))

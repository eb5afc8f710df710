"""Closed-form solutions of smooth contacts, for users, for first guesses and for tests.

All arguments are in one consistent set of units (m, Pa and N, for example), and so are the answers. With R = E = 1, the
default, they are dimensionless like those of :func:`solver.solve`. Arrays broadcast.

Johnson, Contact Mechanics (1985), ch. 4 (Hertz) and 5.8 (elastic layers); Popov, Heß & Willert, Handbook of Contact
Mechanics (2019).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike


class SmoothContact(NamedTuple):
    """A smooth contact; arrays of one shape.

    Attributes
    ----------
    P, a, D, p0 : load, contact radius, indentation depth, and central pressure p(0)

    Examples
    --------
    >>> contact = hertz(a=0.04)
    >>> print(f"D = {contact.D:.4f}, p0 = {contact.p0:.4f}")
    D = 0.0016, p0 = 0.0255
    """

    P: np.ndarray
    a: np.ndarray
    D: np.ndarray
    p0: np.ndarray


def hertz(
    P: ArrayLike | None = None,
    a: ArrayLike | None = None,
    D: ArrayLike | None = None,
    p0: ArrayLike | None = None,
    R: float | np.ndarray = 1.0,
    E: float | np.ndarray = 1.0,
) -> SmoothContact:
    """Smooth sphere on a homogeneous half-space: P, a, D and p(0) from any one of these.

    P = 4 E a³/(3 R), D = a²/R, p0 = 2 E a/(pi R): Johnson (1985), Eqs (4.22) to (4.24).

    Parameters
    ----------
    P, a, D, p0 : load, contact radius, indentation depth, pressure in the centre, > 0; exactly one
    R, E : radius of the sphere, and reduced modulus E* of the half-space, > 0

    Returns
    -------
    SmoothContact : arrays of the shape to which the arguments broadcast

    Raises
    ------
    ValueError : not exactly one of P, a, D, p0

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
    return SmoothContact(P=4 / 3 * E * a**3 / R, a=a, D=a * a / R, p0=2 / np.pi * E * a / R)


def hertz_pressure(x: ArrayLike, p0: float | np.ndarray) -> np.ndarray:
    """Hertz's pressure p0 sqrt(1 - x²), Johnson (1985), Eq. (3.39).

    Parameters
    ----------
    x : radii r/a in [0, 1]
    p0 : pressure in the centre

    Returns
    -------
    numpy.ndarray : in the unit of p0; x and p0 broadcast

    Examples
    --------
    >>> hertz_pressure([0, 0.6, 1], 2.0).round(12).tolist()
    [2.0, 1.6, 0.0]
    """
    x = np.asarray(x, dtype=float)
    return p0 * np.sqrt((1 - x) * (1 + x))


def yield_pressure(nu: ArrayLike) -> np.ndarray:
    """Pressure in the centre of a sphere on a half-space at which the half-space first yields, over its yield strength.

    It yields on the axis, at the depth y a, where 1/q = max |1.5/(1 + y²) - (1 + nu) (1 - y arctan(1/y))|. The criteria
    of von Mises and Tresca agree there: Johnson (1985), Eqs (3.45) and 6.1.

    Parameters
    ----------
    nu : Poisson ratio of the half-space, in (-1, 0.5]

    Returns
    -------
    numpy.ndarray : q, of the shape of nu

    Examples
    --------
    >>> yield_pressure([0.0, 0.3, 0.5]).round(6).tolist()
    [1.299305, 1.612797, 1.877239]
    """
    nu = np.asarray(nu, dtype=float)
    y = 0.5236 * (1 + nu) / (1 + 0.37 * (1 + nu))  # right to 3 %: after three steps only rounding is left
    for _ in range(3):
        slope = (1 + nu) * (np.arctan2(1.0, y) - y / (1 + y * y)) - 3 * y / (1 + y * y) ** 2
        y = y + slope / ((2 * (1 + nu) + 3) / (1 + y * y) ** 2 - 12 * y * y / (1 + y * y) ** 3)
    return 1 / (1.5 / (1 + y * y) - (1 + nu) * (1 - y * np.arctan2(1.0, y)))


def thin_layer_on_rigid_base(
    P: ArrayLike | None = None,
    a: ArrayLike | None = None,
    D: ArrayLike | None = None,
    *,
    h: float | np.ndarray,
    nu1: ArrayLike = 0.3,
    bonded: bool = False,
    R: float | np.ndarray = 1.0,
    E: float | np.ndarray = 1.0,
) -> SmoothContact:
    """Smooth sphere on a thin layer on a rigid base: P, a, D and p(0) from any one of the first three.

    The layer is a foundation of springs: the displacement at each place is C p(r), with the pressure there. That is the
    leading order for a layer much thinner than the contact, h << a, and Eq. (3) of the model for n -> 0.

    P = pi a⁴/(4 R C), D = a²/(2 R), p0 = a²/(2 R C); the pressure is p0 (1 - (r/a)²): Johnson (1985), 5.8.
    C = 2 A2 h/E, with A2 of Eq. (2) at n = 0: 1/2 without friction, (1 - 2 nu1)/(2 (1 - nu1)²) bonded.

    Parameters
    ----------
    P, a, D : load, contact radius, indentation depth, > 0; exactly one of them
    h : thickness of the layer, > 0
    nu1 : Poisson ratio of the layer in (-1, 0.5), which counts only with a bond. At 0.5 a bonded layer is not a
        foundation of springs: P and p0 are infinite at given a or D, and NaN at given P
    bonded : True: perfect bond of layer and base; False: frictionless interface
    R, E : radius of the sphere, and reduced modulus E1* of the layer, > 0

    Returns
    -------
    SmoothContact : arrays of the shape to which the arguments broadcast

    Raises
    ------
    ValueError : not exactly one of P, a, D

    Examples
    --------
    >>> print(f"{thin_layer_on_rigid_base(a=0.1, h=0.01).P:.5e}")
    7.85398e-03
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
    with np.errstate(divide="ignore", invalid="ignore"):
        return SmoothContact(P=np.pi * a**4 / (4 * R * C), a=a, D=a * a / (2 * R), p0=a * a / (2 * R * C))

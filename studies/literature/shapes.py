"""Published formulas for cones, flat punches and balls on a bonded layer of ν = 1/2 on a rigid base, in units E1* = 1.

Each gives the load at the depth D: the load on a half-space (Sneddon 1965, closed), alone or times
1 + c1 x + c2 x² + ..., where x is D tan(α)/h for a cone, b/h for a flat punch and sqrt(R D)/h for a ball.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import xarray as xr

from study.figures.registry import pick, table

from .formulas import DIMITRIADIS, GARCIA, PYFMRHEO

SHOWN_AT = (0.1, 0.5, 1.0, 2.0, 4.0)  # a/h for which the table has the errors
_GAVARA = 1.7795 / np.pi**2  # times tan(α) D/h


class Formula(NamedTuple):
    """name : authors and year; shape : of the punch; of : (D, h, contact) -> P; read : source of its constants"""

    name: str
    shape: str
    of: Callable
    read: str


def _series(half_space: Callable, x: Callable, *coefficients: float) -> Callable:
    """The load on the half-space times a polynomial in x, as a function of (D, h, contact)."""
    polynomial = np.polynomial.polynomial.polyval
    return lambda D, h, case: half_space(D, case) * polynomial(x(D, case) / h, (1.0, *coefficients))


def _tangent(case: xr.Dataset) -> float:
    return float(np.tan(np.radians(case["half_angle"])))


def _cone(D, case):
    return 2 / np.pi * _tangent(case) * D**2


def _flat(D, case):
    return 2 * float(case["flat_radius"]) * D


def _hertz(D, case):
    return 4 / 3 * D**1.5 + 0 * case["h"].values


def _ball(D, case):
    """Sneddon's ball: D = a artanh a, P = (a² + 1) artanh a - a, in R = 1."""
    a = np.linspace(1e-4, 0.999, 20_000)
    return np.interp(D, a * np.arctanh(a), (a**2 + 1) * np.arctanh(a) - a)


def _of_cone(D, case):
    return D * _tangent(case)


def _of_flat(D, case):
    return float(case["flat_radius"])


def _of_ball(D, case):
    return np.sqrt(D)


FORMULAS = (
    Formula("Sneddon 1965", "cone", _series(_cone, _of_cone), "closed"),
    Formula("Gavara and Chadwick 2012", "cone", _series(_cone, _of_cone, 2 * _GAVARA, 16 * 1.7795**2), PYFMRHEO),
    Formula("Managuli and Roy 2018", "cone", _series(_cone, _of_cone, 4 * _GAVARA, 20 * _GAVARA**2), PYFMRHEO),
    Formula("Garcia and Garcia 2018", "cone", _series(_cone, _of_cone, 0.721, 0.650, 0.491, 0.225), PYFMRHEO),
    Formula("Sneddon 1965", "flat", _series(_flat, _of_flat), "closed"),
    Formula("Garcia and Garcia 2018", "flat", _series(_flat, _of_flat, 1.133, 1.283, 0.598, -0.291), PYFMRHEO),
    Formula("Sneddon 1965", "sphere", _series(_ball, _of_ball), "closed"),
    Formula("Hertz 1882, of a paraboloid", "sphere", _series(_hertz, _of_ball), "closed"),
    Formula("Dimitriadis et al. 2002, nu = 1/2", "sphere", _series(_hertz, _of_ball, *DIMITRIADIS), PYFMRHEO),
    Formula("Garcia and Garcia 2018", "sphere", _series(_hertz, _of_ball, *GARCIA), PYFMRHEO),
)


def load_error(formula: Formula, contacts: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """a/h in ascending order, and the relative error of a formula's load at the exact depth."""
    case = pick(contacts, label=formula.shape).sortby("h", ascending=False)
    case = case.isel(h=case["status"].values == 0)
    h = case["h"].values
    load = formula.of(float(case["D"]), h, case)
    return case["a"].values / h, load / case["P"].values - 1


@table(
    "literature_shapes",
    "literature_shapes",
    columns="formula; shape; constants read in" + "".join(f"; a/h = {x:g} | +.2% | $a/h = {x:g}$" for x in SHOWN_AT),
)
def loads_of_shapes(contacts: xr.Dataset) -> list[tuple]:
    """Formulas of the load on a cone (half angle 70.3 degrees), a flat punch and a ball (a = 0.4 R on a half-space) on
    a bonded layer of nu = 1/2 on a rigid base: their errors at one depth."""
    from scipy.interpolate import CubicSpline

    rows = []
    for formula in FORMULAS:
        x, error = load_error(formula, contacts)
        rows.append((formula.name, formula.shape, formula.read, *CubicSpline(np.log(x), error)(np.log(SHOWN_AT))))
    return rows

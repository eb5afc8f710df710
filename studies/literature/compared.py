"""The formulas of the literature compared with the exact layer: errors, safe ranges, and decisive numbers."""

import numpy as np
import xarray as xr

from study import derived
from study.figures.registry import pick

from . import formulas
from .formulas import Formula

LEVELS = (0.01, 0.05)  # errors for which the tables have the ranges of a/h
SERIES_UP_TO = 0.15
"""The series of F/F_H is fitted below this a/h: with degree 6 the first two coefficients agree to 1e-4 with their
closed forms (tests/literature/test_literature.py)."""


def contacts_on_layer(rigid: xr.Dataset, bonded: bool, nu: float) -> xr.Dataset:
    """The contacts of one layer on a rigid base, in order of a/h. Without friction the Poisson ratio has no effect."""
    case = pick(rigid, bonding="bonded", nu1=nu) if bonded else pick(rigid, bonding="frictionless")
    return case.sortby("h", ascending=False)


def over_hertz(contact: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """a/h, χ = sqrt(R D)/h and F/F_H of contacts on a rigid base, R = E1* = 1."""
    h, D = contact["h"].values, contact["D"].values
    return float(contact["a"]) / h, np.sqrt(D) / h, contact["P"].values / (4 / 3 * D**1.5)


def load_error(formula: Formula, rigid: xr.Dataset, nu: float) -> tuple[np.ndarray, np.ndarray]:
    """a/h, and the relative error of a formula's load at the exact depth."""
    x, chi, exact = over_hertz(contacts_on_layer(rigid, formula.bonded, nu))
    return x, formula.of(chi, nu) / exact - 1


def stiffness(coated: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """a/h (m,), n (k,) and E_eff/E2* (k, m) of coated half-spaces."""
    coated = coated.sortby("h", ascending=False)
    x = float(coated["a"]) / coated["h"].values
    return x, coated["n"].values, derived.effective_modulus(coated).transpose("n", "h").values


def stiffness_errors(coated: xr.Dataset) -> dict[str, np.ndarray]:
    """Name of a formula -> its relative error (n, a/h). The last formula has a free α: it gets the best α for each
    n."""
    x, n, exact = stiffness(coated)
    nu = float(coated["nu1"])
    by_name = {name: formula(x, n[:, None], nu) / exact - 1 for name, (formula, _) in formulas.STIFFNESSES.items()}
    errors = formulas.doerner_nix(x, n[:, None], nu, np.geomspace(0.1, 10, 201)[:, None, None]) / exact - 1
    best = np.abs(errors).max(axis=2).argmin(axis=0)  # the α with the smallest largest error
    return by_name | {"Doerner and Nix 1986, King 1987": errors[best, np.arange(len(n))]}


def over_smooth(rough: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """α, μ, and p(0) and effective radius over those of Hertz, (cases,) each, of contacts with random heights.

    The effective radius is (3π/4) ∫ r p dr/∫ p dr, which is a for a smooth sphere.
    """
    from scipy.interpolate import CubicSpline

    P, sigma, x, p = (rough[name].values for name in ("P", "sigma", "x", "p"))
    smooth = np.cbrt(0.75 * P)
    alpha, mu = sigma / smooth**2, 8 / 3 * rough["Nbar"].values * sigma * np.sqrt(2 * rough["Ra"].values)
    moments = [CubicSpline(x, weight * p, axis=-1).integrate(0, 1) for weight in (x, np.ones_like(x))]
    radius = 3 * np.pi / 4 * rough["a"].values * moments[0] / moments[1]
    return alpha, mu, rough["p0"].values / (2 * smooth / np.pi), radius / smooth


def safe_range(x: np.ndarray, error: np.ndarray, level: float, *, last: bool = False) -> tuple[float, float]:
    """Smallest and largest x of the range with |error| <= level that begins at the first x, or ends at the last x.

    The error is linear in ln x between the points. NaN if there is no such range.
    """
    if last:
        start, stop = safe_range(1 / x[::-1], error[::-1], level)
        return 1 / stop, 1 / start
    if abs(error[0]) > level:
        return np.nan, np.nan
    exceeds = np.abs(error) > level
    if not exceeds.any():
        return x[0], x[-1]
    i = int(np.argmax(exceeds))
    share = (np.copysign(level, error[i]) - error[i - 1]) / (error[i] - error[i - 1])
    return x[0], float(np.exp(np.interp(share, (0, 1), np.log(x[i - 1 : i + 1]))))


def range_of(x: np.ndarray, error: np.ndarray, level: float, thin: bool) -> str:
    """`safe_range` in words."""
    start, stop = safe_range(x, error, level, last=thin)
    if np.isnan(start):
        return "nowhere"
    if (start, stop) == (x[0], x[-1]):
        return "everywhere"
    return f"from {start:.3g}" if thin else f"up to {stop:.3g}"


def around_one(n: np.ndarray, largest: np.ndarray, level: float) -> str:
    """The range of n around 1 in which the largest error (n,) stays within the level, in words."""
    above, below = n > 1, n < 1
    ends = []
    for side, order in ((below, -1), (above, 1)):
        y, error = np.abs(np.log(n[side][::order])), largest[side][::order]
        ends.append(np.exp(order * safe_range(y, error, level)[1]))
    return "nowhere" if np.isnan(ends).any() else f"{ends[0]:.2g} to {ends[1]:.2g}"


def coefficients(rigid: xr.Dataset, bonded: bool, nu: float) -> np.ndarray:
    """c1, c2, c3 of F/F_H = 1 + c1 χ + c2 χ² + c3 χ³ + ..., by least squares of the exact contacts at small a/h."""
    x, chi, exact = over_hertz(contacts_on_layer(rigid, bonded, nu))
    small = x <= SERIES_UP_TO
    degree = min(6, np.count_nonzero(small) - 1)
    series = np.polynomial.Polynomial.fit(chi[small], (exact[small] - 1) / chi[small], degree).convert().coef
    return np.append(series, np.full(3, np.nan))[:3]


def kappa(rigid: xr.Dataset, nu: float, at: float | np.ndarray = 1.0) -> np.ndarray:
    """E_eff/E1* of bonded layers at the a/h `at`: a cubic spline of logarithms."""
    from scipy.interpolate import CubicSpline

    contact = contacts_on_layer(rigid, True, nu)
    x = over_hertz(contact)[0]
    return np.exp(CubicSpline(np.log(x), np.log(derived.effective_modulus(contact).values))(np.log(at)))

"""Micro laws in studies: their results, and the fits of power laws."""

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np

from solver.laws import Law
from solver.laws.power_law_fit import fit_power_law
from solver.parameters import allowed, one_of

from ..grid import Grid, along
from ..lexicon import PACKAGE
from ..vocabulary import names

MOST_FITS = 1000
"""Most different values of Nbar Ra² in a study. A law is fitted to each, in 2 ms."""
DIGITS = 10
"""B and beta are rounded to so many significant digits. Results are found on disk by the values of their parameters,
and the last digits of a fit depend on the processor."""
COMMENT = "fitted to Nbar and Ra by least squares over pressures from 1e-4 to 0.025 E1*, as in Section 4.1 of the paper"

#: Results that only asperities which feel the layer have.
_OF_FELT = ("p_spot", "r_spot")


def results_of(
    laws: Mapping[str, Law], micro: np.ndarray, sticking: bool = False, felt: bool = False
) -> tuple[str, ...]:
    """Names of the results of the `laws` that `micro` names. They include plastic_share if the spots of some law yield,
    results of pull-off if contacts may be `sticking`, and results of spots if some asperities feel the layer (`felt`).
    """
    yields = one_of(micro, [name for name, law in laws.items() if law.yielded]).any()
    left_out = ("plastic_share",) * (not yields) + _OF_FELT * (not felt)
    of_laws = tuple(name for name in names("result") if name not in left_out)
    return of_laws + (names("pull_off") if sticking else ())


def wants_a_fit(grid: Grid) -> bool:
    """Whether some case has the power law, no case has B and beta, and all cases with the power law have Nbar and Ra.

    A grid with only one of B and beta has been refused before.
    """
    power = along(grid, "micro") == "power_law"
    if not power.any() or "B" in grid.values:
        return False
    return bool((np.isfinite(along(grid, "Nbar") * along(grid, "Ra")) | ~power).all())


def fitted(grid: Grid) -> tuple[dict, list[str]]:
    """Values of B and beta over the dimensions of Nbar and Ra, as in `Grid.values`, and messages."""
    products = along(grid, "Nbar") * along(grid, "Ra") ** 2
    different = np.unique(products[np.isfinite(products)]).tolist()
    if len(different) > MOST_FITS:
        few = f"at most {MOST_FITS} values of Nbar Ra^2 are fitted, not {len(different)}"
        return {}, [f"B and beta are missing: {few}"]
    dims = tuple(dim for dim in grid.sizes if dim in {*grid.values["Nbar"][0], *grid.values["Ra"][0]})
    values, errors = {}, []
    for name, fits in fits_to(different).items():
        parameter = PACKAGE.parameter(name)
        rounded = {product: float(f"{fit:.{DIGITS}g}") for product, fit in fits.items()}
        array = np.array([rounded.get(product, np.nan) for product in products.ravel().tolist()])
        values[name] = dims, array.reshape([grid.sizes[dim] for dim in dims])
        wrong = [f"{product:g} is {fit:g}" for product, fit in fits.items() if not allowed(parameter, fit)][:1]
        errors += [f"{name} fitted to Nbar Ra^2 = {fit}: must be in {parameter.interval}" for fit in wrong]
    return values, errors


def fits_to(products: list[float]) -> dict[str, dict[float, float]]:
    """B and beta -> Nbar Ra² -> the fitted value, in full digits."""
    power_laws = {product: fit_power_law(product) for product in products}
    return {name: {product: getattr(law, name) for product, law in power_laws.items()} for name in ("B", "beta")}


#: Nbar Ra^2 is moved by this share of itself. Fits are accurate to some 1e-12 (their root is sought to 1e-15), so that
#: rounding changes a slope by some 1e-9. So does the curvature.
_STEP = 1e-3


def slopes_of_fit(products: Any) -> dict[str, Any]:
    """B and beta -> d ln B/d ln(Nbar Ra^2), d ln beta/d ln(Nbar Ra^2) of the fits to `products`, Nbar Ra^2.

    products : a number or a DataArray, as the slopes are
    """
    values = np.array([_slopes_of_fit(v) if v > 0 else (0.0, 0.0) for v in np.ravel(products).tolist()]).T
    zero = 0.0 * products
    return {name: zero + slopes.reshape(np.shape(products)) for name, slopes in zip(("B", "beta"), values, strict=True)}


@cache
def _slopes_of_fit(product: float) -> tuple[float, float]:
    up, down = (fit_power_law(product * (1 + step)) for step in (_STEP, -_STEP))
    return float(np.log(up.B / down.B) / (2 * _STEP)), float(np.log(up.beta / down.beta) / (2 * _STEP))

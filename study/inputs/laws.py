"""Micro laws in studies: laws that users register, and power laws that are fitted."""

from contextlib import suppress
from functools import cache
from typing import Any

import numpy as np

from solver import laws
from solver.laws.fit import fit_power_law
from solver.laws.own_table import PREFIX
from solver.parameters import PARAMETERS as SOLVER_PARAMETERS
from solver.parameters import allowed, one_of

from .grid import Grid, along
from .punch import shapes
from .vocabulary import (
    BODIES,
    PARAMETERS,
    SCENE,
    VOCABULARY,
    Entry,
    names,
    of_package,
    put_rows,
)

MOST_FITS = 1000
"""Most different values of Nbar Ra² in a study. A law is fitted to each, in 2 ms."""
DIGITS = 10
"""Significant digits of B and beta that are kept. Results are found on disk by the values of their parameters, and the
last digits of a fit depend on the processor."""
COMMENT = "fitted to Nbar and Ra by least squares over pressures from 1e-4 to 0.025 E1*, as in Section 4.1 of the paper"

# A law must not call a parameter like a result, or like another argument of `study.solve`.
laws.RESERVED.update({*VOCABULARY, "cases", "profiles", "title", "workers"} - set(SOLVER_PARAMETERS))
laws.RESERVED.update(f"{name}_spread" for name in VOCABULARY)
laws.RESERVED.update(SCENE, BODIES)


def update_vocabulary() -> None:
    """Make PARAMETERS and VOCABULARY fit the micro laws and shapes that are registered now.

    Where they do already nothing is touched: other threads read them meanwhile.
    """
    put_rows(_rows)


def _rows() -> dict[str, Entry]:
    """Rows of the vocabulary for the parameters of laws and shapes that are registered."""
    rows: dict[str, Entry] = {}
    for law in laws.LAWS.values():
        for name, declared in law.parameters.items():
            if not of_package(name):
                owners = " and ".join(other.name for other in laws.LAWS.values() if name in other.parameters)
                words = declared.long_name or f"parameter of the micro law {owners}"
                rows.setdefault(name, Entry(name, "roughness", words, declared.symbol or name, declared.powers))
    return rows | shapes.rows()


def law_names(values: list) -> list:
    """The values of `micro` as names. A law given as an object is registered under its name.

    If a name is not known, the laws of installed packages are loaded. Raises ValueError for a law that cannot be used.
    """
    words = laws.named(values)
    laws.load((), [word for word in words if isinstance(word, str)])
    update_vocabulary()
    return words


def recall(versions: str) -> None:
    """Register the laws of results, if they are installed; `versions` has a line "NAME VERSION" for each.

    A table of the user's is not read: whoever sends a results file must not choose which files are opened.
    """
    for line in versions.splitlines():
        if (name := laws.name_in(line)) not in laws.LAWS and not name.startswith(PREFIX):
            with suppress(ValueError):  # then it stays unknown
                law_names([name])


def is_parameter(name: str) -> bool:
    """Whether this is the name of a parameter. The laws of installed packages are loaded before the answer is no."""
    if name not in PARAMETERS:
        with suppress(ValueError):  # a law that cannot be loaded is an error when `micro` names it
            laws.load([name], ())
        update_vocabulary()
    return name in PARAMETERS


#: Results that only asperities which feel the layer have.
_OF_FELT = ("p_spot", "r_spot")


def results_of(micro: np.ndarray, sticking: bool = False, felt: bool = False) -> tuple[str, ...]:
    """Names of the results of these laws; plastic_share only if the spots of some law yield, those of pull-off only of
    contacts that may be `sticking`, those of spots only where some asperities feel the layer (`felt`)."""
    yields = one_of(micro, [name for name, law in laws.LAWS.items() if law.yielded]).any()
    left_out = ("plastic_share",) * (not yields) + _OF_FELT * (not felt)
    of_laws = tuple(name for name in names("result") if name not in left_out)
    return of_laws + (names("pull_off") if sticking else ())


def smooth_laws() -> list[str]:
    """Names of the laws without asperities."""
    return [name for name, law in laws.LAWS.items() if not law.rough]


def wants_a_fit(grid: Grid) -> bool:
    """Whether some case has the power law, none has B and beta, and all with the power law have Nbar and Ra.

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
        parameter = VOCABULARY[name].parameter
        rounded = {product: float(f"{fit:.{DIGITS}g}") for product, fit in fits.items()}
        array = np.array([rounded.get(product, np.nan) for product in products.ravel().tolist()])
        values[name] = dims, array.reshape([grid.sizes[dim] for dim in dims])
        wrong = [f"{product:g} is {fit:g}" for product, fit in fits.items() if not allowed(parameter, fit)][:1]
        errors += [f"{name} fitted to Nbar Ra^2 = {fit}: must be in {parameter.interval}" for fit in wrong]
    return values, errors


def fits_to(products: list[float]) -> dict[str, dict[float, float]]:
    """B and beta -> Nbar Ra² -> value of the law that is fitted to it, in full digits."""
    power_laws = {product: fit_power_law(product) for product in products}
    return {name: {product: getattr(law, name) for product, law in power_laws.items()} for name in ("B", "beta")}


#: Nbar Ra^2 is moved by this part of itself. Fits are good to some 1e-12 (their root is sought to 1e-15), so that
#: rounding changes a slope by some 1e-9. The curvature does as much.
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

"""Power laws without B and beta: fitted to Nbar and Ra, as the paper fits its own."""

import numpy as np

from solver.laws.fit import fit_power_law
from solver.parameters import allowed

from .grid import Grid, along
from .vocabulary import VOCABULARY

MOST_FITS = 1000
"""Most different values of Nbar Ra² in a study. A law is fitted to each, in 2 ms."""
DIGITS = 10
"""Significant digits of B and beta that are kept: the last ones of a fit depend on the processor, and results are found
on disk by the values of their parameters."""
COMMENT = "fitted to Nbar and Ra by least squares over pressures from 1e-4 to 0.025 E1*, as in Section 4.1 of the paper"


def wants_a_fit(grid: Grid) -> bool:
    """Whether some case has the power law, none has B and beta, and Nbar and Ra are known where they are needed. Of B
    and beta a grid has both or none: that one is missing has been said before."""
    power = along(grid, "micro") == "power_law"
    if not power.any() or "B" in grid.values:
        return False
    return bool((np.isfinite(along(grid, "Nbar") * along(grid, "Ra")) | ~power).all())


def fitted(grid: Grid) -> tuple[dict, list[str]]:
    """Values of B and beta over the dimensions of Nbar and Ra, as in `Grid.values`; and what is wrong with them."""
    products = along(grid, "Nbar") * along(grid, "Ra") ** 2
    known = np.unique(products[np.isfinite(products)]).tolist()
    if len(known) > MOST_FITS:
        few = f"at most {MOST_FITS} values of Nbar Ra^2 are fitted, not {len(known)}"
        return {}, [f"B and beta are missing: {few}"]
    dims = tuple(dim for dim in grid.sizes if dim in {*grid.values["Nbar"][0], *grid.values["Ra"][0]})
    laws, found, errors = {value: fit_power_law(value) for value in known}, {}, []
    for name in ("B", "beta"):
        own = VOCABULARY[name].own
        fits = {value: getattr(law, name) for value, law in laws.items()}
        kept = {value: float(f"{fit:.{DIGITS}g}") for value, fit in fits.items()}
        array = np.array([kept.get(value, np.nan) for value in products.ravel().tolist()])
        found[name] = dims, array.reshape([grid.sizes[dim] for dim in dims])
        wrong = [(value, fit) for value, fit in fits.items() if not allowed(own, fit)]
        errors += [f"{name} fitted to Nbar Ra^2 = {v:g} is {fit:g}: must be in {own.interval}" for v, fit in wrong[:1]]
    return found, errors

"""Studies of kind "micro_law": the exact law A[p] and its power-law fit for given asperities, no contact problem."""

import numpy as np
import xarray as xr

from solver import fit_power_law
from solver.laws.disc_cell import displacement

from ..data.dataset import assembled
from ..spec.definition import Definition
from ..spec.grid import columns


def compute(definition: Definition, command: str) -> xr.Dataset:
    """A_exact, A_fit over (..., p) and B, beta, max_error over the cases. Pressures in E1*, A in R, B in Ra/E1*^β."""
    grid, fit, p = definition.grid, definition.fit, definition.x
    given = columns(grid, 0, grid.size)
    Nbar, Ra = given["Nbar"], given["Ra"]
    fits = [fit_power_law(ratio, **(fit | {"check": tuple(fit["check"])})) for ratio in Nbar * Ra**2]
    B, beta, max_error = (np.array([getattr(one, name) for one in fits]) for name in ("B", "beta", "max_error"))
    arrays = {
        "A_exact": np.array([displacement(p, 1.0, *case) for case in zip(Nbar, Ra, strict=True)]),
        "A_fit": (B * Ra)[:, None] * p ** beta[:, None],
        "B": B,
        "beta": beta,
        "max_error": max_error,
    }
    dataset = assembled(definition, arrays, "p", p, command)
    dataset["p"].attrs["scale"] = "E1*"
    return dataset

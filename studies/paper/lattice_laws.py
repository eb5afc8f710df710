"""Table 1 and Figures 9 and 10 of the paper, compared with asperities on a square lattice.

The law of the lattice has each neighbour in its place; the paper's disc cell spreads the neighbours evenly.
"""

import numpy as np
import xarray as xr

from solver.laws.power_law_fit import least_squares
from study.figures.registry import TWO_COLUMNS, Columns, figure, pick, table

from . import numbers
from .curves import PAPER, pressures
from .law_fits import PAPERS_NAME, PRESSURES, draw_laws, exact, largest_error, printed

DISC = {"linestyle": (0, (4, 2)), "linewidth": 0.9}


@table(
    "table1_lattice",
    columns=r"""
    Ra/R | g | $R_a/R$; N R^2 | d | $\bar N R^2$; N Ra^2 | g | $\bar N R_a^2$; paper's fit off | .1%
    disc cell off | .1%; B | .3e | $B E_1^{*\beta}/R$; beta | .4f | $\beta$; error | .1%""",
)
def table1_lattice() -> list[tuple]:
    """Table 1 against asperities on a square lattice, 0.0025 to 0.025 E1*: largest error of the power law with the
    paper's constants, and of the disc cell that it is fitted to; the power law fitted to the lattice, and its error. B
    is in R/E1*^beta."""
    rows = []
    for Ra, Nbar, *_ in numbers.TABLE1:
        true = exact(Ra, Nbar, "square_lattice")
        B, beta = least_squares(PRESSURES, true)
        errors = [largest_error(A, true) for A in (printed(Ra, Nbar), exact(Ra, Nbar))]
        rows.append((Ra, Nbar, Nbar * Ra**2, *errors, B, beta, largest_error(B * PRESSURES**beta, true)))
    return rows


@figure("fig09_lattice", size=(TWO_COLUMNS, 2.9), panels=(1, 2))
def laws(panels) -> Columns:
    """Additional displacement against pressure: asperities on a square lattice, the disc cell of the paper (dashed),
    and the power law with the constants of its Table 1 (dotted). (a) Three densities of asperities, (b) three radii."""

    def laws_of(Ra: float, Nbar: float) -> dict[str, np.ndarray]:
        return {"lattice": exact(Ra, Nbar, "square_lattice"), "disc": exact(Ra, Nbar), "paper": printed(Ra, Nbar)}

    names = {"lattice": "square lattice", "disc": "disc cell, Eqs (6), (7)", "paper": PAPERS_NAME}
    return draw_laws(panels, laws_of, names, tuple(names), at=0.72 * PRESSURES[-1], side="below", align="left")


@figure("fig10_lattice", "spot_density_lattice", "spot_density", size=(TWO_COLUMNS, 3.0), panels=(1, 2))
def densities(panels, lattice: xr.Dataset, paper: xr.Dataset) -> Columns:
    """(a) Nominal pressure for three densities of asperities on a square lattice, on the exact layer; dotted: with
    the power law of Table 1 on the same layer. (b) How far that (dotted) and the disc cell (dashed) are from the
    lattice, over its p(0). a0: radius of the paper's contact 1."""
    axes, right = panels
    shown, differences = [], {}
    a0 = float(pick(paper, Nbar=250_000, base="thin_layer")["a"])
    for i, side in enumerate(("above", "below", "below")):
        name, of_density = str(i + 1), lattice.isel(Nbar=i)
        true, disc = (of_density.sel(micro=micro) for micro in ("square_lattice", "disc_cell"))
        fitted = pick(paper, Nbar=float(true["Nbar"]), base="layered")
        cases = {name: true, f"{name}, power law": fitted}
        shown.append((cases, rf"{name}: $\bar N R^2 = {int(true['Nbar'])}$", side))
        for kind, other, style in (("power law", fitted, PAPER), ("disc cell", disc, DISC)):
            r = np.linspace(0, max(float(case["a"]) for case in (other, true)), true.sizes["x"])
            p = [np.interp(r, case["x"] * case["a"], case["p"], right=0.0) for case in (other, true)]
            difference = (p[0] - p[1]) / float(true["p0"])
            right.plot(r / a0, 100 * difference, color=f"C{i}", **style)
            differences |= {f"r/a0 ({name}, {kind} off)": r / a0, f"off/p(0) ({name}, {kind})": difference}
    columns = pressures(axes, shown, a0, "power law (the paper)")
    right.plot([], [], color="0.3", label="power law (the paper)", **PAPER)
    right.plot([], [], color="0.3", label="disc cell", **DISC)
    right.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    right.set(xlabel="$r/a_0$", ylabel=r"difference from the lattice / $p(0)$ (%)", xlim=axes.get_xlim())
    right.legend(loc="best", fontsize=8)
    by_curve = sorted((columns | differences).items(), key=lambda column: column[0].rpartition("(")[2][0])
    return dict(by_curve)

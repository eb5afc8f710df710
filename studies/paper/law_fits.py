"""Figure 9 and Table 1: the additional displacement A[p] of five roughnesses, and the power laws fitted to it.

No study is needed: the exact law is a formula, Eqs (6) and (7), and a fit takes milliseconds.
"""

from collections.abc import Callable

import numpy as np

from solver import fit_power_law
from solver.laws import LAWS
from solver.laws.power_law_fit import Fit
from study.figures.annotate import name_curve
from study.figures.registry import TWO_COLUMNS, Columns, figure, table

from . import numbers

PRESSURES = np.linspace(1e-4, 0.025, 250)  # p/E1* of the paper's fit, Section 4.1: from 1e-4 to 0.025 in steps of 1e-4
_DISC = {"color": "black", "linestyle": (0, (4, 3)), "linewidth": 0.8}
_PAPER = {"linestyle": (0, (1, 1.2)), "linewidth": 1.3}
LOOKS = {"fit": {"linestyle": "-"}, "lattice": {"linestyle": "-"}, "exact": _DISC, "disc": _DISC, "paper": _PAPER}
"""Law -> style of its lines; the last law is drawn on top."""
PAPERS_NAME = "with the paper's $B$, $\\beta$"
PANELS = {"a": [(0.004, N) for N in (250_000, 62_500, 15_625)], "b": [(Ra, 250_000) for Ra in (0.004, 0.002, 0.001)]}
"""Ra and N̄ of the curves in each panel of Figure 9."""


def exact(Ra: float, Nbar: float, law: str = "disc_cell") -> np.ndarray:
    """A/R at PRESSURES by Eqs (6) and (7), or by another law."""
    return LAWS[law].at(PRESSURES, 1.0, Nbar=Nbar, Ra=Ra).A


def fitted(Ra: float, Nbar: float) -> Fit:
    """The power law as the paper fits it, with B in R/E1*^β."""
    fit = fit_power_law(Nbar * Ra**2)
    return fit._replace(B=fit.B * Ra)


def printed(Ra: float, Nbar: float) -> np.ndarray:
    """A/R at PRESSURES with the constants printed in the paper."""
    B, beta = next(row[2:] for row in numbers.TABLE1 if row[:2] == (Ra, Nbar))
    return B * PRESSURES**beta


def largest_error(A: np.ndarray, true: np.ndarray) -> float:
    """Largest relative error of A at the PRESSURES for which the paper states errors, including both ends."""
    inside = np.isclose(PRESSURES, np.clip(PRESSURES, *numbers.ERROR_INTERVAL), rtol=1e-9)
    return float(np.abs(A / true - 1)[inside].max())


def bound(Ra: float, Nbar: float) -> str:
    """The paper's words on the error of its fit."""
    return f"at most {numbers.ERROR_BOUNDS[round(Nbar * Ra**2, 9)]:.0%}"


@table(
    "table1",
    columns=r"""
    Ra/R | g | $R_a/R$; N R^2 | d | $\bar N R^2$; N Ra^2 | g | $\bar N R_a^2$
    B paper | .1e | $B E_1^{*\beta}/R$ (paper); beta paper | .2f | $\beta$ (paper); error stated; error found | .1%
    B | .3e | $B E_1^{*\beta}/R$; beta | .4f | $\beta$; error | .1%""",
)
def table1() -> list[tuple]:
    """Power law A = B p^beta fitted to the additional displacement of a rough layer: the paper's constants, the error
    that it states and the one that we find; our constants and their error. B is in R/E1*^beta; the B of a study, which
    is in Ra/E1*^beta, is this over Ra/R."""
    rows = []
    for Ra, Nbar, B, beta in numbers.TABLE1:
        error = largest_error(printed(Ra, Nbar), exact(Ra, Nbar))
        rows.append((Ra, Nbar, Nbar * Ra**2, B, beta, bound(Ra, Nbar), error, *fitted(Ra, Nbar)))
    return rows


@figure("fig09", size=(TWO_COLUMNS, 2.9), panels=(1, 2))
def laws(panels) -> Columns:
    """Additional displacement against pressure: the exact law (dashed), the power law B p^beta fitted to it, and that
    with the constants of the paper's Table 1, which are rounded (dotted). (a) Three densities of asperities, (b) three
    radii."""

    def laws_of(Ra: float, Nbar: float) -> dict[str, np.ndarray]:
        B, beta, _ = fitted(Ra, Nbar)
        return {"exact": exact(Ra, Nbar), "fit": B * PRESSURES**beta, "paper": printed(Ra, Nbar)}

    names = {"exact": "exact, Eqs (6), (7)", "fit": r"fitted, $B p^{\beta}$", "paper": PAPERS_NAME}
    return draw_laws(panels, laws_of, names, ("fit",), at=0.95 * PRESSURES[-1], align="right")


def draw_laws(panels, laws_of: Callable, names: dict[str, str], labelled: tuple[str, ...], **place) -> Columns:
    """Draw A[p] of the roughnesses of PANELS by several laws; returns the numbers.

    laws_of : (Ra, N̄) -> law, one of LOOKS -> A/R at PRESSURES; names : law -> its label in the legend
    labelled : laws whose curves carry the name of a roughness; place : of the name, see `name_curve`
    """
    columns = {"p/E1*": PRESSURES}
    for axes, (panel, roughnesses) in zip(panels, PANELS.items(), strict=True):
        for i, (Ra, Nbar) in enumerate(roughnesses):
            A = laws_of(Ra, Nbar)
            looks = {law: {"color": f"C{i}"} | look for law, look in LOOKS.items() if law in A}
            lines = {law: axes.plot(PRESSURES, A[law] * 1e4, **look)[0] for law, look in looks.items()}
            text = rf"$\bar N R^2 = {Nbar}$" if panel == "a" else f"$R_a/R = {Ra}$"
            name_curve(axes, [lines[law] for law in labelled], text, **place)
            columns |= {f"A/R Ra={Ra} N={Nbar} {law}": values for law, values in A.items()}
        for law, name in names.items():
            axes.plot([], [], label=name, **{"color": "0.5"} | LOOKS[law])
        common = f"$R_a/R = {roughnesses[0][0]}$" if panel == "a" else rf"$\bar N R^2 = {roughnesses[0][1]}$"
        axes.legend(title=f"({panel}) {common}", loc="upper left")
        limits = {"xlim": (0, PRESSURES[-1]), "ylim": (0, axes.get_ylim()[1] * 1.25)}
        axes.set(xlabel="$p/E_1^*$", ylabel=r"$A[p]\ /\ (10^{-4} R)$", **limits)
    return columns

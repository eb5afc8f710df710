"""The formulas of the literature as a figure and as tables."""

import numpy as np
import xarray as xr
from matplotlib.ticker import FuncFormatter

from study.figures.registry import TWO_COLUMNS, Columns, figure, joined, table

from . import compared, formulas, pull_off, shapes, yielding  # noqa: F401 - figures and tables of their own

SHOWN_AT = (0.1, 0.5, 1.0, 2.0, 4.0)  # a/h for which the table has the errors
SHOWN_N = (0.01, 0.1, 0.5, 2.0, 10.0, 100.0)
THIN_TO = (2.0, 20.0)  # largest a/h of the two ranges over which the table has the error of the stiffness
INTERFACES = ((True, 0.5, r"(a) rigid base, bonded, $\nu = 1/2$"), (False, 0.3, "(b) rigid base, frictionless"))
STYLES = {
    "Hertz": ("0.45", "-"),
    "Hayes": ("#e08214", "-"),
    "Dimitriadis, nu = 1/2": ("#2166ac", "-"),
    "Dimitriadis, general": ("#67a9cf", (0, (4, 1.5))),
    "Garcia": ("#762a83", "-"),
    "Hermanowicz": ("#1b7837", "-"),
    "Johnson": ("#b2182b", (0, (1, 1.2))),
    "Gao": ("#8c510a", "-"),
    "Hay": ("#35978f", "-"),
    "Perriot": ("#c51b7d", "-"),
    "Bec": ("k", "-"),
    "Doerner": ("#5e4fa2", (0, (4, 1.5))),
}
"""First word of the name of a formula -> colour, dashes. If two begin alike, the key also has the words after the
comma."""


def look(name: str) -> dict:
    """Colour, dashes and width of the line of a formula."""
    first = name.split()[0].strip(",")
    key = first if first in STYLES else f"{first}, {name.partition(', ')[2]}"
    colour, dashes = STYLES[key]
    return {"color": colour, "linestyle": dashes, "linewidth": 1.1}


@figure("literature", "literature", "literature_coatings", size=(TWO_COLUMNS, 3.7), panels=(1, 3))
def errors(panels, rigid: xr.Dataset, coated: xr.Dataset) -> Columns:
    """Error of published formulas for a smooth punch against the exact layer. (a), (b): of the load at one depth
    on a rigid base, over a/h. (c): of the stiffness on a bonded coating, ν = 0.3, the largest over a/h from 0.01 to
    20, over n. Grey: within 1 % and 5 %."""
    parts = []

    def add_part(panel: int, x: np.ndarray, error: np.ndarray) -> None:
        columns = {"panel": np.full(len(x), panel), "curve": np.full(len(x), len(parts))}
        parts.append(columns | {"a/h or n": x, "error": error})

    for panel, (axes, (bonded, nu, title)) in enumerate(zip(panels, INTERFACES, strict=False)):
        for formula in formulas.LOADS:
            if formula.bonded == bonded and (nu in formula.nu or formula.nu == (nu,) or is_short(formula, bonded)):
                x, error = compared.load_error(formula, rigid, nu)
                words = formula.name.replace("general", f"general, nu = {nu:g}").replace("nu =", r"$\nu$ =")
                axes.plot(x, np.abs(error), label=words, **look(formula.name))
                add_part(panel, x, error)
        axes.set(xlabel="$a/h$", xlim=(0.01, 20), title=title)
    axes = panels[2]
    _, n, _ = compared.stiffness(coated)
    for name, error in compared.stiffness_errors(coated).items():
        if not name.endswith("0.626"):
            largest = np.abs(error).max(axis=1)
            axes.plot(n, largest, label=name, **look(name))
            add_part(2, n, largest)
    axes.set(xlabel="$n = E_1^*/E_2^*$", xlim=(0.01, 100), title=r"(c) coating, bonded, $\nu = 0.3$")
    axes.figure.suptitle("smooth punch, against the exact layer", fontsize=7)
    for axes, words in zip(panels, ("error of the load", "error of the load", "largest error, stiffness"), strict=True):
        frame(axes, words)
    return joined(parts)


def is_short(formula: formulas.Formula, bonded: bool) -> bool:
    """Whether it is the short form of Dimitriadis without friction: it is drawn although it is meant for ν = 1/2."""
    return not bonded and formula.name.endswith("nu = 1/2")


def frame(axes, words: str) -> None:
    """Logarithmic axes in percent, the bands of LEVELS, the legend below."""
    axes.set(xscale="log", yscale="log", ylim=(1e-4, 10))
    axes.set_ylabel(words, fontsize=8, labelpad=1)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g} %"))
    for level, grey in zip(compared.LEVELS, ("0.86", "0.94"), strict=True):
        axes.axhspan(1e-4, level, color=grey, linewidth=0, zorder=-2 if grey == "0.94" else -1)
    axes.title.set_fontsize(8)
    axes.tick_params(labelsize=7)
    axes.legend(loc="upper center", bbox_to_anchor=(0.45, -0.2), fontsize=6, handlelength=2.2, frameon=False)


@table(
    "literature",
    "literature",
    columns=r"formula; interface; nu | s | $\nu$; constants read in; 1%; 5%"
    + "".join(f"; a/h = {x:g} | +.2% | $a/h = {x:g}$" for x in SHOWN_AT),
)
def loads(rigid: xr.Dataset) -> list[tuple]:
    """Formulas of the load on a smooth sphere on a layer on a rigid base: the a/h (0.01 to 20) up to which, or from
    which on, they err by less than 1% and 5% at one depth, and their errors."""
    from scipy.interpolate import CubicSpline

    rows = []
    for formula in formulas.LOADS:
        for nu in formula.nu:
            x, error = compared.load_error(formula, rigid, nu)
            ranges = [compared.range_of(x, error, level, formula.thin) for level in compared.LEVELS]
            shown = CubicSpline(np.log(x), error)(np.log(SHOWN_AT))
            any_nu = not formula.bonded and len(formula.nu) == 1 and not is_short(formula, False)
            interface = "bonded" if formula.bonded else "frictionless"
            case = (formula.name, interface, "any" if any_nu else f"{nu:g}", formula.read)
            rows.append((*case, *ranges, *shown))
    return rows


@table(
    "literature_coatings",
    "literature_coatings",
    columns="formula; constants read in; a/h up to | g | $a/h$ up to; 1%; 5%"
    + "".join(f"; n = {n:g} | .2% | $n = {n:g}$" for n in SHOWN_N),
)
def stiffnesses(coated: xr.Dataset) -> list[tuple]:
    """Formulas of the stiffness of a smooth contact over 2a on a bonded coating, nu = 0.3: largest error over a/h from
    0.01 to 2 and to 20, and the n around 1 for which it stays below 1% and 5%."""
    x, n, _ = compared.stiffness(coated)
    places = [int(np.argmin(np.abs(np.log(n / wanted)))) for wanted in SHOWN_N]
    rows = []
    for name, error in compared.stiffness_errors(coated).items():
        read = formulas.STIFFNESSES.get(name, ("", "alpha, the best for each n, found here"))[1]
        for most in THIN_TO:
            largest = np.abs(error[:, x <= most * (1 + 1e-9)]).max(axis=1)
            ranges = [compared.around_one(n, largest, level) for level in compared.LEVELS]
            rows.append((name, read, most, *ranges, *largest[places]))
    return rows


@table(
    "literature_decided",
    "literature",
    "literature_coatings",
    columns="quantity; by; says | .4g; exact | .5g; off by | +.1%",
)
def decided(rigid: xr.Dataset, coated: xr.Dataset) -> list[tuple]:
    """Where the literature differs, on a rigid base. c1, c2, c3: coefficients of the load over that of Hertz in powers
    of sqrt(R D)/h. kappa: stiffness of a flat punch over 2 E1* a."""
    bonded, loose = compared.coefficients(rigid, True, 0.5), compared.coefficients(rigid, False, 0.3)
    first, second = formulas.DIMITRIADIS, formulas.GARCIA
    rows = [("c1, bonded, nu = 1/2", "Dimitriadis, Garcia", first[0], bonded[0])]
    for k in (1, 2):
        rows.append((f"c{k + 1}, bonded, nu = 1/2", "Dimitriadis", first[k], bonded[k]))
        rows.append((f"c{k + 1}, bonded, nu = 1/2", "Garcia", second[k], bonded[k]))
    for nu in (0.0, 0.3, 0.5):
        value_of_formula = -2 * formulas.ALPHA_LOOSE * (3 - 2 * nu) / (1 - nu) / np.pi
        rows.append(("c1, frictionless, any nu", f"Dimitriadis with nu = {nu:g}", value_of_formula, loose[0]))
    for script, value_of_formula in formulas.KAPPA.items():
        for nu, value in value_of_formula.items():
            rows.append((f"kappa at a/h = 1, nu = {nu:g}", script, value, float(compared.kappa(rigid, nu))))
    x, n, exact = compared.stiffness(coated)
    near = int(np.argmin(np.abs(n - 1)))
    share, middle = formulas.gao_weight(x, float(coated["nu1"])), int(np.argmin(np.abs(np.log(x))))
    slope = (exact[near] - 1) / (n[near] - 1)
    rows.append(("slope of the stiffness at n = 1, a/h near 1", "Gao", share[middle], slope[middle]))
    return [(*row, row[2] / row[3] - 1) for row in rows]


@table(
    "literature_rough",
    "literature_rough",
    columns=r"""alpha | g | $\alpha$; mu | g | $\mu$; Ra/R | g | $R_a/R$; lambda(0) | .2g | $\lambda(0)$
    p(0), Greenwood and Tripp | .4f | $p(0)$, Greenwood and Tripp
    p(0), with neighbours | .4f | $p(0)$, with neighbours; p(0) off by | +.1% | $p(0)$ off by
    radius, Greenwood and Tripp | .4f; radius, with neighbours | .4f; radius off by | +.1%""",
)
def rough_spheres(rough: xr.Dataset) -> list[tuple]:
    """A sphere with asperities of normal heights: pressure in the middle and effective radius over those of Hertz, by
    Greenwood and Tripp (1967), who leave out that asperities press down their neighbours, and with it."""
    rows = []
    values = zip(*compared.over_smooth(rough), rough["Ra"].values, rough["lam0"].values, strict=True)
    for alpha, mu, p0, radius, Ra, covered in values:
        alpha, mu = float(f"{alpha:.4g}"), round(mu)
        ratios = formulas.GREENWOOD_TRIPP[mu][alpha]
        rows.append(
            (alpha, mu, Ra, covered, ratios[0], p0, ratios[0] / p0 - 1, ratios[1], radius, ratios[1] / radius - 1)
        )
    return rows

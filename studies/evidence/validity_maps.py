"""Maps of the error of the thin-layer model against the exact layer, over h/a and n, which show where it may be
used."""

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import NullFormatter

from solver.models.thin_layer_error import thin_layer_error
from study import vocabulary
from study.figures.registry import TWO_COLUMNS, Columns, figure, joined, table

from ..literature.compared import safe_range

LEVELS = (-10.0, -0.1, -0.01, 0.01, 0.1, 10.0)
COLOURS = ("#4f9bcb", "#c6dcee", "white", "#fbd9b5", "#f0914a")
WORDS = (
    "more than 10 % too small",
    "1 to 10 % too small",
    "within 1 %",
    "1 to 10 % too large",
    "more than 10 % too large",
)
ESTIMATE = {"colors": "black", "linestyles": [(0, (2, 1.5))], "linewidths": 0.9}
REFUSED = {"facecolor": "0.93", "edgecolor": "0.5", "hatch": "////", "linewidth": 0}
TITLES = {
    "frictionless": "frictionless",
    "bonded, ν = 0": r"bonded, $\nu = 0$",
    "bonded, ν = 0.3": r"bonded, $\nu = 0.3$",
    "bonded, ν = 0.45": r"bonded, $\nu = 0.45$",
    "bonded, ν1 = 0.45, ν2 = 0.3": "bonded, $\\nu_1 = 0.45$,\n$\\nu_2 = 0.3$",
}
MAIN_CASE = {"h": 0.02, "n": 0.5}


@figure("validity", "validity", size=(TWO_COLUMNS, 7.6), panels=(5, 5))
def given_load(panels, contacts: xr.Dataset) -> Columns:
    """Error of the thin layer against the exact one under one load, over h/a (a of the exact layer) and n: rows are
    quantities, columns materials. Star: the paper's main case. Hatched: the thin-layer equation does not apply."""
    rough = contacts.sel(micro="disc_cell")
    rows = [(name, rough, name) for name in ("a", "p0", "D", "Ar_An", "p_max")]
    symbols = {"a": "$a$", "p0": "$p(0)$", "D": "$D$", "Ar_An": "$A_r/A_n$", "p_max": r"$p_{\max}$"}
    columns = matrix(panels, rows, symbols)
    legend(panels, estimate=False)
    return columns


@figure("validity_load", "validity_load", size=(TWO_COLUMNS, 3.9), panels=(2, 5))
def given_radius(panels, contacts: xr.Dataset) -> Columns:
    """Error of the load of the thin layer against the exact one at one contact radius, over h/a and n: smooth and rough
    punch. Dashed: the closed form of docs/accuracy.md. Star: the paper's main case. Hatched: the thin-layer equation
    does not apply."""
    rows = [(micro, contacts.sel(micro=micro), "P") for micro in ("smooth", "disc_cell")]
    columns = matrix(panels, rows, {"smooth": "$P$, smooth", "disc_cell": "$P$, rough"})
    for axes, case in zip(panels[0], materials(contacts), strict=True):
        x, n = np.geomspace(0.01, 20, 200), np.geomspace(0.01, 0.95, 100)
        material = [float(case[name]) for name in ("nu1", "nu2")]
        estimate = thin_layer_error(x, n[:, None], *material, str(case["bonding"].values) == "bonded").P
        axes.contour(x, n, np.ma.masked_invalid(estimate), LEVELS[1:-1], **ESTIMATE)
    legend(panels, estimate=True)
    return columns


def matrix(panels, rows: list[tuple[str, xr.Dataset, str]], symbols: dict[str, str]) -> Columns:
    """Draw a map for each row (name, dataset, quantity) and each material. Returns the errors that are not NaN."""
    parts = []
    for i, (name, dataset, quantity) in enumerate(rows):
        for j, (axes, case) in enumerate(zip(panels[i], materials(dataset), strict=True)):
            h_a, error = one_map(axes, case, quantity)
            n, finite = error["n"].broadcast_like(error), np.isfinite(error.values)
            place = {"row": np.full(finite.sum(), i), "material": np.full(finite.sum(), j)}
            numbers = {"h/a": h_a, "n": n, "error": error}
            parts.append(place | {name: array.values[finite] for name, array in numbers.items()})
            if case["bonding"] == "frictionless":
                main_case(axes, case)
            if i == 0:
                axes.set_title(TITLES[str(case["label"].values)], fontsize=8)
            axes.tick_params(labelbottom=i == len(rows) - 1, labelleft=axes is panels[i][0], labelsize=7)
        panels[i][0].set_ylabel("$n$", labelpad=1)
        panels[i][0].annotate(
            symbols[name], (-0.62, 0.5), xycoords="axes fraction", ha="right", va="center", fontsize=10
        )
    for axes in panels[-1]:
        axes.set_xlabel("$h/a$")
    return joined(parts)


def materials(dataset: xr.Dataset) -> list[xr.Dataset]:
    """The dataset of each material."""
    return [dataset.isel(case=i) for i in range(dataset.sizes["case"])]


def from_layered(dataset: xr.Dataset, name: str) -> xr.DataArray:
    """Relative error of a quantity on the thin layer against the exact layer; `base` is a dimension of the dataset.

    NaN where the thin-layer equation does not apply.
    """
    error = dataset[name].sel(base="thin_layer", drop=True) / dataset[name].sel(base="layered", drop=True) - 1
    error.attrs = {"long_name": f"{vocabulary.VOCABULARY[name].long_name}: thin layer over exact layer, less 1"}
    return error


def error_over_thickness(case: xr.Dataset, quantity: str) -> tuple[xr.DataArray, xr.DataArray]:
    """h/a, with the a of the exact layer, and the relative error of a quantity on the thin layer; both over (n, h)."""
    error = from_layered(case, quantity).transpose("n", "h")
    a = case["a"].sel(base="layered", drop=True) if "base" in case["a"].dims else case["a"]
    return (case["h"] / a).broadcast_like(error).transpose("n", "h"), error


def one_map(axes, case: xr.Dataset, quantity: str) -> tuple[xr.DataArray, xr.DataArray]:
    """Draw bands of the error over h/a (of the exact layer) and n, hatched where the thin-layer equation does not
    apply."""
    h_a, error = error_over_thickness(case, quantity)
    n = case["n"].broadcast_like(h_a)
    applies = np.isfinite(error.values).any(axis=1)
    if not applies.all():
        axes.axhspan(float(case["n"][applies].max()), 1, **REFUSED)
    grid = h_a.values[applies], n.values[applies], error.values[applies]
    axes.contourf(*grid, LEVELS, colors=COLOURS)
    axes.contour(*grid, LEVELS[1:-1], colors="0.25", linewidths=[0.9, 0.5, 0.5, 0.9], linestyles="solid")
    axes.set(xscale="log", yscale="log", xlim=(0.01, 20), ylim=(0.01, 0.95))
    axes.set_xticks([0.01, 0.1, 1, 10], ["0.01", "0.1", "1", "10"])
    axes.set_yticks([0.01, 0.1], ["0.01", "0.1"])
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(top=False, right=False, which="both", direction="out")
    return h_a, error


def main_case(axes, case: xr.Dataset) -> None:
    """Draw a star at the paper's main case."""
    if "base" in case["a"].dims:
        exact = case["a"].sel(base="layered").sel(n=MAIN_CASE["n"], method="nearest")
        a = float(np.interp(MAIN_CASE["h"], exact["h"], exact))
    else:
        a = float(case["a"])
    axes.plot(MAIN_CASE["h"] / a, MAIN_CASE["n"], "*", color="black", markersize=7, markeredgewidth=0)


def legend(panels, *, estimate: bool) -> None:
    """One legend for the whole figure, below it."""
    edge = {"edgecolor": "0.25", "linewidth": 0.5}
    handles = [Patch(facecolor=colour, label=word, **edge) for colour, word in zip(COLOURS, WORDS, strict=True)]
    handles.append(Patch(label=r"does not apply, $C \leq 0$", **REFUSED))
    handles.append(Line2D([], [], color="black", marker="*", linestyle="", label="the paper's main case"))
    if estimate:
        line = {"color": "black", "linestyle": ESTIMATE["linestyles"][0], "linewidth": 0.9}
        handles.append(Line2D([], [], label=r"estimate, $\pm 1$ and $\pm 10$ %", **line))
    panels[0][0].figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=7, handlelength=1.8)


MATERIALS = ("frictionless", "nu=0", "nu=0.3", "nu=0.45")
"""The first cases of the validity studies: without friction, and bonded with equal Poisson ratios."""


@table(
    "validity",
    "validity",
    "validity_load",
    columns="punch; error in; given"
    + "".join(rf"; {name} {level}% | .3g | {name}, {level}\%" for name in MATERIALS for level in (1, 10)),
)
def limits(given_load: xr.Dataset, given_radius: xr.Dataset) -> list[tuple]:
    """Largest h/a (0.01 or more) up to which the thin-layer model errs by less than 1% and 10%, n from 0.01 to 0.95;
    nu: bonded."""
    rows = []
    for micro, names in (("smooth", ("P", "a", "p0", "D")), ("disc_cell", ("P", "a", "p0", "D", "Ar_An", "p_max"))):
        for name in names:
            contacts = (given_radius if name == "P" else given_load).sel(micro=micro)
            cases = (contacts.isel(case=i) for i in range(len(MATERIALS)))
            largest = [round(largest_thickness(case, name, level), 3) for case in cases for level in (0.01, 0.1)]
            punch, control = "smooth" if micro == "smooth" else "rough", "a" if name == "P" else "P"
            rows.append((punch, vocabulary.VOCABULARY[name].symbol, control, *largest))
    return rows


def largest_thickness(case: xr.Dataset, name: str, level: float) -> float:
    """Smallest h/a, over all n, at which |error| of a quantity exceeds `level`, see `safe_range`; inf if none does."""
    h_a, error = error_over_thickness(case, name)
    crossings = [np.inf]
    for x, e in zip(h_a.values, error.values, strict=True):
        if (np.abs(e) > level).any():
            crossings.append(x[0] if abs(e[0]) > level else safe_range(x, e, level)[1])
    return float(min(crossings))

"""Figures of the paper: each a function of axes and opened datasets that draws, and returns the numbers it drew.

The curves have the paper's names: 1 rough, layered; 2 rough, homogeneous; 1' smooth, layered; 2' smooth, homogeneous.
"""

from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import as_file, files
from pathlib import Path

import matplotlib.style
import numpy as np
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from .marks import load_axis, name_curve, shade_violations
from .outputs import csv_text, open_studies, pick, write_text
from .schemes import contact_scheme, spot_scheme

CURVES = {"1": "rough, layered", "2": "rough, homogeneous", "1′": "smooth, layered", "2′": "smooth, homogeneous"}
ONE_COLUMN, TWO_COLUMNS = 3.35, 6.9  # inches, widths of a journal page
Columns = dict[str, np.ndarray]


@dataclass(frozen=True)
class Recipe:
    """`draw(axes, *datasets)` takes the datasets of the `studies`, and an array of axes if there are several `panels`."""

    studies: tuple[str, ...]
    draw: Callable[..., Columns]
    size: tuple[float, float] = (ONE_COLUMN, 2.6)
    panels: int = 1


def pressures(axes, main: xr.Dataset, names: tuple[str, ...], at: dict[str, float]) -> Columns:
    """p(r) of the named curves over the contact radius a0 of the rough layered contact; `at`: r/a0 of their names."""
    a0 = float(pick(main, label=CURVES["1"])["a"])
    columns = {}
    for name in names:
        case = pick(main, label=CURVES[name])
        r, p = main["x"].values * float(case["a"]) / a0, case["p"].values
        (line,) = axes.plot(r, p, label=f"{name}: {CURVES[name]}")
        name_curve(axes, line, name, at[name])
        columns |= {f"r/a0 ({name})": r, f"p/E2* ({name})": p}
    pressure_axes(axes, columns)
    axes.legend()
    return columns


def pressure_axes(axes, columns: Columns) -> None:
    """Labels and limits of p/E2* over r/a0."""
    largest = {quantity: max(v.max() for k, v in columns.items() if k.startswith(quantity)) for quantity in ("r", "p")}
    axes.set(xlabel="$r/a_0$", ylabel="$p/E_2^*$", xlim=(0, 1.02 * largest["r"]), ylim=(0, 1.08 * largest["p"]))


def fig03(axes, main: xr.Dataset) -> Columns:
    """Nominal pressure of the rough contacts, layered and homogeneous, under the same load."""
    return pressures(axes, main, ("1", "2"), {"1": 0.72, "2": 0.5})


def fig07(axes, main: xr.Dataset) -> Columns:
    """Nominal pressure of the rough and the smooth contacts under the same load."""
    return pressures(axes, main, ("1", "2", "1′", "2′"), {"1": 0.85, "2": 0.1, "1′": 0.25, "2′": 0.6})


def against_load(
    axes, sweep: xr.Dataset, main: xr.Dataset, quantity: str, label: str, names=("1", "2"), scale: float = 1.0
) -> Columns:
    """One quantity of the named curves against the load; P0 marked, loads shaded where an assumption fails."""
    P = sweep["P"].values
    cases = {name: pick(sweep, label=CURVES[name]) for name in names}
    columns = {"P/(E2* R^2)": P}
    for place, (name, case) in zip((0.8, 0.8, 0.55, 0.55), cases.items(), strict=False):
        values = case[quantity].values
        (line,) = axes.plot(P * 1e5, values / scale, label=f"{name}: {CURVES[name]}")
        name_curve(axes, line, name, place * P[-1] * 1e5)
        columns[f"{label[0]} ({name})"] = values
    load_axis(axes, P[-1], float(main["P"]))
    axes.set_ylabel(label[1])
    axes.set_ylim(0, 1.1 * max(case[quantity].max().item() for case in cases.values()) / scale)
    shade_violations(axes, P, {name: case["validity"] for name, case in cases.items()})
    axes.legend()
    return columns


def fig04(axes, sweep: xr.Dataset, main: xr.Dataset) -> Columns:
    """Real over nominal contact area against the load."""
    return against_load(axes, sweep, main, "Ar_An", ("Ar/An", "$A_r/A_n$"))


def fig05(axes, sweep: xr.Dataset, main: xr.Dataset) -> Columns:
    """Largest real pressure against the load."""
    return against_load(axes, sweep, main, "p_max", ("pmax/E2*", r"$p_{\max}/E_2^*$"))


def fig06(axes, sweep: xr.Dataset, main: xr.Dataset) -> Columns:
    """Indentation depth of the rough punch against the load."""
    return against_load(axes, sweep, main, "D", ("D/R", r"$D\ /\ (10^{-3} R)$"), scale=1e-3)


def fig08(axes, sweep: xr.Dataset, main: xr.Dataset) -> Columns:
    """Indentation depth of the rough and the smooth punch against the load."""
    return against_load(axes, sweep, main, "D", ("D/R", r"$D\ /\ (10^{-3} R)$"), tuple(CURVES), scale=1e-3)


def fig09(panels, laws: xr.Dataset) -> Columns:
    """Additional displacement against pressure, exact and fitted: (a) three densities, (b) three asperity radii."""
    p = laws["p"].values
    columns = {"p/E1*": p}
    rows = {"a": [(0.004, N) for N in (250_000, 62_500, 15_625)], "b": [(Ra, 250_000) for Ra in (0.004, 0.002, 0.001)]}
    for axes, (panel, roughnesses) in zip(panels, rows.items(), strict=True):
        for i, (Ra, Nbar) in enumerate(roughnesses):
            case, colour = pick(laws, Ra=Ra, Nbar=Nbar), f"C{i}"
            name = rf"$\bar N R^2 = {Nbar}$" if panel == "a" else f"$R_a/R = {Ra}$"
            (line,) = axes.plot(p, case["A_fit"] * 1e4, "-", color=colour)
            axes.plot(p, case["A_exact"] * 1e4, "--", color=colour, dashes=(5, 3))
            name_curve(axes, line, name, 0.62 * p[-1])
            columns |= {f"A/R Ra={Ra} N={Nbar} {kind}": case[f"A_{kind}"].values for kind in ("exact", "fit")}
        axes.plot([], [], "k--", label="exact, Eqs (6), (7)")
        axes.plot([], [], "k-", label=r"fitted, $B p^{\beta}$")
        given = f"$R_a/R = {roughnesses[0][0]}$" if panel == "a" else rf"$\bar N R^2 = {roughnesses[0][1]}$"
        axes.legend(title=f"({panel}) {given}", loc="upper left")
        axes.set(xlabel="$p/E_1^*$", ylabel=r"$A[p]\ /\ (10^{-4} R)$", xlim=(0, p[-1]), ylim=(0, axes.get_ylim()[1] * 1.25))
    return columns


def fig10(axes, densities: xr.Dataset) -> Columns:
    """Nominal pressure on the layer for three densities of asperities under the same load, over a0 of the first."""
    columns, a0 = {}, float(densities["a"][0])
    for i, place in enumerate((0.08, 0.3, 0.55)):
        case = densities.isel(case=i)
        r, p, Nbar = densities["x"].values * float(case["a"]) / a0, case["p"].values, int(case["Nbar"])
        (line,) = axes.plot(r, p, label=rf"{i + 1}: $\bar N R^2 = {Nbar}$")
        name_curve(axes, line, str(i + 1), place)
        columns |= {f"r/a0 (N={Nbar})": r, f"p/E2* (N={Nbar})": p}
    pressure_axes(axes, columns)
    axes.legend()
    return columns


RECIPES = {
    "fig01": Recipe(("main_case",), contact_scheme, (TWO_COLUMNS, 3.2)),
    "fig02": Recipe(("main_case",), spot_scheme, (ONE_COLUMN, 2.6)),
    "fig03": Recipe(("main_case",), fig03),
    "fig04": Recipe(("load_sweep", "main_case"), fig04),
    "fig05": Recipe(("load_sweep", "main_case"), fig05),
    "fig06": Recipe(("load_sweep", "main_case"), fig06),
    "fig07": Recipe(("main_case",), fig07),
    "fig08": Recipe(("load_sweep", "main_case"), fig08),
    "fig09": Recipe(("table1",), fig09, (TWO_COLUMNS, 2.7), panels=2),
    "fig10": Recipe(("spot_density",), fig10),
}


def draw(name: str, results="results", figures="figures") -> list[Path]:
    """Draw a figure as figures/NAME.pdf and .png, and its numbers as .csv; returns the three paths.

    The same datasets give the same bytes: no file carries a date.

    Raises
    ------
    StudyError : there is no such figure, or a study it needs has no results
    """
    recipe, datasets = open_studies(name, RECIPES, results)
    stem = Path(figures) / name
    with as_file(files(__package__) / "roughcoat.mplstyle") as style, matplotlib.style.context(style):
        figure = Figure(figsize=recipe.size, layout="constrained")
        FigureCanvasAgg(figure)
        columns = recipe.draw(figure.subplots(1, recipe.panels), *datasets)
        rows = zip(*(np.asarray(column).tolist() for column in columns.values()), strict=True)
        paths = [write_text(stem.with_suffix(".csv"), csv_text(columns, rows))]
        for suffix, dated in ((".pdf", {"CreationDate": None}), (".png", {})):
            paths.append(stem.with_suffix(suffix))
            digests = " ".join(dataset.attrs["study_digest"][:16] for dataset in datasets)
            figure.savefig(paths[-1], metadata={"Title": f"{name}, studies {digests}"} | dated)
    return paths

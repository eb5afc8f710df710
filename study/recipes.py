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

from .marks import load_axis, name_curve, shade_violations, violated
from .outputs import csv_text, open_studies, pick, write_text
from .schemes import contact_scheme, spot_scheme

CURVES = {"1": "rough, layered", "2": "rough, homogeneous", "1′": "smooth, layered", "2′": "smooth, homogeneous"}
ONE_COLUMN, TWO_COLUMNS = 3.35, 6.9  # inches, widths of a journal page
DEPTH = r"$D\ /\ (10^{-3} R)$"
EXACT = {"color": "black", "linestyle": (0, (4, 3)), "linewidth": 0.8}
Columns = dict[str, np.ndarray]


@dataclass(frozen=True)
class Recipe:
    """`draw(axes, *datasets)` takes the datasets of the `studies`; several `panels` make axes an array."""

    studies: tuple[str, ...]
    draw: Callable[..., Columns]
    size: tuple[float, float] = (ONE_COLUMN, 2.6)
    panels: int = 1


def pressures(axes, main: xr.Dataset, sides: dict[str, str]) -> Columns:
    """p(r) of the curves named in `sides` over the contact radius a0 of the rough layered contact."""
    a0 = float(pick(main, label=CURVES["1"])["a"])
    columns = {}
    for name, side in sides.items():
        columns |= profile(axes, pick(main, label=CURVES[name]), a0, name, f"{name}: {CURVES[name]}", side)
    pressure_axes(axes)
    return columns


def profile(axes, case: xr.Dataset, a0: float, name: str, label: str, side: str) -> Columns:
    """One curve p/E2* over r/a0 with its name."""
    r, p = case["x"].values * float(case["a"]) / a0, case["p"].values
    (line,) = axes.plot(r, p * 100, label=label)
    name_curve(axes, line, name, 0.25, side=side)
    return {f"r/a0 ({name})": r, f"p/E2* ({name})": p}


def pressure_axes(axes) -> None:
    """Labels, limits and legend of pressures that have all been drawn."""
    axes.set(xlabel="$r/a_0$", ylabel=r"$p\ /\ (10^{-2} E_2^*)$", xlim=(0, None), ylim=(0, None))
    axes.legend(loc="lower left")


def fig03(axes, main: xr.Dataset) -> Columns:
    """Nominal pressure of the rough contacts, layered and homogeneous, under the same load."""
    return pressures(axes, main, {"1": "above", "2": "above"})


def fig07(axes, main: xr.Dataset) -> Columns:
    """Nominal pressure of the rough and the smooth contacts under the same load."""
    return pressures(axes, main, {"1": "below", "2": "below", "1′": "above", "2′": "above"})


def against_load(axes, data: tuple, quantity: str, sides: dict[str, str], label: str, scale: float = 1.0) -> Columns:
    """One quantity of the curves named in `sides` against the load; P0 marked, loads shaded where an assumption fails.

    data : datasets load_sweep and main_case; label, scale : of the ordinate
    """
    sweep, main = data
    P, columns = sweep["P"].values, {"P/(E2* R^2)": sweep["P"].values}
    cases = {name: pick(sweep, label=CURVES[name]) for name in sides}
    for name, case in cases.items():
        (line,) = axes.plot(P * 1e5, case[quantity] / scale, label=f"{name}: {CURVES[name]}")
        name_curve(axes, line, name, 0.85 * P[-1] * 1e5, side=sides[name])
        columns[f"{quantity} ({name})"] = case[quantity].values
    load_axis(axes, P[-1], float(main["P"]))
    axes.set(ylabel=label, ylim=(0, 1.08 * max(float(case[quantity].max()) for case in cases.values()) / scale))
    shade_violations(axes, P, {name: case["validity"] for name, case in cases.items()})
    axes.legend(loc="lower right")
    return columns


def fig04(axes, *data: xr.Dataset) -> Columns:
    """Real over nominal contact area against the load."""
    return against_load(axes, data, "Ar_An", {"1": "above", "2": "below"}, "$A_r/A_n$")


def fig05(axes, *data: xr.Dataset) -> Columns:
    """Largest real pressure against the load."""
    return against_load(axes, data, "p_max", {"1": "below", "2": "below"}, r"$p_{\max}/E_2^*$")


def fig06(axes, *data: xr.Dataset) -> Columns:
    """Indentation depth of the rough punch against the load."""
    return against_load(axes, data, "D", {"1": "above", "2": "below"}, DEPTH, 1e-3)


def fig08(axes, *data: xr.Dataset) -> Columns:
    """Indentation depth of the rough and the smooth punch against the load."""
    return against_load(axes, data, "D", {"1": "above", "2": "above", "1′": "below", "2′": "below"}, DEPTH, 1e-3)


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
            axes.plot(p, case["A_exact"] * 1e4, **EXACT)
            name_curve(axes, line, name, 0.95 * p[-1], align="right")
            columns |= {f"A/R Ra={Ra} N={Nbar} {kind}": case[f"A_{kind}"].values for kind in ("exact", "fit")}
        axes.plot([], [], label="exact, Eqs (6), (7)", **EXACT)
        axes.plot([], [], "-", color="0.5", label=r"fitted, $B p^{\beta}$")
        given = f"$R_a/R = {roughnesses[0][0]}$" if panel == "a" else rf"$\bar N R^2 = {roughnesses[0][1]}$"
        axes.legend(title=f"({panel}) {given}", loc="upper left")
        axes.set(
            xlabel="$p/E_1^*$", ylabel=r"$A[p]\ /\ (10^{-4} R)$", xlim=(0, p[-1]), ylim=(0, axes.get_ylim()[1] * 1.25)
        )
    return columns


def fig10(axes, densities: xr.Dataset) -> Columns:
    """Nominal pressure on the layer for three densities of asperities under the same load, over a0 of the first."""
    columns, a0 = {}, float(densities["a"][0])
    for i, (name, side) in enumerate({"1": "above", "2": "below", "3": "below"}.items()):
        case = densities.isel(case=i)
        label = ", ".join([rf"{name}: $\bar N R^2 = {int(case['Nbar'])}$", *violated(case["validity"])])
        columns |= profile(axes, case, a0, name, label, side)
    pressure_axes(axes)
    return columns


RECIPES = {
    "fig01": Recipe(("main_case",), contact_scheme, (5.2, 2.9)),
    "fig02": Recipe(("main_case",), spot_scheme, (ONE_COLUMN, 2.3)),
    "fig03": Recipe(("main_case",), fig03),
    "fig04": Recipe(("load_sweep", "main_case"), fig04),
    "fig05": Recipe(("load_sweep", "main_case"), fig05),
    "fig06": Recipe(("load_sweep", "main_case"), fig06),
    "fig07": Recipe(("main_case",), fig07),
    "fig08": Recipe(("load_sweep", "main_case"), fig08, (ONE_COLUMN, 3.2)),
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

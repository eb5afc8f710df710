"""Figures 3 to 10 of the paper and their companions: each draws on axes from opened datasets and returns its numbers.

The curves have the paper's names: 1 rough, layered; 2 rough, homogeneous; 1' smooth, layered; 2' smooth, homogeneous.
A companion draws the curves of the layer on the exact base, with the paper's thin layer dotted beside them.
"""

from functools import partial

import numpy as np
import xarray as xr

from ..figures.annotate import load_axis, name_curve, shade_violations, violated
from ..figures.sources import pick

CURVES = {"1": "rough, layered", "2": "rough, homogeneous", "1′": "smooth, layered", "2′": "smooth, homogeneous"}
EXACT_LAYER = {"1": "rough, exact layer", "1′": "smooth, exact layer"}
DEPTH = r"$D\ /\ (10^{-3} R)$"
EXACT_LAW = {"color": "black", "linestyle": (0, (4, 3)), "linewidth": 0.8}
PAPER = {"linestyle": (0, (1, 1.2)), "linewidth": 0.9, "zorder": 1.5}
PAPER_LABEL = "thin layer (the paper)"
Columns = dict[str, np.ndarray]


def case_of(dataset: xr.Dataset, name: str, exact: bool) -> xr.Dataset:
    """The case of a curve: on the exact layer if wanted and if there is a layer, otherwise as in the paper."""
    return pick(dataset, label=(EXACT_LAYER if exact else {}).get(name, CURVES[name]))


def thin_beside(dataset: xr.Dataset, name: str, exact: bool) -> xr.Dataset | None:
    """The paper's case to draw beside an exact one; None where they do not differ."""
    return pick(dataset, label=CURVES[name]) if exact and name in EXACT_LAYER else None


def pressures(axes, main: xr.Dataset, *, sides: dict[str, str], exact: bool = False) -> Columns:
    """p(r) of the curves named in `sides` over the paper's contact radius a0 of the rough layered contact."""
    a0 = float(pick(main, label=CURVES["1"])["a"])
    columns = {}
    for name, side in sides.items():
        cases = case_of(main, name, exact), thin_beside(main, name, exact)
        columns |= profile(axes, cases, a0, name, f"{name}: {CURVES[name]}", side)
    pressure_axes(axes, exact)
    return columns


def profile(axes, cases: tuple, a0: float, name: str, label: str, side: str) -> Columns:
    """One curve p/E2* over r/a0 with its name; of the two `cases` the second, if any, is the paper's, dotted."""
    case, thin = cases
    r, p = case["x"].values * float(case["a"]) / a0, case["p"].values
    (line,) = axes.plot(r, p * 100, label=label)
    lines, columns = [line], {f"r/a0 ({name})": r, f"p/E2* ({name})": p}
    if thin is not None:
        r, p = thin["x"].values * float(thin["a"]) / a0, thin["p"].values
        lines += axes.plot(r, p * 100, color=line.get_color(), **PAPER)
        columns |= {f"r/a0 ({name}, thin layer)": r, f"p/E2* ({name}, thin layer)": p}
    name_curve(axes, lines, name, 0.12, side=side)
    return columns


def pressure_axes(axes, exact: bool) -> None:
    """Labels, limits and legend of pressures that have all been drawn."""
    if exact:
        axes.plot([], [], color="0.3", label=PAPER_LABEL, **PAPER)
    axes.set(xlabel="$r/a_0$", ylabel=r"$p\ /\ (10^{-2} E_2^*)$", xlim=(0, None), ylim=(0, 1.1 * axes.dataLim.y1))
    axes.legend(loc="lower left")


def against_load(
    axes, *data: xr.Dataset, quantity: str, sides: dict[str, str], label: str, scale: float = 1.0, exact: bool = False
) -> Columns:
    """One quantity of the curves named in `sides` against the load; P0 marked, loads shaded where an assumption fails.

    data : datasets load_sweep and main_case; label, scale : of the ordinate
    """
    sweep, main = data
    P, columns = sweep["P"].values, {"P/(E2* R^2)": sweep["P"].values}
    cases = {name: case_of(sweep, name, exact) for name in sides}
    for name, case in cases.items():
        lines = axes.plot(P * 1e5, case[quantity] / scale, label=f"{name}: {CURVES[name]}")
        columns[f"{quantity} ({name})"] = case[quantity].values
        thin = thin_beside(sweep, name, exact)
        if thin is not None:
            lines += axes.plot(P * 1e5, thin[quantity] / scale, color=lines[0].get_color(), **PAPER)
            columns[f"{quantity} ({name}, thin layer)"] = thin[quantity].values
        align = "right" if sides[name] == "above" else "left"  # away from a curve that rises
        name_curve(axes, lines, name, 0.85 * P[-1] * 1e5, side=sides[name], align=align)
    if exact:
        axes.plot([], [], color="0.3", label=PAPER_LABEL, **PAPER)
    load_axis(axes, P[-1], float(main["P"]))
    axes.set(ylabel=label, ylim=(0, 1.08 * max(float(case[quantity].max()) for case in cases.values()) / scale))
    shade_violations(axes, P, {name: case["validity"] for name, case in cases.items()})
    axes.legend(loc="lower right")
    return columns


def laws(panels, fits: xr.Dataset) -> Columns:
    """Figure 9: additional displacement against pressure, exact and fitted; (a) three densities, (b) three radii."""
    p = fits["p"].values
    columns = {"p/E1*": p}
    rows = {"a": [(0.004, N) for N in (250_000, 62_500, 15_625)], "b": [(Ra, 250_000) for Ra in (0.004, 0.002, 0.001)]}
    for axes, (panel, roughnesses) in zip(panels, rows.items(), strict=True):
        for i, (Ra, Nbar) in enumerate(roughnesses):
            case, colour = pick(fits, Ra=Ra, Nbar=Nbar), f"C{i}"
            name = rf"$\bar N R^2 = {Nbar}$" if panel == "a" else f"$R_a/R = {Ra}$"
            lines = axes.plot(p, case["A_fit"] * 1e4, "-", color=colour)
            axes.plot(p, case["A_exact"] * 1e4, **EXACT_LAW)
            name_curve(axes, lines, name, 0.95 * p[-1], align="right")
            columns |= {f"A/R Ra={Ra} N={Nbar} {kind}": case[f"A_{kind}"].values for kind in ("exact", "fit")}
        axes.plot([], [], label="exact, Eqs (6), (7)", **EXACT_LAW)
        axes.plot([], [], "-", color="0.5", label=r"fitted, $B p^{\beta}$")
        given = f"$R_a/R = {roughnesses[0][0]}$" if panel == "a" else rf"$\bar N R^2 = {roughnesses[0][1]}$"
        axes.legend(title=f"({panel}) {given}", loc="upper left")
        axes.set(
            xlabel="$p/E_1^*$", ylabel=r"$A[p]\ /\ (10^{-4} R)$", xlim=(0, p[-1]), ylim=(0, axes.get_ylim()[1] * 1.25)
        )
    return columns


def densities(axes, found: xr.Dataset, *, exact: bool = False) -> Columns:
    """Figure 10: nominal pressure on the layer for three densities of asperities under one load, over the paper's a0
    of the first."""
    paper = [pick(found, Nbar=Nbar, base="thin_layer") for Nbar in (250_000, 62_500, 15_625)]
    columns, a0 = {}, float(paper[0]["a"])
    for thin, (name, side) in zip(paper, {"1": "above", "2": "below", "3": "below"}.items(), strict=True):
        case = pick(found, Nbar=float(thin["Nbar"]), base="layered") if exact else thin
        label = ", ".join([rf"{name}: $\bar N R^2 = {int(case['Nbar'])}$", *violated(case["validity"])])
        columns |= profile(axes, (case, thin if exact else None), a0, name, label, side)
    pressure_axes(axes, exact)
    return columns


_LOAD = {
    "fig04": partial(against_load, quantity="Ar_An", sides={"1": "above", "2": "below"}, label="$A_r/A_n$"),
    "fig05": partial(against_load, quantity="p_max", sides={"1": "below", "2": "below"}, label=r"$p_{\max}/E_2^*$"),
    "fig06": partial(against_load, quantity="D", sides={"1": "above", "2": "below"}, label=DEPTH, scale=1e-3),
    "fig08": partial(
        against_load,
        quantity="D",
        sides={"1": "above", "2": "above", "1′": "below", "2′": "below"},
        label=DEPTH,
        scale=1e-3,
    ),
}
_PROFILES = {
    "fig03": partial(pressures, sides={"1": "above", "2": "above"}),
    "fig07": partial(pressures, sides={"1": "below", "2": "below", "1′": "above", "2′": "above"}),
    "fig10": densities,
}
PAPERS_FIGURES = _PROFILES | _LOAD
"""Figures 3 to 8 and 10; with `exact=True` each draws its companion."""

"""Figures 3 to 8 and 10 of the paper, each with a companion that shows the same contacts on the exact layer.

The curves have the paper's names: 1 rough, layered; 2 rough, homogeneous; 1' smooth, layered; 2' smooth, homogeneous.
A companion draws the curves of the layer on the exact layer, with the paper's thin layer dotted beside them.
"""

from collections.abc import Callable
from functools import partial

import xarray as xr

from study.figures.annotate import load_axis, name_curve, note_violations, shade_violations
from study.figures.registry import ONE_COLUMN, Columns, caption_of, figure, pick

CURVES = {"1": "rough, layered", "2": "rough, homogeneous", "1′": "smooth, layered", "2′": "smooth, homogeneous"}
EXACT_LAYER = {"1": "rough, exact layer", "1′": "smooth, exact layer"}
DEPTH = r"$D\ /\ (10^{-3} R)$"
PAPER = {"linestyle": (0, (1, 1.2)), "linewidth": 0.9, "zorder": 1.5}
LAYER_THIN = """The layer is the paper's thin one. The figure marks where it is not thin: there the largest relative
error of a, P, D, p(0), pmax and Ar/An against the exact layer exceeds 10 %, as `model_error` estimates."""
LAYER_EXACT = "The layer is exact; thin dotted lines: the same on the paper's thin layer."
LOAD = """P0 = 2.704e-5 E2* R² presses contact 1 to a0 = 0.04 R. The paper prints 2.72e-5 for it, 0.6 % more: its
successive approximations end before they have converged (docs/tradeoff.md)."""
OVER_LOADS = f"""{LOAD} It is the load of figures 3, 7 and 10. Grey: loads at which an assumption
of the model does not hold, for the curves named in the legend."""
PAPER_LABEL = "thin layer (the paper)"
OVER_LOAD = ("load_sweep", "main_case")  # the studies of figures 4, 5, 6 and 8
SIZE, HIGH = (ONE_COLUMN, 3.0), (ONE_COLUMN, 3.6)  # the second has four curves


def with_companion(figure: Callable, companion: Callable, words: str = ""):
    """Register `draw(axes, *datasets, exact)` as a figure and, with exact = True, as its companion.

    figure, companion : decorators of the two
    words : follow the docstring of `draw` in both captions, and precede the sentences about the layer
    """

    def register(draw):
        for exact, decorator in enumerate((figure, companion)):
            draw_one = partial(draw, exact=bool(exact))
            draw_one.__doc__ = " ".join(filter(None, (caption_of(draw), words, LAYER_EXACT if exact else LAYER_THIN)))
            decorator(draw_one)
        return draw

    return register


def cases_of(dataset: xr.Dataset, curve: str, exact: bool) -> dict[str, xr.Dataset]:
    """{curve: its case}; in a companion the case on the exact layer, and the paper's case as "CURVE, thin layer"."""
    if not (exact and curve in EXACT_LAYER):
        return {curve: pick(dataset, label=CURVES[curve])}
    return {curve: pick(dataset, label=EXACT_LAYER[curve]), f"{curve}, thin layer": pick(dataset, label=CURVES[curve])}


def plot(axes, points: list[tuple], label: str) -> list:
    """Draw the (x, y) of one curve; a second (x, y) is the paper's, dotted. Returns the lines."""
    lines = axes.plot(*points[0], label=label)
    for x, y in points[1:]:
        lines += axes.plot(x, y, color=lines[0].get_color(), **PAPER)
    return lines


def pressures(axes, shown: list[tuple[dict[str, xr.Dataset], str, str]], a0: float, dotted: str = "") -> Columns:
    """Draw p/E2* over r/a0: curves with names, labels, limits, legend, and notes on violated assumptions.

    shown : for each curve its cases (the first has the name of the curve), its label, and the side of its name
    dotted : label of the dotted lines in the legend, "" without such lines
    """
    columns = {}
    for cases, label, side in shown:
        points = []
        for name, case in cases.items():
            r, p = case["x"].values * float(case["a"]) / a0, case["p"].values
            columns |= {f"r/a0 ({name})": r, f"p/E2* ({name})": p}
            points.append((r, p * 100))
        name_curve(axes, plot(axes, points, label), next(iter(cases)), 0.12, side=side)
    if dotted:
        axes.plot([], [], color="0.3", label=dotted, **PAPER)
    axes.set(xlabel="$r/a_0$", ylabel=r"$p\ /\ (10^{-2} E_2^*)$", xlim=(0, None), ylim=(0, 1.1 * axes.dataLim.y1))
    axes.legend(loc="lower left")
    firsts = (next(iter(cases.items())) for cases, *_ in shown)
    note_violations(axes, {name: case["validity"] for name, case in firsts})
    return columns


def main_case(axes, main: xr.Dataset, sides: dict[str, str], exact: bool) -> Columns:
    """p(r) of the curves named in `sides` over the paper's contact radius a0 of the rough layered contact."""
    shown = [(cases_of(main, curve, exact), f"{curve}: {CURVES[curve]}", side) for curve, side in sides.items()]
    return pressures(axes, shown, float(pick(main, label=CURVES["1"])["a"]), PAPER_LABEL * exact)


@with_companion(figure("fig03", "main_case", size=SIZE), figure("fig03_layered", "main_case", size=SIZE), LOAD)
def rough_pressures(axes, main: xr.Dataset, exact: bool) -> Columns:
    """Nominal pressure under the rough punch with a layer (1) and without (2); a0 is the radius of contact 1."""
    return main_case(axes, main, {"1": "above", "2": "above"}, exact)


@with_companion(figure("fig07", "main_case", size=SIZE), figure("fig07_layered", "main_case", size=SIZE), LOAD)
def rough_and_smooth_pressures(axes, main: xr.Dataset, exact: bool) -> Columns:
    """Nominal pressure, rough and smooth (primes), with a layer (1) and without (2); a0: radius of 1."""
    return main_case(axes, main, {"1": "below", "2": "below", "1′": "above", "2′": "above"}, exact)


@with_companion(figure("fig10", "spot_density", size=SIZE), figure("fig10_layered", "spot_density", size=SIZE), LOAD)
def densities(axes, contacts: xr.Dataset, exact: bool) -> Columns:
    """Nominal pressure for three densities of asperities, B and β as in Table 1; a0: radius of 1."""
    paper = [pick(contacts, Nbar=Nbar, base="thin_layer") for Nbar in (250_000, 62_500, 15_625)]
    shown = []
    for thin, (name, side) in zip(paper, {"1": "above", "2": "below", "3": "below"}.items(), strict=True):
        layered = pick(contacts, Nbar=float(thin["Nbar"]), base="layered")
        cases = {name: layered, f"{name}, thin layer": thin} if exact else {name: thin}
        shown.append((cases, rf"{name}: $\bar N R^2 = {int(thin['Nbar'])}$", side))
    return pressures(axes, shown, float(paper[0]["a"]), PAPER_LABEL * exact)


def against_load(axes, sweep: xr.Dataset, main: xr.Dataset, exact: bool, what: tuple, sides: dict) -> Columns:
    """One quantity against the load; P0 marked, loads shaded where an assumption fails.

    what : the quantity, its unit and label on the ordinate
    sides : curve -> the side of the curve on which its name stands
    """
    quantity, scale, label = what
    P, columns, first = sweep["P"].values, {"P/(E2* R^2)": sweep["P"].values}, {}
    for curve, side in sides.items():
        cases = cases_of(sweep, curve, exact)
        first[curve] = cases[curve]
        columns |= {f"{quantity} ({name})": case[quantity].values for name, case in cases.items()}
        points = [(P * 1e5, case[quantity] / scale) for case in cases.values()]
        lines = plot(axes, points, f"{curve}: {CURVES[curve]}")
        align = "right" if side == "above" else "left"  # away from a curve that rises
        name_curve(axes, lines, curve, 0.85 * P[-1] * 1e5, side=side, align=align)
    if exact:
        axes.plot([], [], color="0.3", label=PAPER_LABEL, **PAPER)
    load_axis(axes, P[-1], float(main["P"]))
    highest = max(float(case[quantity].max()) for case in first.values()) / scale
    axes.set(ylabel=label, ylim=(0, 1.08 * highest))
    shade_violations(axes, P, {curve: case["validity"] for curve, case in first.items()})
    axes.legend(loc="lower right", fontsize=7)
    return columns


@with_companion(figure("fig04", *OVER_LOAD, size=SIZE), figure("fig04_layered", *OVER_LOAD, size=SIZE), OVER_LOADS)
def real_areas(axes, sweep: xr.Dataset, main: xr.Dataset, exact: bool) -> Columns:
    """Real over nominal contact area against the load."""
    return against_load(axes, sweep, main, exact, ("Ar_An", 1.0, "$A_r/A_n$"), {"1": "above", "2": "below"})


@with_companion(figure("fig05", *OVER_LOAD, size=SIZE), figure("fig05_layered", *OVER_LOAD, size=SIZE), OVER_LOADS)
def real_pressures(axes, sweep: xr.Dataset, main: xr.Dataset, exact: bool) -> Columns:
    """Largest real pressure in the middle of the contact against the load."""
    what = "p_max", 1.0, r"$p_{\max}/E_2^*$"
    return against_load(axes, sweep, main, exact, what, {"1": "below", "2": "below"})


@with_companion(figure("fig06", *OVER_LOAD, size=SIZE), figure("fig06_layered", *OVER_LOAD, size=SIZE), OVER_LOADS)
def rough_depths(axes, sweep: xr.Dataset, main: xr.Dataset, exact: bool) -> Columns:
    """Depth of the rough punch against the load."""
    return against_load(axes, sweep, main, exact, ("D", 1e-3, DEPTH), {"1": "above", "2": "below"})


@with_companion(figure("fig08", *OVER_LOAD, size=HIGH), figure("fig08_layered", *OVER_LOAD, size=HIGH), OVER_LOADS)
def all_depths(axes, sweep: xr.Dataset, main: xr.Dataset, exact: bool) -> Columns:
    """Depth of the rough punch, and of the smooth one (primes), against the load."""
    sides = {"1": "above", "2": "above", "1′": "below", "2′": "below"}
    return against_load(axes, sweep, main, exact, ("D", 1e-3, DEPTH), sides)

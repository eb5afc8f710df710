"""Figures 3 to 8 and 10 of the paper, and a companion of each that shows the same on the exact layer.

The curves have the paper's names: 1 rough, layered; 2 rough, homogeneous; 1' smooth, layered; 2' smooth, homogeneous.
A companion draws the curves of the layer on the exact layer, with the paper's thin layer dotted beside them.
"""

from functools import partial

import xarray as xr

from ..figures.annotate import load_axis, name_curve, note_violations, shade_violations
from ..figures.registry import ONE_COLUMN, Columns, caption_of, figure, pick

CURVES = {"1": "rough, layered", "2": "rough, homogeneous", "1′": "smooth, layered", "2′": "smooth, homogeneous"}
EXACT_LAYER = {"1": "rough, exact layer", "1′": "smooth, exact layer"}
DEPTH = r"$D\ /\ (10^{-3} R)$"
PAPER = {"linestyle": (0, (1, 1.2)), "linewidth": 0.9, "zorder": 1.5}
LAYER_THIN = """The layer is the paper's thin one. It is said where it is not thin: the largest relative error of a, P,
D, p(0), pmax and Ar/An against the exact layer then exceeds 10 %, as `model_error` estimates it."""
LAYER_EXACT = "The layer is exact; thin dotted lines: the same on the paper's thin layer."
OVER_LOADS = """P0 is the load of figures 3, 7 and 10. Grey: loads at which an assumption of the model does not hold,
for the curves named in the legend."""
PAPER_LABEL = "thin layer (the paper)"


def with_companion(name: str, *studies: str, words: str = "", height: float = 3.0):
    """Register `draw(axes, *datasets, exact)` as the figure NAME and, with exact = True, as its companion.

    words : the caption of both, by default the docstring; what holds for the layer is added
    """

    def register(draw):
        for suffix, exact in (("", False), ("_layered", True)):
            caption = f"{caption_of(draw, words)} {LAYER_EXACT if exact else LAYER_THIN}"
            named = figure(name + suffix, *studies, size=(ONE_COLUMN, height), caption=caption)
            named(partial(draw, exact=exact))
        return draw

    return register


def cases_of(dataset: xr.Dataset, curve: str, exact: bool) -> dict[str, xr.Dataset]:
    """{curve: its case}; in a companion the case on the exact layer, and the paper's under "CURVE, thin layer"."""
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
    """Draw p/E2* over r/a0: curves with their names, labels, limits, legend, and notes on what is not valid.

    shown : for each curve its cases (the first has the name of the curve), its label, and where its name stands
    dotted : what the legend calls the dotted lines, if there are some
    """
    columns = {}
    for cases, label, side in shown:
        own = []
        for name, case in cases.items():
            r, p = case["x"].values * float(case["a"]) / a0, case["p"].values
            columns |= {f"r/a0 ({name})": r, f"p/E2* ({name})": p}
            own.append((r, p * 100))
        name_curve(axes, plot(axes, own, label), next(iter(cases)), 0.12, side=side)
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


@with_companion("fig03", "main_case")
def rough_pressures(axes, main: xr.Dataset, exact: bool) -> Columns:
    """Nominal pressure under the rough punch with a layer (1) and without (2); a0 is the radius of contact 1."""
    return main_case(axes, main, {"1": "above", "2": "above"}, exact)


@with_companion("fig07", "main_case")
def rough_and_smooth_pressures(axes, main: xr.Dataset, exact: bool) -> Columns:
    """Nominal pressure, rough and smooth (primes), with a layer (1) and without (2); a0: radius of 1."""
    return main_case(axes, main, {"1": "below", "2": "below", "1′": "above", "2′": "above"}, exact)


@with_companion("fig10", "spot_density")
def densities(axes, found: xr.Dataset, exact: bool) -> Columns:
    """Nominal pressure for three densities of asperities, B and β as in Table 1; a0: radius of 1."""
    paper = [pick(found, Nbar=Nbar, base="thin_layer") for Nbar in (250_000, 62_500, 15_625)]
    shown = []
    for thin, (name, side) in zip(paper, {"1": "above", "2": "below", "3": "below"}.items(), strict=True):
        layered = pick(found, Nbar=float(thin["Nbar"]), base="layered")
        cases = {name: layered, f"{name}, thin layer": thin} if exact else {name: thin}
        shown.append((cases, rf"{name}: $\bar N R^2 = {int(thin['Nbar'])}$", side))
    return pressures(axes, shown, float(paper[0]["a"]), PAPER_LABEL * exact)


def against_load(axes, sweep: xr.Dataset, main: xr.Dataset, what: tuple, exact: bool) -> Columns:
    """One quantity against the load; P0 marked, loads shaded where an assumption fails. what : see AGAINST_LOAD"""
    quantity, scale, label, sides = what
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


AGAINST_LOAD = {
    "fig04": ("Real over nominal contact area against the load.",
              "Ar_An", 1.0, "$A_r/A_n$", {"1": "above", "2": "below"}),
    "fig05": ("Largest real pressure in the middle of the contact against the load.",
              "p_max", 1.0, r"$p_{\max}/E_2^*$", {"1": "below", "2": "below"}),
    "fig06": ("Depth of the rough punch against the load.",
              "D", 1e-3, DEPTH, {"1": "above", "2": "below"}),
    "fig08": ("Depth of the rough punch, and of the smooth one (primes), against the load.",
              "D", 1e-3, DEPTH, {"1": "above", "2": "above", "1′": "below", "2′": "below"}),
}  # fmt: skip
"""Figure -> caption, quantity, its unit and label on the ordinate, curves and on which side of them their names are."""
for _name, (_words, *_what) in AGAINST_LOAD.items():
    _height = 3.6 if _name == "fig08" else 3.0  # it has four curves
    _register = with_companion(_name, "load_sweep", "main_case", words=f"{_words} {OVER_LOADS}", height=_height)
    _register(partial(against_load, what=tuple(_what)))

"""The work-precision study as a figure and as tables."""

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D

from study.figures.registry import TWO_COLUMNS, Columns, figure, table

FLOOR = 1e-12  # smaller errors are drawn here: they come from the reference
TIMES = (5.0, 4e6)  # µs, ends of the abscissa
DRAWN = {
    "paper k = 5": ("the paper's way, $k$ = 5", "#a63603", "D"),
    "paper k = 20": ("the paper's way, $k$ = 20", "#4d1a02", "v"),
    "paper k = 35": ("the paper's way, $k$ = 35", "#000000", "p"),
    "picard k = 20": ("(8), (10) on Newton's nodes, $k$ = 20", "#88419d", "X"),
    "newton, rtol": ("Newton, rtol $10^{-2}$ to $10^{-9}$", "#0b559f", "o"),
    "auto": ("base auto, accuracy 0.5 to $10^{-4}$", "#1b7837", "*"),
}
"""Ways in the figure, with name, colour and mark. The three k of the paper's method are those that reach 1e-2, 1e-4 and
1e-6 first. Tables and CSV have all ways."""
MODELS = {"the other law": "power law for the exact law", "the other layer": "thin layer for the exact layer"}
MODEL_LINE = {"color": "0.35", "linewidth": 0.8, "linestyle": (0, (4, 2)), "zorder": 0}
SETTLED = 0.99  # a mark is filled if at least this share of the cases has ended
REACHED = 0.95  # a setting reaches a target if this share of the cases ends and 95 % of all cases are within it
TARGETS = (1e-2, 1e-3, 1e-4, 1e-6, 1e-9)
ERRORS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)  # errors at which the paper's method is compared with Newton's


@figure("tradeoff", "tradeoff", long=True, size=(TWO_COLUMNS, 6.4), panels=(2, 2))
def work_precision(panels, measurements: xr.Dataset) -> Columns:
    """Error below which 95 % of the cases are, against processor time per case, a panel for each problem set
    (docs/tradeoff.md). Open marks: fewer than 99 % of the cases ended. Dashed: half of the cases differ by more between
    two models."""
    for axes, name in zip(panels.ravel(), measurements["set"].values.tolist(), strict=True):
        of_set = measurements.sel(set=name)
        axes.set_title(name, fontsize=9)
        for way, (_, colour, mark) in DRAWN.items():
            part = of_set.sel(way=way).dropna("step", subset=["time"])
            curve(axes, 1e6 * part["time"].values, part["most"].values, part["ended"].values, colour, mark)
        for way, words in MODELS.items():
            error = float(of_set["median"].sel(way=way)[0])
            if np.isfinite(error):
                axes.axhline(error, **MODEL_LINE)
                text = f"{words.partition(' for')[0]}: {error:.1%}"
                axes.annotate(text, (0.02, error), (0, 1.5), xycoords=("axes fraction", "data"), ha="left", va="bottom",
                              textcoords="offset points", fontsize=6.5, color="0.25")  # fmt: skip
        axes.set(xscale="log", yscale="log", xlim=TIMES, ylim=(FLOOR / 2, 3))
        axes.set_yticks(10.0 ** np.arange(-12, 1, 3))
    for axes in panels[-1]:
        axes.set_xlabel("processor time per case (µs)")
    for axes in panels[:, 0]:
        axes.set_ylabel("error, 95 % of the cases below")
    legend(panels)
    return columns(measurements)


def curve(axes, time, error, ended, colour: str, mark: str) -> None:
    """Draw error against time of one way; marks are open if a smaller share than SETTLED of the cases has ended."""
    error = np.maximum(error, FLOOR)
    axes.plot(time, error, "-", color=colour, linewidth=0.9)
    for where, face in ((ended >= SETTLED, colour), (ended < SETTLED, "white")):
        size = 7 if mark == "*" else 4
        style = {"markersize": size, "markerfacecolor": face, "markeredgewidth": 0.8}
        axes.plot(time[where], error[where], mark, color=colour, linestyle="none", **style)


def legend(panels) -> None:
    """One legend below the figure."""
    handles = [
        Line2D([], [], color=colour, marker=mark, markersize=6 if mark == "*" else 4, linewidth=0.9, label=name)
        for name, colour, mark in DRAWN.values()
    ]
    hollow = {"color": "0.3", "marker": "o", "markerfacecolor": "white", "markersize": 4, "linewidth": 0}
    handles.append(Line2D([], [], label="open: fewer than 99 % ended", **hollow))
    handles.append(Line2D([], [], label="a simpler model: error of half the cases", **MODEL_LINE))
    panels[0, 0].figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=7.5)


@table(
    "tradeoff",
    "tradeoff",
    long=True,
    columns=r"""set; way; setting; cases | d; time/us | .1f | time/\textmu s
    error 50% | .1e; error 95% | .1e; largest | .1e; ended | .1%""",
)
def rows(measurements: xr.Dataset) -> list[tuple]:
    """Work and precision: time per case on one thread, error of half and of 95% of the cases, largest error, share of
    the cases that ended."""
    table = []
    for name in measurements["set"].values.tolist():
        for way in measurements["way"].values.tolist():
            part = measurements.sel(set=name, way=way)
            for step in np.flatnonzero(np.isfinite(part["time"].values)):
                measurement = part.isel(step=step)
                errors = [float(measurement[key]) for key in ("median", "most", "worst")]
                setting = f"{str(measurement['varied'].values)} {float(measurement['setting']):g}"
                numbers = (
                    int(measurement["cases"]),
                    1e6 * float(measurement["time"]),
                    *errors,
                    float(measurement["ended"]),
                )
                table.append((name, MODELS.get(way, way), setting, *numbers))
    return table


@table(
    "tradeoff_cheapest",
    "tradeoff",
    long=True,
    columns="; ".join(["set", "way", *(f"{target:g} | .3g" for target in TARGETS)]),
)
def cheapest(measurements: xr.Dataset) -> list[tuple]:
    """Time per case in us of the cheapest setting with which 95% of the cases are within the error; -: there is
    none."""
    table, ways = [], [way for way in measurements["way"].values.tolist() if way not in MODELS]
    for name in measurements["set"].values.tolist():
        for way in ways:
            part = measurements.sel(set=name, way=way)
            if int(part["cases"]):
                times = (time_to(part, target) for target in TARGETS)
                table.append((name, way, *(time if np.isfinite(time) else "-" for time in times)))
    return table


def time_to(part: xr.Dataset, target: float) -> float:
    """µs per case of the cheapest setting of one way that reaches the target; inf if none does."""
    reached = (part["most"].values <= target) & (part["ended"].values >= REACHED)
    return 1e6 * float(np.min(part["time"].values[reached], initial=np.inf))


@table(
    "tradeoff_factors",
    "tradeoff",
    long=True,
    columns="error | g; the paper's way | .3g; with; Newton | .3g; factor | .0f",
)
def factors(measurements: xr.Dataset) -> list[tuple]:
    """On the paper's layer: the paper's way at its cheapest beside Newton (rtol), time per case in us.

    It has those of ERRORS that the paper's way reaches.
    """
    layer, table = measurements.sel(set="paper, layer"), []
    ways = [way for way in layer["way"].values.tolist() if way.startswith("paper") and int(layer["cases"].sel(way=way))]
    for target in ERRORS:
        theirs, way = min((time_to(layer.sel(way=way), target), way) for way in ways)
        newton = time_to(layer.sel(way="newton, rtol"), target)
        if np.isfinite(theirs):
            table.append((target, theirs, way.removeprefix("paper "), newton, theirs / newton))
    return table


def columns(measurements: xr.Dataset) -> Columns:
    """The numbers in the figure; set and way are given by their positions."""
    timed = np.isfinite(measurements["time"].values)
    i, j, _ = np.nonzero(timed)
    cells = {name: measurements[name].values[timed] for name in ("setting", "time", "median", "most", "worst", "ended")}
    return {"set": i, "way": j, "cases": measurements["cases"].values[i, j]} | cells

"""Random cases far beyond any scene: maps of status, error and iterations over the ranges, and their table."""

from itertools import product

import numpy as np
import xarray as xr
from matplotlib.colors import BoundaryNorm, LogNorm
from matplotlib.lines import Line2D

from solver import Status
from solver.status import NO_SOLUTION
from study.figures.registry import TWO_COLUMNS, Columns, figure, joined, table

BASES = {"half_space": "half-space", "thin_layer": "thin layer", "layered": "exact layer"}
LAWS = ("smooth", "disc_cell", "power_law")
AXES = {"P": r"$P/(E_2^* R^2)$", "N Ra^2": r"$\bar N R_a^2$", "h": "$h/R$", "n": "$n$"}
ROWS = (("half_space", "P", "N Ra^2"), ("thin_layer", "P", "N Ra^2"), ("thin_layer", "h", "n"),
        ("layered", "P", "N Ra^2"), ("layered", "h", "n"))  # fmt: skip
BARS = ("estimated error / rtol, median of the cell", "iterations, largest of the cell")
BINS = 24
_MANY = 10_000  # with more cases in a map, converged ones are drawn as smaller points
#: FAILED: status of a failed case -> its colour; COLOURS: the same for all statuses.
_FAILURES = [s for s in Status if s not in (Status.CONVERGED, Status.OUTSIDE_LAW, *NO_SOLUTION)]
#: Statuses without a solution that occur without adhesion; also where the law of asperities on a layer has ended.
_WITHOUT = [*(status for status in NO_SOLUTION if status != Status.PULLED_OFF), Status.OUTSIDE_LAW]
FAILED = dict(zip(_FAILURES, ("#d55e00", "#cc79a7", "black", "#e69f00", "#0072b2", "#009e73"), strict=False))
COLOURS = {Status.CONVERGED: "0.85"} | dict(zip(_WITHOUT, ("0.4", "#56b4e9", "#f0e442"), strict=True)) | FAILED
ITERATIONS = (1, 5, 10, 15, 20, 30, 50, 100, 200, 500)


@figure("extremes", "extremes", "extremes_layered", long=True, size=(TWO_COLUMNS, 9.2), panels=(5, 3))
def maps(panels, *studies: xr.Dataset) -> Columns:
    """Random cases far beyond any scene, drawn as studies/evidence/extremes.toml and extremes_layered.toml say. Rows: a
    base and two of its parameters. Columns: every case as a point by its status; of the converged cases of a cell the
    median of error over rtol, and the largest number of iterations.

    The numbers are those of the cells that hold cases.
    """
    cases, parts = pooled(studies), []
    for row, (base, x, y) in zip(panels, ROWS, strict=True):
        drawn = {name: values[cases["base"] == base] for name, values in cases.items()}
        edges = [np.geomspace(drawn[name].min(), drawn[name].max(), BINS + 1) for name in (x, y)]
        cells = binned(drawn, x, y, edges)
        points(row[0], drawn, x, y)
        images = [shaded(row[1], edges, cells["median error/rtol"], LogNorm(1e-8, 1))]
        images.append(shaded(row[2], edges, cells["largest iterations"], BoundaryNorm(ITERATIONS, 256)))
        for axes in row:
            axes.set(xscale="log", yscale="log", xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]], xlabel=AXES[x])
            axes.tick_params(top=False, right=False, which="both", direction="out", labelsize=7)
            axes.minorticks_off()
        row[0].set_ylabel(f"{BASES[base]}\n{AXES[y]}")
        nonempty = cells["cases"] > 0
        numbers = {name: values[nonempty] for name, values in cells.items()}
        parts.append({"row": np.full(nonempty.sum(), len(parts))} | numbers)
    for axes, title in zip(panels[0], ("status", "error / rtol, median", "iterations, largest"), strict=True):
        axes.set_title(title, fontsize=9)
    legend(panels, images, np.unique(cases["status"]))
    return joined(parts)


def pooled(studies: tuple[xr.Dataset, ...]) -> dict[str, np.ndarray]:
    """All cases of the studies, flat: parameters, N Ra², status, error over rtol, iterations."""
    flat = []
    for study in studies:
        wanted = {name: study[name] for name in ("P", "h", "n", "base", "micro", "status", "iterations")}
        wanted |= {"N Ra^2": study["Nbar"] * study["Ra"] ** 2, "error/rtol": study["error"] / study["rtol"]}
        arrays = xr.broadcast(*wanted.values(), exclude=("x",))
        flat.append({name: array.values.ravel() for name, array in zip(wanted, arrays, strict=True)})
    return joined(flat)


def binned(cases: dict[str, np.ndarray], x: str, y: str, edges: list[np.ndarray]) -> Columns:
    """Columns over the cells of the plane: middle; numbers of cases, of converged and of failed ones; for the converged
    ones also the median and largest error over rtol and the largest number of iterations, NaN without such cases."""
    at = [np.searchsorted(e[1:-1], cases[name], "right") for name, e in zip((x, y), edges, strict=True)]
    cell, status = at[0] * BINS + at[1], cases["status"]
    middles = np.meshgrid(*(np.sqrt(e[1:] * e[:-1]) for e in edges), indexing="ij")
    columns = {"x": middles[0].ravel(), "y": middles[1].ravel(), "cases": np.bincount(cell, minlength=BINS**2)}
    columns["failed"] = np.bincount(cell[np.isin(status, list(FAILED))], minlength=BINS**2)
    columns["converged"] = np.bincount(cell[status == Status.CONVERGED], minlength=BINS**2)
    reductions = {"median error/rtol": np.median, "largest error/rtol": np.max, "largest iterations": np.max}
    converged = [np.flatnonzero((cell == i) & (status == Status.CONVERGED)) for i in range(BINS**2)]
    for column, reduce in reductions.items():
        values = cases[column.split()[1]]
        columns[column] = np.array([reduce(values[index]) if len(index) else np.nan for index in converged])
    return columns


def points(axes, cases: dict[str, np.ndarray], x: str, y: str) -> None:
    """Draw every case as a point in the colour of its status, failures on top."""
    smallest = 1.0 if len(cases["status"]) > _MANY else 2.0
    for status, colour in COLOURS.items():
        which = cases["status"] == status
        size = smallest if status == Status.CONVERGED else 5.0 if status in FAILED else 2.5
        style = {"color": colour, "markersize": size, "markeredgewidth": 0, "rasterized": True}
        axes.plot(cases[x][which], cases[y][which], ".", **style)


def shaded(axes, edges: list[np.ndarray], values: np.ndarray, norm):
    """Draw the values of the cells; empty ones are grey. Returns the image, for the colour bar."""
    axes.set_facecolor("0.9")
    grid = np.ma.masked_invalid(np.clip(values, norm.vmin, norm.vmax).reshape(BINS, BINS).T)
    return axes.pcolormesh(*edges, grid, norm=norm, cmap="viridis", rasterized=True)


def legend(panels, images, present: np.ndarray) -> None:
    """Colour bars and legend below the columns. present : the statuses that occur"""
    figure = panels[0, 0].figure
    for column, image, label in zip(panels.T[1:], images, BARS, strict=True):
        bar = figure.colorbar(image, ax=column, location="bottom", fraction=0.03, pad=0.01, aspect=25)
        bar.ax.tick_params(labelsize=7)
        bar.set_label(label, fontsize=8)
    handles = []
    for status, colour in COLOURS.items():
        if status in present:
            word = status.name.lower().replace("_", " ")
            handles.append(Line2D([], [], color=colour, marker="o", markersize=4, linestyle="", label=word))
    figure.legend(handles=handles, loc="outside lower left", ncols=2, fontsize=7)


SHARES = "n/a", "lift-off", "outside law", "converged", "above rtol", "failed"
NUMBERS = "error 50% | .1e; error 99.9% | .1e; error max | .1e; iterations | .0f; max | .0f"


@table(
    "extremes",
    "extremes",
    "extremes_layered",
    long=True,
    columns="base; law; cases | d; " + "".join(f"{share} | .2%; " for share in SHARES) + NUMBERS,
)
def shares(*studies: xr.Dataset) -> list[tuple]:
    """Random cases far beyond any scene: share of the cases that have no solution (the thin layer does not apply, the
    punch lifts off, the law of asperities on the layer has ended), shares of the others, error over rtol and iterations
    of the converged ones.

    A row for each base and law. Of the cases that have a solution it tells how many converged, missed rtol, failed
    otherwise.
    """
    cases, rows = pooled(studies), []
    for base, law in product(BASES, LAWS):
        which = (cases["base"] == base) & (cases["micro"] == law)
        status = cases["status"][which]
        solvable = status[~np.isin(status, _WITHOUT)]
        kinds = [Status.CONVERGED], [Status.TOLERANCE_NOT_MET], set(FAILED) - {Status.TOLERANCE_NOT_MET}
        counts = [(status == s).mean() for s in _WITHOUT]
        counts += [np.isin(solvable, list(kind)).mean() for kind in kinds]
        error, iterations = (cases[name][which][status == Status.CONVERGED] for name in ("error/rtol", "iterations"))
        numbers = [*counts, *np.quantile(error, (0.5, 0.999, 1)), *np.quantile(iterations, (0.5, 1))]
        rows.append((BASES[base], law.replace("_", " "), len(status), *map(float, numbers)))
    return rows

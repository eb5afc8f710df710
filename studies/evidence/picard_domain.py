"""Convergence of the paper's successive approximations: maps of the cycle in which they end, over C and k."""

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.colors import BoundaryNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogFormatterMathtext

from study.figures.registry import TWO_COLUMNS, Columns, figure, joined

MAPS = ((0.5, 16), (0.5, 32), (0.5, 64), (0.4, 32), (0.6667, 32))  # β and number of nodes of each map
SHARES = (1e-2, 1e-4)  # p/p(0) of the lines A'(p) = (1 + 2k) C
LARGEST = 0.57021276802733
"""Largest eigenvalue, over 4/π, of the operator p -> u(r) - u(1) of the half-space on a contact of radius 1.
tests/evidence/test_picard_domain.py computes it from the matrix."""
DECADES = 10.0 ** np.arange(-8, 0)
LINES = {"color": "black", "linewidth": 0.9}
DASHES = ((0, (4, 1.5)), (0, (1, 1.2)))


@figure("picard_domain", "picard_domain", long=True, size=(TWO_COLUMNS, 4.8), panels=(2, 3))
def domain(panels, approximations: xr.Dataset) -> Columns:
    """Size of the cycle in which the paper's successive approximations (8) end, over the compliance C of the layer and
    the relaxation 1 + 2k, and the lines of the linear theory. Last panel: two successive iterates near the edge, and
    the solution."""
    *maps, last = panels.ravel()
    parts = []
    for axes, (beta, nodes) in zip(maps, MAPS, strict=True):
        part = approximations.sel(beta=beta, nodes=nodes).transpose("k", "h", ...)
        image = draw_map(axes, part)
        parts.append(map_columns(part))
        axes.set_title(rf"$\beta = {'2/3' if beta > 0.6 else beta}$, {nodes} nodes", fontsize=8)
        axes.set_xlabel(r"$C\,E_2^*/R$", labelpad=1)
    cycle(last)
    for axes in panels[:, 0]:
        axes.set_ylabel("$1 + 2k$")
    fine = {"ticks": DECADES[::2], "aspect": 30, "format": LogFormatterMathtext()}
    bar = panels[0, 0].figure.colorbar(image, ax=panels[:, -1], **fine)
    bar.set_label(r"largest $|\hat p - p|\,/\,p(0)$ after 2000 approximations")
    bar.ax.tick_params(which="both", length=0)
    legend(panels)
    return joined(parts)


def compliance(part: xr.Dataset) -> np.ndarray:
    """C (R/E2*) for each h: 2 A2 h/E1* with A2 = 1/2, without friction under the layer."""
    return part["h"].values / float(part["n"])


def cycle_size(part: xr.Dataset) -> np.ndarray:
    """Largest |p̂ - p|/p(0) over (k, h): the residual of Eq. (4), which is relative to a²/2, over C."""
    pressure = part["residual"].values * float(part["a"]) ** 2 / (2 * compliance(part))
    with np.errstate(divide="ignore"):  # an iterate may be 0 in the middle
        return pressure / part["p0"].values


def draw_map(axes, part: xr.Dataset):
    """Draw the size of the cycle over C and 1 + 2k, in grey above 0.1, and the lines of the linear theory."""
    C, k = compliance(part), part["k"].values
    size = np.ma.masked_greater_equal(cycle_size(part), DECADES[-1])  # above, the whole pressure swings
    axes.set_facecolor("0.75")
    style = {"shading": "nearest", "cmap": "YlGnBu_r", "norm": BoundaryNorm(DECADES, 256), "rasterized": True}
    image = axes.pcolormesh(C, 1 + 2 * k, size.clip(DECADES[0]), **style)
    for line, dashes in zip(theory(part), ("-", *DASHES), strict=True):
        axes.plot(C, line, linestyle=dashes, **LINES)
    axes.set(xscale="log", yscale="log", xlim=(C[0], C[-1]), ylim=(1, 1 + 2 * k[-1]))
    axes.set_xticks([0.01, 0.1], ["0.01", "0.1"])
    axes.set_yticks([1, 10, 100], ["1", "10", "100"])
    axes.tick_params(which="both", direction="out", top=False, right=False)
    return image


def theory(part: xr.Dataset) -> list[np.ndarray]:
    """Smallest 1 + 2k for which small errors shrink: for each line an array over h.

    The first line is that of the whole contact, by its half-space part alone. The others are those of the asperities
    alone, A'(p)/C at each p/p(0) of SHARES. p(0) is that of the largest k, whose error is at most 5e-7.
    """
    C, p0 = compliance(part), part["p0"].values[-1]
    a, n, B, Ra, beta = (float(part[name]) for name in ("a", "n", "B", "Ra", "beta"))
    slopes = [beta * B * Ra / n**beta * (share * p0) ** (beta - 1) for share in SHARES]
    return [slope / C for slope in (4 / np.pi * a * LARGEST, *slopes)]


def cycle(axes) -> None:
    """Draw two successive iterates near the edge, long after the load has settled, and the solution between them.

    Results hold no iterates. The iterates come from a file that tools/references/make_picard_cycle.py has written.
    """
    x, *iterates, solution = np.loadtxt(Path(__file__).with_name("picard_cycle.csv"), delimiter=",", skiprows=1).T
    for p, count, mark in zip(iterates, (1000, 1001), "os", strict=True):
        axes.plot(x, 1e3 * p, f"-{mark}", markersize=3, linewidth=0.9, label=f"iterate {count}")
    axes.plot(x, 1e3 * solution, "k-", linewidth=0.9, label="solution")
    inside = 1e3 * np.interp(0.985, x[::-1], solution[::-1])
    axes.set(xlim=(0.985, 1.0005), ylim=(0, 1.15 * inside), xlabel="$r/a$", ylabel=r"$10^3\,p/E_2^*$")
    axes.legend(loc="upper right", fontsize=7)
    axes.set_title(r"$k = 0$, $\beta = 0.5$, 64 nodes, $C = 0.04$", fontsize=8)


def map_columns(part: xr.Dataset) -> Columns:
    """β, nodes, C, k, size of the cycle and status of each case of a map that has numbers."""
    size, status = cycle_size(part), part["status"].values
    k, C = np.meshgrid(part["k"].values, compliance(part), indexing="ij")
    finite = np.isfinite(size)
    whole = {"beta": np.full(size.shape, float(part["beta"])), "nodes": np.full(size.shape, int(part["nodes"]))}
    whole |= {"C": C, "k": k, "cycle/p(0)": size, "status": status}
    return {name: values[finite] for name, values in whole.items()}


def legend(panels) -> None:
    """One legend below the figure."""
    words = ["small errors of the whole contact die above this line"]
    words += [rf"$A'(p) = (1 + 2k)\,C$ at $p = 10^{{{round(np.log10(share))}}}\,p(0)$" for share in SHARES]
    lines = [Line2D([], [], linestyle=d, label=word, **LINES) for word, d in zip(words, ("-", *DASHES), strict=True)]
    handles = [lines[0], Patch(facecolor="0.75", label="all of the pressure swings"), *lines[1:]]
    panels[0, 0].figure.legend(handles=handles, loc="outside lower center", ncols=2, fontsize=8)

"""How far the paper's successive approximations get: the cycle in which they end over C and k, and one seen near the
edge."""

import numpy as np
import xarray as xr
from matplotlib.colors import BoundaryNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogFormatterMathtext

from solver import Problem, solve
from solver.contact import picard
from solver.numerics.mesh import mesh
from solver.scaling import as_cases, dimensionless

MAPS = ((0.5, 16), (0.5, 32), (0.5, 64), (0.4, 32), (0.6667, 32))
"""β and number of nodes of each map."""
SHOWN = {"beta": 0.5, "nodes": 64, "k": 0.0, "h": 0.02}
"""The case whose iterates are drawn."""
SHARES = (1e-2, 1e-4)
"""p/p(0) of the lines A'(p) = (1 + 2k) C."""
DECADES = 10.0 ** np.arange(-8, 0)
LINES = {"color": "black", "linewidth": 0.9}
DASHES = ((0, (4, 1.5)), (0, (1, 1.2)))
Columns = dict[str, np.ndarray]


def domain(panels, found: xr.Dataset) -> Columns:
    """Five maps of the size of the cycle in which the approximations end, and two successive iterates in one."""
    *maps, last = panels.ravel()
    parts = []
    for axes, (beta, nodes) in zip(maps, MAPS, strict=True):
        part = found.sel(beta=beta, nodes=nodes).transpose("k", "h", ...)
        image = draw_map(axes, part)
        parts.append(map_columns(part))
        axes.set_title(rf"$\beta = {'2/3' if beta > 0.6 else beta}$, {nodes} nodes", fontsize=8)
        axes.set_xlabel(r"$C\,E_2^*/R$", labelpad=1)
    cycle(last, parameters(found))
    for axes in panels[:, 0]:
        axes.set_ylabel("$1 + 2k$")
    bar = panels[0, 0].figure.colorbar(
        image, ax=panels[:, -1], ticks=DECADES[::2], aspect=30, format=LogFormatterMathtext()
    )
    bar.set_label(r"largest $|\hat p - p|\,/\,p(0)$ after 2000 approximations")
    bar.ax.tick_params(which="both", length=0)
    legend(panels)
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def parameters(found: xr.Dataset) -> dict:
    """What the cases of the study have in common, as arguments of `Problem.of`."""
    names = ("a", "n", "Nbar", "Ra", "B")
    return {name: float(found[name]) for name in names} | {"base": "thin_layer", "micro": "power_law"}


def compliance(part: xr.Dataset) -> np.ndarray:
    """C (R/E2*) over h: 2 A2 h/E1* with A2 = 1/2, no friction under the layer."""
    return part["h"].values / float(part["n"])


def cycle_size(part: xr.Dataset) -> np.ndarray:
    """Largest |p̂ - p|/p(0) over (k, h): the residual of Eq. (4), which is relative to a²/2, over C."""
    pressure = part["residual"].values * float(part["a"]) ** 2 / (2 * compliance(part))
    with np.errstate(divide="ignore"):  # an iterate may be 0 in the middle
        return pressure / part["p0"].values


def draw_map(axes, part: xr.Dataset):
    """Size of the cycle over C and 1 + 2k, grey where all of the pressure swings; the lines of the linear theory."""
    C, k = compliance(part), part["k"].values
    size = np.ma.masked_greater_equal(cycle_size(part), DECADES[-1])  # beyond, all of the pressure swings
    axes.set_facecolor("0.75")
    norm = BoundaryNorm(DECADES, 256)
    image = axes.pcolormesh(
        C, 1 + 2 * k, size.clip(DECADES[0]), shading="nearest", cmap="YlGnBu_r", norm=norm, rasterized=True
    )
    whole, edges = theory(parameters(part), part["h"].values, float(part["beta"]), int(part["nodes"]))
    axes.plot(C, whole, linestyle="-", **LINES)
    for edge, dashes in zip(edges, DASHES, strict=True):
        axes.plot(C, edge, linestyle=dashes, **LINES)
    axes.set(xscale="log", yscale="log", xlim=(C[0], C[-1]), ylim=(1, 1 + 2 * k[-1]))
    axes.set_xticks([0.01, 0.1], ["0.01", "0.1"])
    axes.set_yticks([1, 10, 100], ["1", "10", "100"])
    axes.tick_params(which="both", direction="out", top=False, right=False)
    return image


def theory(case: dict, h: np.ndarray, beta: float, nodes: int) -> tuple[np.ndarray, list[np.ndarray]]:
    """Smallest 1 + 2k, over the thickness h, for which small errors die: of the whole contact by its half-space part
    alone, and of the asperities alone where p/p(0) is each of SHARES, A'(p)/C."""
    grid = mesh(nodes)
    problem = Problem.of(**case, beta=beta, h=h, rtol=1e-6)
    cases = as_cases(dimensionless(problem))
    largest = np.linalg.eigvals(cases.body.at(cases.value, grid).K[0]).real.max()
    whole = 4 / np.pi * cases.value * largest / (cases.body.E * cases.body.C)
    p0, B = solve(problem).p0, float(case["B"]) * float(case["Ra"]) / float(case["n"]) ** beta
    return whole, [beta * B * (share * p0) ** (beta - 1) / cases.body.C for share in SHARES]


def cycle(axes, case: dict) -> None:
    """Two successive iterates near the edge, long after the load has settled, and the solution between them."""
    case = {name: case[name] for name in ("a", "n", "Nbar", "Ra", "B", "base", "micro")} | SHOWN
    grid = mesh(case.pop("nodes"))
    k = np.array([case.pop("k")])
    problem = Problem.of(**case, nodes=grid.n, rtol=1e-9)
    cases = as_cases(dimensionless(problem))
    eta = np.log(cases.value)
    for count, mark in ((1000, "o"), (1001, "s")):
        q = picard.approximate(cases, eta, grid, k, np.zeros(1), count).at.q[0]
        axes.plot(grid.x, 1e3 * cases.law.p_star * q, f"-{mark}", markersize=3, linewidth=0.9, label=f"iterate {count}")
    x = np.linspace(0.98, 1, 201)
    axes.plot(x, 1e3 * solve(problem, x).p[0], "k-", linewidth=0.9, label="solution")
    axes.set(xlim=(0.985, 1.0005), ylim=(0, None), xlabel="$r/a$", ylabel=r"$10^3\,p/E_2^*$")
    inside = 1e3 * solve(problem, np.array([0.985])).p[0, 0]
    axes.set_ylim(0, 1.15 * inside)
    axes.legend(loc="upper right", fontsize=7)
    axes.set_title(rf"$k = {k[0]:g}$, $\beta = {case['beta']}$, {grid.n} nodes, $C = {2 * case['h']:g}$", fontsize=8)


def map_columns(part: xr.Dataset) -> Columns:
    """β, nodes, C, k, size of the cycle and status of each case of a map that has numbers."""
    size, status = cycle_size(part), part["status"].values
    k, C = np.meshgrid(part["k"].values, compliance(part), indexing="ij")
    known = np.isfinite(size)
    whole = {"beta": np.full(size.shape, float(part["beta"])), "nodes": np.full(size.shape, int(part["nodes"]))}
    whole |= {"C": C, "k": k, "cycle/p(0)": size, "status": status}
    return {name: values[known] for name, values in whole.items()}


def legend(panels) -> None:
    """One legend below the figure."""
    words = ["small errors of the whole contact die above this line"]
    words += [rf"$A'(p) = (1 + 2k)\,C$ at $p = 10^{{{round(np.log10(share))}}}\,p(0)$" for share in SHARES]
    handles = [
        Line2D([], [], linestyle=dashes, label=word, **LINES)
        for word, dashes in zip(words, ("-", *DASHES), strict=True)
    ]
    handles.insert(1, Patch(facecolor="0.75", label="all of the pressure swings"))
    panels[0, 0].figure.legend(handles=handles, loc="outside lower center", ncols=2, fontsize=8)

"""The figures of `make validate`."""

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D
from validate_cases import LAWS
from validate_cells import SHOWN

from study.figures.style import style

WORDS = {"power_law": "power law", "disc_cell": "disc cell", "square_lattice": "square lattice"}
LOOKS = {"power_law": ("C1", (0, (1, 1.2))), "disc_cell": ("C2", (0, (4, 2))), "square_lattice": ("C0", "-")}

#: Colours of five stiffnesses, from hard to soft.
COLOURS = ("#8c2d04", "#dd5f21", "#E69F00", "#2878b8", "#08306b")
#: Smaller errors, which are near that of the resolved cells, are drawn here.
LEAST = 1e-6


def draw_means(half_space: xr.Dataset, layer: xr.Dataset, path: Path) -> None:
    """Draw means of the cells over r/a with the nominal pressure of each law, and below them the errors of the laws."""
    from matplotlib.figure import Figure

    with style():
        figure = Figure(figsize=(6.9, 7.8), layout="constrained")
        panels = figure.subplots(4, 3, sharex=True, height_ratios=(2, 1.1, 2, 1.1))
        for dataset, rows in ((half_space, panels[:2]), (layer, panels[2:])):
            for name, (top, below) in zip(dataset["case"].values, rows.T, strict=True):
                _means(dataset.sel(case=name).isel(base=0), top, below)
                top.set_title(name, fontsize=8)
            rows[0, 0].set_ylabel("$100\\,p/E_2^*$")
            rows[1, 0].set_ylabel("law less mean, % of $p(0)$", fontsize=7)
            low, high = min(p.get_ylim()[0] for p in rows[1]), max(p.get_ylim()[1] for p in rows[1])
            for panel in rows[1]:
                panel.set_ylim(low, high)
        for panel in panels[3]:
            panel.set(xlabel="$r/a$", xlim=(0, 1.05))
        panels[0, 0].legend(fontsize=6.5, loc="lower left")
        figure.savefig(path)


def _means(case: xr.Dataset, top, below) -> None:
    a, p0 = float(case["a0"]), float(case["p0"])
    touched = np.isfinite(case["r"].values)
    r, mean = case["r"].values[touched], case["mean"].values[touched]
    for law in LAWS["base"]:
        colour, dashes = LOOKS[law]
        x, p = case["profile_r"].sel(law=law).values, case["profile"].sel(law=law).values
        top.plot(x / a, 100 * p, color=colour, linestyle=dashes, label=WORDS[law], linewidth=1)
        off = 100 * (np.interp(r, x, p, right=0) - mean) / p0
        below.plot(r / a, off, color=colour, marker="o", linestyle="", markersize=1.5)
    top.plot(r / a, 100 * mean, "k.", markersize=2.5, label="resolved, mean of a cell")
    top.set_ylim(bottom=0)
    below.axhline(0, color="0.5", linewidth=0.6)


def draw_limits(parts: dict[str, xr.Dataset], path: Path) -> None:
    """Draw the contacts on layers that are thin compared with the pitch, and those with random heights."""
    from matplotlib.figure import Figure

    with style():
        figure = Figure(figsize=(6.9, 5.8), layout="constrained")
        panels = figure.subplots(2, 2)
        _thinner(parts["thinner"], panels[0, 0])
        _films(parts["films"], panels[0, 1])
        _spheres(parts["heights"], panels[1, 0])
        _cells(parts["cells"], panels[1, 1])
        for letter, panel in zip("abcd", panels.ravel(), strict=True):
            panel.set_title(f"({letter})", fontsize=8, loc="left")
        figure.savefig(path)


def _thinner(dataset: xr.Dataset, panel) -> None:
    pitch = (dataset["pitch"] / dataset["h"]).values
    for name, words, colour, mark in (
        ("D", "depth", "C0", "o"),
        ("a", "width", "C2", "s"),
        ("p_max", "largest pressure", "C1", "^"),
    ):
        error = 100 * dataset[f"{name}_error"].sel(law="square_lattice")
        look = {"color": colour, "marker": mark, "markersize": 3.5}
        panel.plot(pitch, error.sel(asperities_on="layer").values, label=words, linestyle="-", **look)
        panel.plot(pitch, error.sel(asperities_on="half_space").values, linestyle=":", fillstyle="none", **look)
    panel.axhline(0, color="0.5", linewidth=0.6)
    panel.set(xscale="log", xlabel="pitch/$h$", ylabel="error of two scales (%)")
    _plain(panel, [0.3, 0.5, 1, 2, 3, 5])
    title = "sphere, $n$ = 0.5, frictionless;\ndotted: asperities on a half-space"
    panel.legend(fontsize=6.5, title=title, title_fontsize=6.5, loc="upper left")


def _films(dataset: xr.Dataset, panel) -> None:
    some = dataset.sel(lam=SHOWN)
    for i, material in enumerate(dataset["material"].values):
        of_material = some.sel(material=material)
        look = {"color": COLOURS[i], "linewidth": 1}
        panel.plot(
            of_material["fine"].values, 100 * abs(of_material["law"].values), linestyle="-", label=material, **look
        )
        at, change = of_material["pitch_over_h"].values, of_material["change"].sel(quantity="A").values
        panel.plot(at, 100 * abs(change), color=COLOURS[i], linestyle="", marker="o", markersize=3)
    panel.set(xscale="log", yscale="log", ylim=(3e-3, 3e4), xlim=(0.95, 17), xlabel="pitch/$h$")
    panel.set_ylabel("change of $A$ by the coated body (%)")
    _plain(panel, [1, 2, 3, 5, 10, 16])
    panel.legend(fontsize=6.5, title=f"λ = {SHOWN:g}; o cell, — the law", title_fontsize=6.5, loc="upper left")


def draw_cells(dataset: xr.Dataset, path: Path) -> None:
    """Draw the errors of both laws in A and p_max of the cells, over pitch/h."""
    from matplotlib.figure import Figure

    with style():
        figure = Figure(figsize=(6.9, 3.1), layout="constrained")
        panels = figure.subplots(1, 2, sharey=True)
        stiff = sorted({*dataset["n"].values.tolist()})
        for panel, name, symbol in zip(panels, ("A", "p_max"), ("$A$", "$p_{\\max}$"), strict=True):
            for n, colour in zip(stiff, COLOURS[::-1], strict=True):
                of_stiffness = dataset.isel(cell=dataset["n"].values == n)
                error = 100 * abs(of_stiffness["error"].sel(quantity=name)).clip(LEAST)
                at, look = (
                    of_stiffness["pitch_over_h"].values,
                    {"color": colour, "linestyle": "", "marker": "o", "markersize": 4},
                )
                panel.plot(at, error.sel(on="layer").values, label=f"$n$ = {n:g}", **look)
                panel.plot(at, error.sel(on="half_space").values, fillstyle="none", **look)
            panel.axhline(1, color="0.5", linewidth=0.6, linestyle=":")
            panel.set(xscale="log", yscale="log", xlabel="pitch/$h$", ylim=(100 * LEAST / 2, 1000))
            panel.set_title(f"error of {symbol} (%)", fontsize=8)
            _plain(panel, [1, 2, 3, 5, 10, 16])
        handles = panels[0].get_legend_handles_labels()[0]
        handles += [Line2D([], [], color="0.3", linestyle="", marker="o", markersize=4, fillstyle=fill, label=label)
                    for fill, label in (("full", "on the layer"), ("none", "on a half-space"))]  # fmt: skip
        figure.legend(handles=handles, loc="outside lower center", ncols=7, fontsize=7, handlelength=1)
        figure.savefig(path)


def _plain(panel, ticks: list[float]) -> None:
    """Ticks of a logarithmic axis written as they are."""
    panel.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    panel.set_xticks([], minor=True)


def _spheres(dataset: xr.Dataset, panel) -> None:
    for i, name in enumerate(dataset["case"].values):
        case = dataset.sel(case=name)
        r, law = 1e3 * case["r"].values, 100 * case["law_mean"]
        _resolved(panel, r, 100 * case["mean"].values, 200 * case["unsure"].values, f"C{i}")
        panel.plot(r, law.sel(law="heights").values, color=f"C{i}", linewidth=1, label=name)
    panel.plot(r, law.sel(law="one height").values, color="0.6", linestyle="-", linewidth=1, label="one height")
    panel.set(xlabel="$1000\\,r/R$", ylabel="mean pressure, $100\\,p/E^*$", ylim=(0, None))
    panel.legend(fontsize=6.5)


def _cells(dataset: xr.Dataset, panel) -> None:
    for i, spread in enumerate(dataset["spread"].values):
        of_spread, depth = dataset.sel(spread=spread), dataset["A"].sel(spread=spread)
        unsure = depth.std("draw", ddof=1).values / np.sqrt(depth.sizes["draw"])
        p, law = of_spread["p"].values, of_spread["law_A"].values
        _resolved(panel, p, depth.mean("draw").values, 2 * unsure, f"C{i}")
        panel.plot(p, law, color=f"C{i}", linewidth=1, label=f"$\\sigma$ = {spread:g} $A^*$")
    panel.set(xscale="log", xlabel="$p\\,R_a/(E\\,$pitch$)$", ylabel="depth of the mean plane over $A^*$")
    panel.legend(fontsize=6.5, title="lines: mean field; o periodic cells", title_fontsize=6.5)


def _resolved(panel, x, y, unsure, colour) -> None:
    panel.errorbar(x, y, unsure, color=colour, linestyle="", marker="o", markersize=2.5, linewidth=0.8)

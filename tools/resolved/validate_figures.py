"""The figures of `make validate`."""

from pathlib import Path

import numpy as np
import xarray as xr
from validate_cases import LAWS

from study.figures.style import style

WORDS = {"power_law": "power law", "disc_cell": "disc cell", "square_lattice": "square lattice"}
LOOKS = {"power_law": ("C1", (0, (1, 1.2))), "disc_cell": ("C2", (0, (4, 2))), "square_lattice": ("C0", "-")}


def draw_means(half_space: xr.Dataset, layer: xr.Dataset, path: Path) -> None:
    """Means of the cells over r/a with the nominal pressure of each law, and below what the laws are off by."""
    from matplotlib.figure import Figure

    with style():
        figure = Figure(figsize=(6.9, 7.8), layout="constrained")
        panels = figure.subplots(4, 3, sharex=True, height_ratios=(2, 1.1, 2, 1.1))
        for found, rows in ((half_space, panels[:2]), (layer, panels[2:])):
            for name, (top, below) in zip(found["case"].values, rows.T, strict=True):
                _means(found.sel(case=name).isel(base=0), top, below)
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


def _means(one: xr.Dataset, top, below) -> None:
    a, p0 = float(one["a0"]), float(one["p0"])
    touched = np.isfinite(one["r"].values)
    r, mean = one["r"].values[touched], one["mean"].values[touched]
    for law in LAWS:
        colour, dashes = LOOKS[law]
        x, p = one["profile_r"].sel(law=law).values, one["profile"].sel(law=law).values
        top.plot(x / a, 100 * p, color=colour, linestyle=dashes, label=WORDS[law], linewidth=1)
        off = 100 * (np.interp(r, x, p, right=0) - mean) / p0
        below.plot(r / a, off, color=colour, marker="o", linestyle="", markersize=1.5)
    top.plot(r / a, 100 * mean, "k.", markersize=2.5, label="resolved, mean of a cell")
    top.set_ylim(bottom=0)
    below.axhline(0, color="0.5", linewidth=0.6)


def draw_limits(parts: dict[str, xr.Dataset], path: Path) -> None:
    """Where the layer is thin against the pitch, and random heights."""
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


def _thinner(found: xr.Dataset, panel) -> None:
    pitch = (found["pitch"] / found["h"]).values
    best = found.sel(law="square_lattice", base="layered")
    for name, words, colour, mark in (
        ("D", "depth", "C0", "o"),
        ("a", "width", "C2", "s"),
        ("p_max", "largest pressure", "C1", "^"),
    ):
        panel.plot(pitch, 100 * best[f"{name}_error"].values, color=colour, marker=mark, markersize=3.5, label=words)
    panel.axhline(0, color="0.5", linewidth=0.6)
    panel.set(xscale="log", xlabel="pitch/$h$", ylabel="error of two scales (%)")
    _plain(panel, [0.3, 0.5, 1, 2, 3, 5])
    panel.legend(fontsize=6.5, title="sphere, $n$ = 0.5, frictionless", title_fontsize=6.5)


def _films(found: xr.Dataset, panel) -> None:
    some = found.isel(p=1)
    for i, material in enumerate(found["material"].values):
        one = some.sel(material=material)
        at = one["pitch_over_h"].values
        panel.plot(at, 100 * abs(one["formula"].values), color=f"C{i}", linewidth=1, label=material)
        panel.plot(at, 100 * abs(one["change"].values), color=f"C{i}", linestyle="", marker="o", markersize=3)
    panel.set(xscale="log", yscale="log", ylim=(3e-3, 100), xlabel="pitch/$h$", ylabel="$|\\delta A|/A$ (%)")
    _plain(panel, [1, 1.5, 2, 3, 4, 6])
    panel.legend(fontsize=6.5, title=f"λ = {float(some['lam']):.2f}; o cell, — first order", title_fontsize=6.5)


def _plain(panel, ticks: list[float]) -> None:
    """Ticks of a logarithmic axis written as they are."""
    panel.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    panel.set_xticks([], minor=True)


def _spheres(found: xr.Dataset, panel) -> None:
    for i, name in enumerate(found["case"].values):
        one = found.sel(case=name)
        r, law = 1e3 * one["r"].values, 100 * one["law_mean"]
        _resolved(panel, r, 100 * one["mean"].values, 200 * one["unsure"].values, f"C{i}")
        panel.plot(r, law.sel(law="heights").values, color=f"C{i}", linewidth=1, label=name)
    panel.plot(r, law.sel(law="one height").values, color="0.6", linestyle="-", linewidth=1, label="one height")
    panel.set(xlabel="$1000\\,r/R$", ylabel="mean pressure, $100\\,p/E^*$", ylim=(0, None))
    panel.legend(fontsize=6.5)


def _cells(found: xr.Dataset, panel) -> None:
    for i, spread in enumerate(found["spread"].values):
        one, own = found.sel(spread=spread), found["A"].sel(spread=spread)
        unsure = own.std("draw", ddof=1).values / np.sqrt(own.sizes["draw"])
        p, law = one["p"].values, one["law_A"].values
        _resolved(panel, p, own.mean("draw").values, 2 * unsure, f"C{i}")
        panel.plot(p, law, color=f"C{i}", linewidth=1, label=f"$\\sigma$ = {spread:g} $A^*$")
    panel.set(xscale="log", xlabel="$p\\,R_a/(E\\,$pitch$)$", ylabel="depth of the mean plane over $A^*$")
    panel.legend(fontsize=6.5, title="lines: mean field; o periodic cells", title_fontsize=6.5)


def _resolved(panel, x, y, unsure, colour) -> None:
    panel.errorbar(x, y, unsure, color=colour, linestyle="", marker="o", markersize=2.5, linewidth=0.8)

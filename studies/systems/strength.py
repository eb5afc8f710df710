"""Pressures and loads at which coated bodies first yield or crack, from the largest stresses of smooth contacts."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D

from solver.laws.disc_cell import largest_pressure
from solver.laws.elastic_plastic import TABOR
from solver.yields.asperities import hertz_part, stress_on_axis
from study import extremes, materials
from study.figures.registry import TWO_COLUMNS, Columns, figure, joined

#: n -> colour, from soft (blue) to hard (red); 1 is the body without a layer.
COLOURS = {0.1: "#08306b", 0.3: "#2878b8", 1.0: "0.2", 3.0: "#f4a36c", 10.0: "#dd5f21", 100.0: "#8c2d04"}


@figure("first_yield", "first_yield", long=True, size=(TWO_COLUMNS, 5.2), panels=(2, 2))
def first_yield(panels, contacts: xr.Dataset) -> Columns:
    """The pressure p(0) under a smooth sphere at which layer (above) and body (below) first yield by von Mises, over
    the yield strength of each, from thin layers to thick ones; bonded (left) and frictionless (right), ν = 0.3. Dotted:
    a half-space, 1.61. A hard layer bends and yields long before a half-space of it would; a thick layer protects the
    body, but under a hard one of h/a near 0.3 the body yields a little earlier than without a layer."""
    largest, parts = extremes(contacts), []
    h_a = (contacts["h"] / contacts["a"]).values
    for column, bonding in zip(panels.T, contacts["bonding"].values.tolist(), strict=True):
        for n in contacts["n"].values.tolist():
            case = largest.sel(bonding=bonding, n=n)
            p0 = contacts["p0"].sel(bonding=bonding, n=n)
            ratios = {number: (p0 / case[f"mises{number}"]).values for number in (1, 2)}
            for axes, ratio in zip(column, ratios.values(), strict=True):
                axes.plot(h_a, ratio, color=COLOURS[n], linestyle="-", label=f"{n:g}")
            fixed = {"bonded": float(bonding == "bonded"), "n": n}
            part = {name: np.full(len(h_a), value) for name, value in fixed.items()} | {"h/a": h_a}
            parts.append(part | {"p0/Y1": ratios[1], "p0/Y2": ratios[2]})
        for axes, letter, body in zip(column, "ac" if bonding == "bonded" else "bd", ("layer", "body"), strict=True):
            axes.set_title(f"({letter}) {body}, {bonding} interface", fontsize=9, loc="left")
    for axes in panels.flat:
        axes.axhline(1.613, color="0.5", linestyle=":", linewidth=0.8, zorder=0)
        axes.set(xscale="log", yscale="log", xlim=(h_a[0], h_a[-1]))
        axes.set_xticks([0.1, 1], ["0.1", "1"])
    rows = (1, (0.03, 5), [0.1, 1]), (2, (1, 100), [1, 10, 100])  # a thicker layer protects the body from all loads
    for row, (number, limits, ticks) in zip(panels, rows, strict=True):
        row[0].set_ylabel(f"$p(0)/Y_{number}$ at first yield")
        for axes in row:
            axes.set(ylim=limits)
            axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    for axes in panels[1]:
        axes.set_xlabel("$h/a$")
    handles = panels[0, 0].get_legend_handles_labels()[0]
    panels[0, 0].figure.legend(handles=handles, title="$n=E_1^*/E_2^*$", loc="outside lower center", ncols=6)
    return joined(parts)


class Mode(NamedTuple):
    """A way to fail: words, colour, its stress in `study.extremes`, and the body whose strength the stress reaches."""

    words: str
    colour: str
    stress: str
    body: str


MODES = (
    Mode("steel yields", "#0072B2", "mises2", "body"),
    Mode("layer yields", "#E69F00", "mises1", "layer"),
    Mode("layer cracks", "#D55E00", "s1_layer", "layer"),
)
FRICTION = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
SHOWN = {0.0: "-", 0.4: (0, (4, 1.5))}  # coefficients of friction whose loads are drawn, and their dashes
THICKNESS = np.geomspace(2.5e-3, 0.2, 161)  # h/R
CONTOURS = [20, 25, 30, 40, 60, 100, 200, 400]  # of loads over R², N/mm²
GREY, DOTTED = "0.45", (0, (1, 1.2))
SHEAR = 1e9  # of the interface, in Pa; no table has its strength
ASPERITIES = 16.0  # N Ra²: of 2 µm radius, every half micrometre
PARABOLA = 0.2  # a/R up to which a sphere is close to its parabola


def strength(mode: Mode, contacts: xr.Dataset) -> float:
    """The strength in Pa from the table of materials; a yield strength that it lacks is the hardness over 2.84."""
    material = materials.get(contacts[mode.body].item())
    if mode.stress == "s1_layer":
        return material.fracture_strength
    return material.yield_strength or material.hardness / TABOR


def first(h: np.ndarray, along: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """The smallest load of the curve (along, loads) at each h; NaN if it has none there. The curve, drawn in
    logarithms, may run to and fro: the load that is reached first counts."""
    least = np.full(len(h), np.nan)
    x, y = np.log(along), np.log(loads)
    for i in range(len(x) - 1):
        share = (np.log(h) - x[i]) / (x[i + 1] - x[i])
        value = np.where((share >= 0) & (share <= 1), y[i] + share * (y[i + 1] - y[i]), np.nan)
        least = np.fmin(least, value)
    return np.exp(least)


def nominal_at_asperity_yield(contacts: xr.Dataset) -> float:
    """The pressure p in Pa at which elastic asperities first yield; they have the hardness of the softer of punch and
    layer."""
    punch, layer = (materials.get(contacts[name].item()) for name in ("punch", "layer"))
    Y = min(punch.hardness, layer.hardness) / TABOR
    E = 1 / ((1 - punch.nu**2) / punch.E + (1 - layer.nu**2) / layer.E)
    p = np.geomspace(1e6, 1e10, 2000)
    p0s, c = hertz_part(largest_pressure(p, E, ASPERITIES, 1.0), p, E, ASPERITIES, 1.0)
    return float(np.interp(Y, p0s * stress_on_axis(layer.nu, c, p / p0s), p))


@figure("what_fails_first", "what_fails_first", long=True, size=(TWO_COLUMNS, 3.6), panels=(1, 2))
def what_fails_first(panels, contacts: xr.Dataset) -> Columns:
    """A steel ball on ta-C on bearing steel. (a) Loads over R² at which steel and layer first yield by von Mises and at
    which the largest tension in the layer reaches its fracture strength, without friction (solid) and in sliding with
    $\\mu$ = 0.4 (dashed); dotted: where the shear of the interface, whose strength no table has, reaches 1 GPa without
    friction. (b) What comes first, and contours of its load. All radii have one map. Strengths are those of the table
    of materials, yield strengths a 2.84th of the hardness. Thin: beyond a = 0.2 R, where a sphere is no parabola. The
    layer has no residual stress here, and asperities are left out but for the load that is written in (a): that at
    which elastic ones of $\\bar N R_a^2$ = 16 on the ball yield in the middle."""
    largest = {mu: extremes(contacts, mu) for mu in FRICTION}
    loads = {}
    for mode in MODES:
        limit = strength(mode, contacts)
        loads[mode] = np.array([reached(contacts, case[mode.stress], limit) for case in largest.values()])
    draw_loads(panels[0], contacts, largest, loads)
    draw_map(panels[1], loads)
    for axes in panels:
        axes.set(xscale="log", xlim=(THICKNESS[0], THICKNESS[-1]), xlabel="$h/R$")
    handles = [Line2D([], [], color=mode.colour, label=mode.words) for mode in MODES]
    handles.append(Line2D([], [], color=GREY, linestyle=DOTTED, label="interface shear 1 GPa"))
    panels[0].figure.legend(handles=handles, loc="outside lower center", ncols=4)
    panels[0].figure.suptitle("ball of steel 52100, layer of DLC ta-C, body of steel 52100, bonded", fontsize=7)
    parts = []
    for number, mode in enumerate(MODES):
        for mu, load in zip(FRICTION, loads[mode], strict=True):
            part = {"mode": np.full(len(THICKNESS), number), "mu": np.full(len(THICKNESS), mu), "h/R": THICKNESS}
            finite = np.isfinite(load)
            parts.append({name: column[finite] for name, column in (part | {"P/R^2 [Pa]": load}).items()})
    return joined(parts)


def reached(contacts: xr.Dataset, stress: xr.DataArray, limit: float, most: float = np.inf) -> np.ndarray:
    """P/R² at which a stress of the contacts first reaches its limit, for each THICKNESS; NaN if a/R exceeds `most`.

    At a fixed h/a stresses grow like a/R, the thickness like a, and the load like a³.
    """
    R, factor = float(contacts["R"]), limit / stress.values
    factor = np.where(factor * (contacts["a"] / R).values <= most, factor, np.nan)
    return first(THICKNESS, contacts["h"].values / R * factor, contacts["P"].values / R**2 * factor**3)


def draw_loads(axes, contacts: xr.Dataset, largest: dict, loads: dict) -> None:
    """The load of each mode without friction (solid) and in sliding (dashed)."""
    for mu, dashes in SHOWN.items():
        for mode in MODES:
            load = loads[mode][FRICTION.index(mu)] / 1e6
            valid = reached(contacts, largest[mu][mode.stress], strength(mode, contacts), PARABOLA) / 1e6
            look = {"color": mode.colour, "linestyle": dashes}
            axes.plot(THICKNESS, np.where(valid == load, np.nan, load), linewidth=0.6, **look)
            axes.plot(THICKNESS, valid, **look)
    shear = reached(contacts, largest[0.0]["tau_interface"], SHEAR)
    axes.plot(THICKNESS, shear / 1e6, color=GREY, linestyle=DOTTED)
    asperities = np.nanmax(reached(contacts, contacts["p0"], nominal_at_asperity_yield(contacts))) / 1e6
    text = f"asperities would yield from {asperities:.1g} N/mm²"
    axes.text(0.97, 0.03, text, transform=axes.transAxes, ha="right", va="bottom", fontsize=8, color="0.3")
    axes.set(yscale="log", ylabel="$P/R^2$, N/mm²")
    axes.set_ylim(bottom=5)
    axes.set_title("(a) $\\mu$ = 0, dashed: 0.4", loc="left", fontsize=9)


def draw_map(axes, loads: dict) -> None:
    """The failure that comes first, over thickness and friction, and its load."""
    friction = np.linspace(FRICTION[0], FRICTION[-1], 121)
    fine = np.array([[np.interp(friction, FRICTION, column) for column in np.log(loads[mode]).T] for mode in MODES])
    fine = np.where(np.isfinite(fine), fine, np.inf).swapaxes(1, 2)
    least = np.where(np.isfinite(fine.min(0)), fine.min(0), np.nan)
    which = np.where(np.isfinite(least), fine.argmin(0), np.nan)
    look = {"cmap": ListedColormap([mode.colour for mode in MODES]), "vmin": 0, "vmax": len(MODES) - 1, "alpha": 0.5}
    axes.pcolormesh(THICKNESS, friction, which, rasterized=True, **look)
    lines = axes.contour(THICKNESS, friction, np.exp(least) / 1e6, CONTOURS, colors="black", linewidths=0.7)
    axes.clabel(lines, fmt="%g", fontsize=7)
    axes.set(ylabel=r"coefficient of friction $\mu$")
    axes.set_title("(b) what comes first; $P/R^2$, N/mm²", loc="left", fontsize=9)


#: Ways to fail of DLC on chromium on steel: words, colour, the extreme, and the layer; 0: the body.
_OF_STACK = (
    ("steel yields", "#0072B2", "mises2", 0),
    ("chromium yields", "#009E73", "mises_layer", 2),
    ("DLC yields", "#E69F00", "mises_layer", 1),
    ("DLC cracks", "#D55E00", "s1_layer", 1),
)
_INTERFACES = (("DLC/chromium", "#CC79A7"), ("chromium/steel", "#56B4E9"))


def shares(contacts: xr.Dataset, largest: xr.Dataset) -> np.ndarray:
    """Stress over strength for each row of `_OF_STACK`, (4, h1, h2)."""
    carbon, steel = (materials.get(contacts[body].item()) for body in ("layer", "body"))
    limits = (
        steel.yield_strength or steel.hardness / TABOR,
        float(contacts["layers.2.Y"]),
        carbon.yield_strength or carbon.hardness / TABOR,
        carbon.fracture_strength,
    )
    ratios = []
    for (_, _, name, layer), limit in zip(_OF_STACK, limits, strict=True):
        stress = largest[name].sel(layer=layer) if layer else largest[name]
        ratios.append(stress.transpose("h", "layers.2.h").values / limit)
    return np.array(ratios)


def _between(values: np.ndarray, axes: tuple, fine: list) -> np.ndarray:
    """Values (n, h1, h2) on the axes `fine`, interpolated linearly in the logarithms of the thicknesses."""
    for axis, (coarse, points) in enumerate(zip(axes, fine, strict=True), 1):
        along = [np.log(coarse), np.log(points)]
        values = np.apply_along_axis(lambda column, along=along: np.interp(along[1], along[0], column), axis, values)
    return values


@figure("which_layer_first", "which_layer_first", long=True, size=(TWO_COLUMNS, 3.6), panels=(1, 2))
def which_layer_first(panels, contacts: xr.Dataset) -> Columns:
    """A steel ball of 1 mm on DLC on chromium on bearing steel, 40 N, without friction and residual stress. (a) What is
    closest to its strength, over the thickness of both layers: colours, and lines of the stress over the strength.
    Strengths are those of the table of materials, and of chromium that of a hardness of 8 GPa. (b) Which interface has
    the larger shear stress, and lines of that in GPa; dashed: lines of the tension at the lower side of the DLC in
    GPa, where the layer bends."""
    largest = extremes(contacts)
    h1, h2 = (contacts[name].values * 1e6 for name in ("h", "layers.2.h"))
    part, common = shares(contacts, largest), {"cmap": None, "alpha": 0.5, "rasterized": True, "shading": "nearest"}
    shear, bending = (
        largest[name].transpose("interface", "h", "layers.2.h").values / 1e9
        for name in ("tau_interface", "sr_interface")
    )
    maps = (part, [colour for _, colour, *_ in _OF_STACK]), (shear, [colour for _, colour in _INTERFACES])
    fine = [np.geomspace(axis[0], axis[-1], 81) for axis in (h1, h2)]
    for axes, (values, colours) in zip(panels, maps, strict=True):
        look = common | {"cmap": ListedColormap(colours), "vmin": 0, "vmax": len(colours) - 1}
        between = _between(values, (h1, h2), fine)
        axes.set(xscale="log", yscale="log", xlabel="thickness of the DLC, µm", ylabel="thickness of the chromium, µm")
        axes.set(xlim=(h1[0], h1[-1]), ylim=(h2[0], h2[-1]))  # before the labels, whose places depend on the limits
        axes.pcolormesh(*fine, between.argmax(axis=0).T, **look)
        lines = axes.contour(*fine, between.max(axis=0).T, 5, colors="black", linewidths=0.7)
        axes.clabel(lines, fmt="%.2f", fontsize=7, inline_spacing=2)
        axes.set_xticks([1, 2, 5, 10], ["1", "2", "5", "10"])
        axes.set_yticks([0.5, 1, 2, 5, 10], ["0.5", "1", "2", "5", "10"])
    bent = panels[1].contour(*fine, _between(bending, (h1, h2), fine)[0].T, 4, colors=GREY, linestyles="--")
    bent.set(linewidths=0.7)
    panels[1].clabel(bent, fmt="%.2g", fontsize=7, inline_spacing=2)
    panels[0].set_title("(a) closest to its strength; stress/strength", loc="left", fontsize=9)
    panels[1].set_title("(b) larger shear; dashed: tension of the DLC, GPa", loc="left", fontsize=9)
    present = [row[:2] for i, row in enumerate(_OF_STACK) if (part.argmax(axis=0) == i).any()]
    present += [row for i, row in enumerate(_INTERFACES) if (shear.argmax(axis=0) == i).any()]
    handles = [Line2D([], [], color=colour, linewidth=5, alpha=0.5, label=words) for words, colour in present]
    panels[0].figure.legend(handles=handles, loc="outside lower center", ncols=5, fontsize=7)
    panels[0].figure.suptitle("ball of steel 52100, DLC ta-C on chromium on steel 52100, bonded, 40 N", fontsize=7)
    grid = {
        name: array.ravel()
        for name, array in zip(("h1 [m]", "h2 [m]"), np.meshgrid(h1 / 1e6, h2 / 1e6, indexing="ij"), strict=True)
    }
    named = {f"{words}: stress/strength": share.ravel() for (words, *_), share in zip(_OF_STACK, part, strict=True)}
    named |= {f"tau {words} [GPa]": values.ravel() for (words, _), values in zip(_INTERFACES, shear, strict=True)}
    return joined([grid | named])

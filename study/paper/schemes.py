"""Figures 1 and 2: the schemes of the contact and of one asperity, drawn to the numbers of a dataset.

Lengths along r are to scale. Heights of surfaces are stretched by a factor that the figure states, as they would not
be seen otherwise: the punch of radius 1 is pressed in by a thousandth. The thickness of the layer is to scale.
"""

import numpy as np
import xarray as xr
from scipy.special import ellipkm1

from ..figures.sources import pick

LAYER, HALF_SPACE, PUNCH = "0.9", "0.78", "0.6"
ARROW = {"arrowstyle": "-|>", "color": "black", "linewidth": 0.7, "mutation_scale": 7, "shrinkA": 0, "shrinkB": 0}
BOTH = ARROW | {"arrowstyle": "<|-|>"}
Columns = dict[str, np.ndarray]


def sunk(case: xr.Dataset, r: np.ndarray) -> np.ndarray:
    """Displacement of the half-space under the layer at the radii r, in R: the integral of Eq. (3) with A1/E1* = 1/E2*.

    The pressure between the stored points is linear; the kernel is integrated as smooth between their midpoints, which
    is accurate enough to draw.
    """
    edges = np.linspace(0, 1, 801)
    x = (edges[1:] + edges[:-1]) / 2
    p, source = np.interp(x, case["x"], case["p"]), x * float(case["a"])
    total = r[:, None] + source
    kernel = ellipkm1(((r[:, None] - source) / total) ** 2)
    return 4 / np.pi * (p * kernel * source / total).sum(1) * float(case["a"]) / x.size


def contact_scheme(axes, main: xr.Dataset, stretch: float = 10.0) -> Columns:
    """Figure 1: rough punch, layer and half-space, from the rough layered contact; every asperity is drawn."""
    case = pick(main, label="rough, layered")
    a, h, n, D, Ra, Nbar = (float(case[name]) for name in ("a", "h", "n", "D", "Ra", "Nbar"))
    r = np.linspace(-2.3 * a, 2.3 * a, 1841)
    p = np.interp(np.abs(r) / a, case["x"], case["p"], right=0)
    interface = -h - stretch * sunk(case, np.abs(r))
    surface = interface + h - stretch * h / n * p  # C = 2 A2 h/E1* = h/n: Eq. (3), no friction under the layer
    spacing = Nbar**-0.5
    nearest = np.round(r / spacing) * spacing
    tips = nearest**2 / 2 - D
    punch = stretch * (tips + (r - nearest) ** 2 / (2 * Ra))
    top, bottom = 1.75 * h, -2.6 * h
    axes.fill_between(r, bottom, interface, color=HALF_SPACE, linewidth=0)
    axes.fill_between(r, interface, surface, color=LAYER, linewidth=0)
    inside = punch < top
    axes.fill_between(r, punch, top, where=inside, color=PUNCH, linewidth=0)
    for line, width in ((interface, 0.7), (surface, 0.9), (np.where(inside, punch, np.nan), 0.7)):
        axes.plot(r, line, "k-", linewidth=width)
    contact_labels(axes, a, h, stretch * D, (r[-1], top, bottom))
    on_punch = 1.4 * a, stretch * ((1.4 * a) ** 2 / 2 - D)
    arrow(axes, (0.75 * a, 0.92 * top), on_punch, "$R$", (-2, 0), tail=True)
    height = float(np.interp(-1.7 * a, r, surface))  # the layer keeps its thickness where there is no pressure
    measure(axes, (-1.7 * a, height), (-1.7 * a, height - h), "$h$", (-8, 0))
    note = f"$r$ and $h$ to scale; heights of punch, asperities and deflections $\\times$ {stretch:g}"
    axes.set_title(note, size=8)
    return {
        "r/R": r,
        "punch/R": punch / stretch,
        "surface/R": surface / stretch,
        "interface + h/R": (interface + h) / stretch,
    }


def contact_labels(axes, a: float, h: float, D: float, frame: tuple[float, float, float]) -> None:
    """Axes r and z and the letters of Figure 1; D as drawn, frame: largest r, top, bottom."""
    right, top, bottom = frame
    axes.plot([-right, right], [0, 0], color="0.3", linestyle=(0, (6, 2, 1, 2)), linewidth=0.6)
    arrow(axes, (0.97 * right, 0), (1.06 * right, 0), "$r$", (3, 0))
    arrow(axes, (0, -1.3 * h), (0, 0.94 * bottom), "$z$", (8, 0))
    axes.plot([0, 0], [-1.3 * h, -D], color="0.3", linestyle=(0, (6, 2, 1, 2)), linewidth=0.6)
    arrow(axes, (0, 1.5 * top), (0, top), "$P$", (6, 9))
    level = -1.95 * h
    for end in (-a, a):
        axes.plot([end, end], [-0.1 * h, level - 0.1 * h], "k:", linewidth=0.6)
    measure(axes, (0, level), (a, level), "$a$", (0, 6))
    measure(axes, (0, 0), (0, -D), "$D$", (8, 0))
    axes.text(1.8 * a, -0.6 * h, r"$E_1,\ \nu_1$", va="center", ha="center")
    axes.text(1.8 * a, -1.9 * h, r"$E_2,\ \nu_2$", va="center", ha="center")
    axes.set(xlim=(-1.02 * right, 1.12 * right), ylim=(bottom, 1.55 * top), aspect="equal")
    axes.axis("off")


def spot_scheme(axes, main: xr.Dataset, stretch: float = 3.0) -> Columns:
    """Figure 2: the asperity in the middle of the contact on its cell, p outside; from the rough layered contact."""
    case = pick(main, label="rough, layered")
    Ra, Nbar, p, E1 = float(case["Ra"]), float(case["Nbar"]), float(case["p0"]), float(case["n"])
    cell = (np.pi * Nbar) ** -0.5
    b = cell * float(case["lam"][0]) ** 0.5
    r = np.linspace(-2.2 * cell, 2.2 * cell, 881)
    A = b**2 / Ra - 2 * p / E1 * np.sqrt(cell**2 - b**2)  # Eq. (6)
    surface = -stretch * spot_displacement(np.abs(r), A, b, cell, Ra, p / E1)
    asperity = stretch * (r**2 / (2 * Ra) - A)
    top, bottom = 1.3 * cell, -1.5 * cell
    axes.fill_between(r, bottom, surface, color=LAYER, linewidth=0)
    inside = asperity < top
    axes.fill_between(r, np.maximum(asperity, surface), top, where=inside, color=PUNCH, linewidth=0)
    axes.plot(r, np.where(inside, asperity, np.nan), "k-", linewidth=0.9)
    axes.plot(r, surface, "k-", linewidth=0.9)
    spot_labels(axes, b, cell, (r[-1], top, bottom))
    on_asperity = 1.3 * cell, stretch * ((1.3 * cell) ** 2 / (2 * Ra) - A)
    arrow(axes, (0.5 * cell, 0.85 * top), on_asperity, "$R_a$", (-2, 0), tail=True)
    axes.set_title(f"along $r$ to scale; heights $\\times$ {stretch:g}", size=8)
    return {"r/R": r, "asperity/R": asperity / stretch, "surface/R": surface / stretch}


def spot_displacement(r: np.ndarray, A: float, b: float, cell: float, Ra: float, p: float) -> np.ndarray:
    """Displacement of the surface at r >= 0 around one spot, relative to a surface under p everywhere; p in E1*.

    u(r) = (2/π) ∫ φ(r sin ψ) dψ over 0..π/2 with φ(t) = A - t²/Ra on the spot, t < b, and -2p sqrt(B̄² - t²) on the
    rest of the cell, where p is missing; φ(b) is continuous by Eq. (6).
    """
    psi = (np.arange(400) + 0.5) * np.pi / 800
    t = r[:, None] * np.sin(psi)
    phi = np.where(t < b, A - t**2 / Ra, -2 * p * np.sqrt(np.maximum(cell**2 - t**2, 0)))
    return phi.mean(axis=1)


def spot_labels(axes, b: float, cell: float, frame: tuple[float, float, float]) -> None:
    """Axes and letters of Figure 2; frame: largest r, top, bottom."""
    right, top, bottom = frame
    for side in (-1, 1):
        for place in np.linspace(cell, right, 7):
            arrow(axes, (side * place, 0.27 * cell), (side * place, 0.02 * cell), "", (0, 0))
        axes.plot([side * cell, side * right], [0.27 * cell] * 2, "k-", linewidth=0.7)
        axes.text(side * 1.75 * cell, 0.3 * cell, "$p$", ha="center", va="bottom")
        for end, level in ((b, -0.55 * cell), (cell, -1.0 * cell)):
            axes.plot([side * end] * 2, [0, level - 0.06 * cell], "k:", linewidth=0.6)
    measure(axes, (0, -0.5 * cell), (b, -0.5 * cell), "$b$", (0, -8))
    measure(axes, (0, -cell), (cell, -cell), r"$\bar B = 1/\sqrt{\pi\bar N}$", (0, -8))
    axes.plot([0, 0], [bottom, top], color="0.3", linestyle=(0, (6, 2, 1, 2)), linewidth=0.6)
    axes.text(-0.9 * right, 0.75 * bottom, r"$E_1,\ \nu_1$", va="center")
    axes.set(xlim=(-1.02 * right, 1.02 * right), ylim=(bottom, 1.02 * top), aspect="equal")
    axes.axis("off")


def arrow(axes, start, end, text: str, offset, tail: bool = False) -> None:
    """Arrow with a letter at its end, or at its tail."""
    axes.annotate("", end, start, arrowprops=ARROW)
    axes.annotate(
        text,
        start if tail else end,
        offset,
        textcoords="offset points",
        ha="left" if not tail else "right",
        va="center",
    )


def measure(axes, start, end, text: str, offset) -> None:
    """Double arrow with a letter beside its middle."""
    axes.annotate("", end, start, arrowprops=BOTH)
    middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
    axes.annotate(text, middle, offset, textcoords="offset points", ha="center", va="center")

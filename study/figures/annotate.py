"""Marks on axes that several figures share: names of curves, the axis of loads, shading of broken assumptions."""

import numpy as np
import xarray as xr
from matplotlib.patheffects import withStroke

from ..rules.rule import RULES, broken

MOST = 0.75  # largest share of the axis that is shaded: with more, curves and legend would stand on grey


def name_curve(axes, lines: list, text: str, at: float, *, side: str = "above", align: str = "center") -> None:
    """Write the name of a curve at the abscissa `at`, `align`ed there (left, center, right).

    The name stands "above" or "below" all the lines of the curve, in the colour of the first. A short stroke joins it
    to the first line if other lines are between.
    """
    heights = [np.interp(at, *line.get_data()) for line in lines]
    gap, anchor, height = (1, "bottom", max(heights)) if side == "above" else (-1, "top", min(heights))
    colour, halo = lines[0].get_color(), [withStroke(linewidth=2, foreground="white")]
    look = {"ha": align, "va": anchor, "color": colour, "textcoords": "offset points"}
    axes.annotate(text, (at, height), (0, gap), path_effects=halo, **look)
    if height != heights[0]:
        axes.vlines(at, *sorted((height, heights[0])), color=colour, linewidth=0.7)


def name_panels(panels) -> None:
    """Write (a), (b), ... at the upper left corners of panels, unless a title or the legend's begins with a letter."""
    for letter, axes in zip("abcdefghijkl", panels, strict=False):
        legend = axes.get_legend()
        headings = [axes.get_title("left"), axes.get_title(), legend.get_title().get_text() if legend else ""]
        if not any(heading.startswith("(") for heading in headings):
            place = {"xycoords": "axes fraction", "textcoords": "offset points", "ha": "right", "va": "bottom"}
            axes.annotate(f"({letter})", (0, 1), (-4, 4), fontsize=9, **place)


def load_axis(axes, largest: float, P0: float) -> None:
    """An abscissa of loads in 1e-5 E2* R², from 0 to `largest`, with a mark at P0, the load of the main case."""
    axes.set(xlabel=r"$P\ /\ (10^{-5} E_2^* R^2)$", xlim=(0, largest * 1e5))
    axes.axvline(P0 * 1e5, ymin=0.4, color="0.55", linestyle="-", linewidth=0.6, zorder=0)
    place = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points", "ha": "right", "va": "top"}
    axes.annotate("$P_0$ ", (P0 * 1e5, 0.98), (0, 0), fontsize=7, color="0.3", **place)


def shade_violations(axes, P: np.ndarray, validity: dict[str, xr.DataArray]) -> None:
    """Grey bands over the loads (E2* R²) at which curves break an assumption; the legend names assumption and curves.

    An assumption that is broken along more than MOST of the axis is noted above it instead, with the loads.

    validity : curve name -> flags over P, with the attributes flag_masks and flag_meanings
    """
    noted = []
    for meaning, of_curves in violations(validity).items():
        where = np.any(list(of_curves.values()), axis=0)
        along = [(1e5 * start, 1e5 * stop) for start, stop in bands(P, where)]
        if sum(stop - start for start, stop in along) > MOST * 1e5 * P[-1]:
            ends = (f"{low:.3g} < P < {high:.3g}" if low else f"P < {high:.3g}" for low, high in along)
            loads = ", ".join(rf"${both} \times 10^{{-5}} E_2^* R^2$" for both in ends)
            noted.append((meaning, of_curves, "" if where.all() else f", {loads}"))
            continue
        label = f"not valid: {RULES[meaning].text} ({', '.join(of_curves)})"
        for start, stop in along:
            axes.axvspan(start, stop, color=RULES[meaning].grey, linewidth=0, zorder=-1, label=label)
            label = "_"  # one entry in the legend
    note(axes, noted)


def note_violations(axes, validity: dict[str, xr.DataArray]) -> None:
    """Write above the axes which curves break which assumptions.

    validity : curve name -> flags of one case
    """
    note(axes, [(meaning, of_curves, "") for meaning, of_curves in violations(validity).items()])


def violations(validity: dict[str, xr.DataArray]) -> dict[str, dict[str, np.ndarray]]:
    """Assumption -> curve -> where the curve breaks it, for the curves that do; in the order of the masks.

    A results file of an earlier version has fewer masks.
    """
    masks = {name: broken(flags) for name, flags in validity.items()}
    curves_of = {
        meaning: {name: where[meaning] for name, where in masks.items() if meaning in where and where[meaning].any()}
        for meaning in dict.fromkeys(meaning for where in masks.values() for meaning in where)
    }
    return {meaning: curves for meaning, curves in curves_of.items() if curves}


def note(axes, noted: list[tuple]) -> None:
    """Write above the axes a line for each assumption.

    noted : assumption, the curves that break it, and the loads in words, unless it is broken everywhere
    """
    lines = [f"{', '.join(curves)}: {RULES[meaning].text}{loads}"
             for meaning, curves, loads in noted]  # fmt: skip
    axes.set_title("\n".join(lines), fontsize=7, loc="left", color="0.2")


def bands(P: np.ndarray, where: np.ndarray) -> list[tuple[float, float]]:
    """Intervals of P in which `where` holds. A point stands for P half-way to its neighbours, the first from 0 on."""
    edges = np.concatenate([[0.0], (P[1:] + P[:-1]) / 2, P[-1:]])
    steps = np.flatnonzero(np.diff(np.concatenate([[0], where.astype(int), [0]])))
    return [(edges[i], edges[j]) for i, j in zip(steps[::2], steps[1::2], strict=True)]

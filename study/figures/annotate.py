"""Marks on axes that several figures share: names of curves, the axis of loads, shading of broken assumptions."""

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.patheffects import withStroke

from ..data.derived import COMPRESSED, FEW_SPOTS, MERGING, SPOT_OVER_LAYER, STEEP

ASSUMPTION_TEXT = {
    "layer_not_thin": "layer not thin",
    "few_spots": rf"$\bar N A_n < {FEW_SPOTS:g}$",
    "spot_not_small_against_h": rf"$b > {SPOT_OVER_LAYER:g}\,h$",
    "n_not_below_one": r"$n \geq 1$",
    "spots_merging": rf"$\lambda(0) > {MERGING:g}$",
    "strain_not_small": rf"$a > {STEEP:g}\,R$ or strain $> {COMPRESSED:g}$",
}
GREYS = ("0.87", "0.74", "0.8", "0.93", "0.83", "0.9")


def name_curve(axes, lines: list, text: str, at: float, *, side: str = "above", align: str = "center") -> None:
    """Write the name of a curve at the abscissa `at`, `align`ed there (left, center, right).

    It stands "above" or "below" all the lines that belong to the curve, in the colour of the first.
    """
    heights = [np.interp(at, *line.get_data()) for line in lines]
    gap, anchor, height = (2, "bottom", max(heights)) if side == "above" else (-2, "top", min(heights))
    axes.annotate(
        text,
        (at, height),
        (0, gap),
        textcoords="offset points",
        ha=align,
        va=anchor,
        color=lines[0].get_color(),
        path_effects=[withStroke(linewidth=2, foreground="white")],
    )


def load_axis(axes, largest: float, P0: float) -> None:
    """Abscissa of loads 0 to `largest` (E2* R²) in 1e-5, with the load P0 of the main case marked above the legend."""
    axes.set(xlabel=r"$P\ /\ (10^{-5} E_2^* R^2)$", xlim=(0, largest * 1e5))
    axes.axvline(P0 * 1e5, ymin=0.4, color="0.4", linestyle=(0, (1, 2)), linewidth=0.8, zorder=0)
    axes.annotate(
        "$P_0$", (P0 * 1e5, 1), (0, 2), xycoords=("data", "axes fraction"), textcoords="offset points", ha="center"
    )


def shade_violations(axes, P: np.ndarray, validity: dict[str, xr.DataArray]) -> None:
    """Grey bands over the loads (E2* R²) where a curve breaks an assumption; the legend says which and whose.

    What is broken at every load is written in the upper left corner instead.

    validity : curve name -> flags over P, with the attributes flag_masks and flag_meanings
    """
    flags, nowhere = next(iter(validity.values())).attrs, []
    meanings = flags["flag_meanings"].split()
    for mask, meaning, grey in zip(np.atleast_1d(flags["flag_masks"]), meanings, GREYS, strict=True):
        broken = {name: (array.values & mask) != 0 for name, array in validity.items()}
        curves = [name for name, where in broken.items() if where.any()]
        if not curves:
            continue
        where = np.any([broken[name] for name in curves], axis=0)
        text = f"{ASSUMPTION_TEXT[meaning]} ({', '.join(curves)})"
        if where.all():
            nowhere.append(text)
            continue
        label = f"not valid: {text}"
        for start, stop in bands(P, where):
            axes.axvspan(start * 1e5, stop * 1e5, color=grey, linewidth=0, zorder=-1, label=label)
            label = "_"  # one entry in the legend
    if nowhere:
        axes.annotate(
            "\n".join(["nowhere valid:", *nowhere]), (0, 1), (7, -5), xycoords="axes fraction",
            textcoords="offset points", va="top", fontsize=matplotlib.rcParams["legend.fontsize"],
        )  # fmt: skip


def violated(validity: xr.DataArray) -> list[str]:
    """Texts of the assumptions that one case breaks."""
    masks, meanings = np.atleast_1d(validity.attrs["flag_masks"]), validity.attrs["flag_meanings"].split()
    return [ASSUMPTION_TEXT[word] for mask, word in zip(masks, meanings, strict=True) if int(validity) & mask]


def bands(P: np.ndarray, where: np.ndarray) -> list[tuple[float, float]]:
    """Intervals of P that the points `where` stand for, bounded half-way to the next point; the first begins at 0."""
    edges = np.concatenate([[0.0], (P[1:] + P[:-1]) / 2, P[-1:]])
    steps = np.flatnonzero(np.diff(np.concatenate([[0], where.astype(int), [0]])))
    return [(edges[i], edges[j]) for i, j in zip(steps[::2], steps[1::2], strict=True)]

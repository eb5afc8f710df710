"""Marks on axes that several figures share: names of curves, the axis of loads, shading of broken assumptions."""

import numpy as np
import xarray as xr
from matplotlib.patheffects import withStroke

from .derived import COMPRESSED, FEW_SPOTS, MERGING, SPOT_OVER_LAYER, STEEP

ASSUMPTION_TEXT = {
    "layer_not_thin": "layer not thin",
    "few_spots": rf"$\bar N A_n < {FEW_SPOTS:g}$",
    "spot_not_small_against_h": rf"$b > {SPOT_OVER_LAYER:g}\,h$",
    "n_not_below_one": r"$n \geq 1$",
    "spots_merging": rf"$\lambda(0) > {MERGING:g}$",
    "strain_not_small": rf"$a > {STEEP:g}\,R$ or strain $> {COMPRESSED:g}$",
}
GREYS = ("0.87", "0.74", "0.8", "0.93", "0.83", "0.9")


def name_curve(axes, line, text: str, at: float, *, side: str = "above", align: str = "center") -> None:
    """Write the name of a curve at the abscissa `at`, "above" or "below" it, `align`ed there (left, center, right)."""
    x, y = line.get_data()
    gap, anchor = (3, "bottom") if side == "above" else (-3, "top")
    axes.annotate(
        text,
        (at, np.interp(at, x, y)),
        (0, gap),
        textcoords="offset points",
        ha=align,
        va=anchor,
        color=line.get_color(),
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

    What is broken at every load is said without a band.

    validity : curve name -> flags over P, with the attributes flag_masks and flag_meanings
    """
    flags = next(iter(validity.values())).attrs
    meanings = flags["flag_meanings"].split()
    for mask, meaning, grey in zip(np.atleast_1d(flags["flag_masks"]), meanings, GREYS, strict=True):
        broken = {name: (array.values & mask) != 0 for name, array in validity.items()}
        curves = [name for name, where in broken.items() if where.any()]
        if not curves:
            continue
        where = np.any([broken[name] for name in curves], axis=0)
        extent, drawn = ("nowhere valid", where & False) if where.all() else ("not valid", where)
        label = f"{extent}: {ASSUMPTION_TEXT[meaning]} ({', '.join(curves)})"
        if where.all():
            axes.plot([], [], " ", label=label)
        for start, stop in bands(P, drawn):
            axes.axvspan(start * 1e5, stop * 1e5, color=grey, linewidth=0, zorder=-1, label=label)
            label = "_"  # one entry in the legend


def violated(validity: xr.DataArray) -> list[str]:
    """Texts of the assumptions that one case breaks."""
    masks, meanings = np.atleast_1d(validity.attrs["flag_masks"]), validity.attrs["flag_meanings"].split()
    return [ASSUMPTION_TEXT[word] for mask, word in zip(masks, meanings, strict=True) if int(validity) & mask]


def bands(P: np.ndarray, where: np.ndarray) -> list[tuple[float, float]]:
    """Intervals of P that the points `where` stand for, bounded half-way to the next point; the first begins at 0."""
    edges = np.concatenate([[0.0], (P[1:] + P[:-1]) / 2, P[-1:]])
    steps = np.flatnonzero(np.diff(np.concatenate([[0], where.astype(int), [0]])))
    return [(edges[i], edges[j]) for i, j in zip(steps[::2], steps[1::2], strict=True)]

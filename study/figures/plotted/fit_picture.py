"""Measured curves with their fits, and below each its residuals."""

from collections.abc import Callable

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ...data.dataset import decode
from ...inputs.definition import StudyError
from ...specimen.quantities import readable
from ..labels import axis_label, multiple
from ..registry import Columns, joined

MOST = 4  # largest number of curves in a figure


def fits(fitted: xr.Dataset, where: dict, new: Callable[..., Figure]) -> tuple[Figure, Columns]:
    """The points of each curve, its fit, and the residuals below; points that violate the model's assumptions are open.

    Raises StudyError for more than 4 curves, and for a plan, which has no curves.
    """
    fitted = fitted if "curve" in fitted.dims else fitted.expand_dims("curve")
    x, y = fitted.attrs["x"], fitted.attrs["y"]
    if f"{y}_fit" not in fitted:
        raise StudyError(["a plan has no curves to draw"])
    if unknown := [name for name in where if name != "curve"]:
        raise StudyError([f"{unknown[0]} is not an axis of fits: choose with curve=NUMBER"])
    numbers = [int(where["curve"])] if "curve" in where else range(fitted.sizes["curve"])
    if len(numbers) > MOST or not all(0 <= i < fitted.sizes["curve"] for i in numbers):
        raise StudyError(
            [f"there are {fitted.sizes['curve']} curves, at most {MOST} are drawn: choose one with curve=NUMBER"]
        )
    figure = new(figsize=(max(3.4, 2.9 * len(numbers)), 3.8), layout="constrained")
    panels = figure.subplots(2, len(numbers), sharex="col", squeeze=False, height_ratios=(3, 1))
    sizes = [multiple(fitted[name])[1] for name in (x, y)]
    columns = []
    for (above, below), i in zip(panels.T, numbers, strict=True):
        curve = fitted.isel(curve=i)
        across, up, drawn = (curve[name].values for name in (x, y, f"{y}_fit"))
        valid = ~(across > float(curve[f"{x}_valid"]))  # NaN where nothing is fitted
        order = np.argsort(across)
        order = order[np.isfinite(drawn[order])]  # a gap among the points is not a gap of the fit
        for face, is_shown in (("C0", valid), ("none", ~valid)):
            style = {
                "linestyle": "none",
                "marker": "o",
                "markersize": 2.5,
                "markeredgewidth": 0.5,
                "markeredgecolor": "C0",
            }
            above.plot(across[is_shown] / sizes[0], up[is_shown] / sizes[1], markerfacecolor=face, **style)
            below.plot(across[is_shown] / sizes[0], (up - drawn)[is_shown] / sizes[1], markerfacecolor=face, **style)
        above.plot(across[order] / sizes[0], drawn[order] / sizes[1], color="C1", linestyle="-")
        below.axhline(0.0, color="C1", linestyle="-", linewidth=0.8)
        above.set_title(_title(curve, i, fitted.sizes["curve"]), fontsize=8)
        below.set_xlabel(axis_label(x, fitted[x]))
        columns.append({"curve": np.full(len(across), i), x: across, y: up, f"{y}_fit": drawn, "residual": up - drawn})
    panels[0, 0].set_ylabel(axis_label(y, fitted[y]))
    panels[1, 0].set_ylabel(f"residual, {multiple(fitted[y])[0]}")
    handles = [*panels[0, 0].lines[:1], *panels[0, 0].lines[2:3]]
    labels = ["measured", "fit"]
    if (fitted["validity"].isel(curve=list(numbers)) != 0).any():
        handles, labels = [*handles[:1], panels[0, 0].lines[1], *handles[1:]], ["measured", "outside validity", "fit"]
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=7)
    return figure, joined(columns)


def _title(curve: xr.Dataset, i: int, count: int) -> str:
    name = str(curve["cov_i"].values[0])
    status = str(decode(curve["fit_status"]).item()).replace("_", " ")
    unit = curve[name].attrs["units"]
    value = readable(float(curve[name]), unit, float(curve[f"{name}_spread"]))
    about = f"{name} = {value}" if np.isfinite(curve[name]) else ""
    return ", ".join(filter(None, (f"curve {i}" * (count > 1), about, status * (status != "converged"))))

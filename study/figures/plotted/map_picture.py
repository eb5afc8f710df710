"""A map: one quantity as colour over two axes of the contacts."""

from collections.abc import Callable

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ...inputs.definition import StudyError
from ..labels import axis_label, multiple, stated, with_units, wrapped
from ..registry import Columns
from ..style import spaced_by_factors, tick_decades

HATCH = "////"  # of contacts of a map that are not valid


def map_of(
    contacts: xr.Dataset, x: str, y: str, colour: str, look: tuple, new: Callable[..., Figure]
) -> tuple[Figure, Columns]:
    """The figure, and its numbers in columns. look : "linear", "log" or "", and the limits of the colour or None.

    Raises StudyError: x or y is not an axis of the quantity, or there is a third one.
    """
    values = contacts[colour].squeeze(
        [dim for dim, n in contacts[colour].sizes.items() if n == 1 and dim not in (x, y)]
    )
    if missing := [name for name in (x, y) if name not in values.dims]:
        axes = ", ".join(map(str, values.dims))
        raise StudyError(
            [f"a map of {colour} needs two of its axes as x and y: {missing[0]} is none; there are {axes}"]
        )
    if more := [f"{dim} ({n})" for dim, n in values.sizes.items() if dim not in (x, y)]:
        raise StudyError([f"a map has two axes: choose one of {', '.join(more)} by NAME=VALUE, or --where"])
    values = values.sortby([x, y]).transpose(y, x)
    unit, valid = multiple(values)[1], np.ones(values.shape, bool)
    if "validity" in contacts:
        validity = contacts["validity"].squeeze().sortby([name for name in (x, y) if name in contacts["validity"].dims])
        valid = (xr.broadcast(validity, values)[0].transpose(y, x) == 0).values
    figure = new(figsize=(4.2, 2.9), layout="constrained")
    axes = figure.subplots()
    sizes = [values[name].values / multiple(values[name])[1] for name in (x, y)]
    edges = [_edges(numbers) for numbers in sizes]
    norm = _norm(values.values / unit, look, unit)
    shades = axes.pcolormesh(*edges, values.values / unit, norm=norm, rasterized=True)
    for axis, name, numbers in (("x", x, sizes[0]), ("y", y, sizes[1])):
        axes.set(**{f"{axis}scale": "log" if spaced_by_factors(numbers) else "linear"})
        axes.set(**{f"{axis}label": axis_label(name, contacts[name])})
        tick_decades(getattr(axes, f"{axis}axis"))
    if not valid.all():
        nothing = ListedColormap(["none"])
        hatched = np.ma.masked_array(np.zeros(valid.shape), valid)
        axes.pcolor(*edges, hatched, cmap=nothing, edgecolor="0.6", linewidth=0, hatch=HATCH)
        figure.legend(handles=[Patch(facecolor="none", hatch=HATCH, label="not valid")], loc="outside lower center")
    figure.colorbar(
        shades, label=axis_label(colour, contacts[colour]), extend=_beyond(values.values / unit, shades.norm)
    )
    figure.suptitle(wrapped(stated([contacts]), 21 * figure.get_figwidth()), fontsize=7)
    across, up = np.meshgrid(values[x].values, values[y].values)
    columns = {x: across.ravel(), y: up.ravel(), colour: values.values.ravel(), "valid": valid.ravel().astype(int)}
    return figure, with_units(columns, contacts)


def _edges(numbers: np.ndarray) -> np.ndarray:
    """Edges of the cells around the values of an axis, (n + 1,), half way between these as the axis is scaled."""
    if len(numbers) == 1:
        return numbers[0] + np.array([-0.5, 0.5]) * (abs(numbers[0]) or 1.0)
    log = spaced_by_factors(numbers)
    places = np.log(numbers) if log else numbers
    inner = (places[1:] + places[:-1]) / 2
    edges = np.concatenate([[2 * places[0] - inner[0]], inner, [2 * places[-1] - inner[-1]]])
    return np.exp(edges) if log else edges


def _norm(numbers: np.ndarray, look: tuple, unit: float) -> Normalize:
    scale, limits = look
    low, high = (None, None) if limits is None else (limit / unit for limit in limits)
    known = numbers[np.isfinite(numbers)]
    if not len(known):
        raise StudyError(["nothing to draw: no case has a number"])
    wide = known.min() > 0 and known.max() > 30 * known.min()
    if scale == "log" and (known.min() if low is None else low) <= 0:
        raise StudyError(["scale = log: there are numbers that are not above 0; give limits above 0"])
    return (LogNorm if scale == "log" or (not scale and wide and (low is None or low > 0)) else Normalize)(
        known.min() if low is None else low, known.max() if high is None else high
    )


def _beyond(numbers: np.ndarray, norm: Normalize) -> str:
    """At which ends of the scale there are numbers beyond it."""
    low, high = np.nanmin(numbers) < norm.vmin, np.nanmax(numbers) > norm.vmax
    return "both" if low and high else "min" if low else "max" if high else "neither"

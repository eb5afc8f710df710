"""`plot`: a quantity of any results against another, a curve for each value of a third, panels for the other axes."""

from collections.abc import Callable
from itertools import product
from math import prod
from numbers import Real
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from scipy.interpolate import PchipInterpolator

from ..data.derived import QUANTITIES
from ..inputs.definition import StudyError
from ..inputs.scene.stacks import short
from ..inputs.vocabulary import CONTROLS, suggest
from ..specimen.quantities import quantity
from .figure_results import check_size, drawable, why_none
from .labels import axis_label, legend_texts, multiple, name_of, stated, with_units, wrapped
from .plotted.fit_picture import fits
from .plotted.map_picture import map_of
from .plotted.tornado import ORDINATE, tornado
from .registry import Columns, joined
from .style import StyledFigure, as_points, shades, spaced_by_factors, style, tick_decades

MOST_PANELS, MOST_NAMES = 12, 12  # largest number of panels in a figure, and of names in its legend
FINE, FEW = 200, 9  # least number of points in the curve of a profile, and of those through which it passes
BAND = {"alpha": 0.25, "linewidth": 0}  # look of ± one standard deviation
NOT_VALID = {"linestyle": (0, (1, 1.2)), "linewidth": 0.9}


def plot(
    dataset: xr.Dataset,
    x: str = "",
    y: str = "",
    hue: str = "",
    *,
    colour: str = "",
    scale: str = "",
    limits: tuple[Any, Any] | None = None,
    **where: Any,
) -> Figure:
    """A figure of `y` against `x`, a curve for each value of `hue`, a panel for each combination of the other axes.

    A notebook shows the figure as the last value of a cell; `savefig` writes it. It does not belong to pyplot, and
    looks the same whatever the settings of matplotlib are. Stretches where `validity` is not 0 are dotted, and called
    "not valid"; failed cases are gaps. Where the dataset has the spread of `y`, a band shows ± one standard deviation.

    Parameters
    ----------
    dataset : from `study.solve`, results of a study, or from `study.fit`: curves, fits and residuals, without x and y
    x, y : names of variables of the dataset, or of study.derived.QUANTITIES, which follow from it; with y = "input"
        bars show how much each input changes x, one of a, P, D, p0, p_max, Ar_An and dP_dD of a single contact
    hue : name of a dimension, or "label" of the cases
    colour : name of a variable or quantity for a map over the dimensions x and y; where `validity` is not 0, the map is
        hatched, and failed cases are white
    scale : "linear" or "log" for y, or for the colour of a map; "" chooses
    limits : lowest and highest y, or colour of a map, in the units of the dataset or as texts with a unit
    where : the values to draw, such as bonding="bonded"

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    StudyError : not a dataset, a stacked dataset, an unknown name or value, or more than 12 panels

    Examples
    --------
    >>> import study
    >>> contacts = study.solve(P=[1e-5, 2e-5, 4e-5], base="half_space", micro="smooth")
    >>> figure = plot(contacts, x="P", y="a")
    >>> figure.axes[0].get_xlabel().startswith("$P")
    True
    """
    with style():
        return shaped(dataset, (x, y, hue), where, StyledFigure, colour=colour, scale=scale, limits=limits)[0]


def shaped(
    dataset: xr.Dataset, names: tuple, where: dict, new: Callable[..., Figure], *, colour: str, scale: str, limits: Any
) -> tuple:
    """The figure and numbers of `drawn`, with the scale and limits of the ordinate; or a map, if `colour` is not ""."""
    x, y, hue = names
    if scale not in ("", "linear", "log"):
        raise StudyError([f"plot: scale = {scale}: must be linear or log"])
    if (colour or scale or limits is not None) and isinstance(dataset, xr.Dataset):
        if "fit_status" in dataset or y == ORDINATE:
            raise StudyError(["plot: colour, scale and limits are of curves and maps of contacts: leave them out"])
        if colour and hue:
            raise StudyError(["plot: a map has no hue: leave it out"])
    if colour:
        contacts = chosen(with_names(drawable(dataset, (x, y, colour, *where)), [x, y, colour]), where)
        check_size(contacts, x, y)
        return map_of(contacts, x, y, colour, (scale, _ends(contacts[colour], limits)), new)
    figure, columns = drawn(dataset, x, y, hue, where, new)
    if scale or limits is not None:
        ordinate = with_names(dataset, [_name_in(dataset, y)])[_name_in(dataset, y)]
        ends = _ends(ordinate, limits)
        for axes in (axes for axes in figure.axes if axes.get_visible()):
            axes.set(**({"yscale": scale} if scale else {}))
            axes.set(**({"ylim": [end / multiple(ordinate)[1] for end in ends]} if ends else {}))
            tick_decades(axes.yaxis)
    return figure, columns


def _ends(array: xr.DataArray, limits: Any) -> list[float] | None:
    """Limits in the unit of an array. Raises StudyError unless they are two, the lower first."""
    if limits is None:
        return None
    ends = []
    for limit in limits if isinstance(limits, (list, tuple)) else [limits]:
        try:
            ends.append(float(limit))
        except (TypeError, ValueError):
            ends.append(number(str(array.name), limit, array.attrs.get("units", "1")))
    if len(ends) != 2 or not ends[0] < ends[1]:
        raise StudyError([f"plot: limits = {limits}: must be two, the lower first"])
    return ends


def _name_in(dataset: xr.Dataset, name: str) -> str:
    """The name that a dataset has of an input of a layer: h for layers.1.h."""
    return name if name in dataset.variables else short(name)


def drawn(dataset: xr.Dataset, x: str, y: str, hue: str, where: dict, new: Callable[..., Figure]) -> tuple:
    """The figure of `plot`, and its numbers (Columns).

    new : makes an empty figure
    """
    if not isinstance(dataset, xr.Dataset):
        raise StudyError([f"plot takes a dataset of contacts, not a {type(dataset).__name__}"])
    x, y, hue = (_name_in(dataset, name) for name in (x, y, hue))
    where = {_name_in(dataset, name): value for name, value in where.items()}
    if "fit_status" in dataset:
        return fits(dataset, where, new)
    if not x or not y:
        raise StudyError(['plot: name x and y, such as plot(contacts, x="P", y="p_max")'])
    if stacked := [dim for dim, index in dataset.indexes.items() if index.nlevels > 1 and dim in dataset.dims]:
        raise StudyError([f'{stacked[0]} is several axes in one: give dataset.unstack("{stacked[0]}")'])
    bare = [dim for dim in dataset.dims if dim in (x, y, hue, *where) and dim not in dataset.coords]
    dataset = dataset.assign_coords({dim: np.arange(dataset.sizes[dim]) for dim in bare})  # they are numbered
    if y == ORDINATE and y not in dataset.variables:
        return tornado(chosen(dataset, where), x, new)
    dataset = drawable(dataset, (x, y, hue, *where))
    contacts = chosen(with_names(dataset, [x, y, *([hue] if hue else [])]), where)
    check_size(contacts, x, y)
    hue = "case" if hue == "label" and contacts[hue].dims == ("case",) else hue
    check_roles(contacts, x, y, hue)
    contacts = contacts.sortby(x) if x in contacts.dims else contacts  # otherwise a curve may run to and fro
    contacts = contacts.squeeze([dim for dim, size in contacts.sizes.items() if size == 1 and dim not in (x, hue)])
    pair = xr.broadcast(contacts[x], contacts[y])
    if not np.logical_and(*(np.isfinite(array.values) for array in pair)).any():
        raise StudyError([f"nothing to draw: no case has numbers for {x} and {y}; {why_none(y, pair[1])}"])
    if "validity" in contacts and not {*contacts["validity"].dims} <= {*pair[1].dims}:
        contacts = contacts.drop_vars("validity")
    dims = [dim for dim in pair[1].dims if pair[1].sizes[dim] > 1 or dim in (x, hue)]
    if hue and hue not in dims:
        raise StudyError([f"hue = {hue} is not an axis of {y}; its axes: {', '.join(dims)}"])
    along = running(contacts, x, [dim for dim in dims if dim != hue])
    rest = [dim for dim in dims if dim not in (along, hue)]
    count = prod(contacts.sizes[dim] for dim in rest)
    if count > MOST_PANELS:
        sizes = ", ".join(f"{dim} ({contacts.sizes[dim]})" for dim in rest)
        raise StudyError([f"{count} panels, of {sizes}: at most {MOST_PANELS}; choose by NAME=VALUE, or --where"])
    whole = {name: array.variable for name, array in zip((x, y), pair, strict=True) if name not in contacts.dims}
    contacts = contacts.assign(whole)  # as variables, since xarray 2026.2 does not align existing coordinates
    columns = 2 if count == 4 else min(count, 3)
    rows = -(-count // columns)
    names = min(contacts.sizes[hue], MOST_NAMES) if hue else 0  # a long legend needs room below the title
    size = max(2.9, 2.1 * columns) + (1.1 if hue else 0.5), max(2.2 * rows + 0.4, 0.17 * names + 1.2)
    figure = new(figsize=size, layout="constrained")
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
    parts = []
    for axes, place in zip(panels, product(*(range(contacts.sizes[dim]) for dim in rest)), strict=False):
        case = contacts.isel(dict(zip(rest, place, strict=True)))
        axes.set_title(", ".join(name_of(contacts, dim, i) for dim, i in zip(rest, place, strict=True)), fontsize=8)
        parts += curves(axes, case, (x, y, hue, along), contacts)
    for axes in panels[count:]:
        axes.set_visible(False)
    decorate(figure, panels[:count], contacts, (x, y, hue, along))
    return figure, with_units(joined(parts), contacts)


def with_names(dataset: xr.Dataset, names: list[str]) -> xr.Dataset:
    """The dataset with the derived quantities among the names. Raises StudyError for an unknown name."""
    errors = []
    for name in names:
        if name in QUANTITIES and name not in dataset:
            try:
                dataset = dataset.assign({name: QUANTITIES[name](dataset)})
            except (KeyError, ValueError) as error:
                errors.append(f"{name} cannot be computed from these results: {error}")
        elif name not in dataset.variables:
            errors.append(f'"{name}" is not in these results{suggest(name, [*dataset.variables, *QUANTITIES])}')
    if errors:
        raise StudyError(errors)
    return dataset


def check_roles(contacts: xr.Dataset, x: str, y: str, hue: str) -> None:
    """Raise StudyError for texts as coordinates of a curve, an axis as its ordinate, or one axis as abscissa and
    hue."""
    errors = [f"{name} has texts: they are not drawn, but may be the hue" for name in {x, y} if is_text(contacts[name])]
    # where x depends on the axis y, such as the depth on the load, its curve may be drawn
    if y in contacts.dims and (x in contacts.dims or y not in contacts[x].dims):
        errors.append(f"y = {y} is an axis of these results: it may be x or the hue")
    if x == hue:
        errors.append(f"x and hue are both {x}")
    if errors:
        raise StudyError(errors)


def is_text(array: xr.DataArray) -> bool:
    return array.dtype.kind in "UOT"  # T: an index of texts from pandas


def chosen(dataset: xr.Dataset, where: dict) -> xr.Dataset:
    """The dataset at the wanted values of its axes. Raises StudyError for a value that it does not have."""
    for name, value in where.items():
        if name not in dataset.coords or dataset[name].ndim != 1:
            axes = [str(name) for name, axis in dataset.coords.items() if axis.ndim == 1]
            raise StudyError([f"{name} is not an axis of these results{suggest(name, axes)}"])
        values = dataset[name].values
        (dim,), unit = dataset[name].dims, dataset[name].attrs.get("units", "1")
        if is_text(dataset[name]):
            fits = values == str(value)
        else:
            wanted = number(name, value, unit)
            near, exact = np.isclose(values, wanted, rtol=1e-6, atol=0), values == wanted
            fits = exact if exact.any() else near
        if not fits.any():
            few = values if is_text(dataset[name]) else values[np.argsort(np.abs(values - wanted), kind="stable")]
            listed = ", ".join(f"{each:g}" if values.dtype.kind == "f" else str(each) for each in few[:20])
            more = " ..." * (len(values) > 20) + f" {unit}" * (unit != "1")
            raise StudyError([f"{name} = {value} is not among these results; there are {listed}{more}"])
        index = np.flatnonzero(fits)  # several [[cases]] may have the value, and keep their numbers
        if dim not in dataset.coords:
            dataset = dataset.assign_coords({dim: np.arange(len(fits))})
        dataset = dataset.isel({dim: index if name != dim or len(index) > 1 else index[0]})
    return dataset


def number(name: str, value: Any, unit: str) -> float:
    """A value as a number in the unit of the dataset: 2e-6, or "2 um" for physical results. Raises StudyError."""
    if isinstance(value, Real):
        return value
    try:
        return quantity(name, value, unit).value
    except (KeyError, ValueError) as error:  # the unit is not in READABLE, or the value is wrong
        raise StudyError([str(error)]) from None


def running(contacts: xr.Dataset, x: str, dims: list[str]) -> str:
    """The dimension along which a curve runs: `x` itself, or a dimension on which x depends, a control before
    others."""
    if x in dims:
        return x
    varies = [dim for dim in (*CONTROLS, *dims) if dim in dims and dim in contacts[x].dims]
    if not varies:
        raise StudyError([f"x = {x} has one value only; axes: {', '.join(dims) or 'none'}"])
    return varies[0]


def curves(axes, case: xr.Dataset, names: tuple, whole: xr.Dataset) -> list[Columns]:
    """Draw the curves of one panel: solid where the case is valid, dotted elsewhere, in a band of ±. Returns the
    numbers."""
    x, y, hue, along = names
    banded = x if y in whole.dims else y  # the quantity with a band of ±
    parts, colours = [], shades(case.sizes[hue] if hue else 1)
    sizes = [multiple(whole[name])[1] for name in (x, y)]
    for i, colour in enumerate(colours):
        curve = case.isel({hue: i}) if hue else case
        across, up = (np.broadcast_to(curve[name].values, curve.sizes[along]) for name in (x, y))
        valid = np.ones(len(up), bool)
        if "validity" in curve:
            valid = np.broadcast_to(curve["validity"].values == 0, len(up))
        spread = {name: np.broadcast_to(curve[name].values, len(up)) for name in (f"{banded}_spread",) if name in curve}
        points = across / sizes[0], up / sizes[1], np.where(valid, up, np.nan) / sizes[1]
        halves = [half / sizes[banded != x] for half in spread.values()]
        if along == "x" and "status" in curve:  # in a dataset of another program x is not a radius over a
            radii, profiles = between(curve["x"].values, [*points, *halves])
            points, halves = (radii / sizes[0] if x == "x" else profiles[0], *profiles[1:3]), profiles[3:]
        for half in halves:
            if banded == x:
                axes.fill_betweenx(points[1], points[0] - half, points[0] + half, color=colour, **BAND)
            elif along == "case":
                axes.errorbar(*points[:2], half, fmt="none", color=colour, alpha=0.5)
            else:
                axes.fill_between(points[0], points[1] - half, points[1] + half, color=colour, **BAND)
        axes.plot(*points[:2], color=colour, **NOT_VALID)
        axes.plot(points[0], points[2], color=colour, linestyle="-")
        if along == "case":
            as_points(axes.lines[-2:-1], "none")
            as_points(axes.lines[-1:], "full")
        fixed = {
            name: np.full(len(up), array.item())
            for name, array in curve.coords.items()
            if (name in whole.dims or name == "label") and not array.ndim
        }
        flags = {"valid": valid.astype(int)} if "validity" in curve else {}
        parts.append(fixed | {x: across, y: up} | spread | flags)
    return parts


def between(x: np.ndarray, profiles: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """More radii x = r/a, (m,), and the profiles at these, (len(profiles), m), so that their curves have no corners.

    Monotone cubics pass through all points. They are functions of arcsin x where a profile ends like sqrt(1 - x^2):
    straight lines between 33 points would miss it by 6 % of p(0). They are functions of x where a profile ends flatter,
    as under a rough punch. A profile that is infinite at the edge ends at its last number. Fewer than FEW points stay
    as they are.
    """
    points = np.array(profiles, float)
    if len(x) < FEW or not (np.all(np.diff(x) > 0) and x[0] >= 0 and x[-1] <= 1):
        return x, points
    fine = np.unique(np.concatenate([x, np.sin(np.linspace(np.arcsin(x[0]), np.arcsin(x[-1]), FINE))]))
    curves = np.full((len(points), len(fine)), np.nan)
    for curve, values in zip(curves, points, strict=True):
        is_finite = np.isfinite(values)
        at, values = x[is_finite], values[is_finite]
        if len(at) < 4 or not np.all(np.diff(np.flatnonzero(is_finite)) == 1):  # gaps, or very few points
            curve[np.isin(fine, at)] = values
            continue
        falls, nears = np.abs(values[-3:-1] - values[-1]), at[-1] - at[-3:-1]
        flat = at[-1] == 1 and falls[1] * nears[0] ** 0.75 < falls[0] * nears[1] ** 0.75  # a power above 3/4
        inside, over = (fine >= at[0]) & (fine <= at[-1]), np.asarray if flat else np.arcsin
        curve[inside] = PchipInterpolator(over(at), values)(over(fine[inside]))
    return fine, curves


def decorate(figure: Figure, panels, contacts: xr.Dataset, names: tuple) -> None:
    """Labels, scales, the legend, and the parameters above the figure."""
    x, y, hue, along = names
    log_x, values = spaced_by_factors(contacts[x].values), contacts[y].values
    log_y = log_x and np.nanmin(values) > 0 and np.nanmax(values) > 30 * np.nanmin(values)
    for axes in panels:
        grid = axes.get_subplotspec()
        axes.set(xscale="log" if log_x else "linear", yscale="log" if log_y else "linear")
        for axis in (axes.xaxis, axes.yaxis):
            tick_decades(axis)
        axes.set_ylabel(axis_label(y, contacts[y]) if grid.is_first_col() else "")
        axes.set_xlabel(axis_label(x, contacts[x]))
        axes.label_outer()
        if grid.num1 + grid.get_gridspec().ncols >= len(panels):  # no panel is below this one
            axes.set_xlabel(axis_label(x, contacts[x]))
            axes.tick_params(labelbottom=True)
    figure.suptitle(wrapped(stated([contacts]), 21 * figure.get_figwidth()), fontsize=7)
    handles, title = [], ""
    if hue:
        every = -(-contacts.sizes[hue] // MOST_NAMES)
        colours = shades(contacts.sizes[hue])
        named = range(0, contacts.sizes[hue], every)
        title, texts = legend_texts(contacts, hue)
        handles = [Line2D([], [], color=colours[i], linestyle="-", label=texts[i]) for i in named]
        if along == "case":
            as_points(handles, "full")
    if "validity" in contacts and (contacts["validity"] != 0).any():
        handles.append(Line2D([], [], color="0.4", label="not valid", **NOT_VALID))
        if along == "case":
            as_points(handles[-1:], "none")
    if f"{x if y in contacts.dims else y}_spread" in contacts:
        handles.append(Patch(facecolor="0.4", label="± one standard\ndeviation", **BAND))
    if handles:
        figure.legend(handles=handles, title=title, loc="outside right center")

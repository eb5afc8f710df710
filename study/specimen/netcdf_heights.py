"""Heights in netCDF files, classic and of version 4. Axes are recognised by the names of the dimensions, x and y.

SurfaceTopography takes the first dimension as x, whatever its name.
"""

from typing import Any, NamedTuple

import numpy as np

from .scan import UNEVEN, metres, number, spelt
from .scan_grids import overruled

#: The first bytes of a netCDF file: of a classic one, and of HDF5, the form of version 4.
MAGIC = (b"CDF\x01", b"CDF\x02", b"CDF\x05", b"\x89HDF\r\n\x1a\n")


class Heights(NamedTuple):
    """Heights over (y, x) or (x), their positions along each axis, steps or None, units (lateral, height), notes."""

    z: np.ndarray
    positions: list[np.ndarray]
    steps: list[float] | None
    units: tuple[str, str]
    notes: tuple[str, ...]


def read(raw: bytes, arguments: dict, channel: str | None, name: str) -> Heights | None:
    """The heights of a netCDF file over the dimensions x and y, or over x; None where it has none.

    arguments : unit, height_unit, dx, dy, which override what the file states

    Raises ValueError: several variables without a choice, or no steps or units.
    """
    import netCDF4  # heavy: it is needed for these files alone
    from xarray.backends.netCDF4_ import NETCDF4_PYTHON_LOCK

    with NETCDF4_PYTHON_LOCK:
        try:
            file = netCDF4.Dataset("heights", memory=raw)
        except (OSError, ValueError, RuntimeError):
            return None
        try:
            maps = {key: variable for key, variable in file.variables.items() if _is_map(variable)}
            if not maps:
                return None
            variable = maps[_chosen(list(maps), channel, name)]
            return _heights(file, variable, arguments, name, tuple(maps))
        finally:
            file.close()


def data_sets(raw: bytes) -> dict[str, np.ndarray]:
    """The data sets of an HDF5 file that may be maps, heights (x, y) by name; {} for any other file.

    The first index runs along x, as in the files of the contact-mechanics challenge and in SurfaceTopography.
    """
    import netCDF4
    from xarray.backends.netCDF4_ import NETCDF4_PYTHON_LOCK

    def maps(group: Any, path: str) -> dict[str, np.ndarray]:
        heights = {
            path + key: np.ma.filled(np.ma.asarray(data[...], dtype=float), np.nan)
            for key, data in group.variables.items()
            if data.ndim == 2 and min(data.shape) > 0 and getattr(data.dtype, "kind", "O") in "biuf"
        }
        deeper = [maps(subgroup, f"{path}{name}/") for name, subgroup in group.groups.items()]
        return heights | {key: z for heights_of_group in deeper for key, z in heights_of_group.items()}

    with NETCDF4_PYTHON_LOCK:
        try:
            file = netCDF4.Dataset("heights", memory=raw)
        except (OSError, ValueError, RuntimeError):
            return {}
        try:
            return maps(file, "")
        finally:
            file.close()


def _axes(variable: Any) -> list[str]:
    """The dimensions with more than one point, in lower case: "x", "y"."""
    pairs = zip(variable.dimensions, variable.shape, strict=True)
    return [dim.lower() for dim, points in pairs if points != 1]


def _is_map(variable: Any) -> bool:
    """Whether a variable may be heights: numbers over x and y, or over x, that are neither positions nor a mask."""
    axes = _axes(variable)
    numeric = getattr(variable.dtype, "kind", "O") in "iuf"
    return sorted(axes) in (["x"], ["x", "y"]) and numeric and variable.name.lower() not in ("x", "y", "mask")


def _chosen(names: list[str], channel: str | None, name: str) -> str:
    listed = ", ".join(map(repr, names))
    if channel is not None:
        if channel == "Default" and "heights" in names:  # as SurfaceTopography calls it
            return "heights"
        if channel not in names:
            raise ValueError(f"{name}: channel = {channel!r}, but the file has {listed}")
        return channel
    if len(names) > 1 and "heights" not in names:
        raise ValueError(f"{name}: the file has {listed} over x and y: choose the heights with channel=")
    return "heights" if "heights" in names else names[0]


def _heights(file: Any, variable: Any, arguments: dict, name: str, maps: tuple) -> Heights:
    axes = _axes(variable)
    z = np.ma.filled(np.ma.asarray(variable[...], dtype=float), np.nan).reshape([n for n in variable.shape if n != 1])
    mask = next((variable_of_mask for key, variable_of_mask in file.variables.items() if key.lower() == "mask"), None)
    if mask is not None and mask.dimensions == variable.dimensions:
        mask.set_auto_maskandscale(False)
        z = np.where(np.asarray(mask[...]).reshape(z.shape) != 0, np.nan, z)
    order = [axes.index(axis) for axis in ("y", "x") if axis in axes]
    z, axes = z.transpose(order), [axes[i] for i in order]
    axis_positions = {axis: _positions(file, axis, points, name) for axis, points in zip(axes, z.shape, strict=True)}
    stated, of_units = _stated_units(file, variable, axes, arguments, name)
    lacking = [axis for axis in axes if axis_positions[axis] is None]
    units = _units(stated, lacking, arguments, name)
    overruling = {key: value for key, value in arguments.items() if stated.get(key, not lacking)}
    if lacking:  # then `unit` is the unit of dx, and does not override the unit of the file
        overruling.pop("unit", None)
    size = metres(arguments.get("unit", units[0]), name) / metres(units[0], name)
    positions, steps = [], []
    for axis, points in zip(axes, z.shape, strict=True):
        step = arguments.get("dy", arguments.get("dx")) if axis == "y" else arguments.get("dx")
        axis_of_file = axis_positions[axis]
        steps.append(axis_of_file[0] if axis_of_file else number(f"{name}: d{axis}", step, units[0]) * size)
        positions.append(axis_of_file[1] if axis_of_file else steps[-1] * np.arange(points))
    lengths = overruled(positions, steps, units, overruling, name)
    notes = (f"channel {variable.name!r}" + f" of {', '.join(map(repr, maps))}" * (len(maps) > 1), *of_units)
    return Heights(z, lengths.positions, lengths.steps, lengths.units, notes + lengths.notes)


def _positions(file: Any, axis: str, points: int, name: str) -> tuple[float, np.ndarray] | None:
    """Step and positions along an axis, in the unit of the file; None where it states neither.

    Raises ValueError: positions without equal steps.
    """
    variable = next((each for key, each in file.variables.items() if key.lower() == axis), None)
    if variable is None:
        return None
    length = float(getattr(variable, "length", "nan"))  # of `points` steps
    x = np.ma.filled(np.ma.asarray(variable[...], dtype=float), np.nan) if variable.shape == (points,) else np.empty(0)
    if not np.isfinite(x).all() or not x.size:
        return (length / points, length / points * np.arange(points)) if np.isfinite(length) else None
    step = (x[-1] - x[0]) / (points - 1)
    off = np.abs(x - (x[0] + step * np.arange(points))).max()
    if not (step != 0 and off <= UNEVEN * abs(step)):
        raise ValueError(f"{name}: the positions {axis} have no equal steps: interpolate to a grid")
    rounded = abs(length / points - abs(step)) <= 1e-6 * abs(step)
    return length / points if rounded else abs(step), x


def _stated_units(
    file: Any, variable: Any, axes: list[str], arguments: dict, name: str
) -> tuple[dict[str, str | None], tuple[str, ...]]:
    """The unit of the positions, `unit`, and that of the heights, `height_unit`; None where the file has none. And a
    note where x and y have two units, of which the call has decided.

    Raises ValueError: x and y have two units, and the call has neither `unit` nor dx.
    """
    units, notes = {axis: _unit(file, axis, name) for axis in axes}, ()
    lateral = [units[axis] for axis in ("x", "y") if units.get(axis)]
    if len({metres(unit, name) for unit in lateral}) > 1:
        in_words = f"x is in {units['x']}, y in {units['y']}"
        decides = next((key for key in ("dx", "unit") if key in arguments), None)
        if decides is None:
            raise ValueError(f"{name}: {in_words}: write both in one unit, or give unit, which holds for both")
        notes = (f"{in_words} in the file: {decides} of the call holds for both",)
    unit = next(iter(lateral), None)
    height = _unit_of(variable, name)
    if height is None and unit and hasattr(file.variables.get("x"), "unit"):  # of SurfaceTopography: of all lengths
        height = unit
    return {"unit": unit, "height_unit": height}, notes


def _units(stated: dict[str, str | None], lacking: list[str], arguments: dict, name: str) -> tuple[str, str]:
    """The units of positions and of heights, from the file or, where it states none, from the call.

    lacking : axes without positions

    Raises ValueError: units or distances that neither states, all in one message.
    """
    units = {key: value or arguments.get(key) for key, value in stated.items()}
    if not any(stated.values()) and "unit" in arguments:
        units["height_unit"] = arguments.get("height_unit", arguments["unit"])
    missing_units = [key for key, value in units.items() if not value]
    sentences = [f"no {' and no '.join(missing_units)}: give {', '.join(missing_units)}"] if missing_units else []
    if lacking and "dx" not in arguments:
        no_positions = " and ".join(f"no positions of {axis}" for axis in lacking)
        sentences.append(f"{no_positions}: give dx{' (and dy)' * ('y' in lacking)}")
    if sentences:
        raise ValueError(f"{name}: the file states {'; and '.join(sentences)}")
    return str(units["unit"]), str(units["height_unit"])


def _unit(file: Any, axis: str, name: str) -> str | None:
    variable = next((each for key, each in file.variables.items() if key.lower() == axis), None)
    return None if variable is None else _unit_of(variable, name)


def _unit_of(variable: Any, name: str) -> str | None:
    """The unit of a variable: its attribute `units` (CF) or `unit` (SurfaceTopography). Raises ValueError for a unit
    that is not one of length."""
    word = str(getattr(variable, "units", getattr(variable, "unit", ""))).strip()
    if word in ("", "1"):
        return None
    if spelt(word) is None:
        raise ValueError(f"{name}: {variable.name} is in {word!r}, which is not a unit of length")
    return word

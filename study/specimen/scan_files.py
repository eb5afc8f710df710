"""Scans from files: text and CSV, .npy, and the formats of instruments by the package SurfaceTopography."""

import contextlib
import io
import re
import warnings
from collections.abc import Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path

import numpy as np

from solver.numerics.userfile import begins, checked, content, unpacked

from . import netcdf_heights, x3p
from .foreign import plain
from .scan import FEWEST, Scan, metres, number, refusing_others, spelt
from .scan_grids import columns_of, npy_table, on_grid, overruled, scan_of, without_holes
from .scan_headings import check_units, extent_notes, height_metres, length, stated, stated_height_unit, without_no_data
from .scan_texts import NumberTable, table_of, text_of

#: Endings of files that are read here if they are text, and otherwise by SurfaceTopography.
TEXT = (".csv", ".txt", ".tsv", ".dat", ".asc", ".xyz", ".prf", ".smd", ".sdf", ".gz", "")
_LENGTHS = ("unit", "height_unit", "dx", "dy")  # arguments that override what a file states
_FORCE = ("defl", "zsnsr", "lvdt", "raw", "force")  # parts of the names of channels in a force curve, in lower case
_NO_LENGTHS = (
    "the file states no distance of its points: give dx (and dy) and unit, and height_unit if heights have another"
)
_NO_FORMAT = "none of the formats that it knows fits the content"


@refusing_others
def read(
    path: str | PathLike,
    *,
    unit: str | None = None,
    height_unit: str | None = None,
    dx: float | None = None,
    dy: float | None = None,
    columns: Sequence[int] | None = None,
    channel: str | None = None,
    crop: Sequence | None = None,
    missing: str = "fill",
    steep: bool = False,
    huge: bool = False,
    despike: float | None = None,
) -> Scan:
    """A profile or a map of heights from a file.

    Text and .npy: two columns are a profile, x and z. One column (or one row) is a profile with points dx apart. Three
    columns are a map, x, y and z of the points of a grid in any order. 16 columns or more are a map, a line for each
    y, with points dx and dy apart. Columns are separated by commas, semicolons, tabs or spaces; the decimal mark is a
    point or, where commas do not separate, a comma. Text before the first line of numbers, or after # and %, is a
    comment. An empty field, nan, Bad, ***, -- and - are missing points. Text may be UTF-8, UTF-16 or packed (.gz).

    SDF, SMD and PRF in text, netCDF, X3P and every other ending (.sur, .opd, .gwy, …) have their lengths in the file.
    The package SurfaceTopography reads the formats of instruments: pip install 'roughcoat[topography]'. Axes of netCDF
    are recognised by the names of the dimensions, x and y. A mask of Gwyddion marks points; it removes none.

    Parameters
    ----------
    path : of the file
    unit : unit of x, y, dx, dy and crop: m, mm, um, nm, pm or angstrom. Text and .npy have none, so it must be given.
    height_unit : unit of z; None: as `unit`
    dx, dy : distance between points, in unit; dy defaults to dx. Where a file states its lengths, unit, height_unit,
        dx and dy of the call override them, and the notes say what the file states
    columns : the columns to read, counted from 0: (x, z), (x, y, z), or (z,) with dx
    channel : name of the channel to read; None: the first channel of heights. The notes of the scan name it
    crop : the part to keep, (x0, x1) or (x0, x1, y0, y1) of x and y of the file, else from 0; in unit, m, or texts
    missing, steep, huge, despike : as in `height_map`

    Returns
    -------
    Scan : in m

    Raises
    ------
    ValueError : the file cannot be read as a scan; the message says what was read, and what is allowed
    ImportError : the file has the format of an instrument, and SurfaceTopography is not installed

    Examples
    --------
    >>> from study import samples
    >>> read(samples.scan()).z.shape
    (96, 96)
    """
    path = Path(path)
    try:
        if path.exists():  # otherwise the reader says so
            checked(path)
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from None
    ending, how = path.suffix.lower(), {"missing": missing, "steep": steep, "huge": huge, "despike": despike}
    arguments = {"unit": unit, "height_unit": height_unit, "dx": dx, "dy": dy, "columns": columns}
    arguments = {name: value for name, value in arguments.items() if value is not None}
    text = text_of(path) if ending in TEXT else None
    if ending != ".npy" and text is None:
        scan = _of_netcdf_or_x3p(path, arguments, channel, crop, how)
        return scan if scan is not None else _instrument(path, arguments, channel, crop, how)
    if text is not None:
        return _of_text(path.name, text, arguments, channel, crop, how)
    if channel is not None:
        raise ValueError(f"{path.name}: channel = {channel!r}: .npy has no channels; leave it out")
    return _of_table(path.name, npy_table(path), arguments, crop, how)


def _of_netcdf_or_x3p(path: Path, arguments: dict, channel: str | None, crop, how: dict) -> Scan | None:
    """The scan of a netCDF or X3P file; None if it is neither."""
    name, head = path.name, begins(path) if path.exists() else b""
    if head.startswith(netcdf_heights.MAGIC):
        if more := [key for key in arguments if key == "columns"]:
            raise ValueError(f"{name}: the format states its lengths itself; leave out {more[0]}")
        heights = netcdf_heights.read(unpacked(content(path)), arguments, channel, name)
        return None if heights is None else scan_of(name, **heights._asdict(), crop=crop, how=how)
    if not head.startswith(b"PK") or (surface := x3p.read(unpacked(content(path)), name)) is None:
        return None
    return _of_stated(name, *surface, arguments, channel, crop, how)


def _of_stated(name: str, z, steps, arguments: dict, channel: str | None, crop, how: dict) -> Scan:
    """The scan of a format that states its steps in m. Raises ValueError if the call names columns or a channel."""
    if more := [key for key, value in {**arguments, "channel": channel}.items() if value and key not in _LENGTHS]:
        raise ValueError(f"{name}: the format states its lengths itself; leave out {', '.join(more)}")
    positions = [step * np.arange(points) for step, points in zip(steps, z.shape, strict=True)]
    lengths = overruled(positions, list(steps), ("m", "m"), arguments, name)
    return scan_of(name, z, **lengths._asdict(), crop=crop, how=how)


def _of_text(name: str, text: str, arguments: dict, channel: str | None, crop, how: dict) -> Scan:
    """The scan in a text: a format that states its lengths, or a table of numbers."""
    surface = stated(text, name)
    table = None if surface else table_of(text, name, channel)
    pixel = None if surface else _zygo_pixel(table, "dx" in arguments, name)
    if surface:
        return _of_stated(name, *surface, arguments, channel, crop, how)
    if not pixel:
        return _of_table(name, table, arguments, crop, how)
    if "columns" in arguments:
        raise ValueError(f"{name}: the file states its lengths itself; leave out columns")
    lengths = overruled([np.arange(2.0)] * 2, [pixel] * 2, ("m", "um"), arguments, name)
    units_used = {"unit": lengths.units[0], "height_unit": lengths.units[1]}
    scan = _of_table(name, table, units_used | dict(zip(("dy", "dx"), lengths.steps or (), strict=False)), crop, how)
    return replace(scan, notes=lengths.notes + scan.notes)


def _zygo_pixel(table: NumberTable, has_dx: bool, name: str) -> float | None:
    """Size of a pixel, m, in an XYZ file of Zygo, where x and y count pixels and z is in µm; None for any other file.

    Raises ValueError: such a file has no size of a pixel, and the caller gives no dx.
    """
    lines = dict(table.heading)
    if not lines.get(1, "").startswith("Zygo XYZ"):
        return None
    fields = lines.get(8, "").split()
    pixel = float(fields[6]) if len(fields) > 6 and re.fullmatch(r"[\d.]+(?:[eE][-+]?\d+)?", fields[6]) else 0.0
    if not pixel and not has_dx:
        raise ValueError(f"{name}: x and y are numbers of pixels, and the heading has no size of one: give dx and unit")
    return pixel or None


def _of_table(name: str, table: NumberTable, arguments: dict, crop, how: dict) -> Scan:
    """The scan in a table of numbers: a profile, a map, or x, y, z of a map."""
    _refuse_missing_lengths(name, table, arguments)
    unit, height_unit = arguments["unit"], arguments.get("height_unit", arguments["unit"])
    cleaned, holes = without_holes(table.numbers)
    table = replace(table, numbers=cleaned, notes=table.notes + holes)
    columns, places = columns_of(table, arguments, name)
    dx = number(f"{name}: dx", arguments["dx"], unit) if "dx" in arguments else None
    dy = number(f"{name}: dy", arguments["dy"], unit) if "dy" in arguments else dx
    check_units(table, unit, height_unit, places, name)
    size, notes = height_metres(table, height_unit, name)
    z, more = without_no_data(table, columns if columns.shape[1] >= FEWEST else columns[:, -1], name)
    notes += table.notes + more + (f"channel {table.channel!r}",) * bool(table.channel)
    z = z if (factor := size / metres(height_unit, name)) == 1 else z * factor
    if z.ndim == 2:
        positions = [step * np.arange(points) for step, points in zip((dy, dx), z.shape, strict=True)]
        notes += extent_notes(table, (dy, dx), unit, name)
    elif columns.shape[1] == 3:
        z, positions = on_grid(columns, z, None if dx is None else (dy, dx), name)
    else:
        positions = [columns[:, 0] if dx is None else dx * np.arange(len(z))]
    steps = None if dx is None else [dy, dx][-z.ndim :]
    return scan_of(name, z, positions, steps=steps, units=(unit, height_unit), crop=crop, notes=notes, how=how)


def _refuse_missing_lengths(name: str, table: NumberTable, arguments: dict) -> None:
    """Raise one ValueError for every length that the call lacks: unit, dx of a map or one column, height_unit."""
    rows, columns = table.numbers.shape
    picked, unit = plain(arguments.get("columns")), arguments.get("unit")
    is_map = picked is None and columns >= FEWEST and rows > 1
    one_column = 1 in (rows, columns) if picked is None else np.size(picked) == 1
    heading_unit = stated_height_unit(table)
    other = heading_unit and (unit is None or metres(unit, name) != length(heading_unit))
    also = [f"height_unit={heading_unit!r}, as the heading has it"] * bool(other and "height_unit" not in arguments)
    lacks_dx = "dx" not in arguments and (is_map or one_column)
    if unit is not None and is_map and lacks_dx:
        sentences = [f"a map of {rows} × {columns} heights: give dx (and dy), their distance", *also]
        raise ValueError(f"{name}: {'; and '.join(sentences)}")
    if unit is None:
        also = ["dx (and dy), the distance of points" if is_map else "dx, the distance of points"] * lacks_dx + also
        heading = table.heading[-1][1] if table.heading else ""
        raise ValueError(
            f"{name}: give unit, such as unit='um', and height_unit if heights have another: units are not read from "
            "text and .npy"
            + (f". Also give {', and '.join(also)}" if also else "")
            + (f'. Its heading is "{heading[:80]}".' if heading else "")
        )


def _instrument(path: Path, arguments: dict, channel: str | None, crop, how: dict) -> Scan:
    """A scan in the format of an instrument, by SurfaceTopography. Its maps have x as the first axis, ours have y."""
    name, ending = path.name, path.suffix.lower()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ImportWarning)  # it warns that mpi4py is not installed
            import SurfaceTopography as library
    except ImportError as error:
        if ending not in TEXT and path.is_file() and (text := text_of(path)) is not None:
            return _of_text(name, text, arguments, channel, crop, how)
        if (scan := _of_data_sets(path, arguments, channel, crop, how)) is not None:
            return scan
        if ending in TEXT:
            raise ValueError(
                f"{name}: not a text file; text in UTF-8 or UTF-16, .npy and formats of instruments are read. If it is "
                "one of these, pip install 'roughcoat[topography]'; otherwise export the scan as text"
            ) from error
        raise ImportError(
            f"{name}: {path.suffix} is neither text ({', '.join(TEXT[:-1])}) nor .npy. The package "
            "SurfaceTopography reads formats of instruments: pip install 'roughcoat[topography]'. Otherwise export "
            "the scan as text, CSV or .npy."
        ) from error
    refused = f"{name}: " + "not a text file, and " * (ending in TEXT) + "SurfaceTopography cannot read it"
    with _as_value_error(refused, ending):
        channels, default, kind = _channels(library, path)
    if kind in ("asc", "xyz"):
        return _of_text(name, text_of(path), arguments, channel, crop, how)
    chosen, notes = _chosen(channels, default, channel, name) if channels else (None, ())
    if "columns" in arguments:
        raise ValueError(f"{name}: the format states its lengths itself; leave out columns")
    lengths_lacking = _lacking(chosen, arguments) if chosen else []
    several = kind == "h5" and channel is None and len(channels) > 1
    if several or lengths_lacking:
        named = ", ".join(repr(each.channel_id) for each in channels)
        data_sets = [f"the file has the data sets {named}: choose the heights with channel="] * several
        raise ValueError(f"{name}: {'; and '.join([*lengths_lacking, *data_sets])}")
    how_read = {"channel_index": chosen.index} if chosen and chosen is not default else {}
    if chosen and chosen.physical_sizes is None:
        dx, unit = arguments.pop("dx"), arguments.get("unit", chosen.unit)
        steps = number(f"{name}: dx", dx, unit), number(f"{name}: dy", arguments.pop("dy", dx), unit)
        if chosen.unit:  # then the sizes are in this unit, and `unit` is the unit of dx alone
            arguments.pop("unit", None)
            size = metres(unit, name) / metres(chosen.unit, name)
            steps = steps[0] * size, steps[1] * size
        how_read["physical_sizes"] = tuple(n * step for n, step in zip(chosen.nb_grid_pts, steps, strict=False))
    with _as_value_error(refused, ending):
        topography = library.read_topography(_source(path), **how_read)
        if kind == "gwy":
            topography, of_mask = _without_mask(library, topography, chosen)
            notes += of_mask
    return _of_instrument(topography, name, arguments, crop, notes, how, refused)


def _of_data_sets(path: Path, arguments: dict, channel: str | None, crop, how: dict) -> Scan | None:
    """The scan in a data set of HDF5, which states no lengths, without SurfaceTopography; None if there is none."""
    name, is_hdf5 = path.name, path.is_file() and begins(path).startswith(netcdf_heights.MAGIC[-1])
    maps = netcdf_heights.data_sets(unpacked(content(path))) if is_hdf5 else {}
    if not maps:
        return None
    if "columns" in arguments:
        raise ValueError(f"{name}: the format states its lengths itself; leave out columns")
    listed = ", ".join(map(repr, maps))
    if channel is not None and channel not in maps:
        raise ValueError(f"{name}: channel = {channel!r}, but the file has {listed}")
    lacks_lengths = not {"dx", "unit"} <= arguments.keys()
    sentences = [_NO_LENGTHS] * lacks_lengths
    if channel is None and len(maps) > 1:
        sentences.append(f"the file has the data sets {listed}: choose the heights with channel=")
    if sentences:
        raise ValueError(f"{name}: {'; and '.join(sentences)}")
    chosen = channel or next(iter(maps))
    z, note = maps[chosen].T, f"channel {chosen!r}" + f" of {listed}" * (len(maps) > 1)
    if _are_labels(chosen, z):
        raise ValueError(f"{name}: {note} has labels, which are not heights")
    unit = arguments["unit"]
    steps = [number(f"{name}: {key}", arguments.get(key, arguments["dx"]), unit) for key in ("dy", "dx")]
    positions = [step * np.arange(points) for step, points in zip(steps, z.shape, strict=True)]
    units = unit, arguments.get("height_unit", unit)
    return scan_of(name, z, positions, steps=steps, units=units, crop=crop, notes=(note,), how=how)


def _are_labels(channel: str, z: np.ndarray) -> bool:
    """Whether a channel is named for labels or a mask, and has whole numbers alone."""
    return bool(re.search("label|mask", channel, re.IGNORECASE) and (z % 1 == 0).all())


def _without_mask(library, topography, channel) -> tuple:
    """A map of Gwyddion with the heights under its mask, and a note about them.

    A mask marks grains or dust, and the heights under it are measured. Only if Gwyddion itself has replaced missing
    points, all by the mean of the others, does the mask show the missing points: then the mask stays.
    """
    measured = topography
    while hasattr(measured, "parent_topography"):  # the heights as they are in the file, without a scale
        measured = measured.parent_topography
    z = np.ma.asarray(measured.heights())
    mask, data = np.ma.getmaskarray(z), np.ma.getdata(z)
    if not mask.any() or mask.all():
        return topography, ()
    unmasked = data[~mask]
    if np.allclose(data[mask], unmasked.mean(), rtol=0, atol=1e-6 * (np.ptp(unmasked) or 1.0)):
        return topography, (
            "the points under the mask have the mean height: Gwyddion has put it where they are missing",
        )
    note = f"{mask.sum()} of {mask.size} points are under a mask of Gwyddion, which marks them: their heights are taken"
    whole = library.Topography(data.copy(), measured.physical_sizes, unit=channel.unit)
    return whole.scale(channel.height_scale_factor or 1.0), (note,)


def _of_instrument(topography, name: str, arguments: dict, crop, notes: tuple, how: dict, refused: str) -> Scan:
    """The scan of a topography of SurfaceTopography. Its lengths are all in one unit, or have no unit."""
    stated = topography.unit
    if stated is None and "unit" not in arguments:
        raise ValueError(f"{name}: the file states no unit of length; give unit")
    with _as_value_error(refused, ""), np.errstate(over="ignore"):
        overrules = stated is not None and spelt(stated) is not None and not arguments.keys().isdisjoint(_LENGTHS)
        topography = topography if stated is None or overrules else topography.to_unit("m")
        z = np.ma.filled(np.ma.asarray(topography.heights()).astype(float), np.nan).T
        if _are_labels(str(notes[:1]).partition(" of ")[0], z):
            raise ValueError(f"{notes[0]} has labels, which are not heights")
        z = np.where(np.isinf(z), np.copysign(1e300, z), z)  # a mark of missing points times a scale, for `scan_of`
        steps = [float(step) for step in np.atleast_1d(topography.pixel_size)][::-1] if topography.is_uniform else None
        positions = None if steps else [np.asarray(topography.positions(), dtype=float)]
    positions = positions or [step * np.arange(points) for step, points in zip(steps, z.shape, strict=True)]
    unit = arguments.get("unit", "m")
    units = (unit, arguments.get("height_unit", unit)) if stated is None else (stated if overrules else "m",) * 2
    lengths = overruled(positions, steps, (units[0], units[1]), arguments, name)
    lengths = lengths._replace(notes=notes + lengths.notes)
    return scan_of(name, z, **lengths._asdict(), crop=crop, how=how)


def _lacking(channel, arguments: dict) -> list[str]:
    """Sentences on the lengths that both a channel of SurfaceTopography and the call lack."""
    if channel.physical_sizes is None and "dx" not in arguments:
        return [_NO_LENGTHS if channel.unit is None else "the file states no distance of its points: give dx (and dy)"]
    return ["the file states no unit of length; give unit"] * (channel.unit is None and "unit" not in arguments)


def _source(path: Path):
    """The path, or the unpacked content of a .gz file."""
    return str(path) if path.suffix.lower() != ".gz" else io.BytesIO(unpacked(content(path)))


@contextlib.contextmanager
def _as_value_error(refused: str, ending: str):
    """Errors of SurfaceTopography, which are of many kinds, as one ValueError with their first line.

    Where no format fits, its message lists an error from each reader. The error from the reader of the ending is
    quoted, if there is one.
    """
    try:
        yield
    except (FileNotFoundError, PermissionError, IsADirectoryError, MemoryError):
        raise
    except Exception as error:
        tried = dict(re.findall(r"tried (\w+): *\n *(.*)", str(error)))
        reasons = [reason for reader, reason in tried.items() if ending and reader.lower().startswith(ending[1:])]
        fits = _NO_FORMAT + "".join(f"; as {ending}: {reason}" for reason in reasons)
        reason = fits if tried else (str(error).strip().splitlines() or [type(error).__name__])[0]
        raise ValueError(f"{refused}: {reason}") from error


def _channels(library, path: Path) -> tuple[list, object, str]:
    """Channels of a file, the default channel of SurfaceTopography, and the format; none of them if there is no
    file."""
    if not path.is_file():  # the reader says so later
        return [], None, ""
    with library.open_topography(_source(path)) as reader:
        channels, default, kind = list(reader.channels), reader.default_channel, reader.format()
    if kind in ("hgt", "nms") and path.suffix.lower() != f".{kind}":  # these two readers take any bytes
        raise ValueError(_NO_FORMAT)
    return channels, next((each for each in channels if each.index == default.index), default), kind


def _chosen(channels: list, default, channel: str | None, name: str) -> tuple:
    """The channel of that name, or the first of heights, and a note that names it. Raises ValueError without one."""
    named = {each.channel_id: each for each in channels}
    listed = ", ".join(map(repr, named))
    if channel is not None and channel not in named:
        raise ValueError(f"{name}: channel = {channel!r}, but the file has {listed}")
    curve = name.lower().endswith(".ibw") and default.dim == 1
    if curve and any(word in each.name.lower() for each in channels for word in _FORCE):
        raise ValueError(f"{name}: a force curve ({listed}), not a map of heights; give the file of the image")
    heights = [each for each in channels if each.is_height_channel]
    chosen = named[channel] if channel is not None else default if default in heights else (*heights, None)[0]
    if chosen is None or not chosen.is_height_channel:
        height_channels = ", ".join(repr(each.channel_id) for each in heights) or "none"
        what = f"channel {channel!r} has no heights" if chosen else f"the channels {listed} have no heights"
        raise ValueError(f"{name}: {what}; channels of heights: {height_channels}")
    return chosen, (f"channel {chosen.channel_id!r}" + f" of {listed}" * (len(named) > 1),)

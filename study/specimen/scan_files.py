"""Scans from files: text and CSV, .npy, and the formats of instruments by the package SurfaceTopography."""

import re
from pathlib import Path

import numpy as np

from .foreign import plain
from .scan import FEWEST, UNITS, Scan, height_map, metres, profile

TEXT = (".csv", ".txt", ".tsv", ".dat", ".asc", ".xyz", "")
#: (separator, decimal mark) of a text file. The first pair that fits its first line of numbers is taken; if only whole
#: numbers stand there, the first line with a decimal mark shows it.
DIALECTS = ((";", "."), (";", ","), ("\t", "."), ("\t", ","), (",", "."), (None, "."), (None, ","))
#: "1,024": this comma may be no decimal mark.
_THOUSAND = re.compile(r"(?<!\d)[1-9]\d{0,2},\d{3}(?!\d)")


def read(path, *, unit=None, height_unit=None, dx=None, dy=None, columns=None) -> Scan:
    """A profile or a map of heights from a file.

    Text and .npy: two columns are a profile, x and z; one column (or one row) is a profile of the distance dx; 16
    columns or more are a map, a line for each y, of the distances dx and dy. Columns are separated by commas,
    semicolons, tabs or spaces; the decimal mark is a point or, where commas do not separate, a comma. What stands
    before the first line of numbers, or behind # and %, is a comment.

    Every other ending (.sur, .opd, .x3p, .gwy, …) is the format of an instrument; the package SurfaceTopography reads
    it, with the lengths and units that the file states: pip install 'roughcoat[topography]'.

    unit : unit of x, dx, dy: m, mm, um, nm, pm or angstrom. Text and .npy have none, so it must be given.
    height_unit : unit of z; None: as `unit`
    dx, dy : distance of the points, in unit; dy is dx if it is not given
    columns : which columns to take, counted from 0: (x, z), or (z,) with dx

    Raises ValueError: the file cannot be read as a scan; the message names the file, what was read, and what is
    allowed; ImportError: the format of an instrument, and SurfaceTopography is not installed.
    """
    path = Path(path)
    if path.suffix.lower() not in (*TEXT, ".npy"):
        given = {"height_unit": height_unit, "dx": dx, "dy": dy, "columns": columns}
        return _instrument(path, unit, [name for name, value in given.items() if value is not None])
    table, heading = _npy(path) if path.suffix.lower() == ".npy" else _text(path)
    if unit is None:
        said = f'. Its heading is "{heading[:80]}".' if heading else ""
        raise ValueError(
            f"{path.name}: give unit, such as unit='um', and height_unit if heights have another: units are not read "
            f"from text and .npy{said}"
        )
    units = {"unit": unit, "height_unit": height_unit, "name": path.name}
    width, places = table.shape[1], (0, -1)
    if columns is not None:
        table = _picked(table, columns, path.name)
        places = np.atleast_1d(columns)[[0, -1]]
    places = places if dx is None else (None, places[1])
    _as_headed(heading, {"unit": unit, "height_unit": height_unit or unit}, path.name, width, places)
    if columns is None and table.shape[0] == 1:
        table = table.T
    n = table.shape[1]
    if n >= FEWEST:
        if dx is None:
            raise ValueError(f"{path.name}: a map of {table.shape[0]} × {n} heights: give dx (and dy), their distance")
        for two, line in ((table[:2], "row"), (table[:, :2].T, "column")):
            first = two[0]
            if _in_equal_steps(first) and not _in_equal_steps(two[-1]):
                raise ValueError(
                    f"{path.name}: the first {line} has equal steps, {first[0]:g}, {first[1]:g}, {first[2]:g} ...: "
                    "positions or numbers, not heights; take it out of the file"
                )
        return height_map(table, dx=dx, dy=dy, **units)
    if n > 2 or (n == 2) == (dx is not None) or dy is not None:
        given = "".join(f" with {name} = {value}" for name, value in (("dx", dx), ("dy", dy)) if value is not None)
        raise ValueError(
            f"{path.name}: {table.shape[0]} rows of {n} column(s){given}; allowed are "
            f"two columns (x, z), one column (z) with dx, or {FEWEST} columns and more (a map) with dx and dy. "
            "Choose among others with columns=(0, 2). A comma cannot separate columns and decimals."
        )
    return profile(table[:, -1], x=table[:, 0] if n == 2 else None, dx=dx, **units)


def _as_headed(heading: str, given: dict[str, str], name: str, width: int, places: tuple) -> None:
    """Raise ValueError for a unit that is none of those in the heading, such as "x [mm] z [nm]", if it has some.

    Where it has one for each of `width` columns, x and z have those at their `places`, None if dx stands for x. A
    single one is then that of z.
    """
    said = re.findall(r"[\[(]\s*([^\W\d_]+)\s*[\])]", heading)
    said = said if len(said) == width else [word for word in said if word in UNITS]
    of_heights = re.findall(r"Value units: *(\S+)", heading)  # as Gwyddion writes it; of lengths it says nothing
    for (argument, unit), place in zip(given.items(), places, strict=True):
        own = of_heights if of_heights and argument == "height_unit" else said
        if place is None and len(own) in (1, width):
            continue
        own = [own[place]] if len(own) == width else own
        if own and metres(unit, name) not in [UNITS.get(word) for word in own]:
            raise ValueError(
                f'{name}: {argument} is {unit}, but the heading has {" and ".join(own)}: "{heading[:80]}". Give unit '
                "and height_unit as the heading has them, or take its units out of it."
            )


def _in_equal_steps(line: np.ndarray) -> bool:
    steps = np.diff(line)
    return bool(steps[0] != 0 and np.ptp(steps) <= 1e-6 * abs(steps[0]))


def _picked(table: np.ndarray, columns: tuple, name: str) -> np.ndarray:
    columns = plain(columns)
    columns = tuple(columns) if isinstance(columns, (list, tuple)) else (columns,)
    if len(columns) not in (1, 2) or not all(type(i) is int and 0 <= i < table.shape[1] for i in columns):
        raise ValueError(
            f"{name}: columns = {columns}, but the file has the columns 0 to {table.shape[1] - 1}; allowed are two of "
            "them, for x and z, or one, for z"
        )
    return table[:, list(columns)]


def _npy(path: Path) -> tuple[np.ndarray, str]:
    try:
        table = np.load(path, allow_pickle=False).astype(float, casting="same_kind")
    except (ValueError, TypeError, EOFError) as error:
        raise ValueError(f"{path.name}: not a .npy file of real numbers: {error}") from error
    if table.ndim not in (1, 2) or not table.size:
        raise ValueError(f"{path.name}: an array of shape {table.shape}; allowed are one or two dimensions")
    return table.reshape(len(table), -1), ""


def _text(path: Path) -> tuple[np.ndarray, str]:
    """The numbers of a text file, shape (rows, columns), and the last line before them."""
    raw = path.read_bytes()
    if b"\0" in raw:
        raise ValueError(f"{path.name}: not a text file; text in UTF-8, .npy and the formats of instruments are read")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")  # older instruments write a µ of Latin-1 in the heading
    heading, dialect, rows = "", None, []
    for number, full in enumerate(text.splitlines(), 1):
        line = full.split("#")[0].split("%")[0].strip()
        if not line:
            heading = heading if dialect else full.strip() or heading
            continue
        if dialect is None:
            dialect = next((one for one in DIALECTS if _numbers(line, one) is not None), None)
            if dialect is None:
                heading = line
                continue
        row = _numbers(line, dialect)
        if row is None and not np.mod(rows, 1).any() and not _THOUSAND.search(line):  # "0;0" has not shown it
            dialect = dialect[0], ","
            row = _numbers(line, dialect)
        if row is None:
            raise ValueError(f"{path.name}, line {number}: {line[:60]!r} has something else than numbers")
        if rows and len(row) != len(rows[0]):
            raise ValueError(f"{path.name}, line {number}: {len(row)} number(s) after lines of {len(rows[0])}")
        rows.append(row)
    if not rows:
        raise ValueError(f"{path.name}: no line of numbers in it; columns of numbers are read")
    return np.array(rows), heading


def _numbers(line: str, dialect: tuple) -> list[float] | None:
    """The numbers of a line, NaN where a field is empty; None if it has something else or another separator."""
    separator, mark = dialect
    if separator and separator not in line:
        return None
    fields = line.rstrip(separator).split(separator)
    try:
        return [float(field.strip().replace(mark, ".") or "nan") for field in fields]
    except ValueError:
        return None


def _instrument(path: Path, unit: str | None, more: list[str]) -> Scan:
    """A scan in the format of an instrument, by SurfaceTopography. Its maps have x first, ours y."""
    try:
        from SurfaceTopography import read_topography
    except ImportError as error:
        raise ImportError(
            f"{path.name}: {path.suffix} is neither text ({', '.join(TEXT[:-1])}) nor .npy. The package "
            "SurfaceTopography reads formats of instruments: pip install 'roughcoat[topography]'. Otherwise export "
            "the scan as text, CSV or .npy."
        ) from error
    if more:
        raise ValueError(f"{path.name}: the format states its lengths itself; leave out {', '.join(more)}")
    try:
        found = read_topography(str(path))
    except OSError:
        raise
    except Exception as error:  # SurfaceTopography raises many kinds of errors
        reason = str(error).strip().splitlines() or [type(error).__name__]
        raise ValueError(f"{path.name}: SurfaceTopography cannot read it: {reason[0]}") from error
    if (found.unit is None) == (unit is None):
        said = "no unit of length; give unit" if unit is None else f"the unit {found.unit!r}; leave out unit"
        raise ValueError(f"{path.name}: the file states {said}")
    scale = metres(unit, path.name) if unit else 1.0
    found = found if unit else found.to_unit("m")
    z = np.ma.filled(np.ma.asarray(found.heights()).astype(float), np.nan).T * scale
    if not found.is_uniform:
        return profile(z, x=np.asarray(found.positions()) * scale, name=path.name)
    steps = [float(step) * scale for step in np.atleast_1d(found.pixel_size)]
    if found.dim == 1:
        return profile(z, dx=steps[0], name=path.name)
    return height_map(z, dx=steps[0], dy=steps[1], name=path.name)

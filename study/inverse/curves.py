"""Measured curves: from a file, arrays or a dataset to columns in SI."""

import csv
import re
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..inputs.definition import StudyError
from ..inputs.vocabulary import VOCABULARY
from ..specimen.quantities import quantity
from ..terminal import shown
from .afm.reading import is_of_instrument
from .afm.reading import read as of_instrument

COLUMNS = ("D", "P", "a", "dP_dD")
_UNITS = {"D": "m", "P": "N", "a": "m", "dP_dD": "N/m"}
_SUCH = {"D": "nm", "P": "nN", "a": "um", "dP_dD": "N/m"}
_CALLED = "D (depth), P (load), a (contact radius) or dP_dD (stiffness)"
_SPACED = re.compile(r"\S+(?:\s+(?:\[[^\]]*\]|\([^)]*\)))?")  # headings apart by spaces, each with its unit
_HEADING = re.compile(r"\s*(\w+)\s*(?:\[([^\]]*)\]|\(([^)]*)\))?\s*")


def curves(source: Any) -> xr.Dataset:
    """Measured curves in SI: depth D, load P, contact radius a or stiffness dP/dD over (curve, point).

    Parameters
    ----------
    source : path of a text file whose columns have headings with units, "D [nm]", "P [nN]", one curve, or several
        with a column `curve`; or of an instrument (.jpk-force, .ibw, .tab, .h5 ..., by the extra `afm`), whose approach
        is taken; or a dictionary {"D": (array, unit), "P": (array, unit)}, arrays (point,) or (curve, point); or a
        Dataset that has these over `point`, or over `curve` and `point`, with an attribute `units` each. Depths may be
        in any order, and equal; NaN is no point

    Returns
    -------
    xarray.Dataset : the columns over (curve, point) in m, N and N/m, NaN where a curve is shorter

    Raises
    ------
    StudyError : no such file, no heading, no unit, another unit, columns of unequal lengths

    Examples
    --------
    >>> import study
    >>> study.curves({"D": ([0.0, 10.0], "nm"), "P": ([0.0, 2.0], "nN")}).P.values.tolist()
    [[0.0, 2e-09]]
    """
    return measured(source)


def measured(source: Any, least: int = 2) -> xr.Dataset:
    """What `curves` returns, of `least` columns or more: a plan needs one."""
    if isinstance(source, (str, Path)) and is_of_instrument(Path(source)):
        return _of_columns(of_instrument(Path(source)), least=least)
    if isinstance(source, (str, Path)):
        return _of_columns(*_read(Path(source)), least=least)
    if isinstance(source, dict):
        return _of_columns({name: _pair(name, value) for name, value in source.items()}, least=least)
    if isinstance(source, xr.Dataset):
        names = [name for name in COLUMNS if name in source]
        strange = [dim for name in names for dim in source[name].dims if dim not in ("curve", "point")]
        if strange:
            raise StudyError([f"curves: the dimension {strange[0]} must be called point, or curve"])
        columns = {}
        for name in names:
            array = source[name]
            ordered = array.transpose(*(dim for dim in ("curve", "point") if dim in array.dims))
            columns[name] = (ordered.values, str(array.attrs.get("units", "")))
        named = {"curve": source["curve"]} if "curve" in source.coords else {}
        return _of_columns(columns, least=least).assign_coords(named)
    what = shown(source) if source is None or isinstance(source, (int, float)) else f"a {type(source).__name__}"
    raise StudyError([f'curves: must be a file, {{"D": (array, "nm"), "P": (array, "nN")}}, or a Dataset, not {what}'])


def _pair(name: str, value: Any) -> tuple[Any, str]:
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], str):
        return value
    if isinstance(value, xr.DataArray):
        return value.values, str(value.attrs.get("units", ""))
    raise StudyError([f'curves: {name} must be (array, unit), such as ([0.0, 10.0], "nm")'])


def _of_columns(
    columns: dict[str, tuple[Any, str]], curve: list[str] | None = None, where: str = "curves", least: int = 2
) -> xr.Dataset:
    errors = [
        f"{where}: {shown(name)} is no column of curves: call it {_CALLED}, or leave it out"
        for name in columns
        if name not in COLUMNS
    ]
    if len(columns) < least:
        wanted = (
            "two columns are needed, such as D [nm] and P [nN]" if least == 2 else "a column is needed, such as D [nm]"
        )
        errors.append(f"{where}: {wanted}; there is {', '.join(columns) or 'none'}")
    arrays: dict[str, np.ndarray] = {}
    for name in (name for name in columns if name in COLUMNS):
        values, unit = columns[name]
        try:
            if not unit:
                raise ValueError(f"{name} has no unit, such as {_SUCH[name]}")
            array = np.atleast_1d(np.ma.filled(np.ma.asarray(values, float), np.nan))
            size = quantity(name, f"1 {unit}", _UNITS[name]).value
        except (TypeError, ValueError) as error:
            errors.append(f"{where}: {error}" if name in str(error) else f"{where}: {name}: {error}")
            continue
        if array.ndim > 2:
            errors.append(f"{where}: {name} has {array.ndim} dimensions: (point,) or (curve, point)")
        arrays[name] = np.where(np.isfinite(array), array, np.nan) * size
    if errors:
        raise StudyError(errors)
    labels = None if curve is None else list(dict.fromkeys(curve))
    if curve is not None:
        arrays = {name: _apart(array, curve) for name, array in arrays.items()}
    shapes = [np.atleast_2d(array).shape for array in arrays.values()]
    for axis, what in ((1, "points"), (0, "curves")):
        if len({shape[axis] for shape in shapes} - ({1} if axis == 0 else set())) > 1:
            sizes = ", ".join(f"{name} {shape[axis]}" for name, shape in zip(arrays, shapes, strict=True))
            raise StudyError([f"{where}: the columns have unequal numbers of {what}: {sizes}"])
    shape = np.broadcast_shapes(*shapes)
    variables = {
        name: (
            ("curve", "point"),
            np.broadcast_to(array, shape).copy(),
            {"units": _UNITS[name], "long_name": VOCABULARY[name].long_name},
        )
        for name, array in arrays.items()
    }
    return xr.Dataset(variables, {} if labels is None else {"curve": labels})


def _apart(array: np.ndarray, curve: list[str]) -> np.ndarray:
    """One long column as rows, one for each value of the column `curve`, in their order."""
    labels = list(dict.fromkeys(curve))
    curve = np.array(curve)
    parts = [array[curve == label] for label in labels]
    longest = max(map(len, parts))
    return np.array([np.pad(part, (0, longest - len(part)), constant_values=np.nan) for part in parts])


def _read(path: Path) -> tuple[dict, list[str] | None, str]:
    """Columns, the labels in the column `curve` or None, and the name of the file, for messages."""
    where = path.as_posix()
    lines = [line for line in _text(path).splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        raise StudyError([f"{where}: is empty"])
    separator = next((sign for sign in ("\t", ";", ",") if sign in lines[0]), None)
    heading = _cells(lines[0], separator) if separator else _SPACED.findall(lines[0])
    matches = [_HEADING.fullmatch(cell) for cell in heading]
    if not matches or not all(matches) or all(_number(cell) is not None for cell in heading):
        raise StudyError(
            [f'{where}: the first line must have headings with units, such as "D [nm],P [nN]": {shown(lines[0])}']
        )
    names = [(match[1], (match[2] or match[3] or "").strip()) for match in matches if match]
    columns = [name for name, _ in names]
    twice = [name for name in dict.fromkeys(columns) if columns.count(name) > 1]
    if twice or not lines[1:]:
        problem = f"the heading has {twice[0]} twice" if twice else "there is no row under the heading"
        raise StudyError([f"{where}: {problem}"])
    rows = [_row(_cells(line, separator), columns, f"{where}: row {i + 1}") for i, line in enumerate(lines[1:])]
    labels = [str(row.pop("curve")) for row in rows] if "curve" in columns else None
    return {name: ([row[name] for row in rows], unit) for name, unit in names if name != "curve"}, labels, where


def _text(path: Path) -> str:
    where = path.as_posix()
    if path.is_dir():
        raise StudyError([f"{where} is a folder: name a file in it"])
    try:
        raw = path.read_bytes()
    except FileNotFoundError:
        raise StudyError([f"{where}: there is no such file"]) from None
    except OSError as error:
        raise StudyError([f"{where}: cannot be read: {error.strerror}"]) from None
    if b"\0" in raw:  # of a spreadsheet, say, or in UTF-16
        raise StudyError([f"{where}: cannot be read as text: save it as CSV, in UTF-8"])
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")  # older instruments write a µ of Latin-1 in the heading


def _cells(line: str, separator: str | None) -> list[str]:
    return line.split() if separator is None else next(csv.reader([line], delimiter=separator, skipinitialspace=True))


def _row(cells: list[str], columns: list[str], where: str) -> dict[str, Any]:
    """Column -> number; of the column `curve` the label."""
    if len(cells) != len(columns):
        raise StudyError([f"{where} under the heading has {len(cells)} fields, the heading has {len(columns)}"])
    row: dict[str, Any] = {}
    for name, cell in zip(columns, cells, strict=True):
        number = _number(cell)
        if name == "curve" and cell.strip() == "":
            raise StudyError([f"{where}: curve is empty: it must have the name of the curve"])
        if name != "curve" and number is None:
            comma = ": write a decimal point, not a comma" if _number(cell.replace(",", ".")) is not None else ""
            raise StudyError([f"{where}, {name} = {shown(cell)}: must be a number{comma}"])
        row[name] = cell.strip() if name == "curve" else number
    return row


def _number(cell: str) -> float | None:
    word = cell.strip()
    if word.lower() in ("", "nan", "-", "--"):
        return np.nan
    try:
        return float(word)
    except ValueError:
        return None

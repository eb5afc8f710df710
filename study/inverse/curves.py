"""Measured curves from a file, arrays or a dataset, as columns in SI."""

import csv
import re
from collections import Counter
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from solver.numerics.userfile import LARGEST_TEXT, content, unpacked

from ..inputs.definition import StudyError
from ..inputs.vocabulary import VOCABULARY
from ..specimen.quantities import quantity
from ..terminal import shown
from .force_curves import Reading, is_of_instrument, place, reading_of, without_indents
from .force_curves import read as of_instrument

COLUMNS = ("D", "P", "a", "dP_dD")
_AS_IT_IS = Reading()
_UNITS = {"D": "m", "P": "N", "a": "m", "dP_dD": "N/m"}
_SUCH = {"D": "nm", "P": "nN", "a": "um", "dP_dD": "N/m"}
_CALLED = "D (depth), P (load), a (contact radius) or dP_dD (stiffness)"
_SPACED = re.compile(r"\S+(?:\s+(?:\[[^\]]*\]|\([^)]*\)))?")  # headings separated by spaces, each with its unit
_ROWS, _MOST = 10_000, 20  # number of rows of a text that are read at a time, and of messages about one source
_HEADING = re.compile(r"\s*(\w+)\s*(?:\[([^\]]*)\]|\(([^)]*)\))?\s*")


def curves(
    source: Any,
    *,
    part: str = "approach",
    curve: int | str | None = None,
    spring_constant: Any = None,
    sensitivity: Any = None,
    area: Any = None,
) -> xr.Dataset:
    """Measured curves in SI: depth D, load P, contact radius a or stiffness dP/dD over (curve, point).

    Parameters
    ----------
    source : path of a text file whose columns have headings with units, "D [nm]", "P [nN]", with one curve, or several
        and a column `curve`; or of an instrument's file (.jpk-force, .ibw, .tab, .h5 ..., with the extra `afm`); or a
        dictionary {"D": (array, unit), "P": (array, unit)}, arrays (point,) or (curve, point); or a Dataset that has
        these over `point`, or over `curve` and `point`, each with an attribute `units`. Depths may be in any order, and
        equal; NaN is not a point
    part : "approach" or "retraction", for a file of an instrument
    curve : one of several curves: its name in the column `curve`, or its number, counted from 0; None: all
    spring_constant : of the cantilever, N/m or a text with a unit; None: from the file
    sensitivity : deflection of the cantilever per volt, m/V or a text with a unit; None: from the file
    area : for the columns h (depth), P (load) and S (stiffness at the start of unloading) of Oliver and Pharr: the area
        function of the tip, by which a = √(A(hc)/π) with the contact depth hc = h - 0.75 P/S. Numbers C0, C1, C2 ...
        of A = C0 hc² + C1 hc + C2 hc^(1/2) + C3 hc^(1/4) + ..., hc in nm, A in nm²; or a function of hc in m to m².
        None where there is a column A. The dataset has a and dP_dD = S

    Returns
    -------
    xarray.Dataset : the columns over (curve, point) in m, N and N/m, NaN where a curve is shorter

    Raises
    ------
    StudyError : no such file, no heading, no unit, a wrong unit, columns of unequal lengths, a file without two points;
        an option of instruments beside another source

    Examples
    --------
    >>> import study
    >>> study.curves({"D": ([0.0, 10.0], "nm"), "P": ([0.0, 2.0], "nN")}).P.values.tolist()
    [[0.0, 2e-09]]
    """
    return measured(source, reading=reading_of(part, curve, spring_constant, sensitivity), area=area)


def measured(source: Any, least: int = 2, reading: Reading = _AS_IT_IS, area: Any = None) -> xr.Dataset:
    """The dataset that `curves` returns, with at least `least` columns: a plan needs only one."""
    is_file = isinstance(source, (str, Path))
    if is_file and is_of_instrument(Path(source), reading):
        return _of_columns(of_instrument(Path(source), reading), least=least)
    options = reading._replace(curve=None)._asdict()
    if strange := [name for name, value in options.items() if value != getattr(_AS_IT_IS, name)]:
        kind = "for files of instruments; columns of other files are taken as they are"
        raise StudyError([f"curves: {strange[0]} is {kind}: leave it out"])
    dataset = _of_source(source, is_file, least, area)
    if is_file and least > 1 and dataset.sizes["point"] < 2:
        raise StudyError([f"{Path(source).as_posix()}: has one row: a curve needs two points or more"])
    return dataset if reading.curve is None else _chosen(dataset, reading.curve)


def _chosen(dataset: xr.Dataset, curve: Any) -> xr.Dataset:
    """One of several curves, by its name or number, without the points that only longer curves have. A number that is a
    name counts as the name."""
    names = [str(name) for name in dataset["curve"].values] if "curve" in dataset.coords else []
    if str(curve) in names:
        number = names.index(str(curve))
    elif isinstance(curve, str):
        listed = ", ".join(names[:_MOST]) + " ..." * (len(names) > _MOST)
        names_in_words = f"there is {listed}" if names else "the curves have no names, give a number"
        raise StudyError([f"curves: curve = {shown(curve)}: {names_in_words}"])
    else:
        number = place(curve, dataset.sizes["curve"], "curves")
    chosen = dataset.isel(curve=[number])
    has_numbers = np.any([np.isfinite(chosen[name].values[0]) for name in chosen.data_vars], axis=0)
    last = int(np.max(np.flatnonzero(has_numbers), initial=-1)) + 1
    return chosen.isel(point=slice(0, last))


def _of_source(source: Any, is_file: bool, least: int, area: Any) -> xr.Dataset:
    """The curves in a text file, a dictionary or a Dataset."""
    if is_file:
        columns, labels, where = _read(Path(source))
        return _of_columns(without_indents(columns, area, where), labels, where, least=least)
    if isinstance(source, dict):
        columns = {name: _pair(name, value) for name, value in source.items()}
        return _of_columns(without_indents(columns, area, "curves"), least=least)
    if area is not None:
        raise StudyError(["curves: area goes with the columns h, P and S: leave it out"])
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
        f"{where}: {shown(name)} is not a column of curves: call it {_CALLED}, or leave it out"
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
        arrays[name] = np.where(np.isfinite(array), array, np.nan)
        arrays[name] *= size
    if errors:
        more = [f"{where}: and {len(errors) - _MOST} more"] if len(errors) > _MOST else []
        raise StudyError(errors[:_MOST] + more)
    labels = None if curve is None else {label: i for i, label in enumerate(dict.fromkeys(curve))}
    if curve is not None and labels is not None:
        numbers = np.array([labels[label] for label in curve])
        arrays = {name: _as_rows(array, numbers) for name, array in arrays.items()}
    arrays = {name: np.atleast_2d(array) for name, array in arrays.items()}
    shapes = [array.shape for array in arrays.values()]
    for axis, what in ((1, "points"), (0, "curves")):
        if len({shape[axis] for shape in shapes} - ({1} if axis == 0 else set())) > 1:
            sizes = ", ".join(f"{name} {shape[axis]}" for name, shape in zip(arrays, shapes, strict=True))
            raise StudyError([f"{where}: the columns have unequal numbers of {what}: {sizes}"])
    shape = np.broadcast_shapes(*shapes)
    variables = {
        name: (
            ("curve", "point"),
            array if array.shape == shape else np.broadcast_to(array, shape).copy(),
            {"units": _UNITS[name], "long_name": VOCABULARY[name].long_name},
        )
        for name, array in arrays.items()
    }
    return xr.Dataset(variables, {} if labels is None else {"curve": list(labels)})


def _as_rows(array: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """One long column as rows, one for each curve.

    numbers : number of the curve of each value
    """
    order = np.argsort(numbers, kind="stable")
    lengths = np.bincount(numbers)
    row = numbers[order]
    rows = np.full((len(lengths), lengths.max()), np.nan)
    rows[row, np.arange(len(row)) - (np.cumsum(lengths) - lengths)[row]] = array[order]
    return rows


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
    twice = next((name for name, times in Counter(columns).items() if times > 1), None)
    if twice or not lines[1:]:
        problem = f"the heading has {twice} twice" if twice else "there is no row under the heading"
        raise StudyError([f"{where}: {problem}"])
    parts: dict[str, list] = {name: [] for name in columns}
    for begin in range(1, len(lines), _ROWS):  # the texts of all cells at once would be ten times as large
        cells = [_cells(line, separator) for line in lines[begin : begin + _ROWS]]
        for name, values in _numbers(cells, columns, begin, where).items():
            parts[name].append(values)
    labels = list(chain.from_iterable(parts.pop("curve"))) if "curve" in columns else None
    return {name: (np.concatenate(parts[name]), unit) for name, unit in names if name != "curve"}, labels, where


def _text(path: Path) -> str:
    where = path.as_posix()
    try:
        raw = unpacked(content(path, LARGEST_TEXT), LARGEST_TEXT)
    except IsADirectoryError:
        raise StudyError([f"{where} is a folder: name a file in it"]) from None
    except FileNotFoundError:
        raise StudyError([f"{where}: there is no such file"]) from None
    except OSError as error:
        raise StudyError([f"{where}: cannot be read: {error.strerror}"]) from None
    except ValueError as error:  # of userfile
        raise StudyError([f"{where}: {error}"]) from None
    if b"\0" in raw:  # a spreadsheet, say, or UTF-16
        raise StudyError([f"{where}: cannot be read as text: save it as CSV, in UTF-8"])
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")  # older instruments write a µ of Latin-1 in the heading


def _numbers(rows: list[list[str]], columns: list[str], first: int, where: str) -> dict[str, Any]:
    """Column -> numbers of the rows; for the column `curve` their labels.

    first : number of the first row
    """
    if any(len(cells) != len(columns) for cells in rows):
        _check_rows(rows, columns, first, where)
    numbers: dict[str, Any] = {}
    for name, cells in zip(columns, zip(*rows, strict=True), strict=True):
        if name == "curve":
            numbers[name] = [cell.strip() for cell in cells]
            right = "" not in numbers[name]
        else:
            try:
                numbers[name], right = np.array(list(map(float, cells))), True
            except ValueError:  # a missing point, or a word
                values = [_number(cell) for cell in cells]
                numbers[name], right = np.array(values, float), None not in values
        if not right:
            _check_rows(rows, columns, first, where)
    return numbers


def _check_rows(rows: list[list[str]], columns: list[str], first: int, where: str) -> None:
    """Raise StudyError for the first row with other columns, a curve without a name, or a word."""
    for number, cells in enumerate(rows, first):
        row = f"{where}: row {number}"
        if len(cells) != len(columns):
            raise StudyError([f"{row} under the heading has {len(cells)} fields, the heading has {len(columns)}"])
        for name, cell in zip(columns, cells, strict=True):
            if name == "curve" and cell.strip() == "":
                raise StudyError([f"{row}: curve is empty: it must have the name of the curve"])
            if name != "curve" and _number(cell) is None:
                comma = ": write a decimal point, not a comma" if _number(cell.replace(",", ".")) is not None else ""
                raise StudyError([f"{row}, {name} = {shown(cell)}: must be a number{comma}"])


def _cells(line: str, separator: str | None) -> list[str]:
    if '"' not in line:  # 20 times as fast
        return line.split(separator)
    return line.split() if separator is None else next(csv.reader([line], delimiter=separator, skipinitialspace=True))


def _number(cell: str) -> float | None:
    word = cell.strip()
    if word.lower() in ("", "nan", "-", "--"):
        return np.nan
    try:
        return float(word)
    except ValueError:
        return None

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
    if isinstance(source, (str, Path)) and is_of_instrument(Path(source)):
        return _of_columns(of_instrument(Path(source)))
    if isinstance(source, (str, Path)):
        return _of_columns(*_read(Path(source)))
    if isinstance(source, dict):
        return _of_columns({name: _pair(name, value) for name, value in source.items()})
    if isinstance(source, xr.Dataset):
        names = [name for name in COLUMNS if name in source]
        strange = [dim for name in names for dim in source[name].dims if dim not in ("curve", "point")]
        if strange:
            raise StudyError([f"curves: the dimension {strange[0]}: a dataset of curves has curve and point alone"])
        columns = {}
        for name in names:
            array = source[name]
            ordered = array.transpose(*(dim for dim in ("curve", "point") if dim in array.dims))
            columns[name] = (ordered.values, str(array.attrs.get("units", "")))
        return _of_columns(columns)
    raise StudyError([f"curves = {shown(source)}: must be a file, a dictionary of (array, unit), or a Dataset"])


def _pair(name: str, value: Any) -> tuple[Any, str]:
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], str):
        return value
    if isinstance(value, xr.DataArray):
        return value.values, str(value.attrs.get("units", ""))
    raise StudyError([f'curves: {name} must be (array, unit), such as ([0.0, 10.0], "nm")'])


def _of_columns(
    columns: dict[str, tuple[Any, str]], curve: np.ndarray | None = None, where: str = "curves"
) -> xr.Dataset:
    errors = [
        f"{where}: {name} is no column of curves: known are {', '.join(COLUMNS)}"
        for name in columns
        if name not in COLUMNS
    ]
    if len(columns) < 2:
        errors.append(
            f"{where}: two columns are needed, such as D [nm] and P [nN]; there is {', '.join(columns) or 'none'}"
        )
    arrays: dict[str, np.ndarray] = {}
    for name in (name for name in columns if name in COLUMNS):
        values, unit = columns[name]
        try:
            array = np.atleast_1d(np.asarray(values, float))
            size = quantity(name, f"1 {unit}" if unit else 1.0, _UNITS[name]).value
        except (TypeError, ValueError) as error:
            errors.append(f"{where}: {error}")
            continue
        if array.ndim > 2:
            errors.append(f"{where}: {name} has {array.ndim} dimensions: (point,) or (curve, point)")
        arrays[name] = array * size
    if errors:
        raise StudyError(errors)
    if curve is not None:
        arrays = {name: _apart(array, curve) for name, array in arrays.items()}
    try:
        shape = np.broadcast_shapes(*(np.atleast_2d(array).shape for array in arrays.values()))
    except ValueError:
        sizes = ", ".join(f"{name} {array.shape[-1]}" for name, array in arrays.items())
        raise StudyError([f"{where}: the columns have unequal numbers of points: {sizes}"]) from None
    variables = {
        name: (
            ("curve", "point"),
            np.broadcast_to(array, shape).copy(),
            {"units": _UNITS[name], "long_name": VOCABULARY[name].long_name},
        )
        for name, array in arrays.items()
    }
    return xr.Dataset(variables)


def _apart(array: np.ndarray, curve: np.ndarray) -> np.ndarray:
    """One long column as rows, one for each value of the column `curve`, in their order."""
    labels = list(dict.fromkeys(curve.tolist()))
    parts = [array[curve == label] for label in labels]
    longest = max(map(len, parts))
    return np.array([np.pad(part, (0, longest - len(part)), constant_values=np.nan) for part in parts])


def _read(path: Path) -> tuple[dict, np.ndarray | None, str]:
    """Columns, the column `curve` or None, and the name of the file, for messages."""
    where = path.as_posix()
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError(
            [f"{where}: cannot be read as text: {error.strerror if isinstance(error, OSError) else error}"]
        ) from None
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        raise StudyError([f"{where}: is empty"])
    separator = next((sign for sign in ("\t", ";", ",") if sign in lines[0]), None)
    rows = [line.split() if separator is None else next(csv.reader([line], delimiter=separator)) for line in lines]
    matches = [_HEADING.fullmatch(cell) for cell in rows[0]]
    if not all(matches) or all(_number(cell) is not None for cell in rows[0]):
        raise StudyError(
            [f'{where}: the first line must have headings with units, such as "D [nm],P [nN]": {shown(lines[0])}']
        )
    names = [(match[1], (match[2] or match[3] or "").strip()) for match in matches if match]
    values = np.full((len(rows) - 1, len(names)), np.nan)
    for i, row in enumerate(rows[1:]):
        if len(row) != len(names):
            raise StudyError(
                [f"{where}: row {i + 1} under the heading has {len(row)} fields, the heading has {len(names)}"]
            )
        for j, cell in enumerate(row):
            number = _number(cell)
            if number is None:
                raise StudyError([f"{where}: row {i + 1}, {names[j][0]} = {shown(cell)}: must be a number"])
            values[i, j] = number
    known = {name: (values[:, j], unit) for j, (name, unit) in enumerate(names) if name != "curve"}
    unnamed = [name for name, _ in names]
    return known, values[:, unnamed.index("curve")] if "curve" in unnamed else None, where


def _number(cell: str) -> float | None:
    word = cell.strip()
    if word.lower() in ("", "nan", "-", "--"):
        return np.nan
    try:
        return float(word)
    except ValueError:
        return None

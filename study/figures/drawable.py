"""What a figure can show of a dataset, which may be that of another program; results that several figures show."""

import os
from math import prod
from numbers import Real
from pathlib import Path

import numpy as np
import xarray as xr

from ..files.results_file import open_results
from ..inputs.definition import StudyError

MOST_POINTS = 20_000_000  # numbers of a quantity, whose curves matplotlib draws in some seconds: more is a mistake
#: Kinds of types of numpy whose values are neither real numbers nor texts.
_NOT_DRAWN = {"M": "dates", "m": "spans of time", "c": "complex numbers", "S": "bytes", "V": "compound values"}
#: Bytes in memory of results that are kept while a program draws. Some twenty studies have figures.
SMALL = 20_000_000
_kept: dict[Path, tuple[tuple, xr.Dataset]] = {}
_IN_LABELS = ("units", "long_name", "scale")  # attributes


def opened(path: Path) -> xr.Dataset:
    """The results in a file. Those that are small are kept for the next figure that needs them, until the file is
    another one."""
    path = Path(os.path.abspath(path))
    place = path.stat()
    stamp = place.st_mtime_ns, place.st_size, place.st_ino
    if path not in _kept or _kept[path][0] != stamp:
        _kept.pop(path, None)
        dataset = open_results(path)
        if dataset.nbytes > SMALL:
            return dataset
        _kept[path] = stamp, dataset
    return _kept[path][1].copy()


def drawable(dataset: xr.Dataset, names: tuple[str, ...]) -> xr.Dataset:
    """The dataset without values that are neither numbers nor texts, and without labels that are no texts.

    Raises StudyError when one of the `names` is of this kind.
    """
    reasons = {name: _reason(str(name), variable) for name, variable in dataset.variables.items()}
    if wrong := [f"{name} {reasons[name]}" for name in dict.fromkeys(names) if reasons.get(name)]:
        raise StudyError(wrong)
    kept = dataset.drop_vars([name for name, reason in reasons.items() if reason]).copy()
    for variable in kept.variables.values():
        variable.attrs = {
            key: value for key, value in variable.attrs.items() if key not in _IN_LABELS or isinstance(value, str)
        }
    return kept


def check_size(dataset: xr.Dataset, x: str, y: str) -> None:
    """Raise StudyError when the curves of y against x have very many points, before these are read."""
    sizes = {dim: size for name in (x, y) for dim, size in dataset[name].sizes.items()}
    if prod(sizes.values()) > MOST_POINTS:
        axes = ", ".join(f"{dim} ({size})" for dim, size in sizes.items())
        raise StudyError([f"{y} against {x} has {prod(sizes.values())} points, of {axes}: at most {MOST_POINTS}"])


def _reason(name: str, variable: xr.Variable) -> str:
    """Why a variable is not drawn, "" if it can be."""
    kind = variable.dtype.kind
    if len(set(variable.dims)) < variable.ndim:
        return "has a dimension twice: it is not drawn"
    if kind == "O" and variable.size <= MOST_POINTS:
        texts = all(isinstance(value, (str, Real)) for value in variable.values.ravel())
        return "" if texts else "has lists or other objects: they are not drawn"
    if kind in "UOT" and (name == "validity" or name.endswith("_spread")):
        return "has texts: they are not drawn"
    return f"has {_NOT_DRAWN[kind]}: they are not drawn" if kind in _NOT_DRAWN else ""


def why_none(y: str, values: xr.DataArray) -> str:
    """Why no case has a number to draw."""
    return f"{y} is infinite" if np.isinf(values).any() else "status says what became of each"

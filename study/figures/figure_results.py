"""Results for figures: measurements, which no study file computes, and the part of a dataset that can be drawn."""

import hashlib
from math import prod
from numbers import Real
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import xarray as xr

from solver import NUMERICS_VERSION

from ..data.provenance import provenance
from ..files.examine import examine
from ..files.results_file import open_results, write
from ..inputs.definition import StudyError
from .registry import Measured, entry

MOST_POINTS = 20_000_000  # matplotlib draws curves of so many numbers in some seconds; more must be a mistake
#: Kinds of types of numpy whose values are neither real numbers nor texts.
_NOT_DRAWN = {"M": "dates", "m": "spans of time", "c": "complex numbers", "S": "bytes", "V": "compound values"}
_IN_LABELS = ("units", "long_name", "scale")  # attributes that labels use


def drawable(dataset: xr.Dataset, names: tuple[str, ...]) -> xr.Dataset:
    """The dataset without variables that are neither numbers nor texts, and without attributes for labels that are not
    texts.

    Raises StudyError when one of the `names` cannot be drawn.
    """
    reasons = {name: _reason(str(name), variable) for name, variable in dataset.variables.items()}
    if wrong := [f"{name} {reasons[name]}" for name in dict.fromkeys(names) if reasons.get(name)]:
        raise StudyError(wrong)
    drawn = dataset.drop_vars([name for name, reason in reasons.items() if reason]).copy()
    for variable in drawn.variables.values():
        variable.attrs = {
            key: value for key, value in variable.attrs.items() if key not in _IN_LABELS or isinstance(value, str)
        }
    return drawn


def check_size(dataset: xr.Dataset, x: str, y: str) -> None:
    """Raise StudyError when the curves of y against x have too many points, before these are read."""
    sizes = {dim: size for name in (x, y) for dim, size in dataset[name].sizes.items()}
    if prod(sizes.values()) > MOST_POINTS:
        axes = ", ".join(f"{dim} ({size})" for dim, size in sizes.items())
        raise StudyError([f"{y} against {x} has {prod(sizes.values())} points, of {axes}: at most {MOST_POINTS}"])


def _reason(name: str, variable: xr.Variable) -> str:
    """The reason why a variable cannot be drawn; "" if it can."""
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
    """Words on why no case has a number to draw."""
    return f"{y} is infinite" if np.isinf(values).any() else "status says how each of them ended"


def results(name: str, folder, force: bool = False, command: str = "") -> xr.Dataset:
    """The measurements in FOLDER/NAME.nc. If they are missing, damaged or of another plan, they are made again.

    force : make them again in any case

    A damaged file is put aside. Raises Unusable for a file that roughcoat has not written, StudyError for a file with
    the cases of a study, and for a name that no function measures.
    """
    measured, path = entry("measured", name), Path(folder) / f"{name}.nc"
    condition = examine(path)
    if condition.kind in ("foreign", "unreadable"):
        condition.raise_if_bad()
    if condition.sizes:
        raise StudyError([f"{path}: holds the cases of a study: move it away, or use --results DIR"])
    if force or not condition.good or condition.digest != digest(measured.plan()):
        path.parent.mkdir(parents=True, exist_ok=True)
        write(described(measured.measure(), name, measured, command), path, condition)
    return open_results(path)


def described(dataset: xr.Dataset, name: str, measured: Measured, command: str) -> xr.Dataset:
    """Measurements with the provenance of all results; the plan takes the place of the study file."""
    plan = measured.plan()
    about = SimpleNamespace(title=measured.title, name=name, text=plan, digest=digest(plan))
    return dataset.assign_attrs(provenance(about, command))


def digest(plan: str) -> str:
    """sha256 of a plan and the numerics."""
    return hashlib.sha256((NUMERICS_VERSION + plan).encode()).hexdigest()

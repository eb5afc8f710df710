"""Results that no study file makes, such as times: code beside studies measures them (`registry.measured`)."""

import hashlib
from pathlib import Path
from types import SimpleNamespace

import xarray as xr

from solver import NUMERICS_VERSION

from ..data.provenance import provenance
from ..files.examine import examine
from ..files.results_file import open_results, write
from ..inputs.definition import StudyError
from .registry import Measured, entry


def results(name: str, folder, force: bool = False, command: str = "") -> xr.Dataset:
    """The measurements in FOLDER/NAME.nc. If they are missing, damaged or of another plan, they are made anew.

    force : make them anew in any case

    A damaged file is kept aside. Raises Unusable for a file that roughcoat has not written, StudyError for the cases of
    a study, and for a name that nothing measures.
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
    """Measurements with the provenance that all results have; the plan stands for the study file."""
    plan = measured.plan()
    about = SimpleNamespace(title=measured.title, name=name, text=plan, digest=digest(plan))
    return dataset.assign_attrs(provenance(about, command))


def digest(plan: str) -> str:
    """sha256 of a plan and the numerics."""
    return hashlib.sha256((NUMERICS_VERSION + plan).encode()).hexdigest()

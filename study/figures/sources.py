"""What figures and tables share: the datasets of the studies they need, one case of them, CSV."""

import csv
import io
from pathlib import Path

import numpy as np
import xarray as xr

from ..files.results_file import open_results
from ..spec.definition import StudyError
from ..spec.vocabulary import suggest


def open_studies(name: str, known: dict, results) -> tuple:
    """The entry `name` of RECIPES or TABLES and the datasets of its studies, in their order.

    Raises
    ------
    StudyError : no such entry, or no results yet of a study that it needs
    """
    if name not in known:
        raise StudyError([f'"{name}" is not known{suggest(name, known)}'])
    paths = {study: Path(results) / f"{study}.nc" for study in known[name].studies}
    missing = [
        f"{path}: does not exist, {name} needs it; make it with: python -m study run studies/{study}.toml"
        for study, path in paths.items()
        if not path.exists()
    ]
    if missing:
        raise StudyError(missing)
    return known[name], [open_results(path) for path in paths.values()]


def pick(dataset: xr.Dataset, **wanted) -> xr.Dataset:
    """The one case whose coordinates along `case` have the wanted values (numbers within 1e-9).

    Raises
    ------
    StudyError : no case, or several, fit
    """
    fits = np.ones(dataset.sizes["case"], dtype=bool)
    for name, value in wanted.items():
        found = dataset[name].values
        fits &= (found == value) if isinstance(value, str) else np.isclose(found, value, rtol=1e-9, atol=0)
    if np.count_nonzero(fits) != 1:
        which = ", ".join(f"{name} = {value}" for name, value in wanted.items())
        raise StudyError([f"{dataset.attrs['study_name']}: {np.count_nonzero(fits)} cases have {which}: needs one"])
    return dataset.isel(case=int(np.argmax(fits)))


def csv_text(headings, rows) -> str:
    """CSV with one line of headings."""
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows([headings, *rows])
    return stream.getvalue()


def write_text(path: Path, text: str) -> Path:
    """Write a text file, and the folder it goes to; returns the path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path

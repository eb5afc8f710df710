"""The results of a study as rows for a spreadsheet, which `table` writes if its name is that of a study."""

import io
import os
import warnings
from importlib.util import find_spec
from math import isfinite, isnan
from pathlib import Path
from typing import Any

from xarray import Dataset

from ..api import load
from ..figures.formats import guarded, write
from ..files.access import Unusable
from ..files.results_file import open_results
from ..in_words.chosen_columns import beside_bare, in_units, inputs_without_layer, rows_of, selected, usual
from ..inputs.definition import StudyError
from ..inputs.places import study_file
from ..solving import solve
from ..terminal import answer
from .computing import completed

MOST_ROWS = 1_048_575
"""Largest number of rows in a sheet of .xlsx, below its headings."""


def results_of(options, name: str) -> Dataset | int:
    """The results of a study, which `--run` computes first, or those in a file; an exit code if the run fails.

    Raises StudyError if there are no results.
    """
    if Path(name).suffix == ".nc":
        return _of_file(name)
    study = load(study_file(name), options.results)
    if options.run and (code := completed(study)):
        return code
    return study.open()


def _of_file(name: str) -> Dataset:
    """The dataset of a results file, or of a netCDF file of another program."""
    if not Path(os.path.expanduser(name)).exists():
        raise StudyError([f"{name}: does not exist"])
    try:
        return open_results(name)
    except Unusable as error:
        raise StudyError(error.messages) if error.kind == "foreign" else error from None


def write_rows(options, name: str) -> int:
    """Write a row for each contact, and one for each point of each profile, and say which files they are in."""
    if options.format == "xlsx" and find_spec("openpyxl") is None:
        raise StudyError(
            ["table --format xlsx needs openpyxl: pip install 'roughcoat[xlsx]', or leave out --format for CSV"]
        )
    dataset = results_of(options, name)
    if isinstance(dataset, int):
        return dataset
    if "status" not in dataset:
        raise StudyError([f"{name}: this dataset is not one of contacts: it has no status"])
    table = selected(dataset, options.columns)
    if options.beside:
        names = options.columns or usual(dataset)
        table = beside_bare(table, _bare(dataset, names), names)
    dataset = in_units(table, options.units)
    tables, stem = rows_of(dataset, options.columns), Path(options.folder) / Path(name).stem
    if options.format == "csv":
        names = {kind: stem.with_name(f"{stem.name}{f'_{kind}' * (kind != 'contacts')}.csv") for kind in tables}
        answer(*(write(names[kind], _guarded(table).to_csv(index=False)) for kind, table in tables.items()))
        return 0
    for kind, table in tables.items():
        if len(table) > MOST_ROWS:
            rows = f"{len(table)} rows of {kind}"
            raise StudyError([f"{name}: {rows}; a sheet of .xlsx has at most {MOST_ROWS}: leave out --format xlsx"])
    answer(write(stem.with_suffix(".xlsx"), _workbook(tables)))
    return 0


def _bare(dataset: Dataset, names: list[str]) -> Dataset:
    """The contacts on the body without layers, with the profiles among the names.

    Raises StudyError: there is no layer.
    """
    profiles = [name for name in names if name in dataset and "x" in dataset[name].dims]
    points = {"x": dataset["x"].values} if profiles else {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # `validity` of each contact says it
        return solve(**inputs_without_layer(dataset), profiles=profiles or False, **points)


def _guarded(table: Any) -> Any:
    """The frame without texts that a spreadsheet would compute."""
    texts = {name: column.map(guarded) for name, column in table.items() if column.dtype.kind == "O"}
    return table.assign(**texts).rename(columns=guarded)


def _workbook(tables: dict) -> bytes:
    """A sheet for each table."""
    from openpyxl import Workbook  # an extra, whose presence the caller has checked
    from openpyxl.cell import WriteOnlyCell
    from openpyxl.cell.cell import ILLEGAL_CHARACTERS_RE

    page, book = io.BytesIO(), Workbook(write_only=True)

    def as_cell(value: Any) -> Any:
        if isinstance(value, str) and (value[:1] in ("=", "#") or ILLEGAL_CHARACTERS_RE.search(value)):
            cell = WriteOnlyCell(sheet, ILLEGAL_CHARACTERS_RE.sub("\ufffd", value))
            cell.data_type = "s"  # openpyxl takes "=1+1" for a formula, "#N/A" for an error
            return cell
        if isinstance(value, float) and not isfinite(value):
            return None if isnan(value) else str(value)  # a sheet has no infinite number
        return value

    for kind, table in tables.items():
        sheet = book.create_sheet(kind)
        for row in ([*table.columns], *table.itertuples(index=False)):
            sheet.append([*map(as_cell, row)])
    book.save(page)
    return page.getvalue()

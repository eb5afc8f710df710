"""The register of figures and tables. Each is a decorated function of the datasets of the studies that it names.

`study.catalogue` imports every file of the rooms figures, paper, literature and evidence. So `python -m study plot` and
`table`, and `make`, know a function in one of these rooms without another line anywhere.
"""

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..files.results_file import open_results
from ..spec.definition import StudyError
from ..spec.vocabulary import suggest
from ..terminal import program

ONE_COLUMN, TWO_COLUMNS = 3.35, 6.9  # inches, widths of a journal page
Columns = dict[str, np.ndarray]
"""The numbers that a figure shows: heading of the CSV -> column."""


def joined(parts: list[Columns]) -> Columns:
    """The columns of several parts of a figure, one below the other."""
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


class Figure(NamedTuple):
    """See `figure`."""

    studies: tuple[str, ...]
    draw: Callable[..., Columns]
    size: tuple[float, float]
    panels: tuple[int, int]
    caption: str


class Column(NamedTuple):
    """One column of a table: heading, format of its numbers ("s": text), heading in LaTeX if it has its own."""

    text: str
    form: str
    latex: str


class Table(NamedTuple):
    """See `table`."""

    studies: tuple[str, ...]
    rows: Callable[..., list[tuple]]
    caption: str
    columns: tuple[Column, ...]


FIGURES: dict[str, Figure] = {}
TABLES: dict[str, Table] = {}


def figure(name: str, *studies: str, size=(ONE_COLUMN, 2.6), panels=(1, 1), caption: str = ""):
    """Register `draw(axes, *datasets)`, which draws the figure NAME and returns the numbers that it shows.

    studies : names of the studies whose datasets `draw` takes, in this order
    size : width and height in inches
    panels : rows and columns; several make `axes` an array
    caption : what the figure shows; by default the first paragraph of the docstring. The parameters that the studies
        share are added by themselves, and stand above the figure
    """

    def register(draw: Callable[..., Columns]) -> Callable[..., Columns]:
        check_new(name, draw, FIGURES)
        FIGURES[name] = Figure(studies, draw, size, panels, caption_of(draw, caption))
        return draw

    return register


def table(name: str, *studies: str, columns: str, caption: str = ""):
    """Register `rows(*datasets)`, which gives the table NAME as a list of tuples, one value per column.

    studies : names of the studies whose datasets `rows` takes, in this order
    columns : "heading | format of its numbers | heading in LaTeX" of each, on lines or separated by "; "; without a
        format the cells are text, without a heading in LaTeX it is the plain one
    caption : by default the first paragraph of the docstring
    """

    def register(rows: Callable[..., list[tuple]]) -> Callable[..., list[tuple]]:
        check_new(name, rows, TABLES)
        heads = tuple(column(one) for one in re.split(r"\n|(?<!\\); ", columns.strip()))
        TABLES[name] = Table(studies, rows, caption_of(rows, caption), heads)
        return rows

    return register


def check_new(name: str, function: Callable, known: dict) -> None:
    """Raise ValueError if another function has the name. In a notebook a function may be defined anew."""
    own = getattr(function, "func", function)  # of a partial
    other = known[name][1] if name in known else own
    other = getattr(other, "func", other)
    if (other.__module__, other.__name__) != (own.__module__, own.__name__):
        raise ValueError(f'"{name}" is that of {other.__module__}.{other.__name__} already: take another name')


def caption_of(function: Callable, given: str = "") -> str:
    """The caption that was given, by default the first paragraph of the docstring, on one line."""
    return " ".join((given or (function.__doc__ or "").partition("\n\n")[0]).split())


def column(given: str) -> Column:
    """One of the `columns` of a table."""
    text, form, latex = (cell.strip() for cell in (given + "||").split("|")[:3])
    return Column(text, form or "s", latex)


def entry(name: str, known: dict[str, NamedTuple]) -> NamedTuple:
    """The figure or table of a name. Raises StudyError, which suggests another name, if there is none."""
    if name not in known:
        raise StudyError([f'"{name}" is not known{suggest(name, known)}'])
    return known[name]


def open_studies(name: str, known: dict[str, NamedTuple], results) -> list[xr.Dataset]:
    """The datasets that a figure or table needs, in their order. Raises StudyError if a study has no results yet."""
    paths = {study: Path(results) / f"{study}.nc" for study in entry(name, known).studies}
    missing = [
        # the trade-off is no study file and has a command of its own
        f"{path}: does not exist, {name} needs it; make it with: {program()} {'run ' * (study != 'tradeoff')}{study}"
        for study, path in paths.items()
        if not path.exists()
    ]
    if missing:
        raise StudyError(missing)
    return [open_results(path) for path in paths.values()]


def pick(dataset: xr.Dataset, **wanted) -> xr.Dataset:
    """The one case whose coordinates along `case` have the wanted values (numbers within 1e-9).

    Raises StudyError when no case, or several, fit.
    """
    fits = np.ones(dataset.sizes["case"], dtype=bool)
    for name, value in wanted.items():
        found = dataset[name].values
        fits &= (found == value) if isinstance(value, str) else np.isclose(found, value, rtol=1e-9, atol=0)
    if np.count_nonzero(fits) != 1:
        which = ", ".join(f"{name} = {value}" for name, value in wanted.items())
        raise StudyError([f"{dataset.attrs['study_name']}: {np.count_nonzero(fits)} cases have {which}: needs one"])
    return dataset.isel(case=int(np.argmax(fits)))

"""The register of figures and tables. Each is a decorated function of the datasets of the studies that it names.

They are in a file `figures.py` beside studies, see `study.figures.figure_files`, or in a user's script.
"""

import os
import re
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from ..files.results_file import open_results, results_of
from ..inputs.definition import StudyError
from ..inputs.places import BOOK
from ..terminal import program
from . import figure_files

ONE_COLUMN, TWO_COLUMNS = 3.35, 6.9  # inches, widths of a journal page
#: Largest number of bytes of a dataset that stays in memory while a program draws. Some twenty studies have figures.
SMALL = 20_000_000
_datasets: dict[Path, tuple[tuple, xr.Dataset]] = {}
COMMANDS = ("tradeoff",)  # measurements with a command of their own
Decorator = Callable[[Callable], Callable]
Pair = tuple[float, float]
Cells = tuple[int, int]
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


class Drawing(NamedTuple):
    """See `drawing`."""

    stem: Callable[[], Path]
    caption: str
    studies: tuple[str, ...] = ()


class Column(NamedTuple):
    """One column of a table: heading, format of its numbers ("s": text), heading in LaTeX if that differs."""

    text: str
    form: str
    latex: str


class DataTable(NamedTuple):
    """See `table`."""

    studies: tuple[str, ...]
    rows: Callable[..., list[tuple]]
    caption: str
    columns: tuple[Column, ...]


class Measured(NamedTuple):
    """See `measured`."""

    measure: Callable[[], xr.Dataset]
    plan: Callable[[], str]
    title: str


#: Package of files beside studies -> kind -> name -> entry. The package "" stands for scripts and other modules.
REGISTERS = defaultdict[str, dict[str, dict]](lambda: {kind: {} for kind in figure_files.KINDS.values()})
FIGURES, TABLES = REGISTERS[""]["figure"], REGISTERS[""]["table"]
"""Figures and tables of the running program, which go before those beside studies."""


def figure(
    name: str, *studies: str, size: Pair = (3.35, 2.6), panels: Cells = (1, 1), caption: str = "", long: bool = False
) -> Decorator:
    """Register a function that draws a figure: `draw(axes, *datasets)` returns the numbers that it shows.

    Parameters
    ----------
    name : of the figure
    studies : names of the studies whose datasets `draw` takes, in this order
    size : width and height in inches
    panels : rows and columns of panels; with several panels `axes` is an array
    caption : by default the first paragraph of the docstring. The parameters that the studies share are added to it
    long : whether a study takes minutes to compute; `plot all` leaves out the figure

    Returns
    -------
    a decorator, which returns the function

    Examples
    --------
    >>> import study
    >>> @study.figure("parabola", caption="A parabola.")
    ... def parabola(axes):
    ...     axes.plot([0, 1, 2], [0, 1, 4])
    ...     return {"x": [0, 1, 2], "y": [0, 1, 4]}
    >>> FIGURES.pop("parabola").caption
    'A parabola.'
    """

    def register(draw: Callable[..., Columns]) -> Callable[..., Columns]:
        add("figure", name, draw, Figure(studies, draw, size, panels, caption_of(draw, caption)))
        return draw

    return register


def drawing(name: str, caption: str = "") -> Decorator:
    """Register a function that returns the path, without its ending, of a drawing: .svg, .pdf and .png are copied.

    Parameters
    ----------
    name, caption : of the drawing; the caption is by default the first paragraph of the docstring

    Returns
    -------
    a decorator, which returns the function

    Examples
    --------
    >>> import pathlib, study
    >>> @study.drawing("sketch")
    ... def sketch():
    ...     "A sketch of the punch."
    ...     return pathlib.Path("sketches/punch")
    >>> FIGURES.pop("sketch").caption
    'A sketch of the punch.'
    """

    def register(stem: Callable[[], Path]) -> Callable[[], Path]:
        add("figure", name, stem, Drawing(stem, caption_of(stem, caption)))
        return stem

    return register


def table(name: str, *studies: str, columns: str, caption: str = "", long: bool = False) -> Decorator:
    """Register a function that makes a table: `rows(*datasets)` returns a list of tuples, one value per column.

    Parameters
    ----------
    name : of the table
    studies : names of the studies whose datasets `rows` takes, in this order
    columns : "heading | format of its numbers | heading in LaTeX" for each, on lines or separated by "; "; without a
        format the cells are text, without a heading in LaTeX the plain heading serves
    caption, long : as in `figure`

    Returns
    -------
    a decorator, which returns the function

    Examples
    --------
    >>> import study
    >>> @study.table("squares", columns="x | d; square | d | $x^2$")
    ... def squares():
    ...     "The first squares."
    ...     return [(1, 1), (2, 4)]
    >>> [column.latex for column in TABLES.pop("squares").columns]
    ['', '$x^2$']
    """

    def register(rows: Callable[..., list[tuple]]) -> Callable[..., list[tuple]]:
        heads = tuple(column(line) for line in re.split(r"\n|(?<!\\); ", columns.strip()))
        add("table", name, rows, DataTable(studies, rows, caption_of(rows, caption), heads))
        return rows

    return register


def measured(name: str, plan: Callable[[], str], title: str):
    """Register `measure()`, whose dataset is stored as results of the study NAME, which has no study file.

    plan : text that describes the measurement; results of another plan are measured again
    title : of the dataset
    """

    def register(measure: Callable[[], xr.Dataset]) -> Callable[[], xr.Dataset]:
        add("measured", name, measure, Measured(measure, plan, title))
        return measure

    return register


def add(kind: str, name: str, function: Callable, registered: NamedTuple) -> None:
    """Put the entry of a function into the register of its package.

    Raises ValueError if another function there has the name. In a notebook a function may be defined again.
    """
    function = getattr(function, "func", function)  # of a partial
    package = (function.__module__ or "").rpartition(".")[0]
    register = REGISTERS[package if package.startswith(BOOK) else ""][kind]
    other = next((value for value in register.get(name, ()) if callable(value)), function)
    other = getattr(other, "func", other)
    if (other.__module__, other.__name__) != (function.__module__, function.__name__):
        raise ValueError(f'"{name}" is already the name of {other.__module__}.{other.__name__}: take another name')
    register[name] = registered


def caption_of(function: Callable, caption: str = "") -> str:
    """The caption, by default the first paragraph of the docstring, on one line."""
    return " ".join((caption or (function.__doc__ or "").partition("\n\n")[0]).split())


def column(line: str) -> Column:
    """One of the `columns` of a table."""
    text, form, latex = (cell.strip() for cell in (line + "||").split("|")[:3])
    return Column(text, form or "s", latex)


def names(kind: str, *, long: bool = True) -> list[str]:
    """The names of all figures ("figure") or tables ("table").

    long : whether figures that take long are among them
    """
    return list(dict.fromkeys([*REGISTERS[""][kind], *figure_files.names(kind, long=long)]))


def entry(kind: str, name: str) -> Any:
    """The entry of a name, registered by the program itself or by code beside studies, which is run for it.

    Raises StudyError, which suggests another name, if there is no such entry.
    """
    if name in REGISTERS[""][kind]:
        return REGISTERS[""][kind][name]
    place = figure_files.place_of(kind, name)
    if place is None:
        raise figure_files.unknown(kind, name, list(REGISTERS[""][kind]))
    file, last = place
    register = REGISTERS[figure_files.run(file)][kind]
    if last not in register:
        raise StudyError([f"{file.as_posix()}: does not register the {kind} {last}, although it names it"], code=1)
    return register[last]


def code_of(kind: str, name: str) -> list[Path]:
    """Files beside studies on which a figure or table may depend, by their texts; none if a script registers it."""
    place = None if name in REGISTERS[""][kind] else figure_files.place_of(kind, name)
    return figure_files.files_of(place[0]) if place else []


def study_beside(kind: str, name: str) -> Path | None:
    """The folder of a user's figure or table, where the studies that it needs are searched for first."""
    place = None if name in REGISTERS[""][kind] else figure_files.place_of(kind, name)
    return place[0].parent if place and place[0] not in figure_files.book_files() else None


def open_studies(name: str, studies: tuple[str, ...], results) -> list[xr.Dataset]:
    """The datasets of the studies that a figure or table needs. Raises StudyError if one has no results yet."""
    paths = {study: results_of(Path(results), study) for study in studies}
    missing = [path for path in paths.values() if not path.exists()]
    if missing:
        raise StudyError([f"{path}: does not exist, {name} needs it; {_way_out(path.stem)}" for path in missing])
    datasets = [opened(path) for path in paths.values()]
    names = [dataset.attrs.get("study_name", study) for study, dataset in zip(studies, datasets, strict=True)]
    others = [(paths[study], other) for study, other in zip(studies, names, strict=True) if other != study]
    if others:
        raise StudyError([f"{path}: holds results of the study {other}: move it away" for path, other in others])
    return datasets


def opened(path: Path) -> xr.Dataset:
    """The results in a file. Small results stay in memory for the next figure that needs them, until the file
    changes."""
    path = Path(os.path.abspath(path))
    place = path.stat()
    stamp = place.st_mtime_ns, place.st_size, place.st_ino
    if path not in _datasets or _datasets[path][0] != stamp:
        _datasets.pop(path, None)
        dataset = open_results(path)
        if dataset.nbytes > SMALL:
            return dataset
        _datasets[path] = stamp, dataset
    return _datasets[path][1].copy()


def _way_out(study: str) -> str:
    """Words on how to get the results of a study that has none."""
    if is_measured(study):
        return f"make it with: {program()} {study}" if study in COMMANDS else "--run measures it"
    return f"make it with: {program()} run {study}"


def is_measured(study: str) -> bool:
    """Whether the results of a study are measured by code beside studies, see `measured`."""
    return study in REGISTERS[""]["measured"] or figure_files.place_of("measured", study) is not None


def pick(dataset: xr.Dataset, **wanted) -> xr.Dataset:
    """The case whose coordinates along `case` have the wanted values (numbers within 1e-9).

    Raises StudyError when no case fits, or several do.
    """
    fits = np.ones(dataset.sizes["case"], dtype=bool)
    for name, value in wanted.items():
        values = dataset[name].values
        fits &= (values == value) if isinstance(value, str) else np.isclose(values, value, rtol=1e-9, atol=0)
    if np.count_nonzero(fits) != 1:
        which = ", ".join(f"{name} = {value}" for name, value in wanted.items())
        raise StudyError([f"{dataset.attrs['study_name']}: {np.count_nonzero(fits)} cases have {which}: needs one"])
    return dataset.isel(case=int(np.argmax(fits)))

"""The commands that draw and tabulate results. Each takes one name and returns an exit code."""

import atexit
import logging
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from .. import catalogue
from ..api import load
from ..data.provenance import command_line
from ..figures.registry import is_measured, study_beside
from ..figures.style import style
from ..inputs.definition import StudyError
from ..inputs.grid import twins
from ..inputs.places import is_study, study_file
from ..terminal import answer, on_one_line, say
from .computing import completed

if TYPE_CHECKING:
    from ..work.second_process import SecondProcess

log = logging.getLogger(__name__)
KINDS = {"plot": "figure", "table": "table"}
"""Command -> kind of its output."""
MANY = 8
"""Number of figures from which on a second process draws some of them. It takes as long to start as two figures."""


def items(options) -> list[str]:
    """The names of figures, tables or studies that were given; "all" stands for those that need no long study."""
    if options.command == "tradeoff":
        return ["tradeoff"]
    options.names = catalogue.usual(KINDS[options.command]) if options.items == ["all"] else options.items
    return options.names


def plot(options, name: str) -> int:
    """Draw a figure, or curves of results, and say which files it is in."""
    if options.x or options.y or options.hue or options.where:
        return _curves(options, name)
    try:
        return _write(options, name)
    except StudyError:
        what = "file" if Path(name).suffix == ".nc" else "study"
        if name in catalogue.names("figure") or not (what == "file" or is_study(name)):
            raise
        how = "give --x and --y to draw curves of it, such as --x P --y a"
        raise StudyError([f"{name} is a {what}, not a figure: {how}"]) from None


def _curves(options, name: str) -> int:
    """Draw one quantity of the results of a study, or of a file, against another."""
    from ..figures.plots import shaped  # it imports scipy.interpolate, and pandas, which figures of studies do without
    from .spreadsheet import results_of

    if not (options.x and options.y):
        raise StudyError(["curves of results need both --x and --y, such as --x P --y p_max"])
    for i, _ in twins([axis for axis, _ in options.where]):
        raise StudyError([f"--where {options.where[i][0]} is given twice"])
    dataset = results_of(options, name)
    if isinstance(dataset, int):
        return dataset
    study = Path(name).stem
    stem, title = f"{study}_{options.y}", f"{study}: {options.y} against {options.x}"
    if options.colour:
        stem, title = f"{study}_{options.colour}", f"{study}: {options.colour} over {options.x} and {options.y}"
    try:
        with style():
            names, look = (options.x, options.y, options.hue), vars(options)
            look = {name: look[name] for name in ("colour", "scale", "limits")}
            figure, columns = shaped(dataset, names, dict(options.where), Figure, **look)
        figure = catalogue.without_parameters(figure) if options.bare else figure
        written = catalogue.save(Path(options.folder) / stem, figure, columns, title)
    except (StudyError, OSError, MemoryError):
        raise
    except Exception as error:  # a file of another program may contain anything
        log.info("%s", name, exc_info=True)
        raise StudyError([f"{name}: cannot be drawn: {_in_words(error)}"], code=1) from error
    answer(*written)
    return 0


def _in_words(error: Exception) -> str:
    """The message of an exception, and how to find its place."""
    return f"{type(error).__name__}: {on_one_line(str(error), 300)}; -v before the command shows where"


def table(options, name: str) -> int:
    """Write a table, or the results of a study or of a file as rows, and say which files they are in."""
    if name in catalogue.names("table") or not (Path(name).suffix == ".nc" or is_study(name)):
        return _write(options, name)
    from .spreadsheet import write_rows  # it imports pandas

    return write_rows(options, name)


def tradeoff(options, name: str) -> int:
    """Measure what no study file makes, of this name, and say in which file it is."""
    from ..figures import figure_results

    force = getattr(options, "force", False)  # `plot` and `table` have no such option
    figure_results.results(name, options.results, force=force, command=command_line())
    answer(f"{options.results}/{name}.nc")
    return 0


def _write(options, name: str) -> int:
    kind = KINDS[options.command]
    bare = kind == "figure" and options.bare
    make = catalogue.tabulate if kind == "table" else catalogue.draw
    make = partial(make, bare=True) if bare else make
    if options.run:
        make = make if bare else partial(catalogue.renewed, kind)
        code = _prepared(options, kind, name)
        if code or not (bare or catalogue.outdated(kind, name, options.results, options.folder)):
            return code
    second_process = _second_process(options, kind, bare)
    try:
        result = second_process.result_of(name) if second_process else None
        if result is None:
            answer(*make(name, options.results, options.folder))
        else:
            answer(*(catalogue.noted(kind, name, options.folder, *result) if options.run and not bare else result[1]))
    except (StudyError, OSError, MemoryError):
        raise
    except Exception as error:  # from the function of the figure or table; the others are still made
        log.info("%s", name, exc_info=True)
        raise StudyError([f"{name}: its function fails: {_in_words(error)}"], code=1) from error
    return 0


def _prepared(options, kind: str, name: str) -> int:
    """Compute the missing cases of the studies that a figure or table needs. Returns the exit code."""
    studies = catalogue.needed(kind, name)
    return max((_ready(options, study, study_beside(kind, name)) for study in studies), default=0)


def _second_process(options, kind: str, bare: bool) -> "SecondProcess | None":
    """The second process of a command that draws many figures; None for a few, since it takes a while to start.

    It gets the figures that can be drawn. Studies are run before the first figure is drawn.
    """
    if kind == "figure" and len(options.names) >= MANY and not hasattr(options, "second"):
        names = [name for name in dict.fromkeys(options.names) if _waits(options, kind, name, bare)]
        tasks = {name: (kind, name, options.results, options.folder, bare) for name in names}
        from ..work.second_process import SecondProcess

        options.second = SecondProcess(catalogue.written, tasks)
        atexit.register(options.second.end)
    return getattr(options, "second", None)


def _waits(options, kind: str, name: str, bare: bool) -> bool:
    """Whether a figure is to be drawn, and can be, as far as that is known beforehand."""
    if name == catalogue.CAPTIONS:
        return False
    try:
        if options.run and _prepared(options, kind, name):
            return False
        return bare or not options.run or catalogue.outdated(kind, name, options.results, options.folder)
    except StudyError:  # the error is reported when the figure's turn comes
        return False


def _ready(options, study: str, folder: Path | None) -> int:
    """Compute the missing cases of a study, if this command has not done so yet.

    folder : where its file is searched for first

    Results of the same study file are replaced; others are refused as by `run`, once.
    """
    codes = vars(options).setdefault("codes", {})  # study -> exit code, of this command
    try:
        if study not in codes and is_measured(study):
            codes[study] = tradeoff(options, study)
        elif study not in codes:
            codes[study] = completed(load(study_file(study, folder), options.results), renew=True)
    except StudyError as error:
        say(str(error), sys.stderr)
        codes[study] = error.code
    return codes[study]

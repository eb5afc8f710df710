"""The commands that draw and tabulate results. Each takes one name and returns an exit code."""

import logging
import sys
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from .. import catalogue
from ..api import load
from ..data.provenance import command_line
from ..evidence import tradeoff as measured
from ..figures.lines import drawn
from ..figures.style import style
from ..files.access import Unusable
from ..files.results_file import open_results
from ..spec.definition import StudyError
from ..spec.grid import twins
from ..terminal import answer, on_one_line, say
from .arguments import known_studies, study_file
from .computing import completed

log = logging.getLogger(__name__)


def items(options) -> list[str]:
    """The names of figures, tables or studies that were given; "all" stands for those that need no long study."""
    known = catalogue.FIGURES if options.command == "plot" else catalogue.TABLES
    return catalogue.usual(known) if options.items == ["all"] else options.items


def plot(options, name: str) -> int:
    """Draw a figure, or curves of results, and say which files it is in."""
    if options.x or options.y or options.hue or options.where:
        return _curves(options, name)
    try:
        return _write(options, name, catalogue.FIGURES)
    except StudyError:
        what = "file" if Path(name).suffix == ".nc" else "study"
        if name in catalogue.FIGURES or not (what == "file" or name in known_studies()):
            raise
        how = "give --x and --y to draw curves of it, such as --x P --y a"
        raise StudyError([f"{name} is a {what}, not a figure: {how}"]) from None


def _curves(options, name: str) -> int:
    """Draw one quantity of the results of a study, or of a file, against another."""
    if not (options.x and options.y):
        raise StudyError(["curves of results need both --x and --y, such as --x P --y p_max"])
    for i, _ in twins([axis for axis, _ in options.where]):
        raise StudyError([f"--where {options.where[i][0]} is given twice"])
    if Path(name).suffix == ".nc":
        if not Path(name).exists():
            raise StudyError([f"{name}: does not exist"])
        try:
            found = open_results(name)
        except Unusable as error:
            raise StudyError(error.messages) if error.kind == "foreign" else error from None
    else:
        study = load(study_file(name), options.results)
        if options.run and (code := completed(study)):
            return code
        found = study.open()
    with style():
        figure, columns = drawn(found, options.x, options.y, options.hue, dict(options.where), Figure)
    stem = f"{Path(name).stem}_{options.y}"
    title = f"{Path(name).stem}: {options.y} against {options.x}"
    answer(*catalogue.save(Path(options.folder) / stem, figure, columns, title))
    return 0


def table(options, name: str) -> int:
    """Write a table, and say which files it is in."""
    return _write(options, name, catalogue.TABLES)


def tradeoff(options, _) -> int:
    """Measure error against time, and say in which file it is."""
    force = getattr(options, "force", False)  # `plot` and `table` have no such option
    measured.results(options.results, force=force, command=command_line())
    answer(f"{options.results}/tradeoff.nc")
    return 0


def _write(options, name: str, known: dict) -> int:
    make = catalogue.tabulate if known is catalogue.TABLES else catalogue.draw
    if options.run:
        make = partial(catalogue.renewed, known)
        code = max((_ready(options, study) for study in catalogue.needed(name, known)), default=0)
        if code or not catalogue.outdated(name, known, options.results, options.folder):
            return code
    try:
        answer(*make(name, options.results, options.folder))
    except (StudyError, OSError):
        raise
    except Exception as error:  # of the function of the figure or table; the others are made
        log.info("%s", name, exc_info=True)
        reason = f"{type(error).__name__}: {on_one_line(str(error), 300)}"
        wrong = f"{name}: its function fails: {reason}; -v before the command shows where"
        raise StudyError([wrong], code=1) from error
    return 0


def _ready(options, study: str) -> int:
    """Compute what is missing of a study, if this command has not done so yet.

    Results that the same study file made are replaced; others are refused as by `run`, once.
    """
    codes = vars(options).setdefault("codes", {})  # study -> exit code, of this command
    try:
        if study not in codes and study == "tradeoff":
            codes[study] = tradeoff(options, study)
        elif study not in codes:
            codes[study] = completed(load(study_file(study), options.results), renew=True)
    except StudyError as error:
        say(str(error), sys.stderr)
        codes[study] = error.code
    return codes[study]

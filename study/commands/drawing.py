"""The commands that draw and tabulate results. Each does it for one name and returns an exit code."""

from .. import catalogue
from ..api import load
from ..data.provenance import command_line
from ..evidence import tradeoff as measured
from ..terminal import answer
from .arguments import study_file
from .computing import completed


def items(options) -> list[str]:
    """Names of figures or tables; "all" stands for those that no long study is needed for."""
    known = catalogue.FIGURES if options.command == "plot" else catalogue.TABLES
    return catalogue.usual(known) if options.items == ["all"] else options.items


def plot(options, name: str) -> int:
    """Draw a figure, and say which files it is in."""
    return _write(options, name, catalogue.FIGURES, catalogue.draw)


def table(options, name: str) -> int:
    """Write a table, and say which files it is in."""
    return _write(options, name, catalogue.TABLES, catalogue.tabulate)


def tradeoff(options, _) -> int:
    """Measure error against time, and say in which file it is."""
    return _measured(options, options.force)


def _write(options, name: str, known: dict, make) -> int:
    if options.run:
        code = max((_ready(options, study) for study in catalogue.needed(name, known)), default=0)
        if code or not catalogue.outdated(name, known, options.results, options.folder):
            return code
    answer(*make(name, options.results, options.folder))
    return 0


def _ready(options, study: str) -> int:
    """Compute what is missing of a study of this repository, once; its results of an older version may be replaced."""
    codes = vars(options).setdefault("codes", {})
    if study not in codes and study == "tradeoff":
        codes[study] = _measured(options, force=False)
    elif study not in codes:
        codes[study] = completed(load(study_file(study), options.results), force=True)
    return codes[study]


def _measured(options, force: bool) -> int:
    measured.results(options.results, force=force, command=command_line())
    answer(f"{options.results}/tradeoff.nc")
    return 0

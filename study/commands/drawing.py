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
    return catalogue.usual(_known(options)) if options.items == ["all"] else options.items


def plot(options, name: str) -> int:
    """Draw a figure, and say which files it is in."""
    return _write(options, name, catalogue.draw)


def table(options, name: str) -> int:
    """Write a table, and say which files it is in."""
    return _write(options, name, catalogue.tabulate)


def tradeoff(options, _) -> int:
    """Measure error against time."""
    return _measured(options, options.force)


def _known(options) -> dict:
    return catalogue.FIGURES if options.command == "plot" else catalogue.TABLES


def _write(options, name: str, make) -> int:
    """Write a figure or a table; with --run first compute the studies that it needs, each once for all of them."""
    if options.run:
        codes, studies = vars(options).setdefault("codes", {}), catalogue.needed(name, _known(options))
        for study in studies:
            codes[study] = codes[study] if study in codes else _prepared(study, options)
        code = max((codes[study] for study in studies), default=0)
        if code or not catalogue.outdated(name, _known(options), options.results, options.folder):
            return code
    answer(*make(name, options.results, options.folder))
    return 0


def _prepared(study: str, options) -> int:
    """Compute what is missing of a study of this repository; its results of an older version may be replaced."""
    if study == "tradeoff":
        return _measured(options, force=False)
    return completed(load(study_file(study), options.results), force=True)


def _measured(options, force: bool) -> int:
    measured.results(options.results, force=force, command=command_line())
    answer(f"{options.results}/tradeoff.nc")
    return 0

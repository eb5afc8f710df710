"""The commands that draw and tabulate results. Each does it for one name and returns an exit code."""

from pathlib import Path

from .. import catalogue, tables
from ..data.provenance import command_line
from ..evidence import tradeoff as measured
from ..evidence import tradeoff_page
from ..figures.sources import write_text
from ..terminal import answer


def plot(options, name: str) -> int:
    """Draw a figure, and say which files it is in."""
    answer(*catalogue.draw(name, options.results, options.figures))
    return 0


def table(options, name: str) -> int:
    """Write a table, and say which files it is in."""
    answer(*tables.tabulate(name, options.results, options.tables))
    return 0


def tradeoff(options, _) -> int:
    """Measure error against time, and write the page about it."""
    found = measured.results(options.results, force=options.force, command=command_line())
    answer(write_text(Path(options.docs) / "tradeoff.md", tradeoff_page.page(found)))
    return 0

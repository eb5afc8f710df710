"""The tables of docs/literature.md; its text is written by hand: `make literature` runs this."""

import re
import sys
from pathlib import Path

from study.figures.formats import formatted
from study.figures.registry import entry, open_studies


def markdown(name: str, results) -> str:
    """A registered table in Markdown."""
    table = entry("table", name)
    cells = [[column.text for column in table.columns], ["---"] * len(table.columns)]
    cells += formatted(table, table.rows(*open_studies(name, table.studies, results)))
    return "".join(f"| {' | '.join(row)} |\n" for row in cells)


def page(text: str, results="results") -> str:
    """The text of a page. Each table after a line "<!-- table NAME -->" is written anew from the results."""
    return re.sub(r"(<!-- table (\w+) -->\n\n)(?:[|].*\n)*", lambda match: match[1] + markdown(match[2], results), text)


if __name__ == "__main__":
    path = Path(sys.argv[1])
    path.write_text(page(path.read_text(encoding="utf-8")), encoding="utf-8")

"""A table as aligned text, CSV (full precision) and LaTeX (booktabs)."""

import csv
import io
import re
from pathlib import Path
from typing import Any

from ..files.atomic import remove_temporary, replacing
from ..inputs.definition import StudyError
from ..terminal import shown
from .registry import Column, DataTable

STALE = 3600
"""Seconds after which a temporary file has no writer any more: a figure takes some seconds. A younger file may belong
to another program that draws the same figure."""
#: Beginning of a text that spreadsheets compute when they open a CSV, some after blanks; the last four are wide
#: letters.
_FORMULA = re.compile("\\s*[=+\\-@\uff1d\uff0b\uff0d\uff20]|[\\t\\r\\n]")
_NONE = "-"  # stands in tables for a missing number: alone it is a text everywhere


def as_text(table: DataTable, rows: list[tuple]) -> str:
    """Aligned columns: text to the left, numbers to the right."""
    cells = [[column.text for column in table.columns], *formatted(table, rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    marks = ["<" if column.form == "s" else ">" for column in table.columns]
    lines = ["  ".join(f"{c:{m}{w}}" for c, m, w in zip(row, marks, widths, strict=True)).rstrip() for row in cells]
    return "\n".join([table.caption, "", lines[0], "-" * max(map(len, lines)), *lines[1:]]) + "\n"


def as_latex(table: DataTable, rows: list[tuple]) -> str:
    """A table environment of LaTeX, which needs the package booktabs."""
    form = "".join("l" if column.form == "s" else "r" for column in table.columns)
    begin = [r"\begin{table}", r"\centering", rf"\caption{{{latex(table.caption)}}}", rf"\begin{{tabular}}{{{form}}}"]
    head = " & ".join(column.latex or latex(column.text) for column in table.columns) + r" \\"
    lines = [" & ".join(map(latex, row)) + r" \\" for row in formatted(table, rows)]
    end = [r"\end{tabular}", r"\end{table}"]
    return "\n".join([*begin, r"\toprule", head, r"\midrule", *lines, r"\bottomrule", *end]) + "\n"


def formatted(table: DataTable, rows: list[tuple]) -> list[list[str]]:
    """Cells as text; a text in a column of numbers stays as it is.

    Raises StudyError, which names the column, for a cell that its format does not fit.
    """
    return [[_cell(column, cell) for column, cell in zip(table.columns, row, strict=True)] for row in rows]


def _cell(column: Column, cell: object) -> str:
    if isinstance(cell, str):
        return cell
    try:
        return f"{cell:{column.form}}"
    except (TypeError, ValueError):
        form = "has no format" if column.form == "s" else f'has the format "{column.form}"'
        example = f'write one behind it, "{column.text} | .4g"'
        raise StudyError(
            [f'column "{column.text}" {form}, which does not fit {shown(cell)}: {example}'], code=1
        ) from None


def latex(cell: str) -> str:
    """A formatted cell or a caption for LaTeX: powers of ten are written out, special characters escaped; in a text
    with $ only % is escaped."""
    text = re.sub(r"(?<!\\)%" if "$" in cell else r"(?<!\\)[%&#_^]", r"\\\g<0>", cell).replace(r"\^", r"\^{}")
    return re.sub(r"([\d.+-]+)e([+-]\d+)$", lambda match: rf"${match[1]}\times 10^{{{int(match[2])}}}$", text)


def csv_text(headings, rows) -> str:
    """CSV with one line of headings. Texts that a spreadsheet would compute are `guarded`."""
    stream = io.StringIO()
    lines = ([guarded(cell) for cell in row] for row in (headings, *rows))
    csv.writer(stream, lineterminator="\n").writerows(lines)
    return stream.getvalue()


def guarded(cell: Any) -> Any:
    """A text that a spreadsheet would take for a formula, such as "=1+1", after an apostrophe; numbers as they are."""
    if not isinstance(cell, str) or cell == _NONE:
        return cell
    text = re.sub("\r\n?", "\n", cell)  # csv does not quote \r, which would end the row
    return f"'{text}" if _FORMULA.match(cell) else text


def write(path: Path, content: str | bytes) -> Path:
    """Write a file completely or not at all, and make its folder; returns the path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    remove_temporary(path, STALE)
    with replacing(path) as temporary:
        temporary.write_bytes(content.encode() if isinstance(content, str) else content)
    return path

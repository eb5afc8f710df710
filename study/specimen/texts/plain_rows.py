"""Rows of numbers, with missing points among them, by numpy."""

from array import array

import numpy as np

from ..scan import FEWEST
from .text_lines import MISSING, Lines, fields_of, width_of

#: Bytes of lines that have only numbers. Of the words that they spell, numpy reads no others than `values_of` does.
_PLAIN = b"0123456789+-.eE;, \t\n"
#: Characters of the lines that numpy reads at a time: so many stay in the cache of the processor.
CHARACTERS = 2**18


def plain_rows(contents: Lines, dialect: tuple) -> tuple[np.ndarray, np.ndarray] | None:
    """The table and the numbers of its lines, read by numpy in blocks of lines.

    None where numpy cannot: some lines have other words, quotation marks, another length or other marks.
    """
    first = contents[0][1]
    width, step = len(fields_of(first, dialect[0])), 1 + CHARACTERS // (len(first) + 1)
    values, numbers = array("d"), array("q")  # they grow where they are; to join blocks takes twice the memory
    words: list[str] = []  # for missing points, in the blocks so far; each takes time in every block
    for begin in range(0, len(contents), step):
        lines = contents.texts[begin : begin + step]
        places = np.arange(begin, begin + len(lines))
        table = None if words else _by_numpy(lines, dialect, words)
        if table is None or len(table) != len(lines):
            filled = _filled(lines, dialect[0])
            lines, places = [lines[i] for i in filled], places[filled]
            if not lines:
                continue
            table = _by_numpy(lines, dialect, words)
            if table is None:
                words = _words(lines, dialect[0], width)
                table = _by_numpy(lines, dialect, words)
        if table is None or table.shape != (len(lines), width):
            return None  # the reader of single rows reports the error, if there is one
        values.frombytes(table.tobytes())
        numbers.frombytes((contents.first + places).tobytes())
    table = np.frombuffer(values).reshape(-1, width)
    return table[:, : width_of(table)], np.frombuffer(numbers, dtype=np.int64)


def _by_numpy(lines: list[str], dialect: tuple, words: list[str]) -> np.ndarray | None:
    """The numbers of lines with `words` for missing points; None for lines with others, or of several lengths."""
    separator, mark = dialect
    text = "\n".join(lines)
    letters = text.encode().translate(None, _PLAIN).lower()
    if b"nan" in letters and ("-nan" in (lowered := text.lower()) or "+nan" in lowered):
        return None
    if words:
        gap = separator or " "
        text = _between_gaps(text, separator)
        for word in words:  # neighbours share a gap; a replacement takes twice the time of a split
            for _ in range(2):
                text = f"{gap}nan{gap}".join(text.split(f"{gap}{word}{gap}"))
        lines = text[1:-1].split(f"{gap}\n{gap}")
        letters = letters and text.encode().translate(None, _PLAIN)
    if letters.replace(b"nan", b"") or (mark == "," and "." in text):
        return None
    if mark == ",":
        lines = [content.replace(",", ".") for content in lines]
    if not text or text.isspace():  # numpy would warn
        return np.empty((0, 1))
    try:
        return np.loadtxt(lines, delimiter=separator, comments=None, ndmin=2)  # it skips lines without fields
    except ValueError:
        return None


def _between_gaps(text: str, separator: str | None) -> str:
    """Lines in lower case, with each field between two separators, and without spaces beside them."""
    gap = separator or " "
    text = text.lower() if separator else text.lower().replace("\t", " ")
    text = gap + text.replace("\n", f"{gap}\n{gap}") + gap
    for padding in (f" {gap}", f"{gap} ") if separator and " " in text else ():
        while padding in text:
            text = text.replace(padding, gap)
    return text


def _words(lines: list[str], separator: str | None, width: int) -> list[str]:
    """The words for missing points in some lines, nan excepted."""
    text, gap = _between_gaps("\n".join(lines), separator), separator or " "
    # an empty field that ends a row of two may be what is left of a number
    words = MISSING if separator and width > 2 else MISSING[1:]
    return [word for word in words if word != "nan" and f"{gap}{word}{gap}" in text]


def _filled(lines: list[str], separator: str | None) -> list[int]:
    """The places of the lines that are rows: the others have few fields, all of them empty."""
    gaps = f"{separator or ''} \t"
    return [
        i
        for i, content in enumerate(lines)
        if content.strip(gaps) or (separator and content.count(separator) >= FEWEST - 1)
    ]

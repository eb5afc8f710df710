"""Text files of scans: their encoding, the separator and the decimal mark, which lines are heading and which are rows.

scan_headings reads the content of the heading.
"""

import re
from array import array
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from solver.numerics import userfile

from .scan import FEWEST
from .texts.plain_rows import CHARACTERS, plain_rows
from .texts.text_lines import MISSING, Lines, fields_of, values_of, width_of

#: (separator, decimal mark) of a text file. The first pair that fits the first line of numbers holds. If that line has
#: only whole numbers, the first line with a decimal mark shows the mark. (",", ",") fits only fields in quotation
#: marks.
DIALECTS = ((";", "."), (";", ","), ("\t", "."), ("\t", ","), (",", "."), (None, "."), (None, ","), (",", ","))
#: Number of rows that are packed into an array at a time.
_BLOCK = 10_000
#: "1,024": the comma may separate thousands.
_THOUSAND = re.compile(r"(?<!\d)[1-9]\d{0,2},\d{3}(?!\d)")
#: A comment begins a line or follows a gap: "-1.#IND" has none.
_COMMENT = re.compile(r"(?:^|(?<=[\s;,]))[#%].*")
#: Characters that no text has. The end marks 3 and 26, which texts of ISO 5436-2 have, are not among them.
_BINARY = re.compile(r"[\x00-\x02\x04-\x08\x0e-\x19\x1b-\x1f]")
#: Characters with which a number ends, and begins.
_DIGITS, _BEGINS = frozenset("0123456789"), frozenset("0123456789+-.")
#: The bytes of texts in UTF-8.
_OF_TEXTS = bytes(code for code in range(256) if not _BINARY.match(chr(code)))
_CHANNEL = re.compile(r"[#%\s]*(?:channel|kanal|kanál|canale?)\s*[:=]\s*(.+?)\s*$", re.IGNORECASE)
#: Zygo writes "No Data" in the place of z.
_NO_DATA = re.compile(r"(?i)^(\s*[-+\d.,eE]+[\s;,]+[-+\d.,eE]+[\s;,]+)no\s+data[\s;,]*$")


@dataclass(frozen=True, eq=False)
class NumberTable:
    """The numbers of a text file, shape (rows, columns), NaN where a point is missing, and the text around them.

    heading : (number, text) of each line that is not a row, comments included
    separator : between the columns; None: spaces
    channel : name of the channel in the heading, or ""
    notes : sentences about lines of numbers that were not read as rows
    """

    numbers: np.ndarray
    heading: tuple[tuple[int, str], ...] = ()
    separator: str | None = None
    channel: str = ""
    notes: tuple[str, ...] = ()


def text_of(path: Path) -> str | None:
    """The text of a file in UTF-8, UTF-16 or Latin-1, unpacked if it is gzip; None if it is not text."""
    try:
        is_text = not _BINARY.search(userfile.begins(path).decode("latin-1"))  # text in UTF-16 has such bytes too
        most = userfile.LARGEST_TEXT if is_text else userfile.LARGEST
        raw = userfile.unpacked(userfile.content(path, most), most)
    except ValueError as error:  # of userfile
        raise ValueError(f"{path.name}: {error}") from error
    if raw.startswith(b"ISO 5436"):  # separated by zeros
        raw = raw.replace(b"\0", b" ")
    zeros = [raw[parity::2].count(0) for parity in (0, 1)] if b"\0" in raw else [0, 0]
    encodings = ["utf-8-sig", "latin-1"]  # older instruments write a µ of Latin-1 in the heading
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        encodings = ["utf-16"]
    elif min(zeros) == 0 and max(zeros) > len(raw) / 3:  # every second byte of European text in UTF-16 is 0
        encodings = ["utf-16-be" if zeros[0] else "utf-16-le"]
    for encoding in encodings:
        try:
            text = raw.decode(encoding)
        except UnicodeDecodeError:
            continue
        if _is_binary(text):
            return None
        text = text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text  # a pair takes longer to find
        return text.replace("−", "-")
    return None


def _is_binary(text: str) -> bool:
    """Whether a text has characters that no text has. The deletion takes a tenth of the time of a search."""
    blocks = (text[i : i + CHARACTERS] for i in range(0, len(text), CHARACTERS))
    return any(block.encode().translate(None, _OF_TEXTS) for block in blocks)


def table_of(text: str, name: str, channel: str | None = None) -> NumberTable:
    """The rows of numbers in a text, and its heading.

    A line before the first clean row that has as many fields, most of them numbers, is a row too.

    Raises ValueError: there are no numbers; a row has another number of fields, or a word, which the message names with
    its line; no channel of several is chosen, or one that the file does not have.
    """
    lines, channel_note = _of_channel(Lines(text.split("\n"), 1), name, channel)
    contents = Lines([_content(full) for full in lines.texts], lines.first)
    if text.startswith("Zygo XYZ") and (mark := next((i for i, (_, full) in enumerate(lines) if full == "#"), 0)):
        contents.texts[:mark] = [""] * mark  # numbers of the instrument
    first, dialect, counts = _first_row(contents, name)
    before = _missing_rows(contents[:first], dialect, len(fields_of(contents[first][1], dialect[0])))
    first -= before
    table, numbers, dialect, cut = _rows(contents[first:], dialect, name)
    if cut and table.shape[1] == 2:
        raise ValueError(f"{name}, line {numbers[-1]}: 1 number(s) after lines of 2: the file may be cut off")
    _refuse_rows_in_heading(contents[:first], dialect, table, name)
    if table[0, 0] == len(table) - 1 > 0 and np.isnan(table[0, 1:]).all():  # the number of the points that follow
        counts, table, numbers = [contents[first]], table[1:], numbers[1:]
        if table.shape[1] == 1 and _whole(table):
            raise ValueError(
                f"{name}, line {counts[0][0]}: {counts[0][1].strip()} may be a height or the number of the others: "
                "take it out if it is their number, or write it with a decimal point"
            )
    for number, content in counts:
        _check_counts(number, content, table.shape, name)
    notes = tuple(f"line {line}, {content.strip()!r}, is taken for the size of the table" for line, content in counts)
    is_row = np.zeros(len(lines.texts), dtype=bool)
    is_row[numbers - lines.first] = True
    rest = ((lines.first + int(i), lines.texts[i].strip()) for i in np.flatnonzero(~is_row))
    heading = tuple((number, full) for number, full in rest if full)
    return NumberTable(table, heading, dialect[0], channel_note, notes)


def _rows(contents: Lines, dialect: tuple, name: str) -> tuple[np.ndarray, np.ndarray, tuple, bool]:
    """The table (rows, columns), the numbers of its lines, its dialect, and whether the last row may be cut off.

    Raises ValueError for a row with a word or with another number of fields.
    """
    plain = plain_rows(contents, dialect)
    if plain is not None:
        return (*plain, dialect, False)
    table, numbers, cut = _Table(name), array("q"), False
    for number, content in contents:
        fields = fields_of(content, dialect[0])
        if not any(fields) and len(fields) < FEWEST:
            continue
        values = values_of(fields, dialect[1])
        # rows such as "0;0" do not show the decimal mark
        if None in values and table.is_whole() and not _THOUSAND.search(content):
            by_comma = values_of(fields, ",")
            if None not in by_comma:
                dialect, values = (dialect[0], ","), by_comma
        if None in values:
            raise ValueError(
                f"{name}, line {number}: {content.strip()[:60]!r} has something other than numbers: "
                f"{fields[values.index(None)][:30]!r}. Missing points may be empty fields, nan, Bad, ***, -- or -; "
                "remove every line that is not a row of the table"
            )
        table.add(values, number)
        numbers.append(number)
        cut = fields[-1] == "" and len(values) == 2
    return table.even(), np.array(numbers), dialect, cut


def _of_channel(lines: Lines, name: str, channel: str | None) -> tuple[Lines, str]:
    """The lines of one channel, and its name. Gwyddion writes several channels into one file, one after the other."""
    starts = [
        (i, match[1])
        for i, full in enumerate(lines.texts)
        if full[:1] not in _BEGINS and (match := _CHANNEL.match(full))
    ]
    names = [label for _, label in starts]
    if channel is not None and names.count(channel) != 1:
        listed = ", ".join(map(repr, names)) or "none by name; choose columns of text with columns="
        raise ValueError(f"{name}: channel = {channel!r}, but the file has {listed}")
    ends = [*(i for i, _ in starts), len(lines)][1:]
    have_numbers = [
        any(_dialect(_content(full)) for _, full in lines[i:end]) for (i, _), end in zip(starts, ends, strict=True)
    ]
    if channel is None and sum(have_numbers) > 1:
        raise ValueError(f"{name}: the file has the channels {', '.join(map(repr, names))}: choose one with channel=")
    if channel is None or len(names) == 1:
        return lines, names[-1] if names else ""
    i = names.index(channel)
    return lines[starts[i][0] : ends[i]], channel


def _content(full: str) -> str:
    """A line without comments and end marks."""
    content = _COMMENT.sub("", full) if "#" in full or "%" in full else full
    if content[-1:] in _DIGITS:
        return content
    content = _NO_DATA.sub(r"\1nan", content) if "ata" in content[-12:].lower() else content
    return content.rstrip("\x03\x1a ")


def _dialect(content: str) -> tuple | None:
    """Separator and decimal mark of a clean row, which has only numbers and missing points; None for other lines."""
    for separator, mark in DIALECTS:
        if separator and separator not in content.strip(" "):
            continue
        values = values_of(fields_of(content, separator), mark)
        if None not in values and not np.isnan(values).all():
            return separator, mark
    return None


def _first_row(contents: Lines, name: str) -> tuple[int, tuple, list]:
    """Index of the first row, its dialect, and the lines of one or two numbers before it, which are counts of rows."""
    counts = []
    clean = ((i, fits) for i, (_, content) in enumerate(contents) if (fits := _dialect(content)))
    for i, dialect in clean:
        later = next((content for _, content in contents[i + 1 :] if content.strip()), "")
        width, next_dialect = len(fields_of(contents[i][1], dialect[0])), _dialect(later)
        if width > 2 or not next_dialect or len(fields_of(later, next_dialect[0])) <= width or counts:
            return i, dialect, counts
        counts.append(contents[i])
    raise ValueError(f"{name}: no line of numbers in it; columns of numbers are read")


def _check_counts(number: int, content: str, shape: tuple, name: str) -> None:
    """Raise ValueError for a line before the table that does not say how many rows, columns or points it has."""
    sizes = sorted(float(field) for field in re.split(r"[\s;,]+", content.strip()) if field)
    if sizes not in ([shape[0]], [shape[1]], [shape[0] * shape[1]], sorted(shape)):
        raise ValueError(
            f"{name}, line {number}: {content.strip()!r} before a table of {shape[0]} rows of {shape[1]} is not their "
            "number. If it is a distance, give it as dx; if a scale of the heights, multiply them; then take it out"
        )


def _missing_rows(contents: Lines, dialect: tuple, width: int) -> int:
    """Number of lines right before the first clean row that are rows of missing points alone."""
    rows = 0
    for _, content in reversed(contents):
        fields = fields_of(content, dialect[0])
        words = [field.lower() for field in fields]
        is_single = width == 1 and words in (["nan"], ["bad"])  # a line of "--" under a heading is a rule
        if not is_single and not (len(fields) == width >= FEWEST and set(words) <= set(MISSING)):
            break
        rows += 1
    return rows


def _whole(values: np.ndarray) -> bool:
    return bool((np.isnan(values) | (values % 1 == 0)).all())


class _Table:
    """Rows as they come, as wide as the first. Empty fields after the last number are trailing separators."""

    def __init__(self, name: str):
        self.name, self.width = name, 0
        self.blocks: list[np.ndarray] = []  # a number of Python takes three times as much memory
        self.rows: list[list[float]] = []
        self.lengths, self.numbers = array("q"), array("q")

    def add(self, values: list[float], number: int) -> None:
        """Add a row. Raises ValueError for a row with more numbers than the first has fields."""
        self.width = self.width or len(values)
        last = next((i for i in range(len(values), self.width, -1) if values[i - 1] == values[i - 1]), 0)
        self.lengths.append(len(values))
        self.numbers.append(number)
        self.rows.append((values + [np.nan] * (self.width - len(values)))[: self.width])
        if last:
            self._check(self.width, last)
        if len(self.rows) == _BLOCK:
            self._pack()

    def _pack(self) -> None:
        if self.rows:
            self.blocks.append(np.array(self.rows))
            self.rows = []

    def is_whole(self) -> bool:
        """Whether all numbers so far are whole."""
        self._pack()
        return all(map(_whole, self.blocks))

    def _check(self, allowed: int, last: int = 0) -> None:
        """Raise ValueError for the first row with fewer fields, or else for the last row, which has `last` numbers."""
        short = np.flatnonzero(np.array(self.lengths) < allowed)
        if not short.size and not last:
            return
        i = short[0] if short.size else -1
        if short.size:
            self._pack()
            row = np.concatenate(self.blocks)[i]
            last = int(np.max(np.flatnonzero(~np.isnan(row)), initial=-1)) + 1
        raise ValueError(
            f"{self.name}, line {self.numbers[i]}: {last} number(s) after lines of {allowed}; remove every "
            "line that is not a row of the table"
        )

    def even(self) -> np.ndarray:
        """All rows, up to the last column that has a number. Raises ValueError for a row with fewer fields."""
        self._pack()
        table = np.concatenate(self.blocks)
        width = width_of(table)
        self._check(width)
        return table[:, :width]


def _refuse_rows_in_heading(contents: Lines, dialect: tuple, table: np.ndarray, name: str) -> None:
    """Raise ValueError for a line of the heading that is a row of the table except for a word in it."""
    width = table.shape[1]
    for number, content in contents:
        fields = fields_of(content, dialect[0])
        if len(fields) != width:
            continue
        values = values_of(fields, dialect[1])
        words = [field for field, value in zip(fields, values, strict=True) if value is None]
        mostly = len(words) < width / 2 and not all(value is None or value != value for value in values)
        if width == 2 and len(table) > 1 and values[0] is not None:  # "0.0 error" is one step before the first x
            step = table[1, 0] - table[0, 0]
            mostly = abs(values[0] + step - table[0, 0]) < 0.1 * abs(step)
        if words and mostly:
            raise ValueError(
                f"{name}, line {number}: {content.strip()[:60]!r} is a row of the table except for {words[0][:30]!r}. "
                "Missing points may be empty fields, nan, Bad, ***, -- or -; remove the line if it is a heading"
            )

"""Lines of a text, their fields, and the number or the missing point in each field."""

import csv
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

#: Words for a missing point in a row of numbers, in lower case.
MISSING = ("", "nan", "bad", "***", "--", "-")
#: A number in a text; `float` would also read "inf" and "1_000".
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


class Lines:
    """Lines of a text, as pairs of their number and text. A list of tuples would be larger than the text itself."""

    def __init__(self, texts: list[str], first: int):
        self.texts, self.first = texts, first

    def __getitem__(self, i: int | slice) -> Any:
        if isinstance(i, slice):
            return Lines(self.texts[i], self.first + i.indices(len(self.texts))[0])
        return self.first + i, self.texts[i]

    def __iter__(self) -> Iterator[tuple[int, str]]:
        return enumerate(self.texts, self.first)

    def __reversed__(self) -> Iterator[tuple[int, str]]:
        return ((self.first + i, self.texts[i]) for i in reversed(range(len(self.texts))))

    def __len__(self) -> int:
        return len(self.texts)


def fields_of(content: str, separator: str | None) -> list[str]:
    """The fields of a line. Spaces separate however many there are; other separators have a field between two."""
    if separator is None:
        return content.replace('"', " ").split()
    if '"' in content:
        content = next(csv.reader([content.strip(" ")], delimiter=separator, skipinitialspace=True), [])
        return [field.strip() for field in content]
    return [field.strip() for field in content.split(separator)]


def values_of(fields: list[str], mark: str) -> list[float | None]:
    """The number of each field, NaN where a point is missing, None where there is a word."""
    if mark == ",":  # then a point would separate thousands
        fields = [field.replace(",", ".") if "." not in field else "a point" for field in fields]
    return [
        float(field) if _NUMBER.fullmatch(field) else float("nan") if field.lower() in MISSING else None
        for field in fields
    ]


def width_of(table: np.ndarray) -> int:
    """The number of columns up to the last one that has a number."""
    return int(np.max(np.flatnonzero(~np.isnan(table).all(axis=0)), initial=-1)) + 1

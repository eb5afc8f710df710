"""Profiles of graded layers: how the modulus changes from the top of a layer to its bottom, given by a word or by a
table."""

import csv
import hashlib
import io
from typing import NamedTuple

import numpy as np

from .userfile import content, place

__all__ = ["GRADED", "PREFIX", "WORDS", "Profile", "identity", "read"]

#: "uniform" is not graded.
WORDS = ("uniform", "exponential", "linear")
GRADED = WORDS[1:]
#: "table:" and the path of a CSV file is a profile too.
PREFIX = "table:"
#: Most rows of a table, most bytes of its file, and the smallest and the largest modulus that it may have.
_ROWS, _LARGEST, _LEAST, _MOST = 10_000, 10_000_000, 1e-9, 1e9


class Profile(NamedTuple):
    """A profile with straight lines between its rows: z from 0 to 1, over the thickness, and n = E*/E2* (N,)."""

    z: np.ndarray
    n: np.ndarray


def read(word):
    """The :class:`Profile` of a word "table:FILE".

    The file has two columns, z/h from 0 to 1 and E*/E2* > 0. Lines that begin with "#" and a heading of words are
    skipped. Raises ValueError for a file that cannot be used.
    """
    path = word.removeprefix(PREFIX)
    try:
        text = io.StringIO(content(place(path), _LARGEST).decode("utf-8-sig"), newline="")
        lines = [line for line in csv.reader(text) if line and not line[0].lstrip().startswith("#")]
        lines = lines[1:] if lines and not is_number(lines[0][0]) else lines
        rows = np.array([[float(cell) for cell in line] for line in lines[: _ROWS + 1]])
    except (OSError, ValueError, csv.Error) as error:
        raise ValueError(f"profile {word}: cannot be read: {error}") from None
    if rows.ndim != 2 or rows.shape[1] != 2 or not 2 <= len(rows) <= _ROWS:
        raise ValueError(f"profile {word}: must have two columns, z/h and E*/E2*, and 2 to {_ROWS} rows")
    z, n = rows.T
    if z[0] != 0 or z[-1] != 1 or not np.all(np.diff(z) > 0):
        raise ValueError(f"profile {word}: z/h must grow from 0 to 1, not from {z[0]:g} to {z[-1]:g}")
    if not np.all((n >= _LEAST) & (n <= _MOST)):
        raise ValueError(f"profile {word}: E*/E2* must be in [{_LEAST:g}, {_MOST:g}]")
    return Profile(z, n)


def is_number(text):
    """Whether a text is a number."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def identity(word, tables):
    """Text that tells a profile from all others: its word, or for one of the `tables` (word -> :class:`Profile`) a
    digest of its numbers."""
    if word not in tables:
        return word
    return f"{PREFIX} {hashlib.sha256(np.concatenate(tables[word]).astype('<f8').tobytes()).hexdigest()}"

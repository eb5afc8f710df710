"""A shape from a user's table, ``shape = "table:tip.csv"``: a measured tip, for example.

The slope f' consists of straight lines. It goes through the slopes of the chords between the rows, each in the middle
of its chord. The first and the last line are continued to the axis and to the last row. f is the integral of f', and
need not meet the rows.
"""

import csv
import hashlib
import io
import re
from functools import partial
from typing import NamedTuple

import numpy as np

from ..numerics import batch
from ..numerics.profiles import is_number
from ..numerics.userfile import content, place
from ..parameters import Parameter
from .lines import Series, series_of
from .shape import Kind, column, load_by_quadrature

PREFIX = "table:"
#: Length in the unit of R that 1 in the table stands for; R if it is not given.
TABLE_UNIT = Parameter(
    interval="(0, inf)", powers=(0, 1), instead="", long_name="length that 1 in the table of the shape stands for"
)
#: Most rows, most bytes of the file, and the largest fall of the slope from chord to chord, over the largest slope: it
#: allows for rounding in a table that is straight there.
_ROWS, _LARGEST, _FALLS = 1_000, 10_000_000, 1e-9
#: A jump of f'' below this part of the largest f'' is rounding, not a kink.
_STRAIGHT = 1e-9
#: Units of length in a header, in m.
_UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "nm": 1e-9, "Å": 1e-10, "pm": 1e-12}
_HEADER = re.compile(r"\s*(\w+)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")


class Rows(NamedTuple):
    """The slope of a table: radii r (K,) from 0 to the last row, and f' there (K,), with straight lines between.

    metres : whether its lengths are in m, because the header has units
    series : F of a table with many rows, or None
    """

    r: np.ndarray
    slopes: np.ndarray
    metres: bool
    series: Series | None = None


@batch.of_cases
class TableShape(NamedTuple):
    """The :class:`~.shape.Shape` of one table, whose lengths are in `unit` (B,)."""

    rows: Rows
    unit: np.ndarray

    @property
    def pointed(self):
        return (self.rows.slopes[0] > 0) & (self.unit > 0)

    @property
    def even(self):
        return self.unit < 0

    def height(self, r):
        r = r / column(self.unit)
        knots, place, along = self._in_rows(r)
        first, last = self.rows.slopes[:-1], self.rows.slopes[1:]
        until = np.append(0.0, np.cumsum(np.diff(knots) * (first + last) / 2))
        slope = first[place] + self._bend[place] * along / 2
        return column(self.unit) * self._inside(r, until[place] + along * slope)

    def slope(self, r):
        r = r / column(self.unit)
        _, place, along = self._in_rows(r)
        return self._inside(r, self.rows.slopes[place] + self._bend[place] * along)

    def lifted(self, t):
        return t * self._lifted(t / column(self.unit), False)

    def lifted_slope(self, t):
        return self._lifted(t / column(self.unit), True)

    def lifted_load(self, a):
        return load_by_quadrature(self, a)

    def drop(self, a, s):
        # the integral of f' from r = ax to a: for each line, the length of its part there times the mean slope
        x = np.sqrt((1 - s) * (1 + s))
        radius = column(a / self.unit)
        r, inwards = radius * x, radius * (s**2 / (1 + x))
        knots, total = self.rows.r, 0.0
        same = np.searchsorted(knots, r, side="right") == np.searchsorted(knots, radius, side="right")
        for j, (low, high) in enumerate(zip(knots[:-1], knots[1:], strict=True)):
            start, end = np.clip(r, low, high), np.clip(radius, low, high)
            part = np.where(same & (start > low), inwards, end - start) * (end > start)
            total = total + part * (self.rows.slopes[j] + self._bend[j] * ((start + end) / 2 - low))
        return column(2 * self.unit / a**2) * self._inside(radius, total)

    def kinks(self):
        bend = self._bend
        jumps = np.abs(np.diff(bend)) > _STRAIGHT * np.abs(bend).max(initial=0.0)
        return column(self.unit) * self.rows.r[1:-1][jumps]

    def least(self):
        return 0 * self.unit

    def most(self):
        return self.unit * self.rows.r[-1]

    @property
    def _bend(self):
        """f'' (K - 1,) on each line."""
        return np.diff(self.rows.slopes) / np.diff(self.rows.r)

    def _in_rows(self, r):
        """The radii of the rows; the index of the line on which r lies; and the distance of r from the line's start."""
        knots = self.rows.r
        place = np.clip(np.searchsorted(knots, r, side="right") - 1, 0, len(knots) - 2)
        return knots, place, r - knots[place]

    def _inside(self, r, values):
        """The values; NaN where r is beyond the last row."""
        return np.where(r <= self.rows.r[-1] * (1 + 4 * np.finfo(float).eps), values, np.nan)

    def _lifted(self, t, slope):
        """F/t, or F' if `slope`."""
        if self.rows.series is None:
            return self._inside(t, _over_lines(self.rows, t)[int(slope)])
        return self._inside(t, self.rows.series.at(np.minimum(t, self.rows.r[-1]), slope))


def _over_lines(rows, t):
    """F/t and F' at t, as sums over the lines: of their slopes continued to r = 0, and of their bends."""
    knots, bend = rows.r, np.diff(rows.slopes) / np.diff(rows.r)
    start = rows.slopes[:-1] - bend * knots[:-1]
    inner = np.minimum(knots, t[..., None])
    cosines = np.sqrt((t[..., None] - inner) * (t[..., None] + inner))
    angles = np.arctan2(inner, cosines)
    angles[t == 0] = np.where(knots > 0, np.pi / 2, 0.0)
    over_t, bent = np.diff(angles) @ start, -np.diff(cosines) @ bend
    return over_t + bent, over_t + 2 * bent


def read(word):
    """The :class:`~.shape.Kind` of a word "table:FILE".

    The file has two columns, r from 0 upwards and f from 0 upwards. A header may have units, "r [um], f [nm]". Lines
    that begin with "#" are skipped. Raises ValueError for a file that cannot be used.
    """
    return Kind(word, {"table_unit": TABLE_UNIT}, partial(_bound, _rows(word)), "a measured tip")


def rows_of(kind):
    """The :class:`Rows` of a :class:`~.shape.Kind` that :func:`read` returns; None for any other kind."""
    return kind.of.args[0] if isinstance(kind.of, partial) and kind.of.func is _bound else None


def identity(kind):
    """Text that tells a :class:`~.shape.Kind` from all others: its name, or for a table a digest of its numbers."""
    rows = rows_of(kind)
    if rows is None:
        return kind.name
    numbers = np.concatenate([rows.r, rows.slopes, [float(rows.metres)]]).astype("<f8").tobytes()
    return f"{PREFIX} {hashlib.sha256(numbers).hexdigest()}"


def _bound(rows, table_unit, size):
    return TableShape(rows, np.where(np.isnan(table_unit) & (not rows.metres), 1.0, table_unit))


def _rows(word):
    path = word.removeprefix(PREFIX)
    try:
        reader = csv.reader(io.StringIO(content(place(path), _LARGEST).decode("utf-8-sig"), newline=""))
        lines = [(reader.line_num, line) for line in reader if line and not line[0].lstrip().startswith("#")]
    except (OSError, ValueError, csv.Error) as error:
        message = f"cannot be read: {error}" if path else 'names no file: "table:tip.csv"'
        raise ValueError(f"shape {word}: {message}") from None
    header = lines.pop(0)[1] if lines and not is_number(lines[0][1][0]) else []
    for number, line in lines:
        if len(line) != 2 or not all(is_number(cell) and np.isfinite(float(cell)) for cell in line):
            wanted = "must be two numbers, r and f, with a comma between them"
            raise ValueError(f"shape {word}: line {number}: {', '.join(line)}: {wanted}")
    if not 3 <= len(lines) <= _ROWS:
        raise ValueError(f"shape {word}: must have two columns, r and f, and 3 to {_ROWS} rows, not {len(lines)}")
    numbers, units = np.array([[float(cell) for cell in line] for _, line in lines]), _lengths(word, header)
    _check(word, *numbers.T, units[1] / units[0])
    return _of_columns(*(numbers * units).T, _has_units(header))


def _check(word, r, f, unit):
    """Raise ValueError if the rows are not those of a convex shape. r, f : as in the file; unit : the unit of f over
    that of r."""
    if r[0] != 0 or f[0] != 0:
        raise ValueError(f"shape {word}: r and f must be 0 in the first row, which is {r[0]:g}, {f[0]:g}")
    if (back := np.diff(r) <= 0).any():
        raise ValueError(f"shape {word}: r must grow from row to row, and {r[1:][back][0]:g} does not")
    chords = unit * np.diff(f) / np.diff(r)
    falls = np.diff(chords) < -_FALLS * np.abs(chords).max()
    if falls.any() or not chords[-1] > 0 or chords[0] < 0:
        where = f" beyond the row with r = {r[1:-1][falls][0]:g}" if falls.any() else ""
        way_out = "smooth it, or take the part around the axis that is"
        raise ValueError(f"shape {word}: is not convex{where}: the slope of f must not fall; {way_out}")


def _of_columns(r, f, metres):
    chords, middle = np.diff(f) / np.diff(r), (r[1:] + r[:-1]) / 2
    chords = np.maximum.accumulate(np.maximum(chords, 0.0))
    bend = np.diff(chords) / np.diff(middle)
    first = max(0.0, chords[0] - bend[0] * middle[0])
    last = chords[-1] + bend[-1] * (r[-1] - middle[-1])
    rows = Rows(np.concatenate([[0.0], middle, r[-1:]]), np.concatenate([[first], chords, [last]]), metres)
    return rows._replace(series=series_of(rows.r, lambda t: _over_lines(rows, t)))


def _lengths(word, header):
    """The length in m that 1 stands for in each column, by the units of the header; 1 without units."""
    if not _has_units(header):
        return 1.0, 1.0
    factors = []
    for cell in header:
        unit = (_HEADER.fullmatch(cell) or ["", "", ""])[2]
        if unit not in _UNITS:
            raise ValueError(f"shape {word}: the header {', '.join(header)} must name a length for each column, as um")
        factors.append(_UNITS[unit])
    return tuple(factors)


def _has_units(header):
    return any("[" in cell or "(" in cell for cell in header)

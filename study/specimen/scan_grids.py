"""From positions and heights as a file has them to a scan: .npy, x y z of a grid, rounded positions, the cropped part.

Lengths in the call override those that a file states, since a reader or a file may be wrong.
"""

import dataclasses
import math
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.lib.format import MAGIC_PREFIX

from solver.numerics.userfile import begins, opened

from .foreign import plain
from .quantities import has_unit, quantity, unit_in
from .scan import FEWEST, UNEVEN, Scan, height_map, metres, number, profile
from .scan_texts import NumberTable

#: Least share of the points of an x y z grid that must have heights: a disk in its square has 0.79.
FULL = 0.25
#: A position may be off the grid by its last written digit, if that is at most this share of the whole length.
COARSE = 0.01
#: A finite number this large is not a height in any unit: programs mark missing points with their largest number,
#: 1.7e38, 3.4e38 or 1.8e308, perhaps times the scale of the heights.
NO_HEIGHT = 1e20
#: Distances that differ by this share are equal: files round them.
EQUAL = 1e-6


class Lengths(NamedTuple):
    """Arguments of `scan_of`: positions and steps along each axis, units of positions and heights, notes."""

    positions: list[np.ndarray]
    steps: list[float] | None
    units: tuple[str, str]
    notes: tuple[str, ...]


def npy_table(path: Path) -> NumberTable:
    """The numbers in a .npy file. Raises ValueError: it is not a .npy file, or not an array of real numbers."""
    refused = f"{path.name}: not a .npy file of real numbers"
    head = begins(path, size=len(MAGIC_PREFIX))
    if head != MAGIC_PREFIX:  # numpy would open a zip, and speak of pickled data of all else
        zipped = "a zip file: save one array of it by numpy.save" if head.startswith(b"PK") else "of another format"
        raise ValueError(f"{refused}: it is {zipped if head else 'empty'}")
    try:
        with opened(path) as file:
            numbers = np.load(file, allow_pickle=False).astype(float, casting="same_kind", copy=False)
    except Exception as error:  # numpy evaluates the header, and allocates as much as it says
        raise ValueError(f"{refused}: {(str(error).splitlines() or [type(error).__name__])[0][:200]}") from error
    if numbers.ndim not in (1, 2) or not numbers.size:
        raise ValueError(f"{path.name}: an array of shape {numbers.shape}; allowed are one or two dimensions")
    return NumberTable(numbers.reshape(len(numbers), -1))


def without_holes(z: np.ndarray) -> tuple[np.ndarray, tuple[str, ...]]:
    """The numbers, with NaN for each that is too large for a height, and a note about these."""
    holes = np.isfinite(z) & ((z >= NO_HEIGHT) | (z <= -NO_HEIGHT))
    if not holes.any():
        return z, ()
    return np.where(holes, np.nan, z), (
        f"{holes.sum()} of {z.size} heights are larger than any: they are missing points",
    )


def columns_of(table: NumberTable, arguments: dict, name: str) -> tuple[np.ndarray, list]:
    """The columns of positions and heights, or all columns of a map, and the places of positions and heights.

    The place of the positions is None where dx stands for them.
    """
    numbers, dx, picked = table.numbers, arguments.get("dx"), plain(arguments.get("columns"))
    places = [0, -1]
    if picked is not None:
        picked = list(picked) if isinstance(picked, (list, tuple)) else [picked]
        places = all(type(i) is int and 0 <= i < numbers.shape[1] for i in picked)
        if len(picked) not in (1, 2, 3) or not places or len(picked) > max(2, len(set(picked))):
            raise ValueError(
                f"{name}: columns = {arguments['columns']}, but the file has the columns 0 to {numbers.shape[1] - 1}; "
                "allowed are two of them, for x and z, or one, for z, or three, for x, y and z"
            )
        numbers, places = numbers[:, picked], picked if len(picked) > 1 else picked * 2
    elif len(numbers) == 1:
        numbers = numbers.T
    elif numbers.shape[1] == 3:
        places = [0, 1, 2]
    n = numbers.shape[1]
    if n >= FEWEST and picked is None:
        _refuse_positions(numbers, name)
    if n >= FEWEST and dx is None:
        raise ValueError(f"{name}: a map of {numbers.shape[0]} × {n} heights: give dx (and dy), their distance")
    if n < FEWEST and (n > 3 or (n < 3 and ((n == 2) == (dx is not None) or "dy" in arguments))):
        steps_in_words = "".join(f" with {key} = {arguments[key]}" for key in ("dx", "dy") if key in arguments)
        raise ValueError(
            f"{name}: {numbers.shape[0]} rows of {n} column(s){steps_in_words}; allowed are "
            f"two columns (x, z), one column (z) with dx, three (x, y, z of a grid), or {FEWEST} columns and more (a "
            "map) with dx and dy. Choose among others with columns=(0, 2). A comma cannot separate columns and "
            "decimals."
        )
    return numbers, places if dx is None else [None, places[-1]]


def _refuse_positions(heights: np.ndarray, name: str) -> None:
    """Raise ValueError for a map whose first row or column has positions or numbers of the points."""
    for two, line in ((heights[:2], "row"), (heights[:, :2].T, "column")):
        present = [each[~np.isnan(each)] for each in two]  # pandas leaves the corner empty
        first, steps = present[0], [np.diff(each) for each in present]
        equal = [each.size > 1 and each[0] != 0 and np.ptp(each) <= 1e-6 * abs(each[0]) for each in steps]
        if equal[0] and not equal[-1]:
            raise ValueError(
                f"{name}: the first {line} has equal steps, {first[0]:g}, {first[1]:g}, {first[2]:g} ...: "
                "positions or numbers, not heights; take it out of the file"
            )


def on_grid(columns: np.ndarray, z: np.ndarray, arguments: dict, name: str) -> tuple[np.ndarray, list, tuple]:
    """Heights (y, x) of points x, y in any order, NaN where there is none, the positions [y, x] of the grid, and notes.

    With dx in `arguments` x and y may be numbers of points; positions at other distances are overridden.

    Raises ValueError: the points are on no grid, in a single line, or two of them are at one place.
    """
    rows = f"{name}: {len(z)} rows of {columns.shape[1]} column(s)"
    has_position = ~np.isnan(columns[:, :2]).all(axis=1)
    xy, z = columns[has_position, :2], z[has_position]
    if np.isnan(xy).any():
        raise ValueError(f"{rows}, x, y and z: {np.isnan(xy).any(axis=1).sum()} positions are not numbers")
    axes = [_axis(values) for values in xy.T]
    why = [f"{axis_name} has no equal steps" for axis_name, axis in zip("xy", axes, strict=True) if axis is None]
    if not why and 1 in (size := [len(axis[0]) for axis in axes]):
        why = [f"all {'xy'[size.index(1)]} are equal"]
    if not why and len(z) < FULL * math.prod(size):
        why = [f"{size[0]} × {size[1]} points of a grid have {len(z)} heights"]
    if why:
        raise ValueError(
            f"{rows}; they are not the x, y, z of a grid: {' and '.join(why)}. Choose others with columns=(0, 2) for x "
            "and z, or interpolate to a grid"
        )
    (x, column), (y, row) = axes
    places = row * len(x) + column
    if (counts := np.bincount(places)).max() > 1:
        i = int(np.argmax(counts))
        raise ValueError(f"{rows}, x, y and z: x = {x[i % len(x)]:g}, y = {y[i // len(x)]:g} stands there twice")
    heights = np.full((len(y), len(x)), np.nan)
    heights[row, column] = z
    if arguments.keys().isdisjoint(("dx", "dy")):
        return heights, [y, x], ()
    if "dx" in arguments and all(np.isclose(np.diff(axis), 1, rtol=0, atol=EQUAL).all() for axis in (x, y)):
        return heights, [y * arguments.get("dy", arguments["dx"]), x * arguments["dx"]], ()
    steps, unit = [float(axis[1] - axis[0]) for axis in (y, x)], arguments["unit"]
    lengths = overruled([y, x], steps, (unit, unit), arguments | {"height_unit": unit}, name)
    return heights, lengths.positions, lengths.notes


def _axis(values: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Uniform rising positions for the values, and the place of each value among them; None if there are none."""
    changes = np.append(True, values[1:] != values[:-1])  # along a line of the grid one of x and y stays as it is
    unique = np.unique(values[changes])
    span, gaps = unique[-1] - unique[0], np.sort(np.diff(unique))
    if not gaps.size:
        return unique, np.zeros(len(values), dtype=int)
    jump = int(np.argmax(gaps[1:] / gaps[:-1])) + 1 if gaps.size > 1 else 0  # the gaps before it come from rounding
    for gap in (span / gaps.size, span / (gaps.size - jump), np.median(gaps), np.median(gaps[jump:])):
        points = round(span / gap) + 1
        step = span / (points - 1)
        index = np.rint((values - unique[0]) / step)
        off = np.abs(values - unique[0] - index * step).max()
        if off <= UNEVEN * step or (off <= 0.4 * step and off <= _last_digit(unique)):
            return unique[0] + step * np.arange(points), index.astype(int)
    return None


def _last_digit(values: np.ndarray) -> float:
    """The value of the last written digit: the largest among numbers with equally many decimals, or equally many
    digits.

    Trailing zeros may have been left out: for 0.5, 1 and 10.5 it is 0.1.
    """
    written = [Decimal(repr(value)).normalize() for value in np.unique(values[values != 0]).tolist()]
    powers = [(number.adjusted(), number.as_tuple().exponent) for number in written]
    digits, last = max(top - low for top, low in powers), min(low for _, low in powers)
    return max(10.0 ** max(last, top - digits) for top, _ in powers)


def _rounded_step(x: np.ndarray) -> float | None:
    """The mean step of positions that are uneven only by rounding; None if they are even, or more uneven than that.

    Instruments write x with few digits: 0.3, 0.7, 1.0 for a step of 1/3. Where most steps are one unit of the last
    digit, the answer is None: a point may be missing there.
    """
    steps = np.diff(x)
    mean = (x[-1] - x[0]) / max(len(steps), 1)
    if not np.isfinite(x).all() or mean == 0 or np.abs(x - x[0] - mean * np.arange(len(x))).max() <= UNEVEN * abs(mean):
        return None
    digit, line = _last_digit(x), np.polynomial.Polynomial.fit(np.arange(len(x)), x, 1)
    rounded = np.abs(x - line(np.arange(len(x)))).max() <= 0.75 * digit  # half of it, and the error of the line
    lone = np.mean(np.isclose(np.abs(steps), digit, rtol=1e-6, atol=0)) > 0.9
    return abs(line.deriv()(0)) if rounded and not lone and digit <= COARSE * abs(x[-1] - x[0]) else None


def in_unit(arguments: dict, name: str) -> dict:
    """The arguments of `read`, with dx and dy as numbers in `unit`; where that is not given, it is the unit of dx.

    Raises ValueError: they are no lengths, or the unit is unknown.
    """
    measured = {key: arguments[key] for key in ("dx", "dy") if has_unit(arguments.get(key))}
    lengths = {key: quantity(f"{name}: {key}", entry, "m").value for key, entry in measured.items()}
    if not lengths:
        return arguments
    unit = arguments.get("unit") or next(map(unit_in, measured.values()))
    return arguments | {"unit": unit} | {key: length / metres(unit, name) for key, length in lengths.items()}


def overruled(
    positions: list[np.ndarray], steps: list[float] | None, units: tuple[str, str], arguments: dict, name: str
) -> Lengths:
    """Lengths of the file, in `units`, overridden by `unit`, `height_unit`, `dx` and `dy` of the call.

    `unit` alone is the unit of the file's numbers; with dx it is the unit of dx. Without it dx is in the file's unit.

    Raises ValueError: a distance that is not a number, dy without dx, or an unknown unit.
    """
    units_used = arguments.get("unit", units[0]), arguments.get("height_unit", units[1])
    differ = [metres(used, name) != metres(stated, name) for used, stated in zip(units_used, units, strict=True)]
    notes = (f"heights are in {units_used[1]}, as height_unit says; the file states {units[1]}",) * differ[1]
    if "dx" not in arguments:
        if "dy" in arguments:
            raise ValueError(f"{name}: give dx beside dy, both in the place of what the file states")
        notes += (f"x and y are in {units_used[0]}, as unit says; the file states {units[0]}",) * differ[0]
        return Lengths(positions, steps, units_used, notes)
    dx = number(f"{name}: dx", arguments["dx"], units_used[0])
    dy = number(f"{name}: dy", arguments["dy"], units_used[0]) if "dy" in arguments else dx
    stated = [step * metres(units[0], name) for step in steps or [np.nan]]
    steps_of_call = [dy, dx][-len(positions) :]
    ratios = np.array(steps_of_call[-len(stated) :]) * metres(units_used[0], name) / np.array(stated)
    if not np.allclose(ratios, 1, rtol=0, atol=EQUAL):
        by_call = " and ".join(
            f"{key} = {step:g}" for key, step in zip(("dx", "dy"), steps_of_call[::-1], strict=False)
        )
        by_file = " and ".join(f"{step / metres(units[0], name):g}" for step in stated[::-1])
        notes += (
            f"points are {by_call} {units_used[0]} apart, as the call says; the file states {by_file} {units[0]}"
            if steps
            else f"points are {by_call} {units_used[0]} apart, as the call says; the file has unequal steps",
        )
    axes = [step * np.arange(len(axis)) for step, axis in zip(steps_of_call, positions, strict=True)]
    return Lengths(axes, steps_of_call, units_used, notes)


def scan_of(name, z, positions, *, steps=None, units=("m", "m"), crop=None, notes=(), how) -> Scan:
    """The scan of heights at positions, cut to `crop`.

    z : heights (x) or (y, x) in units[1], NaN where a point is missing
    positions : of each axis of z, in units[0]; uniform ones of a map
    steps : distance between points along each axis; None: it follows from the positions
    crop : (x0, x1) or (x0, x1, y0, y1), or None
    notes : sentences about how the file was read
    how : the arguments missing, steep, huge and despike of `height_map`
    """
    z, holes = without_holes(z)
    notes = (*notes, *holes)
    how = how | {"unit": units[0], "height_unit": units[1], "name": name}
    if crop is not None:
        part = _part(crop, positions, units[0], name)
        z, positions = z[part], [axis[keep] for axis, keep in zip(positions, part, strict=True)]
    if z.ndim == 2:
        dy, dx = steps or [abs(axis[-1] - axis[0]) / max(len(axis) - 1, 1) for axis in positions]
        scan = height_map(z, dx=dx, dy=dy, **how)
    elif steps:
        scan = profile(z, dx=steps[0], **how)
    elif (step := _rounded_step(positions[0])) is not None:
        notes = (*notes, f"the positions x are rounded: their mean step, {step:.5g} {units[0]}, is taken")
        scan = profile(z, dx=step, **how)
    else:
        scan = profile(z, x=positions[0], **how)
    return dataclasses.replace(scan, notes=tuple(notes) + scan.notes)


def _part(crop, positions: list, unit: str, name: str) -> tuple[slice, ...]:
    """The points of each axis that lie in `crop`. Raises ValueError for a crop that is not an interval in the scan."""
    crop = list(crop) if isinstance(crop, (list, tuple, np.ndarray)) else [crop]
    if len(crop) not in (2, 2 * len(positions)):
        allowed = "(x0, x1)" + ", or (x0, x1, y0, y1)" * (len(positions) == 2)
        raise ValueError(f"{name}: crop = {tuple(crop)}; allowed is {allowed} for this scan, in {unit} or with units")
    ends = [
        quantity(f"{name}: crop", end, "m").value / metres(unit, name)
        if has_unit(end)
        else float(number(f"{name}: crop", end, unit))
        for end in crop
    ]
    part = [slice(None)] * len(positions)
    for i, (letter, low, high) in enumerate(zip("xy", ends[::2], ends[1::2], strict=False)):
        axis = len(positions) - 1 - i
        where = positions[axis]
        first, last, step = where.min(), where.max(), np.ptp(where) / max(len(where) - 1, 1)
        inside = np.flatnonzero((where >= low - 1e-3 * step) & (where <= high + 1e-3 * step))
        if not (low < high and first - 1.01 * step <= low and high <= last + 1.01 * step):
            raise ValueError(
                f"{name}: crop from {low:g} to {high:g} {unit} in {letter}: must rise and lie in the scan, which goes "
                f"from {first:g} to {last:g} {unit}"
            )
        if len(inside) < FEWEST:
            raise ValueError(
                f"{name}: crop from {low:g} to {high:g} {unit} in {letter} keeps {len(inside)} points; at least "
                f"{FEWEST} are needed. The scan has {len(where)}, from {first:g} to {last:g} {unit}"
            )
        part[axis] = slice(inside[0], inside[-1] + 1)
    return tuple(part)

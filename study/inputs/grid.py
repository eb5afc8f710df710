"""The grid of cases: parameters along named dimensions, their flat columns (B,), and the way back."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from ..terminal import shown
from .vocabulary import VOCABULARY, Parameter, are_within, check, finite

LONGEST_AXIS = 1_000_000
#: Cases in a block: ordinary ones, those that take some milliseconds each, those that may take ten seconds each.
#: A block is some seconds of work. A run that is killed loses the blocks in work.
USUAL, SLOW, SLOWEST = 8000, 1000, 100
#: On the exact layer a case with an n above, or an rtol below, may need a mesh of its own.
_STIFF, _FINE = 1e3, 1e-9
_MANY_NODES = 96  # with more than these, all that the solver begins with, a case takes some milliseconds
SHOWN = 3  # wrong values of one parameter that get a message each; the others are counted


@dataclass(frozen=True, eq=False)
class Grid:
    """Labelled cases, the product of the dimensions.

    sizes : dimension -> number of points, in order
    values : parameter -> (its dimensions, array over them); NaN: not given for this case, which does not need it
    labels : the same for coordinates that are no parameters (`case`, `label`, coordinates of a given DataArray)
    fitted : whether B and beta are fitted to Nbar and Ra
    """

    sizes: dict[str, int]
    values: dict[str, tuple[tuple[str, ...], np.ndarray]]
    labels: dict[str, tuple[tuple[str, ...], np.ndarray]] = field(default_factory=dict)
    fitted: bool = False

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(self.sizes.values())

    @property
    def size(self) -> int:
        """Number of cases B, as a Python integer that cannot overflow."""
        return math.prod(self.sizes.values())


def along(grid: Grid, name: str) -> np.ndarray:
    """Values of a parameter as an array with all dimensions of the grid, in its order.

    A dimension on which the parameter does not depend has the length 1. What is not given has its default, or NaN.
    """
    default = VOCABULARY[name].own.default
    dims, array = grid.values.get(name, ((), np.array(np.nan if default is None else default)))
    if len(dims) > 1:
        array = array.transpose(sorted(range(len(dims)), key=lambda i: list(grid.sizes).index(dims[i])))
    return array.reshape([size if dim in dims else 1 for dim, size in grid.sizes.items()])


def columns(grid: Grid, index: np.ndarray) -> dict[str, np.ndarray]:
    """Parameters of the cases numbered `index` (k,), each (k,); NaN where the case does not need it."""
    places = dict(zip(grid.sizes, np.unravel_index(index, grid.shape), strict=True)) if grid.sizes else {}
    return {
        name: array[tuple(places[dim] for dim in dims)] if dims else np.full(len(index), array)
        for name, (dims, array) in grid.values.items()
    }


def cut_out(grid: Grid, window: dict[str, slice]) -> Grid:
    """The grid within a window, a slice for each dimension."""

    def within(table: dict) -> dict:
        return {name: (dims, array[tuple(window[dim] for dim in dims)]) for name, (dims, array) in table.items()}

    sizes = {dim: len(range(size)[window[dim]]) for dim, size in grid.sizes.items()}
    return Grid(sizes, within(grid.values), within(grid.labels), grid.fitted)


def windows(grid: Grid, most: int, chunk: int) -> Iterator[dict[str, slice]]:
    """Windows, one behind the other in the flat order of the cases, that together are the grid.

    A window has whole chunks, and at most `most` cases unless a single chunk has more.

    chunk : largest number of cases in a chunk; see `box`
    """
    parts, lengths = [], zip(grid.shape, box(grid.shape, max(chunk, most)), box(grid.shape, chunk), strict=True)
    for size, length, within in lengths:
        step = length if length == size else length - length % within
        parts.append([slice(low, min(low + step, size)) for low in range(0, size, step)])
    for window in product(*parts):
        yield dict(zip(grid.sizes, window, strict=True))


def box(shape: tuple[int, ...], most: int) -> list[int]:
    """Lengths of a box of at most `most` cases that are consecutive in flat order.

    They are 1, ..., 1, then a part of one dimension, then whole dimensions.
    """
    lengths, inner = [1] * len(shape), 1
    for axis in reversed(range(len(shape))):
        pieces = -(-shape[axis] // (most // inner))
        lengths[axis] = -(-shape[axis] // pieces)
        if pieces > 1:
            break
        inner *= shape[axis]
    return lengths


def usual_block(grid: Grid) -> int:
    """Number of cases in a block when the study does not say it, by the slowest kind of case of the grid."""
    n, rtol, nodes = (along(grid, name) for name in ("n", "rtol", "nodes"))
    layered = np.isin(along(grid, "base"), ("layered", "auto")).any()
    approximated = (along(grid, "scheme") == "picard").any()
    if layered and (approximated or (n > _STIFF).any() or (rtol < _FINE).any()):
        return SLOWEST
    return SLOW if approximated or (nodes > _MANY_NODES).any() else USUAL


def unflatten(grid: Grid, flat: np.ndarray) -> np.ndarray:
    """(B, ...) -> (*grid.shape, ...): an array over the cases as one over the dimensions."""
    return flat.reshape(grid.shape + flat.shape[1:])


def as_array(own: Parameter, raw: list, key: str, errors: list[str], gaps: bool = False) -> np.ndarray:
    """Check the values of one parameter and make them an array of float, int or text.

    raw : list of values, or a list with one value
    key : how messages call the parameter; entry i of several is called key[i]
    errors : messages are appended here
    gaps : None stands for "not given" and becomes NaN
    """
    if not own.whole and own.interval and set(map(type, raw)) == {float} and are_within(own, raw).all():
        return np.array(raw)  # for a million numbers this takes less than `check` of each
    found = []
    for i, value in enumerate(raw):
        text = "" if value is None and gaps else check(own, value)
        if text:
            found.append(f"{key}{f'[{i}]' if len(raw) > 1 else ''} = {shown(value)}: {text}")
    errors += found[:SHOWN] + ([f"{key}: and {len(found) - SHOWN} more such values"] if len(found) > SHOWN else [])
    if found:
        return np.empty(len(raw))
    if own.choices:
        return np.array(raw, dtype=str)
    if own.whole:
        return np.array([int(value) for value in raw], dtype=np.int64)
    return np.array([math.nan if value is None else float(value) for value in raw])


def axis_values(raw, key: str, errors: list[str]) -> list:
    """Expand an axis: a list, or a table {start, stop, num, spacing = "linear" | "log"}. Wrong input: messages, []."""
    if isinstance(raw, dict):
        return _range_values(raw, key, errors)
    if not isinstance(raw, list):
        errors.append(
            f"{key} = {shown(raw)}: must be a list or {{start, stop, num, spacing}}; a single value belongs in [model]"
        )
    elif not raw:
        errors.append(f"{key} is empty: must have at least one value")
    elif len(raw) > LONGEST_AXIS:
        errors.append(f"{key} is too long: at most {LONGEST_AXIS} values are allowed")
    else:
        return raw
    return []


def _range_values(raw: dict, key: str, errors: list[str]) -> list:
    before = len(errors)
    check_range(raw, key, errors, ("start", "stop", "num", "spacing"))
    num = raw.get("num")
    if type(num) is not int or not 2 <= num <= LONGEST_AXIS:
        errors.append(f"{key}: {quoted('num', raw)}: must be a whole number in [2, {LONGEST_AXIS}]")
    if len(errors) > before:
        return []
    make = np.geomspace if raw.get("spacing", "linear") == "log" else np.linspace
    return make(raw["start"], raw["stop"], num).tolist()


def check_range(raw: dict, key: str, errors: list[str], names: tuple[str, ...]) -> None:
    """Messages for the spacing and the ends of a range, and for what it has that is not one of `names`."""
    for name in raw:
        if name not in names:
            errors.append(f'{key}: "{name}" is not allowed; a range is {{{", ".join(names)}}}')
    spacing = raw.get("spacing", "linear")
    if spacing not in ("linear", "log"):
        errors.append(f'{key}: spacing = {shown(spacing)}: must be one of "linear", "log"')
    for end in ("start", "stop"):
        value = raw.get(end)
        if not finite(value) or (spacing == "log" and value <= 0):
            also = ", > 0 for spacing log" * (spacing == "log")
            errors.append(f"{key}: {quoted(end, raw)}: must be a finite number{also}")
    start, stop = raw.get("start"), raw.get("stop")
    if finite(start) and finite(stop) and not math.isfinite(float(stop) - float(start)):
        errors.append(f"{key}: from start = {shown(start)} to stop = {shown(stop)}: must be less than 1.8e308 apart")


def twins(values: list) -> list[tuple[int, int]]:
    """[(i, j)], the first two places that hold the same value, or []: a coordinate must differ to be selected from."""
    first = {}
    for j, value in enumerate(values):
        i = first.setdefault(value, j)
        if i != j:
            return [(i, j)]
    return []


def equal_values(name: str, values: list, written: Callable = shown) -> list[str]:
    """A message for two values of an axis that are the same, if there are some; `written` makes a value a text."""
    return [
        f"{name}[{i}] and {name}[{j}] are both {written(values[i])}: values of an axis must differ"
        for i, j in twins(values)
    ]


def same_labels(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two coordinates have the same values in the same order. Missing ones, such as NaN, are the same."""
    if one.shape != other.shape:
        return False
    kinds = {one.dtype.kind, other.dtype.kind}
    if "O" not in kinds:
        return np.array_equal(one, other, equal_nan=kinds <= {*"fcmM"})
    return all(map(_same, one.tolist(), other.tolist()))


def _same(one: object, other: object) -> bool:
    try:
        return one is other or bool(one == other) or bool(one != one and other != other)
    except (TypeError, ValueError):  # of pandas.NA, which is neither equal nor unequal
        return False


def quoted(name: str, table: dict) -> str:
    """An entry of a table as a message quotes it: "num = 3", or "num is missing"."""
    return f"{name} = {shown(table[name])}" if name in table else f"{name} is missing"

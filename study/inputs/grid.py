"""The grid of cases: parameters along named dimensions, and their flat columns (B,)."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from ..terminal import shown
from .lexicon import PACKAGE, Lexicon
from .vocabulary import Parameter, are_within, check

SHOWN = 3  # wrong values of one parameter that get a message each; the others are counted


@dataclass(frozen=True, eq=False)
class Grid:
    """Labelled cases, the product of the dimensions.

    sizes : dimension -> number of points, in order
    values : parameter -> (its dimensions, array over them); NaN in a case that does not need it
    labels : the same for coordinates that are no parameters (`case`, `label`, those of DataArrays)
    fitted : whether B and beta are fitted to Nbar and Ra
    lexicon : of its words
    """

    sizes: dict[str, int]
    values: dict[str, tuple[tuple[str, ...], np.ndarray]]
    labels: dict[str, tuple[tuple[str, ...], np.ndarray]] = field(default_factory=dict)
    fitted: bool = False
    lexicon: Lexicon = PACKAGE

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(self.sizes.values())

    @property
    def size(self) -> int:
        """Number of cases B, as a Python integer that cannot overflow."""
        return math.prod(self.sizes.values())


def along(grid: Grid, name: str) -> np.ndarray:
    """Values of a parameter as an array with all dimensions of the grid, in its order.

    A dimension on which the parameter does not depend has the length 1. A parameter that the grid lacks has its
    default, or NaN.
    """
    if name in grid.values:
        dims, array = grid.values[name]
    else:
        default = grid.lexicon.parameter(name).default
        dims, array = (), np.array(np.nan if default is None else default)
    if len(dims) > 1:
        array = array.transpose(sorted(range(len(dims)), key=lambda i: list(grid.sizes).index(dims[i])))
    return array.reshape([size if dim in dims else 1 for dim, size in grid.sizes.items()])


def columns(grid: Grid, index: np.ndarray) -> dict[str, np.ndarray]:
    """Parameters of the cases numbered `index` (k,), each (k,); NaN where the case does not need the parameter."""
    places = dict(zip(grid.sizes, np.unravel_index(index, grid.shape), strict=True)) if grid.sizes else {}
    return {
        name: array[tuple(places[dim] for dim in dims)] if dims else np.full(len(index), array)
        for name, (dims, array) in grid.values.items()
    }


def cut_out(grid: Grid, window: dict[str, slice]) -> Grid:
    """The grid within a window, a slice for each dimension."""

    def within(table: dict) -> dict:
        # with ... the part of a single value is an array too
        return {name: (dims, array[(*(window[dim] for dim in dims), ...)]) for name, (dims, array) in table.items()}

    sizes = {dim: len(range(size)[window[dim]]) for dim, size in grid.sizes.items()}
    return replace(grid, sizes=sizes, values=within(grid.values), labels=within(grid.labels))


def windows(grid: Grid, most: int, chunk: int) -> Iterator[dict[str, slice]]:
    """Windows that together are the grid, in the flat order of the cases.

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

    The lengths are 1, ..., 1, then a part of one dimension, then whole dimensions.
    """
    lengths, inner = [1] * len(shape), 1
    for axis in reversed(range(len(shape))):
        pieces = -(-shape[axis] // (most // inner))
        lengths[axis] = -(-shape[axis] // pieces)
        if pieces > 1:
            break
        inner *= shape[axis]
    return lengths


def unflatten(grid: Grid, flat: np.ndarray) -> np.ndarray:
    """(B, ...) -> (*grid.shape, ...): an array over the cases as one over the dimensions."""
    return flat.reshape(grid.shape + flat.shape[1:])


def as_array(parameter: Parameter, raw: list, key: str, errors: list[str], gaps: bool = False) -> np.ndarray:
    """Check the values of one parameter and make them an array of float, int or text.

    raw : list of values, or a list with one value
    key : name of the parameter in messages, where entry i of several is called key[i]
    errors : messages are appended here
    gaps : None is allowed and becomes NaN
    """
    floats = not parameter.whole and parameter.interval and set(map(type, raw)) == {float}
    if floats and are_within(parameter, raw).all():  # of a million numbers, quicker than `check` of each
        return np.array(raw)
    messages = []
    for i, value in enumerate(raw):
        text = "" if value is None and gaps else check(parameter, value)
        if text:
            messages.append(f"{key}{f'[{i}]' if len(raw) > 1 else ''} = {shown(value)}: {text}")
    errors += messages[:SHOWN]
    errors += [f"{key}: and {len(messages) - SHOWN} more such values"] * (len(messages) > SHOWN)
    if messages:
        return np.empty(len(raw))
    if parameter.choices:
        return np.array(raw, dtype=str)
    if parameter.whole:
        return np.array([int(value) for value in raw], dtype=np.int64)
    return np.array([math.nan if value is None else float(value) for value in raw])


def twins(values: list) -> list[tuple[int, int]]:
    """[(i, j)], the first two places with the same value, or []. On an axis neither of the two could be selected."""
    first = {}
    for j, value in enumerate(values):
        i = first.setdefault(value, j)
        if i != j:
            return [(i, j)]
    return []


def equal_values(name: str, values: list, written: Callable = shown) -> list[str]:
    """A message if two values of an axis are the same; `written` makes a value a text."""
    return [
        f"{name}[{i}] and {name}[{j}] are both {written(values[i])}: values of an axis must differ"
        for i, j in twins(values)
    ]


def same_labels(labels: np.ndarray, other: np.ndarray) -> bool:
    """Whether two coordinates have the same values in the same order. Missing ones, such as NaN, are the same."""
    if labels.shape != other.shape:
        return False
    kinds = {labels.dtype.kind, other.dtype.kind}
    if "O" not in kinds:
        return np.array_equal(labels, other, equal_nan=kinds <= {*"fcmM"})
    return all(map(_same, labels.tolist(), other.tolist()))


def _same(label: object, other: object) -> bool:
    try:
        return label is other or bool(label == other) or bool(label != label and other != other)
    except (TypeError, ValueError):  # of pandas.NA, which is neither equal nor unequal
        return False

"""Batches: B cases side by side, in arrays whose first axis is the case. Parts of them, their union, cases that are
alike, and the loop over cases that have not ended.

A batch is a named tuple or a dataclass that is decorated by :func:`of_cases`. Its arrays, in tuples too, have B rows;
parts that have a method `take` are batches themselves; whatever else is there is the same for all cases.
"""

from dataclasses import fields, is_dataclass
from functools import lru_cache
from typing import Any

import numpy as np


@lru_cache(maxsize=256)
def _names(kind):
    return tuple(field.name for field in fields(kind)) if is_dataclass(kind) else kind._fields


def take(batch: Any, index: Any) -> Any:
    """Some of the cases.

    Parameters
    ----------
    batch : as above
    index : whole numbers, a slice, or bool (B,)

    Returns
    -------
    Any : a batch of the same kind

    Examples
    --------
    >>> import numpy as np
    >>> from solver import Problem
    >>> Problem.of(P=[1e-5, 2e-5, 4e-5], base="half_space", micro="smooth").take([0, 2]).value.tolist()
    [1e-05, 4e-05]
    """
    values = batch if isinstance(batch, tuple) else [getattr(batch, name) for name in _names(type(batch))]
    # most are arrays: a call for each would take as long as the rest
    rows = [value[index] if isinstance(value, np.ndarray) else _rows(value, index) for value in values]
    return type(batch)(*rows)


def of_cases(kind):
    """Class decorator: a named tuple or a dataclass is a batch, and has :func:`take` for a method."""
    kind.take = take
    return kind


def _rows(value, index):
    if isinstance(value, np.ndarray):
        return value[index]
    if type(value) is tuple:
        return tuple([_rows(each, index) for each in value])
    return value.take(index) if is_batch(value) else value


def is_batch(value):
    """Whether a value has rows of cases, and is no array: numbers of numpy have a method `take` too."""
    return hasattr(value, "take") and not isinstance(value, np.generic)


def join(parts, places=None, **fixed):
    """The batch of the `parts`, each at its `places` (b,) in it; one after another if there are none.

    fixed : field -> its value in the whole batch, which then is not put together from those of the parts
    """
    order = slice(None) if places is None else np.argsort(np.concatenate(places))
    return _joined(parts, order, places, fixed)


def _joined(parts, order, places, fixed=()):
    kind, first = type(parts[0]), parts[0]
    if isinstance(first, np.ndarray):
        return np.concatenate(parts)[order]
    if kind is tuple:
        return tuple(_joined(each, order, places) for each in zip(*parts, strict=True))
    if not is_batch(first):
        return first
    if hasattr(kind, "assemble"):  # its rows are in groups
        return kind.assemble(parts, places)
    columns = ([getattr(part, name) for part in parts] for name in _names(kind))
    named = zip(_names(kind), columns, strict=True)
    return kind(*[fixed[name] if name in fixed else _joined(column, order, places) for name, column in named])


def march(step, active, *carried, most=None):
    """Repeat a step on the cases `active` (b,), indices: those that have ended leave, the others go on. The indices of
    those that still go on after `most` steps.

    step : ``step(active, *carried) -> ended, *carried``: which of the cases (b,) have ended, bool, and what the next
        step carries, arrays and batches of these cases. Without anything carried, ``step(active) -> ended``
    most : number of steps; None: until all have ended
    """
    while len(active) and most != 0:
        ended, *carried = step(active, *carried) if carried else (step(active),)
        most = None if most is None else most - 1
        if ended.all():
            return active[:0]
        if ended.any():
            left = np.flatnonzero(~ended)
            active, carried = active[left], [_rows(values, left) for values in carried]
    return active


def alike(*columns):
    """The cases that are alike in all `columns`, arrays (B,) of words or whole numbers: a list of indices (b,), each
    ascending."""
    parts = [np.arange(len(columns[0]))] if len(columns[0]) else []
    for column in columns:
        parts = [rows for index in parts for rows in _split(column[index], index)]
    return parts


def _split(values, index):
    if (values == values[0]).all():
        return [index]
    return [index[values == value] for value in dict.fromkeys(values.tolist())]

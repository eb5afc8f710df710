"""Batches: B cases side by side, in arrays whose first axis is the case. Here are sub-batches, their union, the groups
of cases that are alike, and the loop over the cases that have not ended.

A batch is a named tuple or a dataclass that is decorated by :func:`of_cases`. Its arrays have B rows, and so have the
arrays in its tuples. A field that has a method `take` is a batch itself. Every other field is the same for all cases.
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
    # most values are arrays: calling a function for each would take as long as everything else here
    rows = [value[index] if isinstance(value, np.ndarray) else _rows(value, index) for value in values]
    return type(batch)(*rows)


def of_cases(kind):
    """Class decorator that makes a named tuple or a dataclass a batch: :func:`take` becomes its method."""
    kind.take = take
    return kind


def _rows(value, index):
    if isinstance(value, np.ndarray):
        return value[index]
    if type(value) is tuple:
        return tuple([_rows(each, index) for each in value])
    return value.take(index) if is_batch(value) else value


def is_batch(value):
    """Whether a value that is not an array has rows of cases. Scalars of numpy have a method `take` too, and are no
    batches."""
    return hasattr(value, "take") and not isinstance(value, np.generic)


def join(parts, places=None, **fixed):
    """The batch that the `parts` make up. Each part goes to its `places` (b,) in the batch; without `places` the parts
    follow one another.

    fixed : field -> its value in the whole batch, in place of one put together from those of the parts
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
    if hasattr(kind, "assemble"):  # a batch whose rows are in groups
        return kind.assemble(parts, places)
    columns = ([getattr(part, name) for part in parts] for name in _names(kind))
    named = zip(_names(kind), columns, strict=True)
    return kind(*[fixed[name] if name in fixed else _joined(column, order, places) for name, column in named])


def march(step, active, *states, most=None):
    """Repeat a step on the cases `active` (b,), indices, until they have ended. A case that has ended leaves. Returns
    the indices of the cases that have not ended after `most` steps.

    step : ``step(active, *states) -> ended, *states``. `ended` (b,) bool marks the cases that have ended; `states` are
        arrays and batches of these cases, which the next step receives. Without states, ``step(active) -> ended``
    most : largest number of steps; None: no limit
    """
    while len(active) and most != 0:
        ended, *states = step(active, *states) if states else (step(active),)
        most = None if most is None else most - 1
        if ended.all():
            return active[:0]
        if ended.any():
            left = np.flatnonzero(~ended)
            active, states = active[left], [_rows(values, left) for values in states]
    return active


def alike(*columns):
    """Groups of cases that agree in all `columns`, arrays (B,) of words or whole numbers. Returns a list of indices
    (b,), each ascending."""
    parts = [np.arange(len(columns[0]))] if len(columns[0]) else []
    for column in columns:
        parts = [rows for index in parts for rows in _split(column[index], index)]
    return parts


def _split(values, index):
    if (values == values[0]).all():
        return [index]
    return [index[values == value] for value in dict.fromkeys(values.tolist())]

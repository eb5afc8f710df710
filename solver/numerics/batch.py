"""Batches: B cases side by side, in arrays whose first axis is the case."""

from dataclasses import fields, is_dataclass

import numpy as np


def take(batch, index):
    """The sub-batch at an `index` (whole numbers, a slice, or bool (B,)); the method `take` of most batches.

    batch : a named tuple or a dataclass. Its arrays, in tuples too, have B rows; parts that have a method `take` are
        batches themselves; whatever else is there is the same for all cases
    """
    names = [field.name for field in fields(batch)] if is_dataclass(batch) else batch._fields
    return type(batch)(*(_part(getattr(batch, name), index) for name in names))


def _part(value, index):
    if isinstance(value, np.ndarray):
        return value[index]
    if hasattr(value, "take"):
        return value.take(index)
    return tuple(_part(each, index) for each in value) if type(value) is tuple else value


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

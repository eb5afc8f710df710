"""What an edited large study takes from its former parts: the cases that it still has, as blocks of its windows.

Parts are chosen by their labels, the values of their axes, and cases by their keys. So a case counts only if all that
its numbers depend on is the same, whatever has become of the grid.
"""

import logging
import tomllib
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..data.dataset import labelled, not_run
from ..data.si import axes_of, dataset_of
from ..files.examine import Condition, examine
from ..files.netcdf import read
from ..inputs.definition import Definition, StudyError
from ..inputs.grid import along
from ..inputs.identity import find
from ..inputs.reading import from_tables
from .block_file import Block
from .blocks import facts, keys_of, put, usable
from .window_files import WindowFiles
from .windows import Store, Window, divisions, identities, windows_of, within

log = logging.getLogger(__name__)
#: What goes wrong while the text of a former study is read: it may need a law, or a file, that is not there any more.
UNREADABLE = (StudyError, ValueError, OSError, RecursionError)


class FormerPart(NamedTuple):
    """A part of the study before it was edited: the values of its axes, and its cases."""

    labels: dict[str, np.ndarray]
    block: Block


def take_over(state: WindowFiles, former: list[Condition]) -> int:
    """Write the cases of former parts that windows without results have too as blocks; returns how many.

    They are on the disk when this returns: then the parts may be removed. Cases with derivatives are not taken, because
    results do not contain these.
    """
    taken, windows = 0, state.absent
    labels = [identity.coordinates for identity in identities(state.store, windows)]
    for part in _parts(state.store, former):
        for window, values in zip(windows, labels, strict=True):
            if _overlap(part.labels, values):
                taken += _take(state.store_of(window), part.block)
    return taken


def _take(store: Store, block: Block) -> int:
    """Write the cases of a block that a window has; returns how many."""
    if not usable(store.definition, block):
        return 0
    keys = keys_of(store)
    rows = find(keys, block.keys, np.zeros(len(block.keys)))
    index = np.flatnonzero(rows >= 0)
    if len(index):
        arrays = {name: array[rows[index]] for name, array in block.arrays.items()}
        put(store, Block(block.facts, keys[index], arrays))
    return len(index)


def _overlap(labels: dict[str, np.ndarray], others: dict[str, np.ndarray]) -> bool:
    """Whether cases with these labels may be the same: along no axis that both have is every value different."""
    return all(np.isin(values, others[dim]).any() for dim, values in labels.items() if dim in others)


def _parts(store: Store, former: list[Condition]) -> Iterator[FormerPart]:
    """Those that can be read, one at a time: a part may have a million cases."""
    studies = dict[str, dict[str, tuple[Store, Window]]]()
    for condition in former:
        if condition.digest not in studies:
            studies[condition.digest] = _windows_of_study(store, condition)
        place = studies[condition.digest].get(condition.path.name)
        part = place and _part(*place, condition)
        if part:
            yield part


def _windows_of_study(store: Store, condition: Condition) -> dict[str, tuple[Store, Window]]:
    """Name of the file -> each window of the study that a part is of; {} if that study cannot be read any more."""
    try:
        tables = tomllib.loads(condition.text)
        definition = from_tables(tables, store.definition.name, condition.text, store.definition.name)
    except UNREADABLE as error:
        log.debug("%s: %s", condition.path, error)
        return {}
    if definition.digest != condition.digest or definition.inputs:
        return {}
    before = Store(definition, store.results)
    windows = windows_of(before)
    divided = divisions(definition, windows)
    return {window.path.name: (within(before, window, divided), window) for window in windows}


def _part(store: Store, window: Window, condition: Condition) -> FormerPart | None:
    """The part, if its file holds the cases of the window, undamaged."""
    definition = store.definition
    if store.window is None or examine(condition.path).kind != "sound":
        return None
    labels, dataset = axes_of(definition), read(condition.path)
    if not all(dim in dataset.coords and np.array_equal(dataset[dim], values) for dim, values in labels.items()):
        return None
    block = Block(facts(definition.x), keys_of(store), _columns(definition, dataset))
    return FormerPart(labels, block)


def _columns(definition: Definition, dataset: xr.Dataset) -> dict[str, np.ndarray]:
    """Columns of cases as a block has them, name -> (B, ...), from their results. In SI units these are products with
    the units, which are the results of cases whose every column is 1."""
    grid, empty = definition.grid, not_run(definition, definition.grid.size)
    ones = {name: np.ones_like(array) for name, array in empty.items()}
    units = dataset_of(definition, labelled(definition, ones, "")) if definition.scene else None
    columns = {}
    for name, array in empty.items():
        if name in grid.values:
            values = np.broadcast_to(along(grid, name), grid.shape)
        elif units is not None and array.dtype.kind == "f":
            values = dataset[name].values / units[name].values
        else:
            values = dataset[name].values
        columns[name] = values.reshape(array.shape).astype(array.dtype)
    return columns

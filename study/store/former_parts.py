"""An edited large study takes the cases that it still has from its former parts, as blocks of its windows.

Parts are chosen by their labels, the values of their axes, and cases by their keys. So a case is taken only if
everything on which its numbers depend is the same, however the grid has changed.
"""

import logging
import tomllib
from collections.abc import Iterator

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
from .windows import Store, Window, divisions, identities, is_large, windows_of, within

log = logging.getLogger(__name__)
#: Errors while the text of a former study is read: it may need a law, or a file, that no longer exists.
UNREADABLE = (StudyError, ValueError, OSError, RecursionError)
#: Dimension -> values of the axis, of some cases.
Labels = dict[str, np.ndarray]


def take_over(files: WindowFiles, former: list[Condition]) -> int:
    """Write the cases that former parts share with windows without results, as blocks; returns their number.

    They are on the disk when this returns: then the parts may be removed. Cases with derivatives are not taken, because
    results do not contain derivatives.
    """
    count, labelled_windows = 0, _with_labels(files, files.absent)
    for condition, store in _stores(files.store, former):
        block = store and _block(store, condition)
        if block and usable(files.store.definition, block):
            labels = axes_of(store.definition)
            windows = (window for window, labels_of_window in labelled_windows if _overlap(labels, labels_of_window))
            count += sum(_take(files.store_of(window), block) for window in windows)
    return count


def are_all_kept(files: WindowFiles, former: list[Condition]) -> bool:
    """Whether the study still has, and can take, every case of the former parts, damaged files excepted."""
    labelled_windows = _with_labels(files, files.windows)
    for _, store in _stores(files.store, former):
        if store is None:
            return False
        definition, keys, labels = store.definition, keys_of(store), axes_of(store.definition)
        if not usable(files.store.definition, Block(facts(definition.x), keys[:0], not_run(definition, 0))):
            return False
        is_in_study = np.zeros(len(keys), dtype=bool)
        for window in (window for window, labels_of_window in labelled_windows if _overlap(labels, labels_of_window)):
            keys_of_window = keys_of(files.store_of(window))
            is_in_study |= find(keys, keys_of_window, np.zeros(len(keys_of_window))) >= 0
        if not is_in_study.all():
            return False
    return True


def _take(store: Store, block: Block) -> int:
    """Write the cases of a block that a window has; returns their number."""
    keys = keys_of(store)
    rows = find(keys, block.keys, np.zeros(len(block.keys)))
    index = np.flatnonzero(rows >= 0)
    if len(index):
        arrays = {name: array[rows[index]] for name, array in block.arrays.items()}
        put(store, Block(block.facts, keys[index], arrays))
    return len(index)


def _with_labels(files: WindowFiles, windows: list[Window]) -> list[tuple[Window, Labels]]:
    """Windows, each with the values of its axes."""
    labels = [identity.coordinates for identity in identities(files.store, windows)]
    return list(zip(windows, labels, strict=True))


def _overlap(labels: Labels, others: Labels) -> bool:
    """Whether cases with these labels may be the same: along every common axis they share a value."""
    return all(np.isin(values, others[dim]).any() for dim, values in labels.items() if dim in others)


def _stores(store: Store, former: list[Condition]) -> Iterator[tuple[Condition, Store | None]]:
    """Each former part with the store of its cases; None if its study can no longer be read."""
    studies = dict[str, dict[str, Store]]()
    for condition in former:
        if condition.digest not in studies:
            studies[condition.digest] = _windows_of_study(store, condition)
        yield condition, studies[condition.digest].get(condition.path.name)


def _windows_of_study(store: Store, condition: Condition) -> dict[str, Store]:
    """Name of the file -> store, for each window of the study to which a part belongs; {} if that study can no longer
    be read, or has derivatives."""
    try:
        tables = tomllib.loads(condition.text)
        definition = from_tables(tables, store.definition.name, condition.text, store.definition.name)
    except UNREADABLE as error:
        log.debug("%s: %s", condition.path, error)
        return {}
    if definition.digest != condition.digest or definition.inputs or not is_large(definition):
        return {}
    before = Store(definition, store.results)
    windows = windows_of(before)
    divided = divisions(definition, windows)
    return {window.path.name: within(before, window, divided) for window in windows}


def _block(store: Store, condition: Condition) -> Block | None:
    """The cases of a former part, if its file is undamaged and holds the cases of its window."""
    if examine(condition.path).kind != "sound":
        return None
    definition, dataset = store.definition, read(condition.path)
    for dim, values in axes_of(definition).items():
        if dim not in dataset.coords or not np.array_equal(dataset[dim], values):
            return None
    return Block(facts(definition.x), keys_of(store), _columns(definition, dataset))


def _columns(definition: Definition, dataset: xr.Dataset) -> dict[str, np.ndarray]:
    """Columns of cases as a block has them, name -> (B, ...), from their results.

    Results in SI are the columns times the units. The units are the results of cases whose columns are all 1.
    """
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

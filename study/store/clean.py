"""`clean` removes the blocks that hold no case of the study in its present form."""

import re
from collections.abc import Iterator
from contextlib import contextmanager

from ..files.lock import lock_file
from ..inputs.definition import StudyError
from ..terminal import counted
from .blocks import inventory
from .window_files import glance
from .windows import Store, is_large

OF_A_WINDOW = re.compile(r"\d{12}-[0-9a-f]{16}-")  # the beginning of the name of a block of one of many windows


def clean(store: Store) -> list[str]:
    """Remove the blocks that hold no case of the study in its present form.

    Returns sentences about the blocks that are removed and those that stay. Raises StudyError while the study runs.
    """
    if is_large(store.definition):
        return _clean_windows(store)
    if not store.folder.exists():
        return [f"{store.folder}: is not there, nothing to remove"]
    with alone(store):
        stock = inventory(store)
        used = {stock.sources[number].path for number in set(stock.source[stock.source >= 0].tolist())}
        gone = [path for path in stock.blocks if path not in used and path.is_file()]
        for path in gone:
            path.unlink(missing_ok=True)
        store.remove_litter()
    rest = f"; the study needs the other {counted(len(used), 'block')}" if used else ""
    what = f"removed {_counted([stock.blocks[path] for path in gone])}" if gone else "nothing to remove"
    return [f"{store.folder}: {what}{rest}"]


@contextmanager
def alone(store: Store) -> Iterator[None]:
    """Hold the lock of a study. Raises StudyError while the study runs."""
    with lock_file(store.lock, wait=False) as is_free:
        if not is_free:
            raise StudyError([f"{store.folder}: a run of this study is going on; clean when it has ended"])
        yield


def _clean_windows(store: Store) -> list[str]:
    """Remove blocks, by their names, of windows that have results, and of windows of another study."""
    unread = f"it is so large that no block is looked for in {store.folder}"
    lines = [f"{store.parts}: the study is kept in parts, which stay; {unread}"]
    if not store.folder.exists():
        return lines
    with alone(store):
        needed = tuple(window.prefix for window in glance(store).absent)
        gone = [path for path in store.folder.glob("*.block") if OF_A_WINDOW.match(path.name)]
        gone = [path for path in gone if not path.name.startswith(needed)]
        for path in gone:
            path.unlink(missing_ok=True)
        store.remove_litter()
    return lines + [f"{store.folder}: removed {counted(len(gone), 'block')} that no part needs"] * bool(gone)


def _counted(cases: list[int]) -> str:
    """ "3 blocks of 15 cases, 1 damaged block"."""
    whole = [number for number in cases if number >= 0]
    damaged = len(cases) - len(whole)
    texts = [f"{counted(len(whole), 'block')} of {counted(sum(whole), 'case')}"] * bool(whole)
    return ", ".join([*texts, *[counted(damaged, "damaged block")] * bool(damaged)])

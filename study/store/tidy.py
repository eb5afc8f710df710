"""What becomes of blocks when the results are written, and what `clean` removes."""

from contextlib import suppress
from pathlib import Path

from ..files.lock import held
from ..inputs.definition import StudyError
from ..terminal import counted
from .blocks import Inventory, Store, inventory, remove_litter


def tidy(store: Store, known: Inventory | None = None) -> str:
    """Remove the blocks whose numbers are all in the results file. Returns in words what else is in the folder."""
    known = known or inventory(store, force=True)
    for path in known.covered:
        path.unlink(missing_ok=True)
    remove_litter(store)
    rest = _rest(store)
    if rest:
        blocks = sum(path in known.blocks for path in rest)
        what = f"; `clean` removes the block{'s' * (blocks > 1)}" if blocks else ""
        return f"{store.folder} keeps what is not in it: {_counted(rest, known)}{what}"
    _remove(store, [store.folder])
    return ""


def withdraw(store: Store, made: list[Path]) -> None:
    """Remove the folders that a refused run has `made`, unless something is in them or another run goes on there."""
    with suppress(OSError), held(store.lock, wait=False) as alone:
        if alone and not _rest(store):
            _remove(store, made)


def _remove(store: Store, folders: list[Path]) -> None:
    store.lock.unlink(missing_ok=True)
    with suppress(OSError):  # a folder is gone, or another run has come
        for folder in folders:
            folder.rmdir()


def clean(store: Store, done: bool) -> list[str]:
    """Remove the blocks that do not serve the study as it is; says what was removed, and what stays.

    done : the results file holds the whole study, so no block serves it

    Raises StudyError while a run of the study is going on.
    """
    if not store.folder.exists():
        return [f"{store.folder}: is not there, nothing to remove"]
    with held(store.lock, wait=False) as alone:
        if not alone:
            raise StudyError([f"{store.folder}: a run of this study is going on; clean when it has ended"])
        known = inventory(store, force=True)
        used = set() if done else {known.sources[number].path for number in set(known.source[known.source >= 0])}
        gone = [path for path in known.blocks if path not in used and path.is_file()]
        for path in gone:
            path.unlink(missing_ok=True)
        said = [f"{store.folder}: removed {_counted(gone, known)}"] if gone else []
        known.covered.intersection_update(gone)
        if tidy(store, known):
            what = "; `run` goes on from there" if used else ""
            said.append(f"{store.folder}: kept {_counted(_rest(store), known)}{what}")
    return said or [f"{store.folder}: nothing to remove"]


def _counted(paths: list[Path], known: Inventory) -> str:
    """ "3 blocks of 15 cases, 1 damaged block, 2 other files"."""
    cases = [known.blocks[path] for path in paths if path in known.blocks]
    whole = [number for number in cases if number >= 0]
    parts = [(len(whole), "block", f" of {counted(sum(whole), 'case')}")]
    parts += [(len(cases) - len(whole), "damaged block", ""), (len(paths) - len(cases), "other file", "")]
    return ", ".join(f"{counted(number, what)}{more}" for number, what, more in parts if number)


def _rest(store: Store) -> list[Path]:
    """All that is in the folder but the lock."""
    return sorted(path for path in store.folder.glob("*") if path != store.lock)

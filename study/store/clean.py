"""What `clean` removes: blocks that hold no case of the study as it is."""

from ..files.lock import held
from ..inputs.definition import StudyError
from ..terminal import counted
from .blocks import Store, inventory, remove_litter
from .parts import is_large


def clean(store: Store) -> list[str]:
    """Remove the blocks that hold no case of the study as it is; says what was removed, and what stays.

    Raises StudyError while a run of the study is going on.
    """
    if is_large(store.definition):
        kept = f"it is so large that no block is looked for in {store.folder}"
        return [f"{store.parts}: the study is kept in parts, which stay; {kept}"]
    if not store.folder.exists():
        return [f"{store.folder}: is not there, nothing to remove"]
    with held(store.lock, wait=False) as alone:
        if not alone:
            raise StudyError([f"{store.folder}: a run of this study is going on; clean when it has ended"])
        stock = inventory(store)
        used = {stock.sources[number].path for number in set(stock.source[stock.source >= 0].tolist())}
        gone = [path for path in stock.blocks if path not in used and path.is_file()]
        for path in gone:
            path.unlink(missing_ok=True)
        remove_litter(store)
    kept = f"; the study needs the other {counted(len(used), 'block')}" if used else ""
    what = f"removed {_counted([stock.blocks[path] for path in gone])}" if gone else "nothing to remove"
    return [f"{store.folder}: {what}{kept}"]


def _counted(cases: list[int]) -> str:
    """ "3 blocks of 15 cases, 1 damaged block"."""
    whole = [number for number in cases if number >= 0]
    damaged = len(cases) - len(whole)
    texts = [f"{counted(len(whole), 'block')} of {counted(sum(whole), 'case')}"] * bool(whole)
    return ", ".join([*texts, *[counted(damaged, "damaged block")] * bool(damaged)])

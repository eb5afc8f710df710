"""Mistakes written by hand, of kinds that operators.py does not make: tests/mutants/by_hand.toml."""

import tomllib
from collections.abc import Iterator
from pathlib import Path

from operators import Change

ROOT = Path(__file__).resolve().parents[2]
MOST = 150  # a longer list tells no more, and each entry must follow the code


def read(root: Path = ROOT) -> Iterator[tuple[str, str, str, str]]:
    """Name, file, old and new text of each mistake of a tree: [PACKAGE.ROOM.MODULE.NAME], in the file MODULE.py, or in
    the `file` that the entry names."""
    return _within(tomllib.loads((root / "tests/mutants/by_hand.toml").read_text(encoding="utf-8")), ())


def _within(tables: dict, path: tuple[str, ...]) -> Iterator[tuple[str, str, str, str]]:
    for name, entry in tables.items():
        if "old" in entry:
            yield ".".join((*path, name)), entry.get("file", f"{'/'.join(path)}.py"), entry["old"], entry["new"]
        else:
            yield from _within(entry, (*path, name))


def changes(root: Path = ROOT) -> list[Change]:
    """The list as changes of the files. Raises ValueError if an old text is not in its file exactly once."""
    changes_of_list = []
    for name, file, old, new in read(root):
        source = (root / file).read_bytes()
        if source.count(old.encode()) != 1:
            raise ValueError(f"{name}: {file} has this {source.count(old.encode())} times: {old}")
        start = source.index(old.encode())
        changes_of_list.append(Change(file, start, start + len(old.encode()), new, "by hand"))
    return changes_of_list

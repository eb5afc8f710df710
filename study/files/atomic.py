"""Files that are complete or absent, even after a power cut."""

import os
import secrets
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from glob import escape
from pathlib import Path


@contextmanager
def replacing(path: Path, folder: Path | None = None, place: Callable | None = None) -> Iterator[Path]:
    """A temporary path to write to. When the `with` block ends without an error, the file is flushed and becomes
    `path`.

    If the block has left no file there, `path` stays as it is.

    folder : of the temporary file; by default that of `path`, and also if it is a link, which may lead to another file
        system. The temporary name is random, since two machines that share a folder may have the same process id
    place : place(temporary path, `path`) gives the file its name; by default `os.replace`
    """
    folder = None if folder and folder.is_symlink() else folder
    if path.is_symlink():
        path, folder = target(path), None
    temporary = (folder or path.parent) / f".{path.name}.{secrets.token_hex(4)}.tmp"
    try:
        yield temporary
        if not temporary.exists():
            return
        with open(temporary, "rb+") as file:
            os.fsync(file.fileno())  # a rename may reach the disk before the data do
        (place or os.replace)(temporary, path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    flush_folder(path.parent)  # otherwise blocks might be removed before the rename is on the disk


def target(path: Path) -> Path:
    """The path itself, or the target of a symbolic link."""
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def remove_temporary(path: Path, age: float = 0.0) -> None:
    """Remove the temporary files of killed writers beside `path` that are at least `age` seconds old."""
    path = target(path)
    for temporary in path.parent.glob(f".{escape(path.name)}.????????.tmp"):
        with suppress(FileNotFoundError):  # its writer has just ended
            if time.time() - temporary.stat().st_mtime >= age:
                temporary.unlink()


def make_folder(path: Path) -> None:
    """Make a folder and its missing parents, and flush their names to the disk."""
    missing = [folder for folder in (path, *path.parents) if not folder.exists()]
    path.mkdir(parents=True, exist_ok=True)
    for folder in missing:
        flush_folder(folder.parent)


def flush_folder(path: Path) -> None:
    """Flush the names in a folder to the disk, where the system can do that."""
    with suppress(OSError):
        folder = os.open(path, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)

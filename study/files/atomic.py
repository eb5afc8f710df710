"""Files that are either whole or not there, and that a power cut does not take away again."""

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from glob import escape
from pathlib import Path


@contextmanager
def replacing(path: Path, folder: Path | None = None) -> Iterator[Path]:
    """A temporary path to write to; when the block ends well it is flushed to the disk and becomes `path`.

    folder : where the temporary file is, on the file system of `path`; default beside it. The name is random, not the
        process id: two machines that share a folder may have the same.
    """
    if path.is_symlink():
        path, folder = target(path), None
    temporary = (folder or path.parent) / f".{path.name}.{secrets.token_hex(4)}.tmp"
    try:
        yield temporary
        with open(temporary, "rb+") as file:
            os.fsync(file.fileno())  # a rename may reach the disk before the data do
        os.replace(temporary, path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    flush_folder(path.parent)  # and what comes after, such as removing blocks, before the rename


def target(path: Path) -> Path:
    """The file that a path stands for: of a symbolic link what it leads to, on whatever file system that is."""
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def remove_temporary(path: Path) -> None:
    """Remove what writers of `path` that were killed have left beside it."""
    path = target(path)
    for found in path.parent.glob(f".{escape(path.name)}.????????.tmp"):
        found.unlink(missing_ok=True)


def make_folder(path: Path) -> None:
    """Make a folder, and those above it, so that they outlast a power cut."""
    missing = [folder for folder in (path, *path.parents) if not folder.exists()]
    path.mkdir(parents=True, exist_ok=True)
    for folder in missing:
        flush_folder(folder.parent)


def flush_folder(path: Path) -> None:
    """Flush the names in a folder to the disk; a system or a file system that knows no such thing is left alone."""
    try:
        folder = os.open(path, os.O_RDONLY)
    except OSError:
        return
    try:
        os.fsync(folder)
    except OSError:
        pass
    finally:
        os.close(folder)

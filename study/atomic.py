"""Files that are either whole or not there."""

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def replacing(path: Path, folder: Path | None = None) -> Iterator[Path]:
    """A temporary path to write to; when the block ends well it is flushed to the disk and becomes `path`.

    folder : where the temporary file is, on the file system of `path`; default beside it. The name is random, not the
        process id: two machines that share a folder may have the same.
    """
    if path.is_symlink():  # what it points to is replaced, on whatever file system that is
        path, folder = Path(os.path.realpath(path)), None
    temporary = (folder or path.parent) / f".{path.name}.{secrets.token_hex(4)}.tmp"
    try:
        yield temporary
        with open(temporary, "rb+") as file:
            os.fsync(file.fileno())  # a rename may reach the disk before the data do
        os.replace(temporary, path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise

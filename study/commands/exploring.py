"""The command `explore`: the page that solves contacts in a browser."""

from pathlib import Path

from solver.numerics.userfile import opened

from ..explorer.page import MARK, page
from ..files.atomic import replacing
from ..inputs.definition import StudyError
from ..terminal import answer


def explore(options, _) -> int:
    """Write the page. A file that is no such page is not replaced."""
    path = Path(options.out)
    if path.is_dir():
        raise StudyError([f"--out {path} is a folder: name a file in it, such as {path / 'contact.html'}"])
    if path.exists() and not _is_page(path):
        raise StudyError([f"--out {path}: there is a file that is no page of the explorer; it stays"])
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as temporary:
        temporary.write_text(page(), encoding="utf-8")
    return answer(f"{path}: open it in a browser; it needs no network")


def _is_page(path: Path) -> bool:
    """Whether a file is a page of the explorer. Raises OSError where it cannot be read."""
    try:
        with opened(path) as file:
            return MARK in file.read(10 * len(MARK))
    except ValueError:  # a pipe or device, or far too large
        return False

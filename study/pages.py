"""The pages of docs/, which come with the package: `roughcoat docs` shows them."""

import difflib
from importlib.resources import files
from pathlib import PurePosixPath

from .inputs.definition import StudyError
from .terminal import shown

_INDEX = "model.md"  # tells our folder of pages from that of another package


def _folder():
    """The folder of the pages: in the installed package, or beside it in a clone."""
    package = files("study")
    places = (package / "docs", package.parent / "docs")
    return next((folder for folder in places if (folder / _INDEX).is_file()), places[0])


def titles() -> dict[str, str]:
    """Name of each page, its file name without .md -> its title.

    Pages without a title are left out: they only include a file from elsewhere in the repository, for the site.
    """
    folder = _folder()
    pages = sorted(page.name for page in folder.iterdir() if page.name.endswith(".md")) if folder.is_dir() else []
    heads = {name.removesuffix(".md"): _text(name).partition("\n")[0] for name in pages}
    return {name: head.removeprefix("# ") for name, head in heads.items() if head.startswith("# ")}


def page(name: str) -> str:
    """The text of a page, in Markdown.

    name : "model", or a reference as in messages: "docs/model.md", also with a heading, "docs/model.md#units"

    Raises StudyError if there is no such page; the message lists all pages.
    """
    stem = PurePosixPath(name.partition("#")[0]).name.removesuffix(".md")
    pages = titles()
    if stem in pages:
        return _text(f"{stem}.md")
    near = difflib.get_close_matches(stem.lower(), pages, n=1, cutoff=0.75)
    hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(pages)}"
    raise StudyError([f"docs {shown(name)} is not a page; {hint}"])


def _text(name: str) -> str:
    return (_folder() / name).read_text(encoding="utf-8")

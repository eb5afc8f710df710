"""The pages of docs/, which the package brings along: `roughcoat docs` opens them."""

import difflib
from importlib.resources import files
from pathlib import PurePosixPath

from .inputs.definition import StudyError
from .terminal import shown

_INDEX = "model.md"  # a page of ours, by which our folder is known from one of another package


def _folder():
    """The folder of the pages: in the installed package, or beside it in a clone."""
    package = files("study")
    here = (package / "docs", package.parent / "docs")
    return next((folder for folder in here if (folder / _INDEX).is_file()), here[0])


def titles() -> dict[str, str]:
    """The name of each page, which is that of its file without .md, and its title.

    Pages without a title include a file that stands elsewhere in the repository, for the site.
    """
    folder = _folder()
    pages = sorted(page.name for page in folder.iterdir() if page.name.endswith(".md")) if folder.is_dir() else []
    heads = {name.removesuffix(".md"): _text(name).partition("\n")[0] for name in pages}
    return {name: head.removeprefix("# ") for name, head in heads.items() if head.startswith("# ")}


def page(name: str) -> str:
    """The text of a page, in Markdown.

    name : "model", or as a message has it: "docs/model.md", with or without a heading, "docs/model.md#units"

    Raises StudyError: there is no such page. It says which there are.
    """
    stem = PurePosixPath(name.partition("#")[0]).name.removesuffix(".md")
    known = titles()
    if stem in known:
        return _text(f"{stem}.md")
    near = difflib.get_close_matches(stem.lower(), known, n=1, cutoff=0.75)
    hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(known)}"
    raise StudyError([f"docs {shown(name)} is not a page; {hint}"])


def _text(name: str) -> str:
    return (_folder() / name).read_text(encoding="utf-8")

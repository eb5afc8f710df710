"""Where study files are: at a path, in studies/, or among those that come with roughcoat."""

import os
from functools import cache
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

STUDIES = Path("studies")
PACKAGE = Path(__file__).resolve().parents[1]


def packaged() -> Path:
    """Folder of the studies that come with roughcoat: in the installed package, or beside it in a clone."""
    inside, beside = PACKAGE / "studies", PACKAGE.parent / "studies"
    return next((folder for folder in (inside, beside) if folder.is_dir()), None) or Path(_unpacked().name)


@cache
def _unpacked() -> TemporaryDirectory:
    """A folder, until the program ends, with the studies of a package that is in a zip file."""
    folder, package = TemporaryDirectory(prefix="roughcoat-"), files("study")
    for studies in (package.parent / "studies", package / "studies"):
        for file in studies.iterdir() if studies.is_dir() else ():
            Path(folder.name, file.name).write_bytes(file.read_bytes())
    return folder


def study_file(path) -> Path:
    """The study file at a path, or of the study of a name, in studies/ or among those that come with roughcoat.

    Raises StudyError when there is none.
    """
    from .definition import StudyError  # here: the parser of the command line needs neither
    from .vocabulary import suggest

    text = os.fspath(path)
    given, short = Path(os.path.expanduser(text)), STUDIES / f"{text}.toml"
    by_path = given.suffix == ".toml"
    ours = [packaged() / f"{text}.toml"] if given.name == text else []
    for place in (given,) if by_path else (given, short, *ours):
        if place.exists():
            return place
    paths = [path.as_posix() for folder in (given.parent, STUDIES) for path in sorted(folder.glob("*.toml"))]
    beside = Path(f"{text}.toml")  # whoever writes "mine" means it, and no study of a name that is like it
    same = [path for path in paths if Path(path).name == given.name]
    known = same or paths if by_path else [beside.as_posix()] if beside.is_file() else known_studies()
    looked = "" if by_path else f" (looked for {given.as_posix()} and {short.as_posix()})"
    raise StudyError([f"{text}: not found{looked}{suggest(text, known) if known else ''}"])


def known_studies() -> list[str]:
    """Names of the studies in studies/, and of those that come with roughcoat."""
    return list(dict.fromkeys(path.stem for where in (STUDIES, packaged()) for path in sorted(where.glob("*.toml"))))

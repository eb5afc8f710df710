"""The places of studies: `studies` in the working folder, and the book that comes with roughcoat.

Both hold study files and chapters, which are folders of study files. A file `figures.py` may stand beside these.
"""

import os
import re
from functools import cache
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

STUDIES = Path("studies")
PACKAGE = Path(__file__).resolve().parents[1]
SECTION = re.compile(r"^[ \t]*\[{1,2}[ \t]*(model|axes|cases|sample)[ \t]*\]", re.MULTILINE)
BOOK = "study.studies"  # the package of the code in the book, in a clone and from a wheel


def packaged() -> Path:
    """Folder of the book: in the installed package, or beside it in a clone."""
    for folder in (PACKAGE / "studies", PACKAGE.parent / "studies"):
        if folder.is_dir():
            return folder
    return Path(_unpacked().name)


@cache
def _unpacked() -> TemporaryDirectory:
    """A folder, until the program ends, with the book of a package that is in a zip file."""
    folder, package = TemporaryDirectory(prefix="roughcoat-"), files("study")
    waiting = [(place, Path(folder.name)) for place in (package.parent / "studies", package / "studies")]
    while waiting:
        place, copy = waiting.pop()
        copy.mkdir(exist_ok=True)
        for file in place.iterdir() if place.is_dir() else ():
            if file.is_dir():
                waiting.append((file, copy / file.name))
            else:
                (copy / file.name).write_bytes(file.read_bytes())
    return folder


def chapters(root: Path) -> list[Path]:
    """A folder of studies and its chapters, which are the folders in it, by name."""
    inside = sorted(path for path in root.glob("*/") if path.is_dir() and not path.name.startswith((".", "_")))
    return [root, *inside]


def files_in(root: Path) -> list[Path]:
    """The study files of a folder and of its chapters."""
    return [path for folder in chapters(root) for path in sorted(folder.glob("*.toml"))]


def chapter(name: str) -> Path | None:
    """The folder of study files that a user means by a path, or by the name of a chapter; None if there is none."""
    place = Path(os.path.expanduser(name))
    folders = [place] if len(place.parts) != 1 else [place, STUDIES / place, packaged() / place]
    return next((folder for folder in folders if folder.is_dir() and any(folder.glob("*.toml"))), None)


def root_of(folder: Path) -> Path:
    """The folder of studies of which this folder is a chapter; the folder itself, if it is no chapter."""
    parent = folder.parent
    return parent if parent.name == STUDIES.name and "." not in folder.name else folder


def known_studies() -> list[str]:
    """Names of the studies in `studies`, and of those of the book."""
    return list(dict.fromkeys(path.stem for root in (STUDIES, packaged()) for path in files_in(root)))


def files_here() -> list[Path]:
    """The study files in the working folder, among the .toml files of other programs. A study file has a section whose
    heading occurs in no other program's files."""
    return [path for path in sorted(Path().glob("*.toml")) if path.is_file() and SECTION.search(_text(path))]


def _text(path: Path) -> str:
    from .reading import text_in  # imported here, since it loads numpy

    try:
        return text_in(path)
    except (OSError, ValueError):  # whoever names the file hears why
        return ""


def is_study(name: str) -> bool:
    """Whether a name or path belongs to a study file, and not to a figure, a table or a results file."""
    return Path(name).suffix == ".toml" or name in known_studies() or bool(_here(name))


def _here(name: str) -> Path | None:
    """The study file NAME.toml in the working folder, as `roughcoat new NAME` writes it."""
    path = Path(f"{name}.toml")
    return path if path.is_file() and SECTION.search(_text(path)) else None


def study_file(path, folder: Path | None = None) -> Path:
    """The study file at a path, or with a name, in `studies`, in the working folder or in the book.

    folder : the folder to search first; then comes the folder of studies of which it is a chapter

    A name may have its chapter, "paper/main_case", and a path may lack it: `studies/main_case.toml` is
    `studies/paper/main_case.toml`. Raises StudyError when there is no such file, or there are two.
    """
    text = os.fspath(path)
    place = Path(os.path.expanduser(text))
    if place.is_dir():
        raise _not_found(text, place)
    if place.exists():
        return place
    if by_path := place.suffix == ".toml":
        roots = [place.parent] if place.parent.name == STUDIES.name else []
    else:
        roots = [folder, root_of(folder), STUDIES, packaged()] if folder else [STUDIES, packaged()]
    for root in roots if ".." not in place.parts else ():
        if file := _in(root, place.stem if by_path else text):
            return file
        if root == STUDIES and not (by_path or folder) and (file := _here(text)):
            return file
    raise _not_found(text, place)


def _in(root: Path, name: str) -> Path | None:
    """The study file with a name in a folder, or in its only chapter with one. Raises StudyError if two have one."""
    here, *inside = (folder / f"{name}.toml" for folder in chapters(root))
    paths = [here] if here.exists() else [path for path in inside if path.exists()]
    if len(paths) > 1:
        from .definition import StudyError

        raise StudyError([f"{name}: is in {' and '.join(map(Path.as_posix, paths))}: give the path of one"])
    return paths[0] if paths else None


def _not_found(text: str, place: Path) -> Exception:
    """The error for a study file that does not exist, with the files that may be meant."""
    from .definition import StudyError
    from .vocabulary import suggest

    if folder := chapter(text):
        inside = [path.stem for path in sorted(folder.glob("*.toml"))]
        names = f"its studies are {', '.join(inside)}" if len(inside) > 1 else f"its study is {inside[0]}"
        return StudyError([f"{text}: is a folder of studies, not a study; {names}"])
    if place.is_dir():
        return StudyError([f"{text}: is a folder, not a study file"])
    by_path, neighbour = place.suffix == ".toml", Path(f"{text}.toml")
    files = (*sorted(place.parent.glob("*.toml")), *files_in(STUDIES))
    paths = list(dict.fromkeys(path.as_posix() for path in files))
    same = [path for path in paths if Path(path).name == place.name]
    meant = same or paths if by_path else known_studies()
    looked = "" if by_path else f" (looked for {place.as_posix()} and {(STUDIES / f'{text}.toml').as_posix()})"
    if not by_path and neighbour.is_file():  # not a study with a similar name
        return StudyError([f'{text}: not found{looked}; did you mean "{neighbour.as_posix()}"?'])
    return StudyError([f"{text}: not found{looked}{suggest(text, meant) if meant else ''}"])

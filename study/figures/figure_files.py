"""`figures.py` beside studies: the names of its figures and tables, read without running it, and their registration.

Names are read from the text: from decorators `@figure("NAME", ...)` and the like, in `figures.py` and in the files
beside it that it imports (`from . import curves`). The file is run when one of its figures or tables is needed.
"""

import ast
import hashlib
import logging
import sys
from collections.abc import Iterator
from functools import lru_cache
from importlib import import_module, invalidate_caches
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

from solver.numerics.userfile import LARGEST_TEXT, content

from ..inputs.definition import StudyError
from ..inputs.places import BOOK, STUDIES, chapter, chapters, packaged, root_of
from ..inputs.vocabulary import suggest
from ..terminal import on_one_line

log = logging.getLogger(__name__)
FILE = "figures.py"
KINDS = {"figure": "figure", "drawing": "figure", "table": "table", "measured": "measured"}
"""Decorator of `study.figures.registry` -> kind of what it registers."""
LARGEST = 1_000_000  # largest number of bytes in a file beside `figures.py` that counts as its data; ours have 6,000


def user_files() -> list[Path]:
    """Each `figures.py` of the user: in the working folder, in `studies`, and in its chapters."""
    book = packaged().resolve()
    files = [folder / FILE for folder in (Path(), *chapters(STUDIES))]
    return [file for file in files if file.is_file() and not file.resolve().is_relative_to(book)]


def book_files() -> list[Path]:
    """Each `figures.py` of the book."""
    return [folder / FILE for folder in chapters(packaged()) if (folder / FILE).is_file()]


class Text(NamedTuple):
    """The figures and tables of one file.

    modules : the modules beside it that it imports
    entries : (kind, name) -> whether it is `long`
    """

    modules: tuple[str, ...]
    entries: dict[tuple[str, str], bool]


def names_in(file: Path) -> dict[tuple[str, str], bool]:
    """(kind, name) of each entry of a `figures.py` -> whether it is `long`. The file is not run.

    Raises StudyError for a file that is not Python.
    """
    entries, wanted, seen = {}, [file], set()
    while wanted:
        path = wanted.pop()
        seen.add(path)
        state = path.stat()
        text = read(path, (state.st_ino, state.st_size, state.st_mtime_ns))
        entries |= text.entries
        paths = {file.parent / f"{module.replace('.', '/')}.py" for module in text.modules}
        wanted += sorted(path for path in paths - {*seen, *wanted} if path.is_file())
    return entries


@lru_cache(maxsize=256)  # every command asks several times for each figure; a file is read in a millisecond
def read(path: Path, _: tuple) -> Text:
    """The text of a file; the second argument changes when the file does. Raises StudyError if it is not Python."""
    try:
        nodes = list(ast.walk(ast.parse(content(path, LARGEST_TEXT))))
    except (
        SyntaxError,
        ValueError,
        RecursionError,
        MemoryError,
    ) as error:  # some come from null bytes or deep brackets
        line = f"line {error.lineno}: " if isinstance(error, SyntaxError) and error.lineno else ""
        raise StudyError([f"{path.as_posix()}: is not valid Python: {line}{getattr(error, 'msg', error)}"]) from None
    except OSError as error:
        raise StudyError([f"{path.as_posix()}: cannot be read: {error.strerror}"]) from None
    imports = [node for node in nodes if isinstance(node, ast.ImportFrom)]
    of_folder = [node for node in imports if node.level == 1]
    modules = [name for node in of_folder for name in ([node.module] if node.module else [a.name for a in node.names])]
    called = {alias.asname or alias.name: alias.name for node in imports for alias in node.names if alias.name in KINDS}
    return Text(tuple(modules), dict(_calls(nodes, called)))


def _calls(nodes: list[ast.AST], called: dict[str, str]) -> Iterator[tuple[tuple[str, str], bool]]:
    """(kind, name) and `long` of each call of a decorator.

    called : name of a decorator in the file -> its name in KINDS
    """
    for node in nodes:
        if isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            decorator = called.get(getattr(node.func, "id", None), getattr(node.func, "attr", None))
            name = node.args[0].value
            if decorator in KINDS and isinstance(name, str):  # `@figure` as well as `@registry.figure`
                options = {word.arg: word.value for word in node.keywords}
                yield (KINDS[decorator], name), bool(getattr(options.get("long"), "value", False))


def names(kind: str, *, long: bool = True) -> list[str]:
    """The names of all figures, or tables, beside studies, the user's before the book's.

    long : whether figures that take long are among them

    A file that cannot be read is listed by its path; `place_of` reports the error.
    """
    listed = []
    for file in (*user_files(), *book_files()):
        try:
            entries = names_in(file).items()
            listed += sorted(
                name for (kind_of_entry, name), is_long in entries if kind_of_entry == kind and (long or not is_long)
            )
        except StudyError:
            listed.append(file.as_posix())
    return list(dict.fromkeys(listed))


def place_of(kind: str, name: str) -> tuple[Path, str] | None:
    """The `figures.py` of a figure or table and its name there; None if there is none. FOLDER/NAME names the folder.

    The user's files go before the book's. Raises StudyError if the user, or the book, has two of this name.
    """
    folder, _, last = name.rpartition("/")
    if folder:
        file = Path(folder, FILE)
        files = [file] if file.is_file() and (kind, last) in names_in(file) else []
    else:
        files = [file for file in user_files() if (kind, name) in _readable(file)]
        files = files or [file for file in book_files() if (kind, name) in _readable(file)]
    if len(files) > 1:
        paths = " and ".join(file.as_posix() for file in files)
        raise StudyError([f"{name}: is in {paths}: say which, such as {files[0].parent.as_posix()}/{name}"])
    return (files[0], last) if files else None


def _readable(file: Path) -> dict:
    try:
        return names_in(file)
    except StudyError:
        return {}


def unknown(kind: str, name: str, registered: list[str]) -> StudyError:
    """The error for a figure or table that does not exist.

    registered : further known names

    The name may be the number of a figure or table, or that of a study file in the working folder. The error also names
    files that cannot be read, since the name may be in one of them.
    """
    choices = [*registered, *names(kind)]
    numbered = [text for text in (f"{kind}{name}", f"{kind[:3]}{name:0>2}") if text in choices]
    study_here = [f"{name}.toml"] if Path(f"{name}.toml").is_file() else []
    meant = [f'; did you mean "{text}"?' for text in (*study_here, *numbered)]
    lines = [f'"{name}" is not known{meant[0] if meant else suggest(name, choices)}']
    if (folder := chapter(name)) and not study_here:
        entries = _readable(folder / FILE) if (folder / FILE).is_file() else {}
        inside = [text for kind_of_entry, text in entries if kind_of_entry == kind]
        names_inside = f"its {kind}s are {', '.join(inside)}" if inside else f"it has no {kind}s"
        lines = [f"{name}: is a folder of studies, not a {kind}; {names_inside}"]
    for file in (*user_files(), *book_files()):
        try:
            names_in(file)
        except StudyError as error:
            lines += error.messages
    return StudyError(lines)


def package_of(file: Path) -> str:
    """The package in which a `figures.py` and the files beside it are imported, so that it can import these.

    Chapters of one folder of studies belong to one package: `from ..paper import numbers`.
    """
    folder, root = file.resolve().parent, _root(file)
    in_book = root == packaged().resolve()
    top = BOOK if in_book else f"{BOOK}_{hashlib.sha256(str(root).encode()).hexdigest()[:8]}"
    if top not in sys.modules:
        sys.modules[top] = ModuleType(top)
        sys.modules[top].__path__ = [str(root)]
    return ".".join((top, *folder.relative_to(root).parts))


def _root(file: Path) -> Path:
    """The folder of studies to which a `figures.py` belongs, resolved: the book, or the folder that has its chapter."""
    folder, book = file.resolve().parent, packaged().resolve()
    return book if folder.is_relative_to(book) else root_of(folder)


def run(file: Path) -> str:
    """Run a `figures.py`, once, and return its package. Raises StudyError if it fails."""
    package = package_of(file)
    try:
        invalidate_caches()  # the file may have been written a second ago
        import_module(f"{package}.{Path(FILE).stem}")
    except (StudyError, MemoryError):
        raise
    except Exception as error:
        log.info("%s", file, exc_info=True)
        reason = f"{type(error).__name__}: {on_one_line(str(error), 300)}"
        wrong = f"{file.as_posix()}: cannot be run: {reason}; -v before the command shows where"
        raise StudyError([wrong], code=1) from error
    return package


def files_of(file: Path) -> list[Path]:
    """Files on which the figures of a `figures.py` may depend: itself, the files of studies that it imports, the files
    that these import, and the data beside all of them.

    Imports are read from the texts. So it does not matter which modules a program has imported before, nor which
    process draws a figure.
    """
    code, waiting, root = set[Path](), [file.resolve()], _root(file)
    while waiting:
        path = waiting.pop()
        if path not in code and path.is_relative_to(root):
            code.add(path)
            state = path.stat()
            waiting += _imported(path, (state.st_ino, state.st_size, state.st_mtime_ns))
    neighbours = {path for folder in {file.parent for file in code} for path in folder.iterdir()}
    data = {path for path in neighbours if path.suffix != ".py" and path.is_file() and path.stat().st_size <= LARGEST}
    return sorted(code | {path for path in data if not path.name.startswith(".")})


@lru_cache(maxsize=256)
def _imported(path: Path, _: tuple) -> list[Path]:
    """The files that a file imports by relative imports, wherever these stand in it. For `_` see `read`."""
    try:
        nodes = [node for node in ast.walk(ast.parse(path.read_bytes())) if isinstance(node, ast.ImportFrom)]
    except (SyntaxError, ValueError, RecursionError):  # running the file reports the error
        return []
    paths = []
    for node in (node for node in nodes if node.level):
        place = path.parents[node.level - 1] / (node.module or "").replace(".", "/")
        modules = [place, *(place / alias.name for alias in node.names)]
        paths += [file for module in modules for file in (module.with_suffix(".py"), module / "__init__.py")]
    return [file for file in paths if file.is_file()]

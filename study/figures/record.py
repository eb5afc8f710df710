"""The record of a folder of figures or tables: a digest of the data behind each, and of the files that were written.

It judges whether a file is up to date by its content, not by its time: times change when a folder is copied, and a file
that was cut off is as young as a complete one.
"""

import hashlib
import json
from functools import cache
from pathlib import Path

import solver

from ..data.provenance import NUMERICS_VERSION, package_version
from ..files.results_file import numbers_digest
from .formats import write

RECORD = ".roughcoat.json"  # name of the record in the folder
PACKAGES = (Path(solver.__file__).parent, Path(__file__).parents[1])
LIBRARIES = ("roughcoat", "numpy", "scipy", "xarray", "matplotlib")
"""Packages whose version may change a figure."""
LARGEST = 10_000_000  # largest number of bytes in a record, whose entries have some 400 each


def digest_of(what: str, endings: tuple[str, ...], results: list[Path], code_files: list[Path]) -> str:
    """sha256 of everything on which the files of a figure or table depend.

    what : "figure fig03"
    endings : of the files
    results : files of the studies that it needs
    code_files : the code that draws it, and the files that this code may read
    """
    code = [(path.name, _digest(path)) for path in code_files]
    content = [what, endings, program(), code, [numbers_digest(path) for path in results]]
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()


@cache  # 300 files are read in 30 ms
def program() -> str:
    """sha256 of all files of the program, and of the versions of its libraries."""
    digest = hashlib.sha256(json.dumps([NUMERICS_VERSION, *map(package_version, LIBRARIES)]).encode())
    for package in PACKAGES:
        archive = next((path for path in package.parents if path.is_file()), None)  # a zip file that holds the package
        if archive:
            digest.update(f"{_digest(archive)}\n".encode())
        for file in sorted(package.rglob("*.*")):
            if file.is_file() and file.parent.name != "__pycache__":
                digest.update(f"{file.relative_to(package).as_posix()} {_digest(file)}\n".encode())
    return digest.hexdigest()


def is_up_to_date(folder: Path, what: str, digest: str, names: list[str]) -> bool:
    """Whether the files `names` are byte for byte those that were written for this digest."""
    entry = _read(folder).get(what)
    if not isinstance(entry, dict) or entry.get("of") != digest:
        return False
    digests = {name: _digest(folder / name) for name in names if (folder / name).is_file()}
    return entry.get("files") == digests and len(digests) == len(names)


def note(folder: Path, what: str, digest: str, paths: list[Path]) -> None:
    """Put the newly written files of a figure or table into the record.

    If two programs do so at once, one entry may be lost; its figure or table is then made again.
    """
    entry = {"of": digest, "files": {path.name: _digest(path) for path in paths}}
    write(folder / RECORD, json.dumps(_read(folder) | {what: entry}, indent=1, sort_keys=True) + "\n")


def _read(folder: Path) -> dict:
    """The record of a folder; {} if there is none, or it cannot be read."""
    try:
        path = folder / RECORD
        record = json.loads(path.read_bytes()) if path.is_file() and path.stat().st_size < LARGEST else {}
    except (OSError, ValueError, RecursionError):
        return {}
    return record if isinstance(record, dict) else {}


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()

"""Remove the figures and tables that the program draws, and caches: `make clean`. Results stay, and your own figures.

Usage: python tools/clean.py, in the folder that is to be cleaned
"""

import shutil
from pathlib import Path

from study.catalogue import CAPTIONS, ENDINGS
from study.figures.figure_files import book_files, names_in
from study.figures.record import RECORD

CACHES = (".pytest_cache", ".ruff_cache", ".hypothesis")


def written() -> list[Path]:
    """The files of all figures and tables, whether they exist or not."""
    names = {
        kind: [name for file in book_files() for kind_of_entry, name in names_in(file) if kind_of_entry == kind]
        for kind in ("figure", "table")
    }
    drawn = {*ENDINGS["figure"], *ENDINGS["drawing"]}
    figures = [Path("figures", f"{name}.{ending}") for name in names["figure"] for ending in drawn]
    tables = [Path("tables", f"{name}.{ending}") for name in names["table"] for ending in ENDINGS["table"]]
    records = [Path(folder, RECORD) for folder in ("figures", "tables")]
    return [*figures, *tables, *records, Path("figures", f"{CAPTIONS}.md"), Path("bench.json")]


if __name__ == "__main__":
    for file in written():
        file.unlink(missing_ok=True)
    rooms = map(Path, ("solver", "study", "studies", "tests", "tools"))
    compiled = [folder for room in rooms for folder in room.rglob("__pycache__")]
    for folder in (*map(Path, CACHES), *compiled):
        shutil.rmtree(folder, ignore_errors=True)

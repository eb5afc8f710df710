"""Remove the figures and tables that the program draws, and caches: `make clean`. Results stay, and your own figures.

Usage: python tests/repository/clean.py, in the folder that is to be cleaned
"""

import shutil
from pathlib import Path

from study.catalogue import CAPTIONS, FIGURE, FIGURES, SCHEME, SCHEMES, TABLE, TABLES
from study.figures.record import RECORD

CACHES = (".pytest_cache", ".ruff_cache", ".hypothesis")


def written() -> list[Path]:
    """The files of all figures and tables, whether they are there or not."""
    figures = [Path("figures", f"{name}.{kind}") for name in (*FIGURES, *SCHEMES) for kind in {*FIGURE, *SCHEME}]
    tables = [Path("tables", f"{name}.{kind}") for name in TABLES for kind in TABLE]
    records = [Path(folder, RECORD) for folder in ("figures", "tables")]
    return [*figures, *tables, *records, Path("figures", f"{CAPTIONS}.md"), Path("bench.json")]


if __name__ == "__main__":
    for file in written():
        file.unlink(missing_ok=True)
    compiled = [folder for room in ("solver", "study", "tests") for folder in Path(room).rglob("__pycache__")]
    for folder in (*map(Path, CACHES), *compiled):
        shutil.rmtree(folder, ignore_errors=True)

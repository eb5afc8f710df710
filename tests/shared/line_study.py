"""A study of 23 loads in five blocks, the fixtures around it, and what a run of it leaves on disk."""

import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import study
from study.store.blocks import add, inventory
from study.store.windows import Store
from study.work import cases
from study.work.cases import parcel

TEXT = """
[model]
micro = "smooth"
base = "half_space"
[axes]
P = {start = 1e-6, stop = 1e-4, num = 23}
[numerics]
block = 5
[output]
x = 3
"""
COUNT = 5  # blocks


@pytest.fixture
def file(tmp_path) -> Path:
    path = tmp_path / "line.toml"
    path.write_text(TEXT, encoding="utf-8")
    return path


@pytest.fixture
def computed(monkeypatch) -> list:
    """First cases of the blocks that are computed, in the order of their computation."""
    seen, real = [], cases.compute

    def compute(wanted):
        seen.append(wanted.first)
        return real(wanted)

    monkeypatch.setattr(cases, "compute", compute)
    return seen


@pytest.fixture
def quiet() -> Callable[[], bool]:
    """Whether the threads that the test has started have ended."""
    before = set(threading.enumerate())
    return lambda: set(threading.enumerate()) <= before


def ending(monkeypatch, statuses: dict[int, int]) -> None:
    """Make cases end with a status, and without a contact radius."""
    real = cases.compute

    def compute(wanted):
        found = real(wanted)
        for case, status in statuses.items():
            if wanted.first <= case <= wanted.last:
                found["status"][case - wanted.first] = status
                found["a"][case - wanted.first] = np.nan
        return found

    monkeypatch.setattr(cases, "compute", compute)


def store_block(opened, start: int, stop: int) -> Path:
    """Compute and store the cases start <= i < stop, as a run that ends there would have."""
    store, index = Store(opened.definition, opened.results), np.arange(start, stop)
    store.folder.mkdir(parents=True, exist_ok=True)
    known = inventory(store)
    add(store, known, index, cases.compute(parcel(opened.definition, index)))
    return known.sources[-1].path


def present(opened) -> int:
    """Cases on disk before the results file is written."""
    return opened.status()["cases"] - opened.status()["counts"].get(127, 0)


def load(file, **changes) -> study.Study:
    text = TEXT
    for old, new in changes.items():
        text = text.replace(old, new)
    file.write_text(text, encoding="utf-8")
    return study.load(file, file.parent / "results")


def leftovers(folder: Path) -> list[str]:
    """Names of what is in a folder of results, but for results and what a run keeps with its blocks."""
    kept = ("line.nc", "lock")
    names = (path.name for path in folder.rglob("*") if path.suffix not in (".blocks", ".block", ".cases"))
    return sorted(name for name in names if name not in kept)

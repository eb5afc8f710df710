"""The core is optional: how it is built, chosen, and done without."""

from pathlib import Path

import pytest
from both_paths import ROOT, built, by, compiler, contacts, of_the_sources  # noqa: F401

from solver import solve
from solver.compiled import library

#: Lines of C: 1,000 for Newton's method, and 150 for loads of curves that stick.
LINES, LOAD = 1150, library._library  # the function itself: these tests have another in its place


@pytest.fixture
def without(monkeypatch):
    """As if no core had been built."""
    monkeypatch.setattr(library, "EXTENSION_SUFFIXES", [".nothing"])
    monkeypatch.setattr(library, "_library", LOAD)
    for kept in (LOAD, library._variant):
        kept.cache_clear()
    yield
    monkeypatch.undo()
    for kept in (LOAD, library._variant):
        kept.cache_clear()


def test_without_a_compiler_nothing_fails(tmp_path):
    assert built(tmp_path, CC="/bin/false") == []


@pytest.mark.skipif(not compiler(), reason="no C compiler")
def test_a_compiler_builds_it(tmp_path):
    (name,) = built(tmp_path)
    assert name.startswith(f"{library.NAME}.")
    beside_the_sources = (ROOT / "solver/compiled").glob(f"{library.NAME}*{Path(name).suffix}")
    assert list(beside_the_sources), "build it: make setup, or python setup.py build_ext --inplace"


def test_without_the_core_numpy_computes(without):
    assert library.available() == () and library.core() is None
    problem = contacts(10, 9)
    assert solve(problem).P.tobytes() == by("numpy", problem).P.tobytes()


def test_a_library_that_cannot_be_loaded_is_done_without(without, monkeypatch, tmp_path):
    monkeypatch.setattr(library, "EXTENSION_SUFFIXES", [".so"])
    monkeypatch.setattr(library, "__file__", str(tmp_path / "library.py"))
    (tmp_path / f"{library.NAME}.so").write_text("no library")
    assert library.available() == () and library.core() is None


def test_the_choice(monkeypatch):
    monkeypatch.setenv(library.VARIABLE, "numpy")
    assert library.core() is None
    for name in library.available():
        monkeypatch.setenv(library.VARIABLE, name)
        assert library.core() is library._variant(name)
    monkeypatch.delenv(library.VARIABLE)
    assert (library.core() is None) == (not library.available())


@pytest.mark.parametrize("word", ["cobol", "AVX2"])
def test_a_choice_that_does_not_exist(word):
    with pytest.raises(ValueError, match=rf"ROUGHCOAT_CORE = {word}: must be one of numpy"):
        by(word, contacts(1, 10, base="layered"))


def test_the_core_stays_small():
    files = [path for path in (ROOT / "solver/compiled").iterdir() if path.suffix in (".c", ".h")]
    lines = [line for path in files for line in path.read_text(encoding="utf-8").splitlines()]
    assert len(lines) <= LINES and max(map(len, lines)) <= 120

"""The core is optional: how it is built, chosen, and done without."""

import shutil
import subprocess
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest
from both_paths import ROOT, built, by, compiler, contacts, of_the_sources  # noqa: F401

from solver import solve
from solver.compiled import library

#: Lines of C: 1,000 for Newton's method, 150 for loads of curves that stick, 290 for sums over waves with their Bessel
#: functions, and 110 for the search in models of stresses.
LINES, LOAD, CORE = 1550, library._library, library.FILE  # the function itself: these tests have another in its place


@pytest.fixture
def without(monkeypatch):
    """As if no core had been built."""
    monkeypatch.setattr(library, "FILE", "_core.nothing")
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
def test_a_compiler_builds_it_beside_its_sources(without, monkeypatch, tmp_path):
    """`python setup.py build_ext --inplace`: the new core is loaded, not one that an earlier version left."""
    for path in ("setup.py", "pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / path, tmp_path)
    folder, unwanted = tmp_path / "solver/compiled", shutil.ignore_patterns("__pycache__", "*.so")
    shutil.copytree(ROOT / "solver", tmp_path / "solver", ignore=unwanted)
    (folder / f"_core{EXTENSION_SUFFIXES[0]}").write_text("of an earlier version")
    command = [sys.executable, "setup.py", "--quiet", "build_ext", "--inplace"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, timeout=300)
    monkeypatch.setattr(library, "FILE", CORE)
    monkeypatch.setattr(library, "__file__", str(folder / "library.py"))
    assert Path(LOAD()._name) == folder / CORE and library.available()


def test_the_core_of_this_folder_is_built():
    assert not compiler() or (ROOT / "solver/compiled" / library.FILE).exists(), "build it: make setup"


def test_without_the_core_numpy_computes(without):
    assert library.available() == () and library.core() is None
    problem = contacts(10, 9)
    assert solve(problem).P.tobytes() == by("numpy", problem).P.tobytes()


def test_a_library_that_cannot_be_loaded_is_done_without(without, monkeypatch, tmp_path):
    monkeypatch.setattr(library, "FILE", CORE)
    monkeypatch.setattr(library, "__file__", str(tmp_path / "library.py"))
    (tmp_path / CORE).write_text("no library")
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

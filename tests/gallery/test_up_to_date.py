"""The second `plot --run all` draws nothing: what a figure is made of does not depend on what was imported before."""

import sys
from pathlib import Path

import pytest

from study import catalogue
from study.__main__ import main
from study.figures.figure_files import book_files, files_of
from study.figures.registry import code_of, names
from study.inputs.places import BOOK, packaged


@pytest.fixture
def drawn(monkeypatch) -> list[str]:
    """The names of the figures and tables that commands draw: files of a word each."""
    names = []

    def write(name: str, results, folder) -> list[Path]:
        names.append(name)
        kind = "table" if Path(folder).name == "tables" else "figure"
        ends = ("md",) if name == catalogue.CAPTIONS else catalogue.endings(kind, name)
        Path(folder).mkdir(exist_ok=True)
        paths = [Path(folder) / f"{name}.{end}" for end in ends]
        for path in paths:
            path.write_text(name, encoding="utf-8")
        return paths

    monkeypatch.setattr("study.commands.drawing.MANY", 1000)  # a second process would draw some of them
    monkeypatch.setattr("study.commands.drawing._prepared", lambda *_: 0)
    for name in ("draw", "tabulate"):
        monkeypatch.setattr(catalogue, name, write)
    return names


def forget_the_book(monkeypatch) -> None:
    """As in a process that has just begun."""
    for name in [name for name in sys.modules if f"{name}.".startswith(f"{BOOK}.")]:
        monkeypatch.delitem(sys.modules, name)


@pytest.mark.parametrize("command", ["plot", "table"])
def test_the_second_time_nothing_is_drawn(command, results, drawn, tmp_path, monkeypatch):
    kind = {"plot": "figure", "table": "table"}[command]
    words = [command, "--run", f"--{kind}s", str(tmp_path / f"{kind}s"), "--results", str(results)]
    forget_the_book(monkeypatch)
    assert main([*words, "all"]) == 0 and len(drawn) == len(catalogue.usual(kind))
    always = [catalogue.CAPTIONS] * (command == "plot")
    drawn.clear()
    assert main([*words, "all"]) == 0 and drawn == always
    drawn.clear()
    forget_the_book(monkeypatch)
    backwards = catalogue.usual(kind)[::-1]
    assert main([*words, *backwards]) == 0 and drawn == always
    drawn.clear()
    for name in backwards:
        forget_the_book(monkeypatch)
        assert main([*words, name]) == 0
    assert drawn == always


def test_the_files_of_a_figure_are_those_it_imports_and_the_data_beside(tmp_path):
    texts = {
        "studies/one/figures.py": "from . import helpers\nfrom ..two.deep import more\nimport json\n",
        "studies/one/helpers.py": "def late():\n    from .late import number\n",
        "studies/one/late.py": "from ....outside import nothing\nfrom . import absent\n",
        "studies/one/apart.py": "",
        "studies/one/data.csv": "1",
        "studies/two/deep/__init__.py": "from ..base import *\n",
        "studies/two/deep/more.py": "",
        "studies/two/base.py": "from .deep import more\n",
        "studies/two/table.txt": "2",
        "studies/two/deep/.hidden": "",
        "studies/three/figures.py": "",
        "outside/nothing.py": "",
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    found = {path.relative_to(tmp_path).as_posix() for path in files_of(tmp_path / "studies/one/figures.py")}
    left_out = ("studies/one/apart.py", "studies/two/deep/.hidden", "studies/three/figures.py", "outside/nothing.py")
    assert found == {*texts} - {*left_out}


def test_every_module_of_the_book_that_a_figure_imports_counts():
    """By its text as by what Python has imported."""
    for kind in ("figure", "table"):
        for name in names(kind):
            catalogue.entry(kind, name)
    root = packaged().resolve()
    modules = [module for name, module in sys.modules.items() if name.startswith(f"{BOOK}.")]
    loaded = {Path(module.__file__).resolve() for module in modules if getattr(module, "__file__", None)}
    counted = {path for file in book_files() for path in files_of(file)}
    assert {path for path in loaded if path.is_relative_to(root)} <= counted
    assert len(code_of("figure", "fig03")) > 3

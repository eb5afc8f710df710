"""The scripts of the gallery run, hold what they assert, and leave a picture; they use public names alone."""

import ast
import os
import re
import runpy
import warnings
from pathlib import Path

import matplotlib.pyplot
import pytest
from conftest import ROOT

import roughcoat

SCRIPTS = sorted((ROOT / "docs/gallery").glob("plot_*.py"))


def test_there_are_at_least_twelve():
    assert len(SCRIPTS) >= 12


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_of_the_gallery(script, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = script.read_text(encoding="utf-8")
    tree = ast.parse(text)
    asserted = sum(isinstance(node, ast.Assert) for node in ast.walk(tree))
    assert asserted and len(text.splitlines()) <= 60
    used = set(re.findall(r"\brc\.(\w+)", text))
    assert used <= {*roughcoat.__all__} and "study" not in {n.name for n in ast.walk(tree) if isinstance(n, ast.alias)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made = runpy.run_path(os.fspath(script))
    figures = [value for value in made.values() if isinstance(value, matplotlib.figure.Figure)]
    last = tree.body[-1]
    shown = isinstance(last, ast.Expr) and ast.unparse(last).startswith("rc.plot")
    assert figures or shown
    for figure in figures:
        figure.savefig(tmp_path / "picture.png")
        assert Path("picture.png").stat().st_size > 5000
    matplotlib.pyplot.close("all")

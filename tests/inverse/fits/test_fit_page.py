"""What docs/fit.md prints, in Python and in a terminal."""

import shlex

import pages
import pytest

from study.__main__ import main

pytest.importorskip("pint")


def test_the_command_of_the_page_prints_what_its_python_prints(tmp_path, monkeypatch, capsys):
    pages.check_examples("docs/fit.md", tmp_path)
    monkeypatch.chdir(tmp_path)  # where Python has written curve.csv
    (command,), (_, printed) = pages.blocks("docs/fit.md", "sh"), pages.examples("docs/fit.md")[0]
    assert main(shlex.split(command)[1:]) == 0
    assert pages.same(capsys.readouterr().out.split(), printed.split())

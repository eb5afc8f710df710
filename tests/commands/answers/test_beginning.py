"""The commands of the first minutes: new, show, doctor."""

import tomllib
from pathlib import Path

import pytest
from conftest import ROOT, STUDIES

import study
from study.__main__ import main
from study.commands import beginning
from study.inputs.reading import read


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_a_new_study_is_valid_and_has_comments(capsys):
    assert main(["new", "mine"]) == 0
    check, run = (f"`python -m roughcoat {command} mine.toml`" for command in ("check", "run"))
    assert capsys.readouterr().out == f"mine.toml: edit it, then {check} and {run}\n"
    definition, text = read(Path("mine.toml")), Path("mine.toml").read_text(encoding="utf-8")
    assert dict(definition.grid.sizes) == {"h in SI": 3, "P in SI": 5}
    assert all("#" in line for line in text.splitlines() if " = " in line and "title" not in line)


def test_a_new_study_with_asperities_is_valid():
    """As the comments say: another micro, and the two lines that are commented out."""
    assert main(["new", "mine.toml"]) == 0
    text = Path("mine.toml").read_text(encoding="utf-8")
    text = text.replace("# Nbar", "Nbar").replace("# Ra", "Ra").replace('"smooth"', '"disc_cell"')
    Path("mine.toml").write_text(text, encoding="utf-8")
    assert read(Path("mine.toml")).grid.size == 15


def test_a_copy_of_a_study(capsys):
    source = ROOT / "studies/systems/dlc_on_steel.toml"
    assert main(["new", "a", "b.toml", "--from", "dlc_on_steel"]) == 0
    assert Path("a.toml").read_bytes() == Path("b.toml").read_bytes() == source.read_bytes()
    capsys.readouterr()
    assert main(["show", "dlc_on_steel"]) == main(["show", "a.toml"]) == 0
    assert capsys.readouterr().out == 2 * source.read_text(encoding="utf-8")


def test_no_file_is_written_over(capsys):
    Path("mine.toml").write_text("x = 1\n", encoding="utf-8")
    assert main(["new", "mine"]) == 2
    assert Path("mine.toml").read_text(encoding="utf-8") == "x = 1\n"
    assert main(["new", "nowhere/mine"]) == 2 and main(["new", "mine2", "--from", "dlc_on_stel"]) == 2
    messages = capsys.readouterr().err.splitlines()
    assert messages[0] == "mine.toml: exists and is not overwritten: choose another name"
    assert messages[1] == "nowhere/mine.toml: there is no folder nowhere"
    assert messages[2].startswith("dlc_on_stel: not found") and "dlc_on_steel" in messages[2]
    assert list(Path().iterdir()) == [Path("mine.toml")]


def test_every_study_is_shown(capsys):
    assert main(["show", *(path.stem for path in STUDIES)]) == 0
    assert capsys.readouterr().out.count("[axes]") > 10


def test_the_doctor(capsys, monkeypatch):
    assert main(["doctor"]) == 0
    text = capsys.readouterr().out
    assert text.startswith(f"roughcoat      {study.__version__}, numerics ")
    assert str(study.samples.scan()) in text and str(study.samples.curve()) in text
    assert text.endswith("solved: its radius is that of Hertz\n")
    monkeypatch.setenv("ROUGHCOAT_CORE", "numpy")
    monkeypatch.setattr(beginning, "find_spec", lambda name: None)
    assert main(["doctor"]) == 0
    text = capsys.readouterr().out
    assert "compiled core  none, numpy computes" in text
    assert all(f"missing: pip install 'roughcoat[{extra}]'" in text for extra in beginning.EXTRAS)


def test_a_wrong_contact_is_said(capsys, monkeypatch):
    monkeypatch.setattr("study.solving.solve", lambda **_: {"a": 0.01})
    assert main(["doctor"]) == 1
    assert "WRONG" in capsys.readouterr().out


def test_the_doctor_looks_for_extras_that_exist():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    for extra, (package, _) in beginning.EXTRAS.items():
        assert any(requirement.startswith(package) for requirement in extras[extra])

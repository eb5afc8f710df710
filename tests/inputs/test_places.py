"""Where the program stands: other working folders, none at all, its packages in a zip file."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from conftest import ROOT

import study
from study.__main__ import main

TEXT = '[model]\nbase = "half_space"\nmicro = "smooth"\n[axes]\nP = [1e-5, 2e-5]\n'
pytestmark = pytest.mark.skipif(os.name == "nt", reason="a working folder cannot be deleted there")


def run(script: str, folder: Path, *packages) -> str:
    """What a Python script prints in a folder, with the packages on its path."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, packages))}
    command = [sys.executable, "-P", "-c", script]
    ended = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


def test_a_study_is_loaded_by_its_name_as_the_command_line_does(tmp_path, monkeypatch, capsys):
    """In studies/, then among those that come with roughcoat."""
    monkeypatch.chdir(tmp_path)
    studies = tmp_path / "studies"
    studies.mkdir()
    (studies / "good.toml").write_text(TEXT, encoding="utf-8")
    assert repr(study.load("good")) == repr(study.load(studies / "good.toml"))
    assert study.load("dlc_on_steel").definition.name == "dlc_on_steel"
    (studies / "dlc_on_steel.toml").write_text(TEXT, encoding="utf-8")
    assert study.load("dlc_on_steel").definition.cases.startswith("2 cases")
    for name in ("dlc_on_steal", "no.toml"):
        with pytest.raises(study.StudyError) as said:
            study.load(name)
        assert main(["check", name]) == 2
        assert str(said.value) in capsys.readouterr().err


def test_results_stay_where_they_were_when_the_study_was_loaded(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("mine.toml").write_text(TEXT, encoding="utf-8")
    Path("elsewhere").mkdir()
    loaded = study.load("mine.toml")
    assert repr(loaded).endswith(", results/mine.nc)"), "short while nobody goes away"
    monkeypatch.chdir("elsewhere")
    assert loaded.run(workers=1).path == tmp_path / "results/mine.nc"
    assert loaded.status()["state"] == "done" and loaded.open().sizes["P"] == 2 and loaded.verify().good
    assert list(Path().iterdir()) == [] and (tmp_path / "results/mine.nc").is_file()
    monkeypatch.chdir(tmp_path)
    assert loaded.run(workers=1).path == Path("results/mine.nc")
    assert loaded.run(workers=1).computed == 0


def test_results_in_the_home_directory(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "mine.toml").write_text(TEXT, encoding="utf-8")
    study.load("~/mine.toml", "~/there").run(workers=1)
    assert study.open_results("~/there/mine.nc").sizes["P"] == 2
    assert main(["plot", "~/there/mine.nc", "--x", "P", "--y", "a", "--figures", str(tmp_path / "figures")]) == 0


GONE = """
import contextlib, io, os, subprocess, sys
import study
from study.__main__ import main
os.mkdir("gone"); os.chdir("gone"); os.rmdir("../gone")
print(study.solve(P=[1e-5, 2e-5], base="half_space", micro="smooth").sizes["P"])
def command(*words):
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        code = main([*words])
    print(words[0], code, said.getvalue().splitlines()[-1])
here = os.environ["HERE"]
print(study.load(here + "/mine.toml", here + "/results").run(workers=2).computed)
begun = subprocess.run([sys.executable, "-m", "study", "check", here + "/mine.toml"], capture_output=True, text=True)
assert "Traceback" not in begun.stderr, begun.stderr
print("begun", begun.returncode, begun.stdout)
command("status", here + "/mine.toml")
command("plot", here + "/results/mine.nc", "--x", "P", "--y", "a", "--figures", here + "/figures")
command("plot", "fig09")
"""


def test_a_working_folder_that_has_been_deleted(tmp_path, monkeypatch):
    (tmp_path / "mine.toml").write_text(TEXT, encoding="utf-8")
    monkeypatch.setenv("HERE", str(tmp_path))
    solved, computed, *said = filter(None, run(GONE, tmp_path, ROOT).splitlines())
    assert (solved, computed) == ("2", "2")
    assert [line.split()[:2] for line in said] == [["begun", "0"], ["status", "0"], ["plot", "0"], ["plot", "1"]]
    assert said[-1] == "plot 1 fig09: [Errno 2] No such file or directory: 'figures'"


ZIPPED = """
import study
from study.__main__ import main
if __name__ == "__main__":
    print(study.__file__)
    rough = study.solve(P=1e-5, h=0.1, n=2.0, bonding="bonded", micro="hex_lattice", Nbar=1e5, Ra=1e-6)
    print(rough.status.item(), study.load("mine.toml").run(workers=2).computed, study.load("main_case"))
    print(max(main([*words]) for words in (
        ["list"], ["check", "dlc_on_steel"], ["plot", "fig01", "fig09"], ["table", "table1"],
        ["plot", "mine.toml", "--x", "P", "--y", "a"],
        ["point", "P=1 N", "R=5 mm", "body=steel 52100", "micro=smooth", "base=half_space"],
    )))
"""


@pytest.mark.parametrize("studies_in", ["studies", "study/studies"], ids=["clone", "wheel"])
def test_packages_in_a_zip_file(studies_in, tmp_path):
    with zipfile.ZipFile(tmp_path / "roughcoat.zip", "w") as archive:
        for name, place in (
            ("solver", "solver"),
            ("study", "study"),
            ("roughcoat", "roughcoat"),
            ("studies", studies_in),
        ):
            for file in sorted((ROOT / name).rglob("*.*")):
                if file.is_file() and file.parent.name != "__pycache__":
                    archive.write(file, f"{place}/{file.relative_to(ROOT / name).as_posix()}")
    (tmp_path / "mine.toml").write_text(TEXT, encoding="utf-8")
    first, second, *_, last = run(ZIPPED, tmp_path, tmp_path / "roughcoat.zip").splitlines()
    assert first == str(tmp_path / "roughcoat.zip/study/__init__.py")
    assert second.startswith('0 2 Study("main_case", 6 cases')
    assert last == "0"

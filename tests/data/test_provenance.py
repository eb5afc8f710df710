"""What a results file says about its origin: study, command, code, machine."""

import json
import subprocess

import numpy as np
import pytest

import study
from solver import NUMERICS_VERSION
from study.data import provenance
from study.inputs.reading import from_tables

TEXT = """title = "A line"
[model]
micro = "smooth"
base = "half_space"
P = 1e-6
"""


@pytest.fixture(scope="module")
def opened(tmp_path_factory) -> study.Study:
    folder = tmp_path_factory.mktemp("study")
    (folder / "line.toml").write_text(TEXT, encoding="utf-8")
    found = study.load(folder / "line.toml", folder / "results")
    found.run()
    return found


def test_provenance_of_a_run(opened):
    found = opened.open().attrs
    created = found["created"]
    expected = {
        "Conventions": "CF-1.11",
        "title": "A line",
        "references": "Goryacheva & Yakovenko, Lubricants 2024, 12(3), 68, doi:10.3390/lubricants12030068",
        "study": TEXT,
        "study_name": "line",
        "study_digest": opened.definition.digest,
        "numerics_version": NUMERICS_VERSION,
        "command": provenance.command_line(),
        "history": f"{created} {provenance.command_line()}",
        "git_commit": provenance.git_commit(),
        "cpu": provenance.cpu(),
        "blas": provenance.blas(),
    }
    assert {name: found[name] for name in expected} == expected
    assert set(found) == {*expected, "created", "source", "versions"}
    assert created[-6:] == "+00:00" and np.datetime64("now") - np.datetime64(created[:-6]) < np.timedelta64(1, "h")
    assert found["source"].split()[0] == "roughcoat" and len(opened.definition.digest) == 64
    assert set(json.loads(found["versions"])) == {"python", "numpy", "scipy", "xarray", "dask", "netCDF4"}
    assert json.loads(found["versions"])["numpy"] == np.__version__
    assert all(isinstance(text, str) and text for text in found.values())


def test_provenance_of_a_call():
    found = study.solve(P=1e-6, micro="smooth", base="half_space", title="mine").attrs
    assert (found["title"], found["command"], found["study_name"]) == ("mine", "study.solve", "solve")
    assert found["history"].endswith(" study.solve")
    assert study.solve(P=1e-6, micro="smooth", base="half_space").title == "solve", "a dataset has a title"


def test_a_file_without_a_title_has_its_name():
    untitled = from_tables({"model": {"P": 1, "micro": "smooth", "base": "half_space"}}, "line", "", "line")
    assert provenance.provenance(untitled, "command")["title"] == "line"


def test_the_machine_is_named():
    assert len(provenance.cpu()) > 3 and provenance.blas().split()[0] not in ("", "unknown")


@pytest.fixture
def checkout(monkeypatch, tmp_path):
    """A package in a repository of its own."""

    def git(*arguments):
        who = ["-c", "user.name=n", "-c", "user.email=e"]
        done = subprocess.run(["git", "-C", tmp_path, *who, *arguments], check=True, capture_output=True, text=True)
        return done.stdout.strip()

    git("init", "-q")
    (tmp_path / "study" / "data").mkdir(parents=True)
    (tmp_path / "study" / "data" / "provenance.py").touch()
    git("add", ".")
    git("commit", "-q", "-m", "x")
    monkeypatch.setattr(provenance, "__file__", str(tmp_path / "study" / "data" / "provenance.py"))
    return git


def test_the_commit_is_that_of_the_checkout_whatever_its_tags(checkout):
    checkout("tag", "-a", "v1", "-m", "x")
    assert provenance.git_commit() == checkout("rev-parse", "HEAD") and len(provenance.git_commit()) == 40


def test_changed_code_is_marked(checkout, tmp_path):
    clean = provenance.git_commit()
    (tmp_path / "notes").touch()
    assert provenance.git_commit() == clean, "a file that is not tracked changes no number"
    (tmp_path / "study" / "data" / "provenance.py").write_text("changed", encoding="utf-8")
    assert provenance.git_commit() == f"{clean}-dirty"


def test_the_commit_is_unknown_outside_a_checkout(checkout, monkeypatch, tmp_path):
    """Also when the environment lies inside somebody else's repository, or there is no git."""
    monkeypatch.setattr(provenance, "__file__", str(tmp_path / "site-packages" / "study" / "data" / "provenance.py"))
    assert provenance.git_commit() == "unknown"
    monkeypatch.setattr(provenance, "__file__", str(tmp_path / "study" / "data" / "provenance.py"))
    monkeypatch.setenv("PATH", "")
    assert provenance.git_commit() == "unknown"


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        ("/home/someone/lib/study/__main__.py", "python -m study run 'a b.toml'"),
        ("/home/someone/lib/roughcoat/__main__.py", "python -m roughcoat run 'a b.toml'"),
        ("/usr/bin/tool", "tool run 'a b.toml'"),
    ],
)
def test_command_line_without_machine_paths(monkeypatch, program, expected):
    monkeypatch.setattr(provenance.sys, "argv", [program, "run", "a b.toml"])
    assert provenance.command_line() == expected


def test_code_and_machine_are_looked_at_once(monkeypatch):
    """Not at each call of `study.solve`, which takes less time itself."""
    first = study.solve(P=1e-6, micro="smooth", base="half_space").attrs
    for name in ("git_commit", "package_version", "cpu", "blas"):
        monkeypatch.setattr(provenance, name, lambda *_: pytest.fail("is read again"))
    again = study.solve(P=1e-6, micro="smooth", base="half_space").attrs
    same = ("source", "git_commit", "versions", "cpu", "blas")
    assert {name: again[name] for name in same} == {name: first[name] for name in same}

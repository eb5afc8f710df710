"""What `plot --run` and `table --run` may replace: results that the same study made, and no others."""

from pathlib import Path

import netCDF4
import pytest
from test_cli import GOOD, studies  # noqa: F401

import study
from study.__main__ import main
from study.figures import registry
from study.files.examine import examine

pytestmark = pytest.mark.usefixtures("studies")
RESULTS = Path("results/book.nc")


@pytest.fixture(autouse=True)
def book(studies, monkeypatch) -> Path:  # noqa: F811
    """The study file of two figures and a table."""
    for name in ("one", "two"):
        figure = registry.Figure(("book",), lambda axes, found: {"P": found["P"].values}, (3, 3), (1, 1), name)
        monkeypatch.setitem(registry.FIGURES, name, figure)
    columns = (registry.column("P | .2e"),)
    table = registry.DataTable(("book",), lambda found: [(P,) for P in found["P"].values.tolist()], "", columns)
    monkeypatch.setitem(registry.TABLES, "loads", table)
    (studies / "book.toml").write_text(GOOD, encoding="utf-8")
    return studies / "book.toml"


def elsewhere(text: str) -> None:
    """Results of a study of the user's own, that has the same name."""
    Path("mine").mkdir()
    Path("mine/book.toml").write_text(text, encoding="utf-8")
    assert main(["run", "mine/book.toml"]) == 0


def renumber(monkeypatch, version: str) -> None:
    from study.data import provenance
    from study.inputs import identity
    from study.store import blocks
    from study.work import cases, plan

    for module in (identity, blocks, plan, cases, provenance):
        monkeypatch.setattr(module, "NUMERICS_VERSION", version)


MANY = GOOD.replace("[1e-6, 2e-6, 3e-6]", "{ start = 1e-6, stop = 1e-4, num = 40 }")


@pytest.mark.parametrize("command", ["plot --run one two", "table --run loads"])
def test_results_of_another_study_file_stay(command, monkeypatch, capsys):
    """Of 400 cases of a user the paper's 6 were left, with exit code 0."""
    monkeypatch.setattr("sys.argv", ["/usr/bin/roughcoat", "run", "mine/book.toml"])
    elsewhere(MANY)
    before = RESULTS.read_bytes()
    capsys.readouterr()
    assert main(command.split()) == 2
    printed = capsys.readouterr()
    assert RESULTS.read_bytes() == before and printed.out == "" and not Path("figures").exists()
    (line,) = printed.err.splitlines()
    assert line.startswith("results/book.nc: holds results of another definition (digest ")
    assert "39 of its 40 cases are not in this one: roughcoat run --force book replaces them, --results DIR" in line
    assert line.endswith('it was made by "roughcoat run mine/book.toml"')
    assert main(["run", "--force", "book"]) == 0 and main(command.split()) == 0, "the way out"


def test_results_of_another_study_of_an_earlier_version_stay_too(monkeypatch, capsys):
    elsewhere(MANY)
    before = RESULTS.read_bytes()
    renumber(monkeypatch, "next")
    capsys.readouterr()
    assert main(["plot", "--run", "one"]) == 2
    assert "run --force book computes them again, --results DIR elsewhere; it was" in capsys.readouterr().err
    assert RESULTS.read_bytes() == before


def test_results_that_lose_no_case_are_extended(book, capsys):
    """As by `run`."""
    elsewhere(GOOD)
    book.write_text(MANY.replace("num = 40", "num = 2").replace("1e-4", "2e-6"), encoding="utf-8")
    assert main(["plot", "--run", "one"]) == 2, "3e-6 would be lost"
    book.write_text(GOOD.replace("3e-6", "3e-6, 4e-6"), encoding="utf-8")
    assert main(["plot", "--run", "one"]) == 0
    assert study.open_results(RESULTS).sizes["P"] == 4


@pytest.mark.parametrize("edit", ["", "# a comment\n", 'title = "another title"\n'])
def test_results_of_the_same_study_are_replaced_when_the_numerics_change(book, edit, monkeypatch, capsys):
    """`make figures` goes on by itself after the solver has changed. Blocks of a run that was stopped stay."""
    assert main(["plot", "--run", "one"]) == 0
    book.write_text(edit + GOOD.replace('title = "a line"\n', "" if "title" in edit else 'title = "a line"\n'))
    renumber(monkeypatch, "next")
    assert main(["run", "book"]) == 2, "who asks for a run has the choice"
    assert main(["plot", "--run", "one"]) == 0
    assert study.open_results(RESULTS).attrs["numerics_version"] == "next"


def spoil(path: Path, name: str) -> None:
    """Change an attribute, as another program would."""
    with netCDF4.Dataset(path, "a") as file:
        file.setncattr(name, "[model]\n" if name == "study" else "changed")


def test_damaged_results_of_the_same_study_are_computed_again(monkeypatch):
    assert main(["plot", "--run", "one"]) == 0
    renumber(monkeypatch, "next")
    spoil(RESULTS, "title")
    assert main(["plot", "--run", "one"]) == 0
    assert examine(RESULTS).kind == "sound" and examine("results/book.nc.damaged").kind == "damaged"


@pytest.mark.parametrize("name", ["title", "study"])
def test_damaged_results_of_another_study_stay(name, capsys):
    elsewhere(MANY)
    spoil(RESULTS, name)
    before = RESULTS.read_bytes()
    assert main(["plot", "--run", "one"]) == 2
    assert "39 of its 40 cases are not in this one: python -m roughcoat run --force" in capsys.readouterr().err
    assert RESULTS.read_bytes() == before


def test_a_text_that_is_no_study_file_is_of_no_study(monkeypatch):
    """Nor is one whose parsing would take all memory."""
    from study.inputs.reading import same_tables

    deep = ".".join("a" * 20_000) + " = 1\n"
    for text in (deep, "[" * 5000, "a =", "", "x = 1\n[model]\n"):
        assert not same_tables(text, GOOD) and not same_tables(GOOD, text)
    assert same_tables("[a]\nb = 1\n# c\n", 'title = "x"\n[a]\nb = 1 # d')


def test_a_study_that_is_called_like_the_measurements_stays(monkeypatch, capsys):
    Path("mine").mkdir()
    Path("mine/tradeoff.toml").write_text(GOOD, encoding="utf-8")
    assert main(["run", "mine/tradeoff.toml"]) == 0
    before = Path("results/tradeoff.nc").read_bytes()
    made = registry.entry("measured", "tradeoff")._replace(measure=lambda: pytest.fail("measures"))
    monkeypatch.setitem(registry.REGISTERS[""]["measured"], "tradeoff", made)
    for command in (["plot", "--run", "tradeoff"], ["table", "--run", "tradeoff"], ["tradeoff", "--force"]):
        capsys.readouterr()
        assert main(command) == 2
        said = "results/tradeoff.nc: holds the cases of a study: move it away, or use --results DIR\n"
        assert capsys.readouterr().err == said
    assert Path("results/tradeoff.nc").read_bytes() == before

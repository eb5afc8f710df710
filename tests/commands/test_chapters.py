"""Studies in chapters, the folders of `studies`: found by name, with their chapter, and by a path without it."""

from pathlib import Path

import pytest
from test_cli import GOOD, OURS, studies  # noqa: F401

from study.__main__ import main
from study.commands.arguments import proposed
from study.inputs.places import packaged, study_file


@pytest.fixture(autouse=True)
def chapter(studies) -> Path:  # noqa: F811
    """A study in a chapter of the user."""
    (studies / "film").mkdir()
    (studies / "film/thin.toml").write_text(GOOD, encoding="utf-8")
    return studies / "film"


@pytest.mark.parametrize("name", ["thin", "film/thin", "studies/thin.toml", "studies/film/thin.toml"])
def test_a_study_of_a_chapter_is_found(name, capsys):
    assert main(["run", name]) == 0
    assert capsys.readouterr().out == "results/thin.nc: 3 cases, 3 computed now\n"


def test_one_of_the_book_too(chapter):
    for name in ("main_case", "paper/main_case"):
        assert study_file(name) == packaged() / "paper/main_case.toml"
    assert study_file(str(packaged() / "main_case.toml")) == packaged() / "paper/main_case.toml"
    (chapter / "main_case.toml").write_text(GOOD, encoding="utf-8")
    assert study_file("main_case") == Path("studies/film/main_case.toml"), "that of the user goes before"


def test_two_chapters_with_one_name_are_told_and_a_file_beside_them_is_meant(studies, capsys):  # noqa: F811
    (studies / "coat").mkdir()
    (studies / "coat/thin.toml").write_text(GOOD, encoding="utf-8")
    assert main(["check", "thin", "studies/thin.toml", "film/thin"]) == 2
    printed = capsys.readouterr()
    said = "thin: is in studies/coat/thin.toml and studies/film/thin.toml: give the path of one"
    assert printed.err.splitlines() == [said, said] and printed.out.startswith("film/thin: 3 cases")
    (studies / "thin.toml").write_text(GOOD, encoding="utf-8")
    assert study_file("thin") == Path("studies/thin.toml")


def test_chapters_are_listed_and_completed(studies, capsys):  # noqa: F811
    for hidden in (".git", "__pycache__", "film/deeper"):
        (studies / hidden).mkdir()
        (studies / hidden / "no.toml").write_text("[", encoding="utf-8")
    assert main(["list"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == ["good", "thin"]
    (studies / "film/deeper/no.toml").unlink()
    assert main(["list", "studies/film"]) == 0
    assert capsys.readouterr().out.split()[0] == "thin"
    assert proposed("run", "th") == ["thin"] and proposed("run", "studies/f") == ["studies/film/thin.toml"]


def test_a_chapter_is_no_study_and_its_studies_are_named(capsys):
    """The book's by its name, the user's by a path too; `list` shows what is in it."""
    inside = "load_sweep, main_case, reference_load, spot_density, spot_density_lattice"
    for words in (["run", "paper"], ["check", "paper"], ["show", "paper"], ["new", "mine", "--from", "paper"]):
        assert main(words) == 2
        assert capsys.readouterr().err == f"paper: is a folder of studies, not a study; its studies are {inside}\n"
    assert main(["run", "studies/film"]) == 2
    assert capsys.readouterr().err == "studies/film: is a folder of studies, not a study; its study is thin\n"
    assert main(["plot", "paper"]) == 2
    said = "paper: is a folder of studies, not a figure; its figures are fig01, fig02,"
    assert capsys.readouterr().err.startswith(said)
    assert main(["table", "film"]) == 2
    assert capsys.readouterr().err == "film: is a folder of studies, not a table; it has no tables\n"
    for name, first in (("paper", "load_sweep"), ("film", "thin")):
        assert main(["list", name]) == 0
        assert capsys.readouterr().out.split()[0] == first


def test_a_study_in_the_working_folder_goes_before_the_book_and_after_studies(studies, capsys):  # noqa: F811
    """`roughcoat new dlc_on_steel --from dlc_on_steel`, edited, is the one that `run dlc_on_steel` means."""
    Path("dlc_on_steel.toml").write_text(GOOD, encoding="utf-8")
    assert study_file("dlc_on_steel") == Path("dlc_on_steel.toml")
    assert study_file("dlc_on_steel", packaged() / "paper") == packaged() / "systems/dlc_on_steel.toml"  # of a figure
    assert main(["plot", "dlc_on_steel"]) == 2
    assert capsys.readouterr().err.startswith("dlc_on_steel is a study, not a figure: give --x and --y")
    (studies / "dlc_on_steel.toml").write_text(GOOD, encoding="utf-8")
    assert study_file("dlc_on_steel") == Path("studies/dlc_on_steel.toml")
    Path("main_case.toml").write_text("[tool.other]\nmain = 1\n", encoding="utf-8")
    assert study_file("main_case") == packaged() / "paper/main_case.toml", "that file is another program's"


@pytest.mark.parametrize("name", ["../good", "film/../good", "studies/none.toml", "elsewhere/thin.toml", "film/none"])
def test_what_is_not_there(name, capsys):
    assert main(["check", name]) == 2
    assert capsys.readouterr().err.startswith(f"{name}: not found")


def test_all_studies_of_the_book_are_known():
    assert OURS.split(", ") == [path.stem for path in sorted(packaged().glob("*/*.toml"))]

"""Figures and tables from the command line: folders, what is computed for them, what is up to date."""

import os
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from test_cli import GOOD, studies  # noqa: F401
from test_cli_options import tree

from study import api, catalogue
from study.__main__ import main
from study.commands import drawing
from study.figures import registry
from study.inputs.definition import StudyError
from study.work.plan import Report

pytestmark = pytest.mark.usefixtures("studies")


def test_figures_and_tables_go_to_their_folders(capsys):
    """Of micro laws, which need no study."""
    assert main(["plot", "fig09"]) == 0
    drawn = [f"figures/fig09.{kind}" for kind in ("csv", "pdf", "png")]
    assert capsys.readouterr().out.splitlines() == drawn
    assert main(["table", "table1"]) == 0
    written = [f"tables/table1.{kind}" for kind in ("txt", "csv", "tex")]
    assert capsys.readouterr().out.splitlines() == written
    assert tree() == sorted([*drawn, *written])


def test_folders_that_are_asked_for(monkeypatch, capsys):
    seen = []
    for name in ("draw", "tabulate"):
        monkeypatch.setattr(catalogue, name, lambda *given: seen.append(given) or [f"{given[0]} of {given[2]}"])
    assert main(["plot", "fig01", "fig02", "--results", "there", "--figures", "elsewhere"]) == 0
    assert main(["table", "table1", "--results", "there", "--tables", "elsewhere"]) == 0
    assert seen == [(name, "there", "elsewhere") for name in ("fig01", "fig02", "table1")]
    assert capsys.readouterr().out.splitlines() == [f"{name} of elsewhere" for name in ("fig01", "fig02", "table1")]


@pytest.mark.parametrize(("command", "function"), [("plot", "draw"), ("table", "tabulate")])
def test_what_cannot_be_drawn_does_not_keep_the_next_from_its_turn(command, function, monkeypatch, capsys):
    real = getattr(catalogue, function)
    monkeypatch.setattr(catalogue, function, lambda name, *_: ["made"] if name == "other" else real(name, *_))
    assert main([command, "fig91", "paper_numbers" if command == "table" else "fig10", "other"]) == 2
    printed = capsys.readouterr()
    assert printed.out == "made\n"
    unknown, *missing = printed.err.splitlines()
    assert unknown.startswith('"fig91" is not known; ')
    study = "reference_load" if command == "table" else "spot_density"
    assert missing[0].startswith(f"results/{study}.nc: does not exist, ")
    assert missing[0].endswith(f"make it with: python -m roughcoat run {study}")


def test_a_function_that_fails_does_not_keep_the_next_from_its_turn(results, tmp_path, monkeypatch, capsys):
    """`make figures` ended with a traceback at the first figure whose function raised."""
    given = ["--results", str(results)]

    def no_variable(axes, main):
        return {"P": main["nosuch"].values}

    def no_columns(axes, main):
        axes.plot([1, 2])

    def wrong_text(axes, main):
        axes.set_xlabel(r"$\nosuch$")
        return {"a": np.arange(2)}

    figures = no_variable, no_columns, wrong_text, lambda axes, main: {"a": [1, 2], "b": [1]}
    for name, function in zip(("raises", "none", "text", "unequal"), figures, strict=True):
        monkeypatch.setitem(registry.FIGURES, name, registry.Figure(("main_case",), function, (3, 3), (1, 1), ""))
    assert main(["plot", "raises", "none", "text", "unequal", "fig01", *given, "--figures", str(tmp_path)]) == 1
    assert sorted(path.name for path in tmp_path.iterdir() if path.suffix == ".csv") == []
    printed = capsys.readouterr()
    assert printed.out.endswith("fig01.png\n")
    raised, nothing, text, unequal = printed.err.splitlines()
    assert raised.startswith("raises: its function fails: KeyError: \"No variable named 'nosuch'")
    assert raised.endswith("; -v before the command shows where")
    assert nothing == "none: the function must return its numbers: heading -> column, all of one length"
    assert unequal == nothing.replace("none", "unequal")
    assert text.startswith("text: its function fails: ValueError: \\n\\nosuch")


def test_a_table_that_fails_says_what_it_must_return(results, tmp_path, monkeypatch, capsys):
    cells = {"short": [("a",)], "nothing": None, "none": [("a", None)], "empty": []}
    columns = tuple(map(registry.column, ("a", "b | .3f")))
    for name, rows in cells.items():
        table = registry.DataTable(("main_case",), lambda main, rows=rows: rows, "", columns)
        monkeypatch.setitem(registry.TABLES, name, table)
    assert main(["table", *cells, "--results", str(results), "--tables", str(tmp_path)]) == 1
    printed = capsys.readouterr()
    assert [Path(line).name for line in printed.out.splitlines()] == ["empty.txt", "empty.csv", "empty.tex"]
    short, nothing, none = printed.err.splitlines()
    assert short == "short: the function must return a list of tuples of 2 cells, one a row"
    assert nothing == short.replace("short", "nothing")
    assert none.startswith('none: column "b" has the format ".3f", which does not fit None')


def test_a_figure_does_not_take_the_name_of_another(monkeypatch):
    """Of the program itself. One of the book is left alone: that of the user goes before it."""
    for kind in ("figure", "table"):
        monkeypatch.setitem(registry.REGISTERS[""], kind, {})
    registry.figure("fig03", "main_case")(lambda axes, main: {})
    registry.table("table1", "main_case", columns="a")(lambda main: [])
    assert (
        registry.entry("figure", "fig03").draw(None, None) == {} and registry.entry("table", "table1").rows(None) == []
    )

    def other(*_):
        """Another function."""

    with pytest.raises(ValueError, match='"fig03" is already the name of test_cli_drawing.<lambda>: take another name'):
        registry.figure("fig03", "main_case")(other)
    with pytest.raises(ValueError, match='"table1" is already the name of test_cli_drawing.*: take another name'):
        registry.table("table1", "main_case", columns="a")(other)
    other.__name__, other.__module__ = "<lambda>", "elsewhere"
    with pytest.raises(ValueError, match='"fig03" is already the name of test_cli_drawing.<lambda>: take another name'):
        registry.figure("fig03", "main_case")(other)
    other.__module__ = __name__
    registry.figure("fig03", "main_case")(other)
    assert registry.entry("figure", "fig03").draw is other, "as a cell of a notebook is run again"


def test_results_that_are_missing_have_a_way_out_each(monkeypatch, tmp_path):
    """Measured by a command, measured beside studies, or computed from a study file."""
    monkeypatch.setitem(registry.REGISTERS[""], "measured", {"times": None})
    with pytest.raises(StudyError) as caught:
        registry.open_studies("mine", ("tradeoff", "times", "main_case"), tmp_path)
    ways = (
        "make it with: python -m roughcoat tradeoff",
        "--run measures it",
        "make it with: python -m roughcoat run main_case",
    )
    names = ("tradeoff", "times", "main_case")
    assert caught.value.messages == tuple(
        f"{tmp_path / name}.nc: does not exist, mine needs it; {way}" for name, way in zip(names, ways, strict=True)
    )


def test_a_file_that_holds_no_results_is_bad_input(capsys):
    Path("junk.nc").write_text("junk", encoding="utf-8")
    assert main(["plot", "junk.nc", "--x", "P", "--y", "a"]) == 2
    assert capsys.readouterr().err == "junk.nc: is not a netCDF file\n"
    assert main(["plot", "junk.nc"]) == 2
    assert capsys.readouterr().err.startswith("junk.nc is a file, not a figure: give --x and --y to draw curves of it")


def test_the_command_to_type_is_the_one_that_was_started(monkeypatch, capsys):
    """From a wheel, `python` may be another one, which has no `study`."""
    monkeypatch.setattr(sys, "argv", ["/anywhere/bin/roughcoat", "plot", "fig10"])
    assert main(["plot", "fig10"]) == 2
    assert capsys.readouterr().err.endswith("make it with: roughcoat run spot_density\n")


def test_run_computes_the_studies_that_are_needed_once_and_skips_what_is_up_to_date(monkeypatch, capsys):
    """A figure is drawn again when its results are others, whatever the times of the files."""
    ran, drawn = [], []

    def run(self, **options):
        name = self.definition.name
        ran.append((name, options["renew"]))
        path = self.results / f"{name}.nc"
        path.parent.mkdir(exist_ok=True)
        if not path.exists():  # what is up to date is left alone
            path.touch()
        return Report(path, 1, 0, {}, {}, True)

    def draw(name, results, folder):
        drawn.append(name)
        Path(folder).mkdir(exist_ok=True)
        paths = [Path(folder) / f"{name}.{kind}" for kind in ("csv", "pdf", "png")]
        for path in paths:
            path.touch()
        return paths

    for study in ("load_sweep", "main_case"):
        Path(f"studies/{study}.toml").write_text(GOOD, encoding="utf-8")
    monkeypatch.setattr(api.Study, "run", run)
    monkeypatch.setattr(catalogue, "draw", draw)
    assert main(["plot", "--run", "fig04", "fig05"]) == 0
    assert (ran, drawn) == ([("load_sweep", True), ("main_case", True)], ["fig04", "fig05"])
    assert main(["plot", "--run", "fig04", "fig05"]) == 0
    assert drawn == ["fig04", "fig05"], "they are up to date"
    later = Path("figures/fig05.png").stat().st_mtime + 10
    os.utime("results/main_case.nc", (later, later))
    assert main(["plot", "--run", "fig05"]) == 0
    assert drawn == ["fig04", "fig05"], "they still are"
    Path("results/main_case.nc").write_text("others", encoding="utf-8")
    os.utime("results/main_case.nc", (1, 1))
    assert main(["plot", "--run", "fig05"]) == 0
    Path("figures/fig04.csv").unlink()
    assert main(["plot", "--run", "fig04", "fig05"]) == 0
    assert drawn == ["fig04", "fig05", "fig05", "fig04"]
    monkeypatch.setattr(api.Study, "run", lambda self, **_: Report(Path("x"), 1, 0, {0: "lost"}, {}, False))
    Path("figures/fig05.csv").unlink()
    assert main(["plot", "--run", "fig05"]) == 1
    assert len(drawn) == 4, "not from results that are not complete"


def test_figures_that_a_second_process_may_draw(monkeypatch):
    """All, except with --run those that are up to date; a bare figure is kept nowhere, and drawn anew."""
    monkeypatch.setattr(drawing, "_prepared", lambda *_: 0)
    monkeypatch.setattr(catalogue, "outdated", lambda kind, name, *_: name == "old")
    for run, bare, wanted in ((False, False, ["old", "new"]), (True, False, ["old"]), (True, True, ["old", "new"])):
        options = SimpleNamespace(run=run, results="results", folder="figures")
        assert [name for name in ("old", "new") if drawing._waits(options, "figure", name, bare)] == wanted


def test_all_means_what_no_long_study_is_needed_for(monkeypatch):
    drawn = []
    for name in ("draw", "tabulate"):
        monkeypatch.setattr("study.commands.drawing.MANY", 1000)  # a second process would draw some of them
        monkeypatch.setattr(catalogue, name, lambda *given: drawn.append(given[0]) or [])
    assert main(["plot", "all"]) == 0
    paper = [f"fig{number:02}" for number in range(1, 11)]
    layered = [f"{name}_layered" for name in paper if name not in ("fig01", "fig02", "fig09")]
    ours = ["bead_on_gel", "fig09_lattice", "fig10_lattice", "coatings", "literature", "validity", "validity_load"]
    assert drawn == [*sorted([*paper, *layered, *ours, "scan_law", "substrate", "yielding"]), "captions"]
    drawn.clear()
    assert main(["table", "all"]) == 0
    literature = ["literature", "literature_coatings", "literature_decided", "literature_pull_off"]
    literature += ["literature_rough", "literature_shapes"]
    assert drawn == [*literature, "paper_numbers", "table1", "table1_lattice", "validity"]


def test_a_bare_figure_has_nothing_above_it(results, monkeypatch, capsys):
    """And is written though the one with its parameters is up to date."""
    titles = []
    monkeypatch.setattr(catalogue, "save", lambda stem, figure, *_: titles.append(figure.get_suptitle()) or [stem])
    for options in ([], ["--bare"]):
        assert main(["plot", "fig03", "--results", str(results), *options]) == 0
    assert titles[0].startswith("$") and titles[1] == ""
    curves = ["--x", "x", "--y", "p", "--hue", "label"]
    assert main(["plot", str(results / "main_case.nc"), *curves, "--bare"]) == 0 and titles[2:] == [""]

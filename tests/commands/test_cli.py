"""The command line: exit codes, messages, and that nothing heavy is imported before it is needed."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from conftest import ROOT, STUDIES

import study
from study.__main__ import main
from study.commands.arguments import proposed
from study.terminal import program
from study.work import cases
from study.work import run as running

GOOD = """
title = "a line"
[model]
micro = "smooth"
base = "half_space"
[axes]
P = [1e-6, 2e-6, 3e-6]
[numerics]
block = 1
"""


OURS = ", ".join(file.stem for file in STUDIES)


@pytest.fixture(autouse=True)
def studies(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "studies"
    folder.mkdir()
    (folder / "good.toml").write_text(GOOD, encoding="utf-8")
    return folder


def test_check(capsys):
    assert main(["check", "studies/good.toml"]) == 0
    assert capsys.readouterr().out.startswith("studies/good.toml: 3 cases (P 3), digest ")
    assert not Path("results").exists()


def test_bad_file_does_not_keep_the_good_one_from_its_turn(studies, capsys):
    (studies / "bad.toml").write_text(GOOD.replace("micro", "mirco").replace("2e-6", "-1"), encoding="utf-8")
    assert main(["run", "studies/bad.toml", "studies/good.toml"]) == 2
    printed = capsys.readouterr()
    assert 'studies/bad.toml: [model] "mirco" is not a parameter; did you mean "micro"?\n' in printed.err
    assert "studies/bad.toml: P[1] = -1: must be in [1e-24, 1e3]\n" in printed.err
    assert "results/good.nc: 3 cases, 3 computed now\n" in printed.out
    assert not Path("results/bad.nc").exists()


@pytest.mark.parametrize("command", ["check", "run", "status", "retry --status diverged", "run --dry-run"])
def test_a_study_that_is_not_there(studies, command, capsys):
    (studies / "par_maps.toml").write_text("", encoding="utf-8")
    command, *options = command.split()
    assert main([command, "par_map", "q", "studies/par_map.toml", "good.toml", "a/b", *options]) == 2
    printed = capsys.readouterr()
    assert printed.out == "" and printed.err.splitlines() == [
        'par_map: not found (looked for par_map and studies/par_map.toml); did you mean "par_maps"?',
        f"q: not found (looked for q and studies/q.toml); known: good, par_maps, {OURS}",
        'studies/par_map.toml: not found; did you mean "studies/par_maps.toml"?',
        'good.toml: not found; did you mean "studies/good.toml"?',
        f"a/b: not found (looked for a/b and studies/a/b.toml); known: good, par_maps, {OURS}",
    ]
    assert not Path("results").exists()


def test_a_file_in_the_working_folder_is_known_by_its_name(studies, capsys):
    """One without the sections of a study is another program's, and its path is only told."""
    Path("main.toml").write_text(GOOD, encoding="utf-8")
    assert main(["check", "main"]) == 0
    assert capsys.readouterr().out.startswith("main: 3 cases")
    Path("main.toml").write_text("[tool.other]\nmain = 1\n", encoding="utf-8")
    assert main(["check", "main"]) == 2
    said = 'main: not found (looked for main and studies/main.toml); did you mean "main.toml"?\n'
    assert capsys.readouterr().err == said


def test_where_there_are_no_studies_those_of_the_package_are_known_by_name(studies, monkeypatch, capsys):
    monkeypatch.chdir(studies)
    assert main(["status", "goood", "goood.toml"]) == 2
    assert capsys.readouterr().err.splitlines() == [
        f"goood: not found (looked for goood and studies/goood.toml); known: {OURS}",
        'goood.toml: not found; did you mean "good.toml"?',
    ]
    assert main(["check", "main_case"]) == 0
    assert capsys.readouterr().out.startswith("main_case: 6 cases (case 6), digest ")
    assert main(["list"]) == 0
    listed = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert listed == ["good", *OURS.split(", ")], "and those of the working folder"
    assert main(["check", "main_case.toml"]) == 2


def test_a_study_file_in_the_working_folder_is_known_to_every_command(studies, monkeypatch, capsys):
    """Beside files .toml of other programs."""
    (studies.parent / "pyproject.toml").write_text("[project]\nname = 'model'\n[tool.axes]\n", encoding="utf-8")
    (studies.parent / "mine.toml").write_text(GOOD, encoding="utf-8")
    for command in (
        "check",
        "run",
        "status",
        "verify",
        "table",
        "plot --x P --y a",
        "retry --status diverged",
        "clean",
    ):
        name, *options = command.split()
        assert main([name, *options, "mine.toml"]) == 0, command
    assert main(["plot", "mine.toml"]) == 2 and "mine.toml is a study, not a figure" in capsys.readouterr().err
    assert main(["list"]) == 0 and [line.split()[0] for line in capsys.readouterr().out.splitlines()] == [
        "mine",
        "good",
    ]
    assert Path("tables/mine.csv").exists() and Path("figures/mine_a.csv").exists()
    assert "mine.toml" in proposed("table", "mi") and proposed("status", "pypr") == []
    assert main(["table", "mien.toml"]) == 2 and 'did you mean "mine.toml"' in capsys.readouterr().err


def test_a_file_of_the_same_name_in_studies_is_meant(studies, capsys):
    Path("god.toml").write_text("", encoding="utf-8")
    assert main(["check", "good.toml"]) == 2
    assert capsys.readouterr().err == 'good.toml: not found; did you mean "studies/good.toml"?\n'


def test_a_path_goes_before_a_name(studies, capsys):
    Path("good").mkdir()
    assert main(["check", "good"]) == 2
    assert capsys.readouterr().err == "good: is a folder, not a study file\n"


def test_a_command_without_words_shows_what_it_takes(capsys):
    """`roughcoat` alone lists the commands; `roughcoat point` alone has an example that can be typed."""
    with pytest.raises(SystemExit, match="2"):
        main([])
    assert re.search(r"point +solve one contact", capsys.readouterr().err)
    for command in ("point", "fit", "design", "scan"):
        with pytest.raises(SystemExit, match="2"):
            main([command])
        assert f"for example: {program()} {command} " in capsys.readouterr().err


def test_version(capsys):
    from solver import NUMERICS_VERSION
    from solver.compiled.library import available

    with pytest.raises(SystemExit) as caught:
        main(["--version"])
    assert caught.value.code == 0
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    slow = "" if available() else ", without its compiled core (numpy computes, 3 to 6 times slower)"
    assert capsys.readouterr().out == f"roughcoat {version}, numerics {NUMERICS_VERSION}{slow}\n"


def test_run_twice_and_by_name(capsys):
    assert main(["run", "good"]) == 0
    assert main(["run", "good", "--workers", "2"]) == 0
    assert capsys.readouterr().out.endswith("results/good.nc is up to date (3 cases), nothing to do\n")
    found = study.open_results("results/good.nc")
    assert found.attrs["study"] == GOOD
    assert found.attrs["title"] == "a line"


def test_list_and_status(capsys, studies):
    assert main(["list"]) == 0
    assert capsys.readouterr().out.split() == ["good", "3", "cases", "new", "a", "line"]
    main(["run", "good", "--results", "elsewhere"])
    capsys.readouterr()
    assert main(["status", "good", "--results", "elsewhere"]) == 0
    assert capsys.readouterr().out.split() == ["good", "3", "cases", "done", "a", "line", "converged:", "3"]
    (studies / "bad.toml").write_text("[", encoding="utf-8")
    assert main(["list"]) == 2
    (studies / "empty").mkdir()
    assert main(["list", "studies/empty"]) == 0
    assert "no study files in studies/empty" in capsys.readouterr().out
    assert main(["list", "nowhere"]) == 2
    assert capsys.readouterr().err == "nowhere: is not a folder\n"


def test_results_of_another_definition(studies, capsys):
    main(["run", "good"])
    (studies / "good.toml").write_text(GOOD.replace("2e-6", "2.5e-6"), encoding="utf-8")
    assert main(["run", "good"]) == 2
    assert "--force replaces them, --results DIR writes elsewhere" in capsys.readouterr().err
    assert main(["run", "good", "--results", "other"]) == 0
    assert main(["run", "good", "--force"]) == 0
    assert study.open_results("results/good.nc").P.values[1] == 2.5e-6


def test_failed_block(monkeypatch, capsys):
    real = cases.compute

    def compute(wanted):
        if wanted.first == 1:
            raise MemoryError("too large")
        return real(wanted)

    monkeypatch.setattr(cases, "compute", compute)
    assert main(["run", "good"]) == 1
    assert "good: block 1 failed: cases 1 to 1: MemoryError: too large" in capsys.readouterr().err
    assert main(["status", "good"]) == 0
    assert "partial (2 of 3 cases)" in capsys.readouterr().out


def test_full_disk(monkeypatch, capsys):
    def store(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(running, "add", store)
    assert main(["run", "good"]) == 1
    assert "good: [Errno 28] No space left on device" in capsys.readouterr().err


def test_dry_run_retry_and_parts(capsys):
    assert main(["run", "good", "--dry-run"]) == 0
    assert capsys.readouterr().out.startswith("good: 3 cases, 0 of them computed; the others: about 0 s, at most 0.")
    assert main(["run", "good", "--part", "1/2"]) == 0
    assert capsys.readouterr().out == "good: 2 cases computed now, 1 of 3 are left to other parts\n"
    assert main(["status", "good"]) == 0
    assert capsys.readouterr().out.split("\n")[1:3] == ["    converged: 2", "    not_run: 1"]
    assert main(["run", "good", "--part", "2/2"]) == 0
    assert capsys.readouterr().out == "results/good.nc: 3 cases, 1 computed now\n"
    assert main(["retry", "good", "--status", "diverged"]) == 0
    assert capsys.readouterr().out.endswith("is up to date (3 cases), nothing to do\n")
    assert main(["retry", "good", "--status", "converged"]) == 0
    assert capsys.readouterr().out == "results/good.nc: 3 cases, 3 computed now\n"
    assert main(["retry", "good", "--status", "divergd", "--status", "diverged", "--status", "converge"]) == 2
    assert capsys.readouterr().err.splitlines() == [
        '--status "divergd" is not known; did you mean "diverged"?',
        '--status "converge" is not known; did you mean "converged"?',
    ]


def test_fail_fast(studies, capsys):
    hard = GOOD.replace('"smooth"', '"disc_cell"\nNbar = 1e5\nRa = 0.004') + "max_iterations = 1"
    (studies / "hard.toml").write_text(hard, encoding="utf-8")
    assert main(["run", "hard", "--fail-fast", "--workers", "1"]) == 1
    assert "hard: block 0 failed: case 0: iteration_limit" in capsys.readouterr().err
    assert main(["run", "hard", "--keep-going"]) == 0
    assert "3 of them not converged" in capsys.readouterr().out


def test_interrupt(monkeypatch, capsys):
    def store(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(running, "add", store)
    assert main(["run", "good", "--workers", "1"]) == 130
    assert "finished blocks are kept" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["rnu"],
        ["run"],
        ["run", "good", "--workers", "0"],
        ["run", "good", "--workers", "two"],
        ["run", "good", "--part", "3/2"],
        ["retry", "good"],
        ["run", "good", "--fail-fast", "--keep-going"],
    ],
)
def test_wrong_calls(arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    assert "usage: python -m roughcoat" in capsys.readouterr().err


def test_answers_without_heavy_imports():
    """--help and complaints about a file need neither xarray nor matplotlib; all in one process, --help first."""
    script = (
        "import os, sys, study.__main__ as m\n"
        "assert {os.environ[f'{one}_THREADS'] for one in ('OMP_NUM', 'MKL_NUM', 'VECLIB_MAXIMUM')} == {'1'}\n"
        "for call, expected in (('--help', 0), ('check studies/none.toml', 2), ('check good', 0)):\n"
        "    try: code = m.main(call.split())\n"
        "    except SystemExit as e: code = e.code\n"
        "    assert code == expected, (call, code)\n"
        "    heavy = {'xarray', 'dask', 'netCDF4', 'matplotlib', 'pandas'} & set(sys.modules)\n"
        "    assert not heavy, (call, heavy)\n"
        "    assert ('numpy' in sys.modules) == call.startswith('check'), call\n"
    )
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(path or os.getcwd() for path in sys.path)}
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_the_backend_of_a_notebook_is_not_asked_for(tmp_path):
    """Jupyter sets it for the programs that a cell starts with "!", where it need not be installed."""
    path = os.pathsep.join(path or os.getcwd() for path in sys.path)
    environment = os.environ | {"PYTHONPATH": path, "MPLBACKEND": "no_such_backend"}
    command = [sys.executable, "-m", "study", "plot", "none.nc", "--x", "P", "--y", "a"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (2, "none.nc: does not exist\n")

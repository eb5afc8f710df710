"""The command of an installed roughcoat: its studies, its name, what it takes for its own modules, completion."""

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from conftest import ROOT
from test_cli import GOOD, studies  # noqa: F401

from study.__main__ import main, parser
from study.commands.arguments import proposed

pytestmark = pytest.mark.usefixtures("studies")


def test_a_study_of_the_user_goes_before_one_of_the_package(studies, capsys):  # noqa: F811
    (studies / "main_case.toml").write_text(GOOD, encoding="utf-8")
    assert main(["check", "main_case"]) == 0
    assert capsys.readouterr().out.startswith("main_case: 3 cases (P 3)")


@pytest.mark.parametrize(
    ("program", "name"),
    [
        ("/usr/bin/roughcoat", "roughcoat"),
        ("/x/study/__main__.py", "python -m study"),
        ("/x/roughcoat/__main__.py", "python -m roughcoat"),
        ("/a/notebook.py", "python -m roughcoat"),
    ],
)
def test_the_usage_says_how_it_was_called(program, name, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", [program])
    with pytest.raises(SystemExit):
        main(["--help"])
    assert capsys.readouterr().out.startswith(f"usage: {name} [-h]")


def test_a_file_of_the_user_called_like_our_package_is_not_taken_for_it():
    """Neither by the command nor by the processes that it starts, whatever it is called by."""
    Path("solver.py").write_text("raise SystemExit('the wrong solver')", encoding="utf-8")
    many = GOOD.replace("[1e-6, 2e-6, 3e-6]", "{ start = 1e-6, stop = 2e-6, num = 8 }")  # enough blocks for processes
    Path("studies/many.toml").write_text(many, encoding="utf-8")
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    called = "import sys; sys.argv[0] = 'roughcoat'; sys.path.pop(0); from study.__main__ import command; command()"
    console = [sys.executable, "-c", called, "check", "good"]
    for command in ([sys.executable, "-m", "study", "run", "many", "--workers", "2"], console):
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr


def command_options(top, command: str) -> dict:
    """Name of an option of a command -> the option."""
    (commands,) = [one for one in top._actions if one.dest == "command"]
    return {one.option_strings[-1]: one for one in commands.choices[command]._actions if one.option_strings}


def test_a_shell_completes_names(monkeypatch):
    assert proposed("run", "go") == ["good"] and proposed("run", "stu") == ["studies/good.toml"]
    assert proposed("status", "main") == ["main_case"]
    assert {"fig01", "fig03", "fig03_layered"} <= set(proposed("plot", "fig0"))
    assert proposed("table", "table") == ["table1", "table1_lattice"]
    Path("results").mkdir(exist_ok=True)
    Path("results/other.nc").touch()
    assert proposed("verify", "results/o") == ["results/other.nc"] and proposed("status", "results/o") == []
    options = command_options(parser(), "plot")
    assert all({"p_max", "p_mean", "p_peak"} <= set(options[name].completer("p_")) for name in ("--x", "--y", "--hue"))
    assert command_options(parser(), "retry")["--status"].completer("iter") == ["iteration_limit"]
    assert proposed("point", "E") == ["E1=", "E2=", "E_punch="] and proposed("point", "pu") == ["punch="]
    asked = []
    fake = SimpleNamespace(autocomplete=lambda commands: asked.append(commands.prog))
    monkeypatch.setitem(sys.modules, "argcomplete", fake)
    assert main(["check", "good"]) == 0 and not asked
    monkeypatch.setenv("_ARGCOMPLETE", "1")
    assert main(["check", "good"]) == 0 and asked == ["python -m roughcoat"]
    monkeypatch.setitem(sys.modules, "argcomplete", None)  # not installed
    assert main(["check", "good"]) == 0

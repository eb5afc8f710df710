"""Laws of others that call sys.exit: a command ended with exit code 0, and nothing was done."""

import dataclasses
import os
import runpy
import sys
from pathlib import Path

import cones
import numpy as np
import pytest
from children import joined, started

import study
from solver import laws
from solver.known import register
from study.__main__ import main
from study.figures import registry

pytestmark = pytest.mark.usefixtures("forgetful")

LAW = '[model]\nbase = "half_space"\nNbar = 250000\nmicro = "leaving"\n[axes]\nP = [1e-6, 2e-6]\n'
POINT = ["point", "P=1e-6", "base=half_space", "micro=leaving"]


@pytest.mark.parametrize(
    ("code", "said"),
    [
        ("import sys; sys.exit()", "it calls sys.exit(), "),
        ("import sys; sys.exit(0)", "it calls sys.exit(0), "),
        ("raise SystemExit('bye')", "it calls sys.exit(bye), "),
        ("raise GeneratorExit", "it raises GeneratorExit, "),
        ("class Own(BaseException): pass\nraise Own('x')", "it raises Own, "),
    ],
)
def test_an_entry_point_that_ends_python(tmp_path, code, said):
    """Of an installed package: the module that it names is imported when a law is not known."""
    about = tmp_path / "leaving-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: leaving\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text("[roughcoat.laws]\nleaving = leaving:LAW\n")
    (tmp_path / "leaving.py").write_text(code + "\n")
    (tmp_path / "s.toml").write_text(LAW)
    for command in (["check", "s.toml"], ["run", "s.toml"], POINT):
        process = started(_command, tmp_path, command)
        joined(process)
        where = "entry point leaving = leaving:LAW of roughcoat.laws: "
        out, err = ((tmp_path / name).read_text() for name in ("out", "err"))
        assert process.exitcode == 2 and out == ""
        assert where + said + "which would end the program" in err, err
        assert "Traceback" not in err and not (tmp_path / "results").exists()


def _command(folder: Path, command: list[str]) -> None:
    """In a process that has imported everything: what `python -m study COMMAND` does beside the installed package."""
    os.chdir(folder)
    for name, file in (("out", sys.stdout), ("err", sys.stderr)):
        os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), file.fileno())
    sys.path.insert(0, str(folder))
    sys.argv = ["study", *command]
    runpy.run_module("study", run_name="__main__", alter_sys=True)


def law(**functions) -> laws.Law:
    return dataclasses.replace(cones.CONES, name="leaving", **functions)


@pytest.mark.parametrize("name", ["scales", "curve", "area", "peak", "edge"])
def test_a_function_that_calls_exit_is_told_before_anything_is_computed(name):
    leaves = law(**{name: lambda *_, **__: sys.exit(0)})
    said = rf"micro law leaving: {name} raises RuntimeError: it calls sys.exit\(0\)"
    with pytest.raises(study.StudyError, match=said):
        study.solve(P=[1e-6, 1e-5], base="half_space", Nbar=250_000.0, alpha=1.3, micro=leaves)


def leaves_later(y, q):
    """Not while it is tried, which is with 13 points: among the cases of a block."""
    return q if np.shape(y)[-1] == 13 else sys.exit(0)


def test_a_function_that_calls_exit_later_fails_its_block_and_not_the_program(tmp_path, monkeypatch, capsys):
    register(law(area=leaves_later))
    monkeypatch.chdir(tmp_path)
    Path("s.toml").write_text(LAW.replace("Nbar", "alpha = 1.3\nNbar"))
    assert main(["run", "s.toml"]) == 1
    assert "block 0 failed: cases 0 to 1: RuntimeError: it calls sys.exit(0), " in capsys.readouterr().err
    with pytest.raises(RuntimeError, match="it calls sys.exit"):
        study.solve(P=[1e-6], base="half_space", Nbar=250_000.0, alpha=1.3, micro="leaving")


def test_ctrl_c_is_not_held_back():
    def pressed(*_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study.solve(P=1e-6, base="half_space", Nbar=250_000.0, alpha=1.3, micro=law(area=pressed))


def test_a_figure_whose_function_calls_exit_is_left_out(results, tmp_path, monkeypatch, capsys):
    figure = registry.Figure(("main_case",), lambda axes, main: sys.exit(0), (3, 3), (1, 1), "")
    monkeypatch.setitem(registry.FIGURES, "leaving", figure)
    assert main(["plot", "leaving", "fig01", "--results", str(results), "--figures", str(tmp_path)]) == 1
    said = capsys.readouterr()
    assert said.err == "leaving: something that it needs calls sys.exit(0)\n" and "fig01.pdf" in said.out

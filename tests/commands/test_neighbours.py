"""Files of the user that are called like our packages, beside roughcoat installed from a wheel, or editable."""

import os
import shutil
import subprocess
import sysconfig
import venv
import zipfile
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from test_cli import GOOD

pytest.importorskip("setuptools")
BUILD = "import sys; from setuptools import build_meta; getattr(build_meta, sys.argv[1])(sys.argv[2])"
TRAP = "from pathlib import Path\nPath('it-ran').touch()\nraise SystemExit('the wrong one')\n"
MANY = GOOD.replace("[1e-6, 2e-6, 3e-6]", "{ start = 1e-6, stop = 2e-6, num = 8 }")  # enough blocks for processes
#: The radius of a contact by the `solver` that is imported, and by the one that `study.solve` has: 1 s more of imports.
#: To 12 digits, for the last one depends on the processor.
CONTACT = "P=1e-5, micro='smooth', base='half_space'"
SOLVE = f"import solver; print(format(solver.solve(solver.Problem.of({CONTACT})).a.item(), '.12g'))"
CALL = f"print(format(study.solve({CONTACT}).a.item(), '.12g'))"
#: What a user may have in the working folder: path -> content. A package hides a module of its name, and both hide a
#: plain folder, so each of the three is tried where it counts.
NEIGHBOURS = {
    "modules": {"solver.py": TRAP, "study/solver.py": TRAP, "study/data.csv": "1, 2", "solver/spec.py": TRAP},
    "packages": {"solver/__init__.py": TRAP},
    "folders": {"solver/data.csv": "1, 2", "study/data.csv": "1, 2", "studies/data.csv": "3, 4"},
}


def run(folder: Path, *command) -> subprocess.CompletedProcess:
    """A command in a folder, without a PYTHONPATH that would hide the folder."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)


@pytest.fixture(scope="module", params=["build_wheel", "build_editable"])
def python(request, tmp_path_factory) -> Path:
    """The Python of an environment in which roughcoat has been installed, and what it needs is that of this one."""
    clone, home = tmp_path_factory.mktemp("clone"), tmp_path_factory.mktemp("home")
    for name in ("roughcoat", "solver", "study", "studies", "docs"):
        shutil.copytree(ROOT / name, clone / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, clone)
    venv.create(home / "venv", symlinks=True)
    python = home / "venv/bin/python"
    packages = Path(sysconfig.get_path("purelib", "venv", {"base": str(home / "venv")}))
    (packages / "others.pth").write_text(f"{Path(np.__file__).parents[1]}\n")
    built = run(clone, python, "-c", BUILD, request.param, home)
    assert built.returncode == 0, built.stderr
    with zipfile.ZipFile(next(home.glob("*.whl"))) as archive:
        archive.extractall(packages)
    (command,) = metadata.Distribution.at(next(packages.glob("roughcoat*.dist-info"))).entry_points
    script = f"#!{python}\nimport sys\nfrom {command.module} import {command.attr}\nsys.exit({command.attr}())\n"
    (python.parent / "roughcoat").write_text(script)
    (python.parent / "roughcoat").chmod(0o755)
    return python


@pytest.fixture
def beside(tmp_path):
    """Write files of a user into a folder of its own, which is returned."""

    def written(files: dict[str, str]) -> Path:
        for name, text in files.items():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(text, encoding="utf-8")
        return tmp_path

    return written


@pytest.mark.parametrize("files", NEIGHBOURS.values(), ids=NEIGHBOURS)
def test_files_called_like_our_packages_are_left_alone(python, beside, files):
    folder = beside(files | {"main.py": f"import study\n{SOLVE}\n", "mine.toml": GOOD})
    done = run(folder, python, "main.py")
    assert (done.returncode, done.stdout) == (0, "0.0195743382058\n"), done.stderr
    done = run(folder, python, "-m", "study", "check", "mine.toml")
    assert (done.returncode, done.stdout.split()[:3]) == (0, ["mine.toml:", "3", "cases"]), done.stderr
    assert not (folder / "it-ran").exists()


def test_processes_that_compute_take_our_packages_too(python, beside):
    """And the command takes no module of the working folder for one that it needs."""
    folder = beside(NEIGHBOURS["modules"] | {"many.toml": MANY, "dask.py": TRAP})
    done = run(folder, python, "-m", "study", "run", "many.toml", "--workers", "2")
    assert done.returncode == 0 and "8 computed now" in done.stdout, done.stderr
    (folder / "dask.py").unlink()
    script = "import numpy as np, study; from study.work import engine; engine.BLOCK, engine.START = 10, 1e-9\n"
    script += "c = study.solve(P=np.geomspace(1e-6, 1e-5, 40), micro='smooth', base='half_space', workers=2)\n"
    script += "assert (c.status == 0).all(); print(engine._pool.count)"
    done = run(folder, python, "-c", script)
    assert (done.returncode, done.stdout) == (0, "1\n"), done.stderr
    assert not (folder / "it-ran").exists()


#: A package hides a module of its name.
CALLED_STUDY = {
    "modules": {"study.py": TRAP, "solver.py": TRAP},
    "packages": {"study/__init__.py": TRAP, "solver/__init__.py": TRAP, "study/__main__.py": TRAP},
}


@pytest.mark.parametrize("files", CALLED_STUDY.values(), ids=CALLED_STUDY)
def test_roughcoat_works_beside_a_study_of_the_user(python, beside, files):
    """As a command by its name, by `python -m`, and imported."""
    folder = beside(
        files | {"many.toml": MANY, "main.py": "import roughcoat as rc, study; print(rc.solve is study.solve)"}
    )
    for command in (
        (python.parent / "roughcoat", "check", "many.toml"),
        (python, "-m", "roughcoat", "check", "many.toml"),
    ):
        done = run(folder, *command)
        assert done.returncode == 0 and done.stdout.startswith("many.toml: 8 cases"), done.stderr
    done = run(folder, python, "main.py")
    assert (done.returncode, done.stdout) == (0, "True\n"), done.stderr
    assert not (folder / "it-ran").exists()


def test_processes_take_our_study_beside_one_of_the_user(python, beside):
    """Those of a run, and those of a call."""
    folder = beside(CALLED_STUDY["modules"] | {"many.toml": MANY})
    done = run(folder, python, "-m", "roughcoat", "run", "many.toml", "--workers", "2")
    assert done.returncode == 0 and "8 computed now" in done.stdout, done.stderr
    script = "import numpy as np, roughcoat as rc\n"
    script += "from study.work import engine; engine.BLOCK, engine.START = 10, 1e-9\n"
    script += "c = rc.solve(P=np.geomspace(1e-6, 1e-5, 40), micro='smooth', base='half_space', workers=2)\n"
    script += "assert (c.status == 0).all(); print(engine._pool.count)"
    done = run(folder, python, "-c", script)
    assert (done.returncode, done.stdout) == (0, "1\n"), done.stderr
    assert not (folder / "it-ran").exists()


def test_workers_of_dask_take_our_study_too(python, beside):
    """They look for modules where the program does that starts them: in the working folder first."""
    pytest.importorskip("distributed")
    folder = beside(CALLED_STUDY["modules"] | {"many.toml": MANY})
    script = "from distributed import LocalCluster; import roughcoat as rc\n"
    script += "with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster:\n"
    script += "    with cluster.get_client():\n"
    script += f"        print(rc.solve({CONTACT.replace('1e-5', '[1e-6, 1e-5]')}, chunks={{'P': 1}}).a.values.size)\n"
    script += "    print(rc.load('many.toml').run(scheduler=cluster.scheduler_address).computed)"
    done = run(folder, python, "-c", script)
    assert (done.returncode, done.stdout) == (0, "2\n8\n"), done.stderr
    assert not (folder / "it-ran").exists()


def test_another_study_that_the_program_has_imported_is_named(python, beside):
    folder = beside({"study.py": "mine = 1\n"})
    done = run(folder, python, "-c", "import study, roughcoat")
    assert done.returncode == 1
    assert (
        f"ImportError: {folder / 'study.py'}: has been imported as study, which is also a package of rough"
        in done.stderr
    )


FIGURES = """
from study.figures.registry import figure


@figure("radius", "mine")
def radius(axes, line):
    \"\"\"The radius against the load.\"\"\"
    axes.plot(line["P"], line["a"])
    return {"P": line["P"].values, "a": line["a"].values}
"""


def test_a_figure_of_the_user_and_the_book_in_a_folder_with_nothing_else(python, beside):
    """Whatever the user has that is called like our packages. One figure needs a study of the book, one is a drawing of
    it, and the table needs no study."""
    folder = beside(NEIGHBOURS["modules"] | {"studies/mine.toml": GOOD, "studies/figures.py": FIGURES})
    done = run(folder, python, "-m", "study", "plot", "--run", "radius", "fig01", "fig03")
    assert done.returncode == 0, done.stderr
    names = {path.name for path in (folder / "figures").iterdir()}
    assert {"radius.csv", "radius.pdf", "radius.png", "fig01.svg", "fig03.pdf", "fig03.csv"} <= names
    assert (folder / "figures/radius.csv").read_text().splitlines()[0] == "P,a"
    done = run(folder, python, "-m", "study", "table", "table1")
    assert done.returncode == 0 and (folder / "tables/table1.txt").exists(), done.stderr
    (folder / "studies/figures.py").write_text(TRAP)
    done = run(folder, python, "-m", "study", "list")
    assert (done.returncode, done.stdout.split()[0]) == (0, "mine"), done.stderr
    assert not (folder / "it-ran").exists()


def test_a_script_may_be_called_solver(python, beside):
    folder = beside({"solver.py": f"import study\n{CALL}\n"})
    done = run(folder, python, "solver.py")
    assert (done.returncode, done.stdout) == (0, "0.0195743382058\n"), done.stderr


@pytest.mark.parametrize("name", ["solver.py", "solver/__init__.py"])
def test_another_solver_that_the_program_has_imported_is_named(python, beside, name):
    folder = beside({name: "mine = 1\n"})
    done = run(folder, python, "-c", "import solver, study")
    assert done.returncode == 1
    assert (
        f"ImportError: {folder / name}: has been imported as solver, which is also a package of roughcoat"
        in done.stderr
    )


def test_our_solver_stays_what_it_is(python, beside):
    """Imported before or after, by the name that the pages use, and though the working folder changes."""
    folder = beside({"elsewhere/solver.py": TRAP})
    for order, answer in {"solver, study": SOLVE, "study, solver": CALL}.items():
        script = f"import os\nimport {order}\nos.chdir('elsewhere')\nimport solver\n{answer}; print(solver.Problem)"
        done = run(folder, python, "-c", script)
        assert done.returncode == 0 and "solver.problem.Problem" in done.stdout, done.stderr

"""The import contract: solver knows numpy and scipy only, study imports one way, importing does nothing heavy."""

import ast
import graphlib
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SOLVER = sorted((ROOT / "solver").glob("*.py"))
STUDY = sorted((ROOT / "study").glob("*.py"))


def imported(path: Path) -> set[str]:
    """Absolute dotted names that a file imports anywhere, relative ones resolved against its package."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level <= 1, f"{path.name} leaves its package"
            module = ".".join(filter(None, (path.parent.name if node.level else "", node.module)))
            # `from . import x` and `from package import module` name modules in their alias list
            names = {f"{module}.{alias.name}" for alias in node.names}
            modules = {name for name in names if (ROOT / (name.replace(".", "/") + ".py")).exists()}
            found |= modules if modules and not node.module else {module} | modules
    return found


def tops(path: Path) -> set[str]:
    return {name.split(".")[0] for name in imported(path)}


@pytest.mark.parametrize("path", SOLVER, ids=lambda path: path.name)
def test_solver_imports_numpy_and_scipy_only(path):
    """And threadpoolctl, in the one file that sets the number of BLAS threads."""
    more = {"threadpoolctl"} if path.name == "threads.py" else set()
    assert tops(path) - set(sys.stdlib_module_names) <= {"numpy", "scipy", "solver"} | more


@pytest.mark.parametrize("path", SOLVER, ids=lambda path: path.name)
def test_importing_the_solver_does_nothing_to_the_process(path):
    """A library defines names: no call whose effect stays, such as one that makes malloc keep freed memory."""
    docstring, *statements = ast.parse(path.read_text(encoding="utf-8")).body
    defining = ast.Import | ast.ImportFrom | ast.FunctionDef | ast.ClassDef | ast.Assign | ast.AnnAssign
    assert ast.get_docstring(ast.Module([docstring], []))
    assert all(isinstance(statement, defining) for statement in statements)


@pytest.mark.parametrize("path", STUDY, ids=lambda path: path.name)
def test_study_imports_what_is_declared(path):
    allowed = {"numpy", "scipy", "xarray", "netCDF4", "dask", "matplotlib", "solver", "study"}
    assert tops(path) - set(sys.stdlib_module_names) <= allowed


@pytest.mark.parametrize("paths", [SOLVER, STUDY], ids=["solver", "study"])
def test_no_cycles(paths):
    package = paths[0].parent.name
    graph = {}
    for path in paths:
        if path.stem != "__init__":
            inside = {name.split(".")[1] for name in imported(path) if name.startswith(f"{package}.")}
            graph[path.stem] = inside - {"__init__"}
    graphlib.TopologicalSorter(graph).prepare()  # raises CycleError


def test_only_blocks_and_dataset_and_tables_know_the_solver():
    """The seam between solver and study stays narrow; the vocabulary knows the table of parameters alone."""
    users = {path.stem: {name for name in imported(path) if name.split(".")[0] == "solver"} for path in STUDY}
    assert users["vocabulary"] == {"solver.parameters"}
    assert not any(users[name] for name in ("grid", "draft", "run", "api", "units", "derived", "progress"))


def alone(script: str) -> None:
    """Run a script in a Python of its own."""
    path = [entry or str(ROOT) for entry in sys.path]
    subprocess.run([sys.executable, "-c", f"import sys; sys.path[:] = {path!r}; {script}"], check=True)


NOT_HEAVY = "assert not {'xarray', 'dask', 'netCDF4', 'matplotlib'} & set(sys.modules)"


def test_light_modules_stay_light():
    """Complaints about a study file come at once, and worker processes, which import `blocks`, start soon."""
    alone(f"import study.vocabulary, study.grid, study.draft, study.definition; {NOT_HEAVY}")
    alone(f"import study.arguments, study.blocks; {NOT_HEAVY}")


def test_rooms_are_there_after_import_of_the_package_alone():
    """And the package itself imports nothing: neither numpy nor a room."""
    alone(
        "import study; assert not {'numpy', 'xarray', 'study.vocabulary', 'study.derived'} & set(sys.modules);"
        f"assert study.vocabulary.VOCABULARY; {NOT_HEAVY};"
        "assert study.derived.peak_pressure and study.units.factor; assert 'xarray' in sys.modules"
    )


def test_public_names():
    import study

    assert {"derived", "units", "vocabulary"} <= set(dir(study))

    assert {"solve", "load", "open_results", "Study", "StudyError", "to_physical", "from_physical"} <= set(dir(study))
    assert all(callable(getattr(study, name)) for name in study.__all__)
    with pytest.raises(AttributeError, match="no attribute 'sovle'"):
        study.sovle  # noqa: B018


def test_solve_names_every_parameter():
    import study
    from study.vocabulary import PARAMETERS

    listed = study.solve.__doc__.split("**parameters :")[1].split("all dimensionless")[0]
    assert set(PARAMETERS) - set(re.findall(r"\w+", listed)) == set()
    # getdoc: Python 3.13 takes the indentation of docstrings away
    arguments = re.findall(r"^[*]{0,2}(\w+) : ", inspect.getdoc(study.solve), flags=re.MULTILINE)
    assert set(arguments) - {"StudyError"} == set(inspect.signature(study.solve).parameters)

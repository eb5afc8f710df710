"""The import contract: solver knows numpy and scipy only, study imports one way, importing does nothing heavy."""

import ast
import graphlib
import inspect
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

import roughcoat

ROOT = Path(__file__).resolve().parents[2]
SOLVER = sorted((ROOT / "solver").rglob("*.py"))
STUDY = sorted((ROOT / "study").rglob("*.py"))
BOOK = sorted((ROOT / "studies").rglob("*.py"))

OURS = {"roughcoat", "solver", "study", "studies"}

#: The rooms of each package; a file beside them is a room of its own.
ROOMS = {
    "solver": (
        *("closed_forms", "numerics", "status", "bases", "parameters", "layers", "shapes", "kernels"),
        *("laws", "known", "body", "problem", "solution", "rough", "compiled", "scaling"),
        *("schemes", "smooth", "ways", "models", "solve", "sensitivity", "fields", "yields"),
    ),
    "study": (
        *("terminal", "arrays", "samples", "specimen", "inputs", "pages", "rules", "data", "derivatives"),
        *("in_words", "files", "store", "work", "scan_laws", "lazy", "solving", "fields", "inverse", "adhesion"),
        *("creep", "yields", "figures", "api", "catalogue", "explorer", "commands", "__main__"),
    ),
}
#: Rooms that do not know each other, though both are to the left of others.
APART = {"body": {"laws"}, "kernels": {"laws", "shapes"}}


def name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def of_each(paths: list[Path]) -> Callable:
    """Make one test of a check of each file: some hundred tests of a thousandth of a second take longer to collect."""

    def decorate(check: Callable) -> Callable:
        def test():
            failed = []
            for path in paths:
                try:
                    check(path)
                except AssertionError as error:
                    failed.append(f"{name(path)}: {error}")
            assert not failed, "\n".join(failed)

        test.__name__, test.__doc__ = check.__name__, check.__doc__
        return test

    return decorate


@cache
def imported(path: Path) -> set[str]:
    """Absolute dotted names that a file imports anywhere, relative ones resolved against its package."""
    return names_in(ast.parse(path.read_text(encoding="utf-8")), path)


def names_in(tree: ast.AST, path: Path) -> set[str]:
    """The same of the tree of a file, or of a part of it."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            home = path.relative_to(ROOT).parts[: -node.level] if node.level else ()
            assert home or not node.level, f"{path} leaves its package"
            module = ".".join(filter(None, (*home, node.module)))
            # `from . import x` and `from package import module` name modules in their alias list
            names = {f"{module}.{alias.name}" for alias in node.names}
            found |= {name if exists(name) else module for name in names}
    return found


def exists(module: str) -> bool:
    path = ROOT / module.replace(".", "/")
    return path.is_dir() or path.with_suffix(".py").exists()


def tops(path: Path) -> set[str]:
    return {name.split(".")[0] for name in imported(path)}


@of_each(SOLVER)
def test_solver_imports_numpy_and_scipy_only(path):
    """And threadpoolctl, in the one file that sets the number of BLAS threads."""
    more = {"threadpoolctl"} if path.name == "threads.py" else set()
    assert tops(path) - set(sys.stdlib_module_names) <= {"numpy", "scipy", "solver"} | more


@of_each(SOLVER)
def test_importing_the_solver_does_nothing_to_the_process(path):
    """A library defines names: no call whose effect stays, such as one that makes malloc keep freed memory."""
    docstring, *statements = ast.parse(path.read_text(encoding="utf-8")).body
    defining = ast.Import | ast.ImportFrom | ast.FunctionDef | ast.ClassDef | ast.Assign | ast.AnnAssign
    assert ast.get_docstring(ast.Module([docstring], []))
    assert all(isinstance(statement, defining) for statement in statements)


@of_each(STUDY)
def test_study_imports_what_is_declared(path):
    """And extras in one file each: SurfaceTopography, which reads scans, openpyxl, argcomplete, which serves shells."""
    allowed = {"numpy", "scipy", "xarray", "netCDF4", "dask", "matplotlib", "pint", "solver", "study"}
    allowed |= {"SurfaceTopography"} if path.name == "scan_files.py" else set()
    allowed |= {"pandas"} if path.name == "labelled.py" else set()  # of which xarray makes its indexes
    allowed |= {"spreadsheet.py": {"openpyxl"}, "__main__.py": {"argcomplete"}}.get(path.name, set())
    allowed |= {"roughcoat"} if path.name in ("cluster.py", "lazy.py") else set()  # so that a worker takes our packages
    allowed |= {"roughcoat", "lmfit"} if path.name == "nanite_layer.py" else set()  # nanite loads it, and has lmfit
    assert tops(path) - set(sys.stdlib_module_names) <= allowed


@of_each([*SOLVER, *STUDY])
def test_rooms_import_one_way(path):
    """A room imports from those to its left alone, so that each can be read with only these in mind."""
    package, room = name(path).split("/")[:2]
    if path.parent == ROOT / package and path.stem == "__init__":
        return
    rooms = ROOMS[package]
    mine = rooms.index(room.removesuffix(".py"))
    others = {full.split(".")[1] for full in imported(path) if full.startswith(f"{package}.")}
    assert others <= {*rooms[: mine + 1]} - APART.get(room, set())


def test_no_function_is_handed_upward():
    """What solves whole problems is imported by the rooms that use it. None waits for one of its functions as an
    argument, which would hide that it needs a room to its right."""
    rooms = ROOMS["solver"]
    solving = rooms[rooms.index("schemes") :]
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in SOLVER}
    public = {
        node.name
        for path, tree in trees.items()
        if name(path).split("/")[1].removesuffix(".py") in solving
        for node in tree.body
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")
    }
    assert {"solve", "judged", "cheapest", "newton"} <= public
    for path, tree in trees.items():
        arguments = {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)}
        assert not arguments & public, name(path)


@of_each(BOOK)
def test_the_book_imports_the_face_and_the_figures(path):
    """And the solver. What a chapter needs beyond it is missing to a user as well."""
    assert tops(path) - set(sys.stdlib_module_names) <= {"numpy", "scipy", "xarray", "matplotlib", *OURS}
    import study

    names = {full.split(".")[1] for full in imported(path) if full.startswith("study.")}
    assert names <= {*dir(study), "figures"}


@of_each([*SOLVER, *STUDY])
def test_nothing_imports_the_book(path):
    """It is found as the studies of a user are, and run when it is asked for."""
    assert not {full for full in imported(path) if full.startswith(("studies", "study.studies"))}
    text = path.read_text(encoding="utf-8")
    assert "study.studies" not in text or name(path) in ("study/inputs/places.py", "study/__init__.py")


@pytest.mark.parametrize("package", ["solver", "study", "studies"])
def test_no_cycles(package):
    graph = {}
    for path in (ROOT / package).rglob("*.py"):
        if path.stem != "__init__":
            module = name(path).removesuffix(".py").replace("/", ".")
            graph[module] = {full for full in imported(path) if full.startswith(f"{package}.")} - {package}
    graphlib.TopologicalSorter(graph).prepare()  # raises CycleError


def test_no_cycles_through_roughcoat():
    """Imports inside functions count, and so does the package of a module that is imported from outside of it. What a
    type checker alone reads does not."""
    graph = {}
    for package in ("roughcoat", "solver", "study", "studies"):
        for path in (ROOT / package).rglob("*.py"):
            files = {file for full in imported(path) - of_checkers(path) if (file := file_of(full))}
            parents = {parent / "__init__.py" for file in files for parent in file.parents if ROOT in parent.parents}
            files |= {parent for parent in parents if parent.exists() and parent.parent not in path.parents}
            graph[path] = files - {path}
    graphlib.TopologicalSorter(graph).prepare()  # raises CycleError


def of_checkers(path: Path) -> set[str]:
    """What the file imports for type checkers alone."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    blocks = [node for node in tree.body if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"]
    tree.body = [node for node in tree.body if node not in blocks]
    return imported(path) - names_in(tree, path)


def file_of(module: str) -> Path | None:
    """The file of a module of ours."""
    path = ROOT / module.replace(".", "/")
    files = (path.with_suffix(".py"), path / "__init__.py")
    return next((file for file in files if file.exists()), None)


@pytest.mark.parametrize("package", ["solver", "study"])
def test_rooms_are_named(package):
    """A new room is named in ROOMS."""
    folders = [ROOT / package, *(path for path in (ROOT / package).iterdir() if (path / "__init__.py").exists())]
    assert {path.stem for folder in folders[:1] for path in folder.glob("*.py")} | {
        folder.name for folder in folders[1:]
    } == {*ROOMS[package], "__init__"}


@pytest.mark.parametrize("package", ["solver", "study"])
def test_the_map_has_every_room_in_order(package):
    """docs/extending.md begins with it: a room is in one row, and no row is above one from which it imports."""
    page = (ROOT / "docs/extending.md").read_text(encoding="utf-8")
    table = page.split(f"**Rooms of `{package}`**\n")[1].strip().split("\n\n")[0]
    rows = [re.findall(r"`(\w+)`", line.split("|")[1]) for line in table.splitlines()[2:]]
    assert [room for row in rows for room in row] == [*ROOMS[package]]


@pytest.mark.parametrize("top", ["solver", "study", "studies", "tests", "tools"])
def test_folders_are_small(top):
    sizes = {folder: len(list(folder.glob("*.py"))) for folder in [ROOT / top, *(ROOT / top).rglob("*")]}
    assert {folder.name: size for folder, size in sizes.items() if size > 12} == {}


@pytest.mark.parametrize("top", ["solver", "study", "studies", "tests", "tools"])
def test_files_are_short(top):
    sizes = {name(path): path.read_bytes().count(b"\n") for path in (ROOT / top).rglob("*.py")}
    assert {file: size for file, size in sizes.items() if size > 400} == {}


def test_only_blocks_and_dataset_and_tables_know_the_solver():
    """The seam between solver and study stays narrow: the vocabulary knows the table of parameters alone."""
    users = {path.stem: {full for full in imported(path) if full.split(".")[0] == "solver"} for path in STUDY}
    assert users["vocabulary"] == {"solver.parameters"}
    own = {"solver.bases", "solver.laws", "solver.laws.own_table", "solver.laws.power_law_fit"}
    own |= {"solver.parameters", "solver.problem"}
    assert users["micro_laws"] == own, "those of the words of a study, fits, and what asperities press on"
    assert not any(users[name] for name in ("grid", "request", "run", "api", "units", "progress"))


def alone(script: str) -> None:
    """Run a script in a Python of its own."""
    path = [entry or str(ROOT) for entry in sys.path]
    subprocess.run([sys.executable, "-c", f"import sys; sys.path[:] = {path!r}; {script}"], check=True)


NOT_HEAVY = "assert not {'xarray', 'dask', 'netCDF4', 'matplotlib'} & set(sys.modules)"


def test_light_modules_stay_light():
    """Complaints about a study file come at once, and worker processes, which import `processes`, start soon."""
    light = (
        *("inputs.vocabulary", "inputs.grid", "inputs.definition", "inputs.reading", "commands.arguments"),
        "work.processes",
    )
    alone("; ".join(f"import study.{module}; {NOT_HEAVY}" for module in (*light, "specimen.materials")))


def test_figures_of_studies_do_without_those_of_any_results():
    """A quarter of the time of `plot fig03` was imports of what it does not use."""
    unused = "{'study.figures.plots', 'study.commands.spreadsheet', 'scipy.interpolate'}"
    alone(f"import study.commands.drawing; assert not {unused} & set(sys.modules)")


def test_a_contact_of_named_materials_is_said_without_a_dataset():
    """With its spreads and strengths, and the load at which the first of them is reached."""
    case = "R='5 mm', punch='alumina', layer='TiN', body='steel 52100', h='3 um', P='10 N', bonding='bonded'"
    alone(
        "from study.solving import solve_one; from study.in_words import summary;"
        f"text = summary(solve_one({case}, micro='smooth'));"
        f"assert 'of the variance' in text and 'would yield at about P =' in text; {NOT_HEAVY}"
    )


def test_rooms_are_there_after_import_of_the_package_alone():
    """And the package itself imports nothing: neither numpy nor a room."""
    alone(
        "import study; assert not {'numpy', 'xarray', 'study.inputs', 'study.data'} & set(sys.modules);"
        f"assert study.vocabulary.VOCABULARY; {NOT_HEAVY};"
        f"assert study.derived.peak_pressure and study.units.factor; {NOT_HEAVY}"
    )


def test_roughcoat_imports_study_when_a_name_is_asked_for():
    alone(
        "import roughcoat; assert not {'study', 'solver', 'numpy'} & set(sys.modules);"
        "assert roughcoat.solve is sys.modules['study'].solve"
    )


def test_public_names():
    import study

    assert {"derived", "materials", "roughness", "units", "vocabulary"} <= set(dir(study))

    assert {"solve", "load", "open_results", "Study", "StudyError", "to_physical", "from_physical"} <= set(dir(study))
    assert all(getattr(study, name) for name in study.__all__)
    assert (
        study.__version__ == tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    )
    for package in (study, roughcoat):
        with pytest.raises(AttributeError, match=f"module '{package.__name__}' has no attribute 'sovle'"):
            package.sovle  # noqa: B018


def test_roughcoat_gives_what_study_gives():
    import study

    assert roughcoat.__all__ == study.__all__ and set(dir(study)) <= set(dir(roughcoat))
    assert all(getattr(roughcoat, name) == getattr(study, name) for name in (*study.__all__, "__version__"))
    assert {*study.__all__} == {*study._HOME, *study._MODULES}, "what is imported when it is asked for"


def test_solve_names_every_parameter_with_its_default_and_its_choices():
    """The signature is what editors show; the docstring has a line for each name, the vocabulary the truth."""
    import study
    from solver.known import PARAMETERS as OWN
    from study.inputs.vocabulary import BODIES, PARAMETERS, SCENE

    known = inspect.signature(study.solve).parameters
    beside = {"cases", "x", "profiles", "title", "workers", "same_piece", "progress", "chunks"}
    beside |= {"sensitivities", "correlations", "parameters"}
    of_stacks = {"layers", "rigid_base"}  # of these follow parameters for each layer
    assert set(known) - beside == ({*PARAMETERS, *SCENE, *BODIES} | of_stacks) - {"table_unit"}  # of a file
    # getdoc: Python 3.13 takes the indentation of docstrings away
    lines = re.findall(r"^([\w, ]+) : ", inspect.getdoc(study.solve), flags=re.MULTILINE)
    assert sorted(name for line in lines for name in line.split(", ")) == sorted([*known, "StudyError"])
    for name in {*PARAMETERS} & {*OWN} - {"table_unit"}:  # E2 is a modulus here, with a unit
        literal = re.search(r"Literal\[(.*?)\]", known[name].annotation)
        assert known[name].default == OWN[name].default
        choices = ast.literal_eval(f"({literal[1]},)") if literal else ()
        read = [word for word in OWN[name].choices if word.startswith("table:")]  # by a test before
        assert sorted([*choices, *read]) == sorted(OWN[name].choices), name


#: Files with locks -> why a forked process does not wait for one that a thread held which it does not have.
LOCKS = {
    "solver/numerics/caches.py": "the fork waits until they are free",
    "solver/numerics/threads.py": "renewed",
    "study/files/access.py": "the fork waits until it is free",
    "study/work/engine.py": "renewed",
    "study/work/processes.py": "of processes, which a fork starts anew",
    "study/work/progress.py": "of one call",
    "study/work/second_process.py": "of one command",
}


def test_a_fork_inherits_no_lock():
    """functools.cached_property has one for all objects until Python 3.12: 4 of 25 forked processes hung."""
    code = {name(path): path.read_text(encoding="utf-8") for path in (*SOLVER, *STUDY)}
    assert [path for path, text in code.items() if re.search(r"import.*cached_property", text)] == []
    assert {path for path, text in code.items() if re.search(r"\b(R?Lock|Semaphore)\(", text)} == {*LOCKS}

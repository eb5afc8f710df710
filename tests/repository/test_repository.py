"""The repository around the code: Makefile, README, lock, citation, CI."""

import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
from pathlib import Path

import pytest
from conftest import ROOT, STUDIES
from lowest import lowest

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
LOCK = (ROOT / "requirements.lock").read_text(encoding="utf-8")
TARGETS = ("help", "docs", "docs-test", "setup", "figures", "table1", "paper_numbers", "validity", "map", "extremes",
           "tradeoff", "picard_domain", "literature", "yield_maps", "validate", "test", "verify", "explorer-test",
           "check", "kernels", "lowest", "mutants", "sanitize", "fuzz", "bench", "speed", "start", "fit_coverage",
           "lint", "clean")  # fmt: skip

#: Files at the top of the repository.
TOP = ("CHANGELOG.md", "CITATION.cff", "CODE_OF_CONDUCT.md", "CONTRIBUTING.md", "LICENSE", "MANIFEST.in", "Makefile",
       "README.md", "SECURITY.md", ".gitignore", "paper.bib", "paper.md", "pyproject.toml", "requirements.lock",
       "setup.py")  # fmt: skip


def make(folder: Path, *arguments: str) -> subprocess.CompletedProcess:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("MAKE")}
    return subprocess.run(["make", *arguments], cwd=folder, capture_output=True, text=True, env=environment, timeout=60)


def test_make_help_lists_every_target():
    lines = make(ROOT, "help").stdout.splitlines()
    assert {line.split()[1] for line in lines} == set(TARGETS)
    assert all(len(line.split()) > 2 for line in lines), "each with a word of explanation"


def test_formatting_leaves_the_pages_alone():
    """CONTRIBUTING.md says `ruff format`, which would take the comments of their examples out of their columns."""
    pytest.importorskip("ruff")
    done = subprocess.run([sys.executable, "-m", "ruff", "format", "--check", "."], cwd=ROOT, capture_output=True)
    assert b".md" not in done.stdout + done.stderr


@pytest.mark.parametrize("listed", ["quick.txt", "computing.txt"])
def test_lists_of_tests_name_files_that_there_are(listed):
    lines = (ROOT / "tests" / listed).read_text(encoding="utf-8").split()
    places = [re.sub("^--(ignore|deselect)=", "", line).split("::") for line in lines if not line.startswith("-k")]
    assert len(places) > 5
    assert not [file for file, *_ in places if not (ROOT / file).exists()]
    assert not [name for file, *test in places for name in test if f"def {name}(" not in (ROOT / file).read_text()]


@pytest.fixture
def sandbox(tmp_path) -> Path:
    """The Makefile with a python that writes down what it is asked."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    for folder in ("studies", "results", ".venv/bin"):
        (tmp_path / folder).mkdir(parents=True)
    for file in ("studies/mine.toml", "requirements.lock", "pyproject.toml"):
        (tmp_path / file).touch()
    python = tmp_path / ".venv/bin/python"
    python.write_text('#!/bin/sh\necho "$@" >> calls\n')
    python.chmod(0o755)
    (tmp_path / ".venv/.ready").touch()
    return tmp_path


def calls(folder: Path) -> list[str]:
    found = (folder / "calls").read_text().splitlines() if (folder / "calls").exists() else []
    (folder / "calls").unlink(missing_ok=True)
    return found


@pytest.mark.parametrize(
    ("target", "asked"),
    [
        ("figures", ["plot --run all"]),
        ("figures/fig04.pdf", ["plot --run fig04"]),
        ("tables/validity.txt", ["table --run validity"]),
        ("picard_domain", ["plot --run picard_domain"]),
        ("map", ["run parameter_map"]),
        ("results/mine.nc", ["run mine"]),
    ],
)
def test_make_asks_the_program_which_knows_what_is_needed(sandbox, target, asked):
    assert make(sandbox, target).returncode == 0
    assert calls(sandbox) == [f"-m study {command}" for command in asked]


def test_make_prints_a_table_that_it_has_written(sandbox):
    (sandbox / "tables").mkdir()
    for name in ("table1", "extremes"):
        (sandbox / f"tables/{name}.txt").write_text(f"{name} in words\n")
        assert make(sandbox, name).stdout.endswith(f"{name} in words\n")
    assert set(calls(sandbox)) == {
        f"-m study {command}" for command in ("table --run table1", "plot --run extremes", "table --run extremes")
    }


def test_clean_removes_what_the_program_draws_alone(tmp_path):
    kept = ("figures/mine.pdf", "figures/parameter_map_p_max.pdf", "tables/mine.txt", "results/main_case.nc")
    ours = ("figures/fig01.svg", "figures/fig04.pdf", "figures/fig10_layered.csv", "figures/captions.md",
            "figures/.roughcoat.json", "tables/.roughcoat.json",
            "tables/table1.tex", "bench.json", "study/inputs/__pycache__/x.pyc", ".ruff_cache/x")  # fmt: skip
    for name in (*kept, *ours):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    subprocess.run([sys.executable, ROOT / "tools/clean.py"], cwd=tmp_path, check=True, timeout=60)
    assert {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*.*") if path.is_file()} == set(kept)


def test_a_refused_run_leaves_the_results(sandbox):
    result = sandbox / "results/mine.nc"
    result.write_text("a night of computing")
    os.utime(result, (1, 1))
    (sandbox / ".venv/bin/python").write_text("#!/bin/sh\nexit 2\n")
    assert make(sandbox, "results/mine.nc").returncode != 0
    assert result.read_text() == "a night of computing"


def test_old_python_is_refused_with_a_reason(sandbox):
    (sandbox / ".venv/.ready").unlink()
    found = make(sandbox, "setup", "PYTHON=false")
    assert found.returncode != 0
    assert "needs Python 3.11 or newer" in found.stdout


def test_the_lock_pins_everything_and_names_no_machine():
    pins = dict(re.findall(r"^([a-z0-9_.-]+)==(\S+)$", LOCK, flags=re.MULTILINE))
    extras = PROJECT["project"]["optional-dependencies"]
    wanted = [
        *PROJECT["build-system"]["requires"],
        *PROJECT["project"]["dependencies"],
        *extras["cluster"],
        *extras["test"],
        *extras["lint"],
    ]
    for requirement in wanted:
        assert re.match(r"[A-Za-z0-9_.-]+", requirement)[0].lower() in pins
    lines = [line for line in LOCK.splitlines() if line and not line.lstrip().startswith("#")]
    assert len(lines) == len(pins), "every line is a pin"
    assert not re.search(r"://|@|^-|/", "\n".join(lines), flags=re.MULTILINE)


def test_the_lowest_versions_are_exact_and_below_the_pinned():
    pins = dict(re.findall(r"^([a-z0-9_.-]+)==(\S+)$", LOCK, flags=re.MULTILINE))
    found = dict(re.fullmatch(r"([A-Za-z0-9_.-]+)==([0-9.]+)", one).groups() for one in lowest(PROJECT))
    assert {"setuptools", "numpy", "netCDF4", "distributed", "pytest"} <= set(found)
    for name, version in found.items():
        least, pinned = (tuple(map(int, re.findall(r"\d+", v))) for v in (version, pins[name.lower()]))
        assert least <= pinned, name


def test_versions_agree():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"version: {PROJECT['project']['version']}\n" in citation
    assert "license: BSD-3-Clause" in citation and PROJECT["project"]["license"] == "BSD-3-Clause"
    assert (ROOT / "LICENSE").read_text(encoding="utf-8").startswith("BSD 3-Clause License")


def test_the_paper_has_the_sections_of_joss_and_its_references():
    paper, bibliography = ((ROOT / name).read_text(encoding="utf-8") for name in ("paper.md", "paper.bib"))
    assert re.findall("^# (.*)$", paper, flags=re.MULTILINE) == [
        "Summary", "Statement of need", "State of the field", "Software design", "Research impact statement",
        "AI usage disclosure", "Acknowledgements", "References",
    ]  # fmt: skip
    assert {*re.findall(r"@(\w+)\b", paper)} == {*re.findall(r"^@article\{(\w+),", bibliography, flags=re.MULTILINE)}
    assert 750 <= len(paper.split()) <= 1750  # what JOSS asks for


def contents(folder: Path) -> dict[str, bytes]:
    """Path in the folder -> bytes of each file, without compiled code."""
    files = (path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def test_what_is_installed_has_every_package_and_the_studies(tmp_path):
    """As a wheel has it: `roughcoat plot --run fig03` works in an empty folder."""
    command = [sys.executable, "setup.py", "--quiet", "build_py", "--build-lib", str(tmp_path)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True, timeout=120)
    for package in ("roughcoat", "solver", "study"):
        ours = {path.relative_to(ROOT) for path in (ROOT / package).rglob("*") if "__pycache__" not in path.parts}
        built = {path.relative_to(tmp_path) for path in (tmp_path / package).rglob("*")}
        # the compiled core is another command's (tests/compiled/test_library.py), and nobody needs its sources
        assert {path for path in ours - built if path.suffix not in (".c", ".h", ".so", ".pyd")} == set()
    assert contents(tmp_path / "study/studies") == contents(ROOT / "studies") and len(STUDIES) == 28
    pages = {path.relative_to(tmp_path / "study/docs").as_posix() for path in (tmp_path / "study/docs").rglob("*")}
    assert pages == {path.name for path in (ROOT / "docs").glob("*.md")} and len(pages) > 12
    assert {path.name for path in tmp_path.iterdir()} == {"roughcoat", "solver", "study"}
    assert PROJECT["project"]["scripts"] == {"roughcoat": "roughcoat.__main__:command"}


def test_a_source_distribution_has_all_that_the_tests_need(tmp_path):
    """Everything of the repository: the tests, the lists that they read, the lock, the sources of the core."""
    clone, unwanted = tmp_path / "clone", shutil.ignore_patterns("__pycache__", "*.so", "*.pyd", "_build")
    for folder in ("roughcoat", "solver", "study", "studies", "docs", "tests", "tools", "findings", ".ci", ".github"):
        shutil.copytree(ROOT / folder, clone / folder, ignore=unwanted)
    for made in ("examples", "reference"):  # by `make docs`
        shutil.rmtree(clone / "docs" / made, ignore_errors=True)
    for name in TOP:
        shutil.copy(ROOT / name, clone)
    wanted = {path.relative_to(clone).as_posix() for path in clone.rglob("*") if path.is_file()}
    command = [sys.executable, "setup.py", "--quiet", "sdist", "--dist-dir", str(tmp_path)]
    subprocess.run(command, cwd=clone, check=True, capture_output=True, timeout=120)
    (packed,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(packed) as archive:
        assert wanted - {name.partition("/")[2] for name in archive.getnames()} == set()


def test_the_workflow_runs_what_ci_runs():
    """Its Pythons are among those of the classifiers, and cibuildwheel's settings say which wheels."""
    workflow = (ROOT / ".github/workflows/tests.yml").read_text(encoding="utf-8")
    assert re.findall(r"- run: (\S+)$", workflow, flags=re.MULTILINE) == [".ci/run"]
    (pythons,) = re.findall(r"python: \[(.*)\]", workflow)
    named = {line.rsplit(" ", 1)[1] for line in PROJECT["project"]["classifiers"] if "Python :: 3." in line}
    assert {*re.findall(r"3\.\d+", pythons)} <= named and "3.11" in pythons
    assert "pipx run cibuildwheel" in workflow
    assert all(build.startswith("cp311-") for build in PROJECT["tool"]["cibuildwheel"]["build"].split())


def test_ci_runs_the_tests_of_the_readme():
    script = ROOT / ".ci/run"
    assert os.access(script, os.X_OK)
    assert script.read_text(encoding="utf-8").rstrip().endswith("make --no-print-directory test")

"""Results of every study of the repository, shrunken so that all of them take seconds; fixtures that files share."""

import os
import shutil
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

# Before numpy is imported. The processors are shared among processes of pytest; a second BLAS thread in each, which
# waits for work at full speed, took 12 of the 16 s of tests/body/test_layered.py.
os.environ |= {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL")} | os.environ

import pytest
import xarray as xr
from budget import pytest_addoption, pytest_configure  # noqa: F401
from explorer_page import explorer  # noqa: F401
from interrupted_study import undisturbed  # noqa: F401
from left_out import left_out
from line_study import computed, file, quiet  # noqa: F401
from screens import impatient, stderr  # noqa: F401

from solver import known
from solver.compiled.library import VARIABLE, available
from study import open_results
from study.files.lock import lock_file
from study.work import engine

collect_ignore = ["shared/hold.py"]  # importing it changes `study`: it is for processes of their own
# What a test puts in the place of the solver is not known to worker processes. Tests of these start them.
engine.START = engine.MANY = float("inf")
ROOT = Path(__file__).resolve().parents[1]
STUDIES = sorted((ROOT / "studies").glob("*/*.toml"))


def shrunken(tables: dict) -> dict:
    """The tables of a study file cut down: ranges to 4 points, lists to first, middle and last, samples to 3 cases.

    Ranges of a real system have 2 points: its inputs have spreads, so each case is solved up to thirteen times.
    """
    axes, most = {}, 2 if "R" in tables.get("model", {}) else 4
    for name, values in tables.get("axes", {}).items():
        if isinstance(values, dict):
            axes[name] = values | {"num": min(values["num"], most)}
        else:
            axes[name] = values if len(values) <= 3 else [values[0], values[len(values) // 2], values[-1]]
    sample = {"sample": tables["sample"] | {"size": min(tables["sample"]["size"], 3)}} if "sample" in tables else {}
    return tables | ({"axes": axes} if axes else {}) | sample


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Files that look at the shrunken results come first. So the first of several processes of pytest has them all: it
    computes the results while others have other things to do, and no other draws the same figures again.

    What tests/verify.txt names is left out, unless pytest was asked for it or for --verify."""
    asking = {item.path for item in items if "results" in getattr(item, "fixturenames", ())}
    items.sort(key=lambda item: item.path not in asking)
    if not config.getoption("verify"):
        named = tuple(argument for argument in config.args if "::" in argument)
        out = {item for item in items if left_out(item.nodeid) and not item.nodeid.startswith(named)}
        config.hook.pytest_deselected(items=list(out))
        items[:] = [item for item in items if item not in out]


@pytest.fixture
def forgetful() -> Iterator[None]:
    """What the test registers is forgotten after it."""
    before = known.default()
    yield
    known._default.known = before


@pytest.fixture
def numpy_path(monkeypatch) -> None:
    """The solver without its compiled core, for tests that look into the numpy path."""
    monkeypatch.setenv(VARIABLE, "numpy")


@pytest.fixture(scope="module", params=["core", "numpy"])
def each_path(request) -> Iterator[str]:
    """The path of the solver: each test that asks is run on both."""
    if request.param == "core" and not available():
        pytest.skip("no compiled core was built here")
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv(VARIABLE, "numpy" if request.param == "numpy" else "")
        yield request.param


@pytest.fixture(scope="session")
def results(tmp_path_factory) -> Path:
    """Folder with the results of every study, shrunken, and of the measurement of work and precision; nobody changes
    them. The first process of pytest that asks computes them for all."""
    alone = "PYTEST_XDIST_WORKER" not in os.environ
    folder = (tmp_path_factory.getbasetemp() if alone else tmp_path_factory.getbasetemp().parent) / "project/results"
    with lock_file(folder.with_name("lock")):
        if not folder.exists():
            unfinished = folder.with_name("unfinished")
            if "ROUGHCOAT_RESULTS" in os.environ:  # of tools/mutants/mutate.py: this mutant does not change them
                shutil.copytree(os.environ["ROUGHCOAT_RESULTS"], unfinished)
            else:
                compute_results(unfinished)
            unfinished.rename(folder)
    return folder


def compute_results(folder: Path) -> None:
    """Write what the fixture `results` promises."""
    from study.figures.figure_results import described
    from study.figures.registry import entry
    from study.files.examine import examine
    from study.files.results_file import write
    from study.inputs.reading import from_tables
    from study.scan_laws.words import with_rows
    from study.studies.evidence.tradeoff import WAYS, measure
    from study.work.run import run

    for toml in STUDIES:
        text = toml.read_text(encoding="utf-8")
        definition = from_tables(shrunken(tomllib.loads(text)), toml.stem, text, toml.name)
        run(with_rows(definition), folder)
    most = {"intervals": 2}  # the paper's way is slow
    ways = {name: replace(way, settings=way.settings[:1], most=most.get(way.varied, 5)) for name, way in WAYS.items()}
    measured = entry("measured", "tradeoff")
    path = folder / "tradeoff.nc"
    write(described(measure(10, 0, ways), "tradeoff", measured, ""), path, examine(path))


@pytest.fixture(scope="session")
def drawing(results) -> Callable:
    """A figure by its name, from the shrunken results: what `study.catalogue.compose` gives; composed once."""
    from study.catalogue import compose

    @cache
    def composed(name: str) -> tuple:
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr("study.figures.registry.opened", opened)
            return compose(name, results)

    return composed


@pytest.fixture(scope="session")
def tables(results, tmp_path_factory) -> Path:
    """Folder with every table of the shrunken results, as .txt, .csv and .tex."""
    from study.catalogue import names, tabulate

    folder = tmp_path_factory.mktemp("tables")
    for name in names("table"):
        assert tabulate(name, results, folder) == [folder / f"{name}.{suffix}" for suffix in ("txt", "csv", "tex")]
    return folder


def opened(path: Path) -> xr.Dataset:
    """A file of the fixture `results`, which is read, and verified, once: a copy, which a test may change."""
    return _opened(path).copy(deep=True)


_opened = cache(open_results)

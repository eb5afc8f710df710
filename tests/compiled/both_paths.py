"""Random contacts of every kind that the compiled core takes, and their solutions by it and by numpy."""

import os
import shutil
import subprocess
import sys
import sysconfig
from ctypes import CDLL
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from solver import Problem, Solution, solve
from solver.compiled import library
from solver.compiled.library import VARIABLE

ROOT = Path(__file__).resolve().parents[2]
#: What the core computes of a case; all are numbers.
SCALARS = ("a", "P", "D", "p0", "p_max", "Ar_An", "A0", "dP_dD")
X = np.array([0.0, 0.3, 0.95, 1.0])


def contacts(size: int, seed: int, **change) -> Problem:
    """Layers of n from 1e-3 to 1e3, both interfaces, h/a from a film to a half-space, some of them on rigid bases or
    under elastic punches; all three laws and bases, three tolerances. Given by their load."""
    random = np.random.default_rng(seed)

    def between(low, high):
        return np.exp(random.uniform(np.log(low), np.log(high), size))

    Ra = between(5e-4, 1e-2)
    case = {
        "P": between(1e-7, 1e-3),
        "h": between(1e-4, 3.0),
        "n": np.where(random.random(size) < 0.05, 0.0, between(1e-3, 1e3)),
        "m": np.where(random.random(size) < 0.2, between(0.01, 3.0), 0.0),
        "nu1": random.uniform(-0.3, 0.5, size),
        "nu2": random.uniform(-0.3, 0.5, size),
        "bonding": random.choice(["frictionless", "bonded"], size),
        "Ra": Ra,
        "Nbar": between(0.1, 10) / Ra**2,
        "B": between(0.05, 1.0),
        "beta": random.uniform(0.1, 1.0, size),
        "micro": random.choice(["disc_cell", "power_law", "smooth"], size),
        "base": random.choice(["half_space", "thin_layer", "layered", "layered"], size),
        "rtol": random.choice([1e-3, 1e-6, 1e-8], size),
    }
    return Problem.of(**case | change)


def by(path: str, problem: Problem, x=X) -> Solution:
    """The solution by "numpy" or by a variant of the core; "": by the one that is taken by itself."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv(VARIABLE, path)
        return solve(problem, x)


def compiler() -> bool:
    """Whether there is a C compiler that setuptools would take."""
    command = os.environ.get("CC") or sysconfig.get_config_var("CC") or "cc"
    program = shutil.which(command.split()[0])
    return bool(program) and subprocess.run([program, "--version"], capture_output=True).returncode == 0


def built(folder: Path, **environment: str) -> list[str]:
    """Names of the files that `setup.py build_ext` leaves; it does not fail."""
    folders = "--build-lib", folder / "lib", "--build-temp", folder
    command = [sys.executable, "setup.py", "--quiet", "build_ext", *folders]
    environment = os.environ | environment
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return [path.name for path in (folder / "lib").rglob("*") if path.is_file()]


@cache
def fresh_core(folder: Path) -> CDLL:
    """The core of the sources as they are now. Built once for each process of pytest, in some seconds."""
    (name,) = built(folder)
    (path,) = Path(folder, "lib").rglob(name)
    return CDLL(str(path))


@pytest.fixture(scope="session", autouse=True)
def of_the_sources(tmp_path_factory):
    """The core of these tests is that of the sources as they are now, if there is a compiler: also of a mutant's."""
    if not compiler():
        yield
        return
    fresh = fresh_core(tmp_path_factory.getbasetemp() / "core")
    with pytest.MonkeyPatch.context() as patched:
        library._variant.cache_clear()
        patched.setattr(library, "_library", lambda: fresh)
        yield
    library._variant.cache_clear()

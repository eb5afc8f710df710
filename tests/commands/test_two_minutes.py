"""The commands of docs/two_minutes.md print what stands there: of a fresh wheel, in an empty folder."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pages
import pytest
from conftest import ROOT

pytest.importorskip("pint")
TEXT = pages.read("docs/two_minutes.md")
SHOWN = re.findall(r"^```sh\nroughcoat ([^\n]*)\n```\n\n```text\n(.*?)^```", TEXT, re.M | re.S)
BUILD = "import sys; from setuptools import build_meta; build_meta.build_wheel(sys.argv[1])"
RUN = """
import contextlib, io, json, sys
import study
from study.__main__ import main
answers = []
for arguments in json.loads(sys.argv[1]):
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        code = main(arguments)
    answers.append((code, printed.getvalue()))
print(json.dumps([study.__file__, answers]))
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory) -> Path:
    """The packages as a wheel has them; where setuptools cannot build one, those of the repository."""
    clone, folder = tmp_path_factory.mktemp("clone"), tmp_path_factory.mktemp("installed")
    unwanted = shutil.ignore_patterns("__pycache__")
    for name in ("roughcoat", "solver", "study", "studies", "docs"):
        shutil.copytree(ROOT / name, clone / name, ignore=unwanted)
    for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, clone)
    built = subprocess.run(
        [sys.executable, "-c", BUILD, folder], cwd=clone, capture_output=True, text=True, timeout=300
    )
    wheels = list(folder.glob("*.whl"))
    if built.returncode or not wheels:
        return ROOT
    with zipfile.ZipFile(wheels[0]) as archive:
        archive.extractall(folder)
        assert (
            "roughcoat = roughcoat.__main__:command"
            in archive.read(next(name for name in archive.namelist() if name.endswith("entry_points.txt"))).decode()
        )
    return folder


def test_one_wheel_serves_every_python(installed):
    """The core is loaded by ctypes: neither the wheel nor the file in it has the version of a Python in its name."""
    if installed == ROOT:
        pytest.skip("setuptools built no wheel")
    (wheel,) = installed.glob("*.whl")
    assert re.fullmatch(r"roughcoat-[\d.]+-py3-none-(?!any\b)\w+\.whl", wheel.name)
    of_wheel, in_place = (list((folder / "solver/compiled").glob("_core*")) for folder in (installed, ROOT))
    assert len(of_wheel) == bool(in_place) and all(path.stem == "_core" for path in of_wheel)


def test_three_contacts_in_two_minutes(installed, tmp_path):
    assert len(SHOWN) == 3
    given = json.dumps([shlex.split(command) for command, _ in SHOWN])
    environment = os.environ | {"PYTHONPATH": str(installed)}
    call = [sys.executable, "-P", "-c", RUN, given]
    ran = subprocess.run(call, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300)
    assert ran.returncode == 0, ran.stderr
    file, answers = json.loads(ran.stdout)
    assert Path(file).is_relative_to(installed) and not list(tmp_path.iterdir())
    for (command, text), (code, printed) in zip(SHOWN, answers, strict=True):
        assert code == 0 and pages.same(printed.split(), text.split()), f"{command}\nprints\n{printed}"

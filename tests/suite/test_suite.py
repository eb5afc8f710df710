"""Which tests `make test` runs, and that a room which became too dear makes it fail."""

import re
import subprocess
import sys
import tomllib
from fnmatch import fnmatchcase

import pytest
from budget import ABOVE, LEAST, TABLE, room, too_dear
from conftest import ROOT
from left_out import LIST, left_out, patterns

ROWS = tomllib.loads(TABLE.read_text(encoding="utf-8"))["rooms"]


def test_a_room_is_too_dear_by_half_and_a_slow_machine_is_allowed_for():
    table = {"laws": 20.0}
    most = ABOVE * 20.0 + LEAST
    assert too_dear({"laws": most}, table, 1.0) == []
    (line,) = too_dear({"laws": most + 0.1}, table, 1.0)
    assert line.startswith("BUDGET: the room laws took 33.1 s of processor time") and line.endswith("33.0 s here")
    assert too_dear({"laws": 2 * most}, table, 2.0) == []
    (line,) = too_dear({"new": LEAST + 0.1}, table, 1.0)
    assert "a room that has no row" in line


def test_every_room_has_a_row():
    rooms = {path.parent.relative_to(ROOT / "tests").parts[0] for path in (ROOT / "tests").rglob("test_*.py")}
    assert {*ROWS} == rooms | {"examples"}
    assert (
        room("tests/laws/heights/test_heights.py::test_a[1]") == "laws"
        and room("solver/laws/law.py::law") == "examples"
    )


def test_every_line_of_the_list_is_of_tests_that_are_there():
    functions = {}
    for path in (ROOT / "tests").rglob("test_*.py"):
        defined = re.findall(r"^def (test_\w+)", path.read_text(encoding="utf-8"), re.M)
        functions[path.relative_to(ROOT / "tests").as_posix()] = defined
    for _, pattern in patterns()[1:]:  # the first is of parameters
        file, _, test = pattern.partition("::")
        test = test.partition("[")[0]
        there = [name for at, names in functions.items() if fnmatchcase(at, file) for name in names]
        assert any(fnmatchcase(name, test) or test.startswith("*build") for name in there), f"{LIST.name}: {pattern}"


def test_one_in_four_stays_on_the_second_path():
    names = [f"tests/rough/test_a.py::test_b[numpy-{i}]" for i in range(400)]
    assert 60 < sum(not left_out(name) for name in names) < 140
    assert not any(left_out(name.replace("numpy", "core")) for name in names)


SLOW = """import time


def test_slow():
    end = time.process_time() + {seconds}
    while time.process_time() < end:
        pass
"""


@pytest.mark.parametrize(("seconds", "code"), [(0.01, 0), (0.4, 1)])
def test_a_run_fails_where_a_room_is_too_dear(seconds, code, tmp_path):
    """Not `make test` itself: the same plugin, with a table of one room and a margin of a tenth of a second."""
    (tmp_path / "tests/slow").mkdir(parents=True)
    (tmp_path / "tests/slow/test_slow.py").write_text(SLOW.format(seconds=seconds))
    (tmp_path / "tests/budget.toml").write_text("piece = 10.0\n[rooms]\nslow = 0.1\n")
    (tmp_path / "tests/conftest.py").write_text(
        f"import sys\nfrom pathlib import Path\nsys.path.append({str(ROOT / 'tests/suite')!r})\nimport budget\n"
        f"budget.TABLE, budget.LEAST = Path({str(tmp_path / 'tests/budget.toml')!r}), 0.1\n"
        "from budget import pytest_addoption, pytest_configure\n"
    )
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--budget", "tests"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == code, done.stdout + done.stderr
    assert ("BUDGET: the room slow took 0.4" in done.stdout) == (code == 1)
    assert "the dearest rooms: slow" in done.stdout

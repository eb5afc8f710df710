"""The fresh lists are whole, and their runner tries each mutant with the tests that may notice it."""

import re
import subprocess
import sys
from collections import Counter

import pytest
from conftest import ROOT
from fresh import first, order
from mutants import Mutant, batches, read, table, with_figures

LISTS = batches()
MODULE = "SIDE = 3\n\n\ndef square(x):\n    return x * x\n\n\ndef cube(x):\n    return x**SIDE\n"
TREE = {
    "solver/__init__.py": "",  # a folder without it would be looked for in the installed package
    "solver/one.py": MODULE,
    "study/__init__.py": "",
    "study/two.py": "def unused(x):\n    return x + 1\n",
    "tests/conftest.py": "def compute_results(folder):\n    folder.mkdir()\n",
    "tests/test_one.py": "from solver.one import cube, square\n\n\ndef test_square():\n    assert square(3) == 9\n\n\n"
    "def test_cube():\n    assert cube(3) == 27\n\n\ndef test_that_fails():\n    assert square(3) == 6\n",
    "tests/mutants/fresh/2020-01-01.toml": """
[about]
written = "2020-01-01"
commit = "0123456"
survived = ["study.two.unseen"]
untried = ["solver.one.gone"]
[solver.one.sum]
old = 'x * x'
new = 'x + x'
[solver.one.constant]
old = 'SIDE = 3'
new = 'SIDE = 4'
[solver.one.gone]
old = 'x // x'
new = 'x'
[study.two.unseen]
old = 'x + 1'
new = 'x - 1'
""",
}
RUN = "import sys, fresh; from pathlib import Path; sys.exit(fresh.main(['--jobs', '1'], Path('tree').resolve(), ()))"


def test_the_runner_chooses_the_tests(tmp_path):
    for name, text in TREE.items():
        file = tmp_path / "tree" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    environment = {"PYTHONPATH": str(ROOT / "tools/mutants")}
    command = [sys.executable, "-c", RUN]
    found = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    said = re.findall(r"^\d of \d: (\S+) (.*)$", found.stdout, flags=re.MULTILINE)
    assert dict(said) == {
        "solver.one.sum": "killed by test_one.py::test_square",
        "solver.one.constant": "killed by test_one.py::test_cube",
        "study.two.unseen": "SURVIVED for no test runs its file",
    }, found.stdout + found.stderr
    assert "solver/: 2 of 2\nstudy/: 0 of 1\n" in found.stdout and '    "study.two.unseen"\n' in found.stdout
    (batch,) = batches(tmp_path / "tree")
    assert "| 2020-01-01 | 0123456 | 2 of 2 (100%) | 0 of 1 (0%) |" in table([], tmp_path / "tree", "")


def test_tests_of_the_function_come_first_those_that_start_processes_last():
    """A test counts for what its file runs; one that asks for results, for what the studies run."""
    places = [["solver/one.py", 4], ["solver/one.py", 8], ["solver/two.py", 1]]
    own, process = "tests/test_one.py::", {"processes": True}
    tests = {
        f"{own}slow": {"functions": [1], "seconds": 2.0},
        f"{own}other": {"functions": [0], "seconds": 0.1},
        f"{own}quick": {"functions": [1, 2], "seconds": 1.0},
        f"{own}beside": {"functions": [], "seconds": 0.0},
        f"{own}fails": {"functions": [1], "seconds": 0.0},
        f"{own}starts": {"functions": [1], "seconds": 0.0} | process,
        "tests/test_two.py::away": {"functions": [2], "seconds": 0.0},
        "tests/test_two.py::starts": {"functions": [], "seconds": 0.5} | process,
        "tests/test_three.py::asks": {"functions": [], "seconds": 0.0, "results": True},
    }
    tests = {node: {"processes": False} | test for node, test in tests.items()}
    known = {"functions": places, "tests": tests, "failed": [f"{own}fails"], "computing": []}
    cube = Mutant("solver.one.cube", "solver/one.py", "x**SIDE", "x*SIDE", [])
    starts = [f"{own}starts", "tests/test_two.py::starts"]
    expected = [f"{own}quick", f"{own}slow", f"{own}other", f"{own}beside"]
    assert list(order(cube, MODULE, known)) == [*expected, *starts]
    known["computing"] = ["solver.one"]
    assert list(order(cube, MODULE, known)) == [*expected, "tests/test_three.py::asks", *starts]


def test_the_first_seconds_of_tests():
    """In their order, and one in any case."""
    seconds = {"quick": 1.0, "slow": 4.0, "last": 1.0}
    for most, count in ((0.5, 1), (1.0, 1), (4.9, 1), (5.0, 2), (6.0, 3), (60.0, 3)):
        assert list(first(seconds, most)) == list(seconds)[:count]


@pytest.mark.parametrize("batch", LISTS, ids=[batch.name for batch in LISTS])
def test_a_list_is_one_of_its_own(batch):
    """It repeats no mutant that has been tried before, and what it says that survived is in it."""
    earlier = read() + [one for other in LISTS[: LISTS.index(batch)] for one in other.mutants]
    known = {(mutant.file, mutant.old.strip(), mutant.new.strip()) for mutant in earlier}
    assert not [mutant.id for mutant in batch.mutants if (mutant.file, mutant.old.strip(), mutant.new.strip()) in known]
    names = Counter(mutant.id for mutant in batch.mutants)
    survived, untried = (set(batch.about.get(which, ())) for which in ("survived", "untried"))
    assert max(names.values()) == 1 and survived | untried <= set(names) and not survived & untried
    packages = Counter(name.partition(".")[0] for name in names if name not in untried)
    assert set(packages) == {"solver", "study"} and min(packages.values()) >= 75
    assert {"written", "commit"} <= set(batch.about) <= {"written", "commit", "survived", "untried", "remark"}


def test_figures_are_put_on_the_page_that_is_there(tmp_path):
    """The figures of the lists are written anew; the kept list, which takes hours, stays as it was."""
    lists = tmp_path / "tests/mutants/fresh"
    lists.mkdir(parents=True)
    (lists / "2020-01-01.toml").write_text(TREE["tests/mutants/fresh/2020-01-01.toml"])
    page = table([], tmp_path, "2019-12-31, 80 min:")
    (lists / "2020-02-02.toml").write_text(
        TREE["tests/mutants/fresh/2020-01-01.toml"].replace("2020-01-01", "2020-02-02")
    )
    later = with_figures(page, tmp_path)
    assert later == table([], tmp_path, "2019-12-31, 80 min:") != page and "| 2020-02-02 |" in later
    assert with_figures(later, tmp_path) == later

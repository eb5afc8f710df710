"""The mutants of mutants.toml are there to be run (`make mutants`), and the runner tells what becomes of them."""

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path

from conftest import ROOT
from mutants import Verdict, read, totals

TREE = {
    "solver/__init__.py": "",  # without it the package that is installed is taken
    "solver/one.py": "def square(x):\n    return x * x\n\n\ndef unused(x):\n    return x + 1\n",
    "tests/conftest.py": "def compute_results(folder):\n    import solver.one\n\n    folder.mkdir()\n",
    "tests/test_one.py": "from solver.one import square\n\n\ndef test_square():\n    assert square(3) == 9\n\n\n"
    "def test_that_fails():\n    assert square(3) == 6\n",
    "tests/mutants/mutants.toml": """
[solver.one.sum]
old = 'x * x'
new = 'x + x'
tests = ["test_one.py::test_square"]
[solver.one.unseen]
old = '''unused(x):
    return x + 1'''
new = '''unused(x):
    return x | 1'''
tests = ["test_one.py::test_square"]
[solver.one.proved-by-nothing]
old = 'x * x'
new = '7'
tests = ["test_one.py::test_that_fails"]
""",
}
RUN = """
import sys
import mutate
from pathlib import Path
mutate.PATIENCE = float(sys.argv[1])
sys.exit(mutate.main(["--table", "table.md", *sys.argv[2:]], Path("tree").resolve(), ()))
"""


def run(folder: Path, *arguments: str, patience: float = 60.0) -> tuple[int, dict[str, str]]:
    """Exit code of the runner on a tree of two functions, and what it says of each mutant."""
    for name, text in TREE.items():
        file = folder / "tree" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    (folder / "tree/study").mkdir(exist_ok=True)
    command = [sys.executable, "-c", RUN, str(patience), *arguments]
    environment = {"PYTHONPATH": str(ROOT / "tools/mutants")}
    found = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    said = re.findall(r"^\d of \d: solver\.one\.(\S+) (.*)$", found.stdout, flags=re.MULTILINE)
    assert said, found.stderr
    return found.returncode, dict(said)


def test_killed_survived_and_proved_by_nothing(tmp_path):
    code, said = run(tmp_path)
    assert code == 1
    assert said == {
        "sum": "killed by test_one.py::test_square",
        "unseen": "SURVIVED",
        "proved-by-nothing": "SURVIVED but tests/test_one.py::test_that_fails fails without it",
    }
    text = (tmp_path / "table.md").read_text()
    assert "- solver/: 1 of 3 killed (33.3%)\n" in text
    change = r"`` unused(x): ⏎ return x + 1 `` → `` unused(x): ⏎ return x \| 1 ``"
    assert f"| solver.one.unseen | solver/one.py:6 | {change} | **SURVIVED** |\n" in text
    assert "| solver.one.sum | solver/one.py:2 | `` x * x `` → `` x + x `` | test_one.py::test_square |\n" in text


def test_one_that_takes_too_long(tmp_path):
    alone = "--only", "*.sum", "--jobs", "1"
    assert run(tmp_path, *alone, patience=-1e9) == (0, {"sum": "killed by takes too long"})


def test_enough_mutants_that_are_one_change_of_code_that_compiles():
    mutants = read()
    assert all(killed >= 75 for killed, _ in totals([Verdict(mutant, True) for mutant in mutants]).values())
    wrong = []
    for mutant in mutants:
        text = (ROOT / mutant.file).read_text(encoding="utf-8")
        try:
            changed = mutant.applied(text)
            if not mutant.file.endswith((".js", ".h")):
                tomllib.loads(changed) if mutant.file.endswith(".toml") else ast.parse(changed)
            wrong += [mutant.id] * (changed == text)
        except (ValueError, SyntaxError) as error:
            wrong.append(f"{mutant.id}: {error}")
    assert not wrong, "\n".join(wrong)


def test_the_tests_of_every_mutant_are_there():
    tests = ROOT / "tests"
    files = {path.relative_to(tests).as_posix(): path for path in tests.rglob("test_*.py")}
    texts = {name: path.read_text(encoding="utf-8") for name, path in files.items()}
    missing = []
    for mutant in read():
        for test in mutant.tests:
            file, _, name = test.partition("::")
            there = file in texts and (not name or f"\ndef {name.partition('[')[0]}(" in texts[file])
            missing += [] if there else [f"{mutant.id}: {test}"]
    assert not missing, "\n".join(missing)

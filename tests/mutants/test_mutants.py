"""Mistakes are made at every place that can hold one, the same by the same seed, and each gets a verdict."""

import ast
import json
import re
import subprocess
import sys
from itertools import islice
from pathlib import Path

import by_hand
import pytest
from conftest import ROOT
from mutate import drawn, files_of, table
from operators import Change, changes
from trials import Verdict, first, order

PYTHON = '''"""A text with 3 < 4."""
SIDE = 3


def near(x: int, y=2.5, *, far=False):
    """Whether 1 < 2."""
    if x < y and not far:
        return x * x - y, f"{x:.3f}"
    return max(x, y, key=abs)
'''
#: Kind -> what stands there and what it becomes.
MADE = {
    "arithmetic": {"* -> /", "* -> +", "- -> +"},
    "argument": {"x, y -> y, x", ", key=abs -> "},
    "branch": {"x < y and not far -> True", "x < y and not far -> False"},
    "comparison": {"< -> <=", "< -> >"},
    "logic": {"and -> or"},
    "name": {"max -> min"},
    "number": {"3 -> 4", "3 -> 2", "2.5 -> 5.0", "2.5 -> 1.25"},
    "return": {'x * x - y, f"{x:.3f}" -> f"{x:.3f}", x * x - y', "max(x, y, key=abs) -> None"},
    "sign": {"not -> "},
    "truth": {"False -> True"},
}
C = """#include <math.h>
/* a < b */
static double f(const double *x) { return x[0] < -1.5 && x[1] > 2 ? fmin(x[0], 3e1) : x[1] / 2.; }
"""
MADE_IN_C = {
    "number": {"0 -> 1", "1.5 -> 3.0", "1.5 -> 0.75", "1 -> 2", "1 -> 0", "2 -> 3", "2 -> 1", "3e1 -> 60.0",
               "3e1 -> 15.0", "2. -> 4.0", "2. -> 1.0"},
    "comparison": {"< -> <=", "< -> >", "> -> >=", "> -> <"},
    "logic": {"&& -> ||"},
    "sign": {"- -> "},
    "branch": {"? -> && false ?"},
    "name": {"fmin -> fmax"},
    "arithmetic": {"/ -> *"},
}  # fmt: skip


def by_kind(file: str, text: str) -> dict[str, set[str]]:
    kinds, source = {}, text.encode()
    for change in changes(file, text):
        kinds.setdefault(change.kind, set()).add(f"{source[change.start : change.stop].decode()} -> {change.new}")
    return kinds


def test_every_kind_of_mistake():
    assert by_kind("one.py", PYTHON) == MADE
    assert by_kind("one.c", C) == MADE_IN_C


def test_texts_annotations_and_formats_are_left_alone():
    for text in (
        '"""1 < 2"""\n',
        "x: tuple[int, 3]\n",
        "def f(x: list[3]) -> list[4]: ...\n",
        "raise ValueError(f'{1}')\n",
    ):
        assert by_kind("one.py", text) == {}


@pytest.mark.parametrize("name", ["solver/laws/heights.py", "study/in_words/numbers.py", "study/figures/plots.py"])
def test_all_mistakes_in_python_are_one_change_that_compiles(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    made = changes(name, text)
    assert len(made) > 50
    for change in made[::9]:
        ast.parse(change.applied(text))
        assert f"[{text.encode()[change.start : change.stop].decode()[:1]}" in change.shown(text)


def test_a_seed_gives_the_same_mistakes_of_every_kind():
    files = [name for name in files_of(ROOT, None) if name.startswith(("solver/laws", "study/explorer"))]
    once, again, other = (list(islice(drawn(ROOT, files, seed), 60)) for seed in (1, 1, 2))
    assert once == again and len(set(once)) == 60
    assert len(set(once) & set(other)) < 30
    assert len({change.kind for change in once}) >= 9
    assert {Path(change.file).suffix for change in once} == {".py", ".js"}


def test_only_tests_that_may_notice_are_tried_the_likeliest_first():
    text = "SIDE = 3\n\n\ndef square(x):\n    return x * x\n\n\ndef cube(x):\n    return x**SIDE\n"
    known = {
        "functions": [["one.py", 4], ["one.py", 8], ["two.py", 1]],
        "tests": {
            "tests/a.py::cube": {"functions": [1], "processes": False, "seconds": 1.0},
            "tests/a.py::square": {"functions": [0], "processes": False, "seconds": 2.0},
            "tests/b.py::other": {"functions": [2], "processes": False, "seconds": 0.1},
            "tests/b.py::child": {"functions": [], "processes": True, "seconds": 0.2},
            "tests/a.py::fails": {"functions": [0], "processes": False, "seconds": 0.1},
            "tests/explorer/page.py::drawn": {"functions": [], "processes": False, "seconds": 0.3},
            "tests/explorer/page.py::fails": {"functions": [], "processes": False, "seconds": 0.2},
        },
        "failed": ["tests/a.py::fails", "tests/explorer/page.py::fails"],
        "computing": [],
    }  # fmt: skip
    assert list(order("one.py", 5, text, known)) == ["tests/a.py::square", "tests/a.py::cube", "tests/b.py::child"]
    assert list(order("one.py", 1, text, known)) == ["tests/a.py::cube", "tests/a.py::square", "tests/b.py::child"]
    assert list(order("core.h", 1, "", known)) == []
    assert list(order("page.js", 1, "", known)) == ["tests/explorer/page.py::drawn"]
    assert first({"a": 1.0, "b": 2.0, "c": 3.0}, 3.5) == {"a": 1.0, "b": 2.0} and first({"a": 9.0}, 1.0) == {"a": 9.0}


def test_the_table_has_each_part_and_the_rooms_with_survivors():
    def verdict(file, killed):
        return Verdict(Change(file, 0, 1, "", "sign"), killed)

    verdicts = [verdict("solver/laws/a.py", True), verdict("study/explorer/a.js", False), verdict("study/b.py", True)]
    assert table(verdicts) == ["explorer: 0 of 1 noticed", "solver: 1 of 1 noticed", "study: 1 of 1 noticed",
                               "not noticed: study/explorer 1 of 1"]  # fmt: skip


def test_the_list_by_hand_is_short_and_of_what_the_program_cannot_make():
    names = [name for name, *_ in by_hand.read()]
    assert 50 <= len(names) <= by_hand.MOST and len(set(names)) == len(names)
    makeable = []
    for name, change in zip(names, by_hand.changes(), strict=True):
        text = (ROOT / change.file).read_text(encoding="utf-8")
        if change.file.endswith(".py"):
            ast.parse(change.applied(text))
        if Path(change.file).suffix in (".py", ".js", ".c", ".h"):
            same = {one.applied(text) for one in changes(change.file, text)}
            makeable += [name] if change.applied(text) in same else []
    assert makeable == []


TREE = {
    "solver/__init__.py": "",  # without it the package that is installed is taken
    "solver/one.py": "def square(x):\n    return x * x\n",
    "study/__init__.py": "",
    "study/two.py": "def unused(x):\n    return -x\n",
    "studies/note.txt": "",
    "tests/conftest.py": "def compute_results(folder):\n    import solver.one\n\n    folder.mkdir()\n",
    "tests/one/test_one.py": "from solver.one import square\n\n\ndef test_square():\n    assert square(3) == 9\n\n\n"
    "def test_that_fails():\n    assert square(3) == 6\n",
}
RUN = (
    "import sys, mutate; from pathlib import Path; sys.exit(mutate.main(['--number', '9'], Path('tree').resolve(), ()))"
)


def test_the_runner_tries_each_and_says_what_became_of_it(tmp_path):
    for name, text in TREE.items():
        file = tmp_path / "tree" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    environment = {"PYTHONPATH": str(ROOT / "tools/mutants")}
    done = subprocess.run([sys.executable, "-c", RUN], cwd=tmp_path, env=environment, capture_output=True, text=True)
    said = dict(re.findall(r"^\d of 5: (\S+:\d) \w+: (.*)$", done.stdout, flags=re.MULTILINE))
    assert "solver: 3 of 3 noticed\nstudy: 0 of 2 noticed\nnot noticed: study 2 of 2\n" in done.stdout, done.stderr
    lines = [line for line in done.stdout.splitlines() if " of 5: " in line]
    assert sum(line.endswith("killed by tests/one/test_one.py::test_square") for line in lines) == 3, said
    assert sum(line.endswith("SURVIVED for no test runs its file") for line in lines) == 2
    assert json.dumps(["tests/one/test_one.py::test_that_fails"])[2:-2] in done.stdout and done.returncode == 1

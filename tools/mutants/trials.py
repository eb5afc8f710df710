"""The tests that may notice a mistake, and whether they do: in a copy of the tree, in a process forked from this one.

This process has imported the libraries, but nothing of the project. A mistake is noticed if a test fails, or takes far
longer than without the mistake.
"""

import ast
import itertools
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
from collections import defaultdict
from collections.abc import Iterator
from cProfile import Profile
from dataclasses import dataclass
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

from copies import NIGHT, Task, answers
from operators import Change

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests/suite"))
from left_out import left_out  # noqa: E402

LIBRARIES = (
    "numpy", "scipy.special", "scipy.optimize", "scipy.interpolate", "scipy.sparse", "scipy.integrate", "dask.array",
    "xarray", "netCDF4", "matplotlib.pyplot", "matplotlib.backends.backend_pdf", "mpmath", "hypothesis", "pytest",
)  # fmt: skip
PATIENCE, SLOWER = 60.0, 10.0  # a test may take so many seconds more than so many times its usual duration
#: Audit events of a process that starts. Its code is not traced: such a test may run any file.
BEGIN = {"subprocess.Popen", "os.fork", "os.forkpty", "os.posix_spawn", "socket.connect"}
#: Tests of code that no trace of Python sees: the page of the explorer, and the compiled core.
UNSEEN = {".js": ["tests/explorer"], ".h": ["tests/compiled", "tests/rough"], ".c": ["tests/compiled"]}
CORE = "solver/compiled/_core" + EXTENSION_SUFFIXES[-1]


@dataclass(frozen=True)
class Verdict:
    """The verdict on a mistake. by : the first test that failed, or the reason why none did"""

    change: Change
    killed: bool
    by: str = ""

    def __str__(self):
        return f"killed by {self.by}" if self.killed else f"SURVIVED {self.by}".strip()


class Watch:
    """Plugin of pytest: the tests that fail, and the seconds of each."""

    def __init__(self):
        self.failed, self.seconds = [], defaultdict(float)

    def pytest_runtest_logreport(self, report):
        self.seconds[report.nodeid] += report.duration
        self.failed += [report.nodeid] if report.failed else []

    def pytest_collectreport(self, report):
        self.failed += [report.nodeid] if report.failed else []


class Trace:
    """Plugin of pytest: the functions of the project that each test runs, as indices of `functions` (file, first line);
    whether it starts processes, and whether it uses the results of the studies."""

    def __init__(self, folder: Path):
        self.inside, self.functions, self.tests = f"{folder}/", {}, {}
        self._profilers, self._processes = [], False
        sys.addaudithook(self._audit)

    def pytest_runtest_protocol(self, item, nextitem):
        self._profilers, self._processes = [], False
        threading.setprofile(self._profile)
        self._profile()

    def pytest_runtest_logfinish(self, nodeid, location):
        threading.setprofile(None)
        sys.setprofile(None)
        codes = {entry.code for profiler in self._profilers for entry in profiler.getstats()}
        places = [(code.co_filename, code.co_firstlineno) for code in codes if not isinstance(code, str)]
        places = [(file.removeprefix(self.inside), line) for file, line in places if file.startswith(self.inside)]
        places = [place for place in places if not place[0].startswith(("tests/", "tools/"))]
        numbers = [self.functions.setdefault(place, len(self.functions)) for place in places]
        self.tests[nodeid] = self.tests.get(nodeid, {}) | {"functions": numbers, "processes": self._processes}

    def pytest_collection_modifyitems(self, items):
        asking = {item.nodeid for item in items if "results" in getattr(item, "fixturenames", ())}
        self.tests |= {node: {"results": True} for node in asking}

    def _profile(self, *_):
        """Profile the calling thread from now on, with a profiler in C: it costs a fifth of the time, but a trace in
        Python several times as much."""
        profiler = Profile(subcalls=False, builtins=False)
        self._profilers.append(profiler)
        profiler.enable()

    def _audit(self, event, arguments):
        self._processes |= event in BEGIN


class Chosen:
    """Plugin of pytest: runs some tests in this order, and ends the process if one takes far longer than usual."""

    def __init__(self, seconds: dict[str, float]):
        self.seconds, self.place = seconds, {node: place for place, node in enumerate(seconds)}

    def pytest_collection_finish(self, session):  # after conftest.py, which sorts them in another order
        chosen = [item for item in session.items if item.nodeid in self.place]
        session.items[:] = sorted(chosen, key=lambda item: self.place[item.nodeid])

    def pytest_runtest_logstart(self, nodeid, location):
        signal.signal(signal.SIGALRM, lambda *_: os._exit(1))
        signal.alarm(int(PATIENCE + SLOWER * self.seconds[nodeid]))

    def pytest_runtest_logfinish(self, nodeid, location):
        signal.alarm(0)


def tested(folder: Path, tests: list[str], results: Path | None, *options: str, plugins=()) -> dict:
    """Run tests: exit code, failed tests, seconds of each. results: of the studies, if the mistake cannot change
    them."""
    import hypothesis
    import pytest

    hypothesis.settings.register_profile("mutants", derandomize=True, database=None)
    hypothesis.settings.load_profile("mutants")
    os.environ |= {"ROUGHCOAT_RESULTS": str(results)} if results else {}
    watch = Watch()
    always = [*["--verify"] * (folder / "tests/verify.txt").exists(), "-q", "-p", "no:cacheprovider"]
    always += [f"--rootdir={folder}", f"--basetemp={folder.with_suffix('.tmp')}"]
    always += ["-W", "ignore::pytest.PytestAssertRewriteWarning"]  # hypothesis is imported already
    code = pytest.main([*always, *options, *tests], plugins=[watch, *plugins])
    return {"code": int(code), "failed": watch.failed, "seconds": watch.seconds}


def results_in(folder: Path) -> list[str]:
    """Compute the studies of the tests into a folder; returns the files that this runs: a mistake there changes
    results."""
    from conftest import compute_results

    compute_results(folder)
    files = [getattr(module, "__file__", None) or "" for name, module in sys.modules.items()]
    root = str(folder.parent / "tree0") + "/"
    return [file.removeprefix(root) for file in files if file.startswith(root)]


def mapped(folders: list[Path], results: Path) -> dict:
    """The functions that each test runs on the unchanged code, with a process for every room of the tests."""
    rooms = sorted(path.name for path in (folders[0] / "tests").iterdir() if [*path.rglob("test_*.py")])
    tops = ["solver", "study", *(f"tests/{room}" for room in rooms)]

    def action(folder, top):
        trace = Trace(folder)
        outcome = tested(folder, [top], results, plugins=[trace])
        seen = {node: test | {"seconds": outcome["seconds"][node]} for node, test in trace.tests.items()}
        seen = {node: test for node, test in seen.items() if "functions" in test}
        return {"functions": list(trace.functions), "tests": seen, "failed": outcome["failed"]}

    functions, tests, failed = {}, {}, []
    for task, outcome in answers([Task(top, lambda folder, top=top: action(folder, top)) for top in tops], folders):
        if isinstance(outcome, str):
            raise RuntimeError(f"the tests in {task.key} cannot be run: {outcome}")
        numbers = [functions.setdefault(tuple(place), len(functions)) for place in outcome["functions"]]
        for node, test in outcome["tests"].items():
            tests[node] = test | {"functions": [numbers[place] for place in test["functions"]]}
        failed += outcome["failed"]
    return {"functions": list(functions), "tests": tests, "failed": failed}


def order(file: str, line: int, text: str, runs: dict) -> dict[str, float]:
    """Tests that may notice a change at a line -> their seconds, in the order in which they are tried.

    A test counts for all that any test of its file runs: they share fixtures and caches. For the same reason a test
    that uses the results of the studies counts for all that any such test runs, and for all that the studies run. The
    tests of `make verify` alone come last: if only they notice a mistake, the name of the test tells it.
    """
    if Path(file).suffix != ".py":
        tops = tuple(f"{top}/" for top in UNSEEN.get(Path(file).suffix, []))
        passing = {node: test["seconds"] for node, test in runs["tests"].items() if node not in runs["failed"]}
        within = {node: seconds for node, seconds in passing.items() if node.startswith(tops)}
        return dict(sorted(within.items(), key=lambda item: (left_out(item[0]), item[1])))
    lines = _function(text, line)
    of_file = {i for i, (at, _) in enumerate(runs["functions"]) if at == file}
    of_function = {i for i in of_file if lines and runs["functions"][i][1] in lines}
    functions = {node: of_file & {*test["functions"]} for node, test in runs["tests"].items()}
    homes = {node.partition("::")[0] for node, here in functions.items() if here}
    asking = {node for node, test in runs["tests"].items() if test.get("results")}
    shared = any(functions[node] for node in asking) or file in runs["computing"]
    chosen = []
    for node, test in runs["tests"].items():
        if node not in runs["failed"] and (
            node.partition("::")[0] in homes or test["processes"] or (shared and node in asking)
        ):
            last = 4 * left_out(node) + 2 * test["processes"] + (node in asking)
            chosen.append((last, not of_function & functions[node], not functions[node], test["seconds"], node))
    return {node: seconds for *_, seconds, node in sorted(chosen)}


def _function(text: str, line: int) -> range | None:
    """Lines of the innermost function around a line; None at the level of the module."""
    inner = None
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            first = min([node.lineno, *(decorator.lineno for decorator in getattr(node, "decorator_list", []))])
            if first <= line <= node.end_lineno and (inner is None or first >= inner.start):
                inner = range(first, node.end_lineno + 1)
    return inner


def first(seconds: dict[str, float], most: float) -> dict[str, float]:
    """The first of some tests, as many as take at most so long together, and at least one."""
    count = sum(spent <= most for spent in itertools.accumulate(seconds.values()))
    return dict(itertools.islice(seconds.items(), max(1, count)))


def runs_of(folders: list[Path], file: Path | None) -> dict:
    """The functions that each test runs, the files that the studies run, and the folder of their results; from the file
    `file`, if it exists."""
    results = folders[0].with_name("kept-results")
    ((_, computing),) = answers([Task("results", lambda _: results_in(results))], folders[:1])
    if isinstance(computing, str):
        raise RuntimeError(f"the studies of the tests cannot be computed: {computing}")
    runs = json.loads(file.read_text()) if file and file.exists() else mapped(folders, results)
    if file:
        file.write_text(json.dumps(runs))
    return runs | {"computing": computing, "results": results}


def compiled(change: Change, root: Path, folder: Path) -> dict[str, bytes] | None:
    """The files that a mistake changes, with the core that is built from them; None if it does not compile."""
    text = (root / change.file).read_text(encoding="utf-8")
    new = change.applied(text)
    match Path(change.file).suffix:
        case ".py":
            try:
                ast.parse(new)
            except SyntaxError:
                return None
            return {change.file: new.encode()}
        case ".js":
            command = ["node", "--check", "-"]
            if shutil.which("node") and subprocess.run(command, input=new.encode(), capture_output=True).returncode:
                return None
            return {change.file: new.encode()}
    shutil.copytree(root / "solver/compiled", folder, dirs_exist_ok=True)
    (folder / Path(change.file).name).write_text(new, encoding="utf-8")
    sources = [folder / f"{name}.c" for name in ("sse2", "avx2", "avx512")]
    options = ["-std=gnu11", "-O2", "-fno-math-errno", "-ffp-contract=fast", "-Wno-psabi", "-shared", "-fPIC"]
    built = folder / "built.so"
    done = subprocess.run(["cc", *options, *sources, "-o", built], capture_output=True)
    return None if done.returncode else {change.file: new.encode(), CORE: built.read_bytes()}


def judged(changes: dict[Change, dict[str, bytes]], folders: list[Path], runs: dict, most: float) -> Iterator[Verdict]:
    """Verdicts as they come. changes : mistake -> the files that it changes; most : seconds of tests for each"""
    tasks = []
    for change, files in changes.items():
        text = (folders[0] / change.file).read_text(encoding="utf-8")
        seconds = first(order(change.file, change.line(text), text, runs), most)
        if not seconds:
            yield Verdict(change, False, "for no test runs its file")
            continue
        tests = list(dict.fromkeys(node.partition("::")[0] for node in seconds))
        there = None if change.file in runs["computing"] else runs["results"]

        def action(folder, seconds=seconds, tests=tests, there=there):
            return tested(folder, tests, there, "-x", plugins=[Chosen(seconds)])

        tasks.append(Task(change, action, NIGHT, files))
    for task, outcome in answers(tasks, folders):
        yield judge(task.key, outcome)


def judge(change: Change, outcome) -> Verdict:
    """The verdict from the result of the tests: a dict of :func:`tested`, or a text without one."""
    if isinstance(outcome, str):
        return Verdict(change, True, outcome.strip().splitlines()[-1])
    by = (outcome["failed"] or [f"pytest, which ends with {outcome['code']}"])[0]
    return (
        Verdict(change, True, f"{by} of make verify" * left_out(by) or by)
        if outcome["code"]
        else Verdict(change, False)
    )

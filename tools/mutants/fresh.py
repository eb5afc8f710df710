"""Would the tests notice what nobody wrote a test for? `make fresh_mutants`; the lists are in tests/mutants/fresh/.

A list is written before its author looks at the tests, and is never mended, so its figure is honest: docs/mutants.md
has it. The mutants of mutants.toml name their tests; a fresh one is tried with every test that runs its file, those
that run its function first, the quickest first. Last come the tests of results, and those that start processes.

`--map FILE` keeps which functions each test runs, which takes as long as all tests in one process, for another list.
`--seconds S` tries each mutant with the first tests that take so long together; what they let live counts as survived.
"""

import argparse
import ast
import itertools
import json
import os
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from fnmatch import fnmatch
from importlib import import_module
from pathlib import Path

from copies import NIGHT, Task, answers, copy
from mutants import FRESH, ROOT, Batch, Mutant, Verdict, batches, totals, with_figures
from mutate import LIBRARIES, PATIENCE, SLOWER, judge, results_in, tested

#: Audit events of a process that begins. What it runs is not seen: such a test may run any file.
BEGIN = {"subprocess.Popen", "os.fork", "os.forkpty", "os.posix_spawn", "socket.connect"}


class Trace:
    """Plugin of pytest: of each test its seconds, whether it starts processes or asks for the results of the studies,
    and the functions of the project that it runs, as places in `functions`: (file, first line)."""

    def __init__(self, folder: Path):
        self.inside, self.functions, self.tests = f"{folder}/", {}, {}
        self._codes, self._processes = {}, False
        sys.addaudithook(self._audit)

    def pytest_runtest_protocol(self, item, nextitem):
        self._codes, self._processes = {}, False
        threading.settrace(self._call)
        sys.settrace(self._call)

    def pytest_runtest_logfinish(self, nodeid, location):
        sys.settrace(None)
        threading.settrace(None)
        files = [(code.co_filename, code.co_firstlineno) for code in list(self._codes.values())]
        own = [(file.removeprefix(self.inside), line) for file, line in files if file.startswith(self.inside)]
        own = [place for place in own if not place[0].startswith(("tests/", "tools/"))]
        places = [self.functions.setdefault(place, len(self.functions)) for place in own]
        self.tests[nodeid] = self.tests.get(nodeid, {}) | {"functions": places, "processes": self._processes}

    def pytest_collection_modifyitems(self, items):
        asking = {item.nodeid for item in items if "results" in getattr(item, "fixturenames", ())}
        self.tests |= {node: {"results": True} for node in asking}

    def _call(self, frame, event, argument):
        self._codes[id(frame.f_code)] = frame.f_code  # its own hash takes long

    def _audit(self, event, arguments):
        self._processes |= event in BEGIN


class Chosen:
    """Plugin of pytest: runs some tests in this order, and ends the process at one that takes far longer than usual."""

    def __init__(self, seconds: dict[str, float]):
        self.seconds, self.place = seconds, {node: place for place, node in enumerate(seconds)}

    def pytest_collection_finish(self, session):  # conftest.py has sorted them in its own way before
        here = [item for item in session.items if item.nodeid in self.place]
        session.items[:] = sorted(here, key=lambda item: self.place[item.nodeid])

    def pytest_runtest_logstart(self, nodeid, location):
        signal.signal(signal.SIGALRM, lambda *_: os._exit(1))
        signal.alarm(int(PATIENCE + SLOWER * self.seconds[nodeid]))

    def pytest_runtest_logfinish(self, nodeid, location):
        signal.alarm(0)


def _tested(folder: Path, paths: list[str], results: Path | None, *options: str, plugins: list) -> dict:
    """`tested`, with the paths of the tests from the root: modules of the project have examples that are tests too."""
    return tested(folder, [f"../{path}" for path in paths], results, *options, plugins=plugins)


def mapped(folder: Path, results: Path, computing: list[str]) -> dict:
    """Which functions each test runs: all tests in this process, on the code as it is."""
    trace = Trace(folder)
    found = _tested(folder, ["tests", "solver", "study"], results, plugins=[trace])
    tests = {node: own | {"seconds": found["seconds"][node]} for node, own in trace.tests.items() if "functions" in own}
    return {"functions": list(trace.functions), "tests": tests, "failed": found["failed"], "computing": computing}


def order(mutant: Mutant, text: str, known: dict) -> dict[str, float]:
    """Tests that may notice a mutant -> their seconds, in the order in which they are tried.

    A test counts for what any test of its file runs: they share fixtures and what is cached. For the same reason a test
    that asks for the results of the studies counts for what any of these runs, and what the studies run.
    """
    lines = _function(text, mutant.line(text))
    of_file = {i for i, (file, _) in enumerate(known["functions"]) if file == mutant.file}
    own = {i for i in of_file if lines and known["functions"][i][1] in lines}
    runs = {node: of_file & {*test["functions"]} for node, test in known["tests"].items()}
    homes = {node.partition("::")[0] for node, here in runs.items() if here}
    asking = {node for node, test in known["tests"].items() if test.get("results")}
    shared = any(runs[node] for node in asking) or mutant.id.rpartition(".")[0] in known["computing"]
    found = []
    for node, test in known["tests"].items():
        if node not in known["failed"] and (
            node.partition("::")[0] in homes or test["processes"] or (shared and node in asking)
        ):
            last = 2 * test["processes"] + (node in asking)
            found.append((last, not own & runs[node], not runs[node], test["seconds"], node))
    return {node: seconds for *_, seconds, node in sorted(found)}


def _function(text: str, line: int) -> range | None:
    """Lines of the innermost function around a line; None at the level of the module."""
    found = None
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            first = min([node.lineno, *(one.lineno for one in getattr(node, "decorator_list", []))])
            if first <= line <= node.end_lineno and (found is None or first >= found.start):
                found = range(first, node.end_lineno + 1)
    return found


def first(seconds: dict[str, float], most: float) -> dict[str, float]:
    """The first of some tests, as many as take at most so long together, and at least one."""
    count = sum(spent <= most for spent in itertools.accumulate(seconds.values()))
    return dict(itertools.islice(seconds.items(), max(1, count)))


def judged(mutants: list[Mutant], folders: list[Path], kept: Path | None, most: float) -> Iterator[Verdict]:
    """Verdicts as they come. kept : the file of the map; most : seconds of tests of each mutant"""
    results = folders[0].with_name("kept-results")
    ((_, computing),) = answers([Task("results", lambda _: results_in(results))], folders)
    if isinstance(computing, str):
        raise RuntimeError(f"the studies of the tests cannot be computed: {computing}")
    known = json.loads(kept.read_text()) if kept and kept.exists() else None
    if known is None:
        ((_, known),) = answers([Task("map", lambda folder: mapped(folder, results, computing))], folders)
        if isinstance(known, str):
            raise RuntimeError(f"the tests cannot be run: {known}")
        if kept:
            kept.write_text(json.dumps(known))
    print(f"{len(known['tests'])} tests, of the code as it is failed: {known['failed']}", flush=True)
    tasks = []
    for mutant in mutants:
        text = (folders[0] / mutant.file).read_text(encoding="utf-8")
        seconds = first(order(mutant, text, known), most)
        if not seconds:
            yield Verdict(mutant, False, "for no test runs its file")
            continue
        files = list(dict.fromkeys(node.partition("::")[0] for node in seconds))
        there = None if mutant.id.rpartition(".")[0] in computing else results

        def action(folder, seconds=seconds, files=files, there=there):
            return _tested(folder, files, there, "-x", plugins=[Chosen(seconds)])

        tasks.append(Task(mutant, action, NIGHT, (mutant.file, mutant.applied(text))))
    for done, found in answers(tasks, folders):
        yield judge(done.key, found)


def there(batch: Batch, root: Path) -> list[Mutant]:
    """The mutants of a list whose line has not changed since it was written."""
    found = []
    for mutant in batch.mutants:
        with suppress(OSError, ValueError):
            mutant.applied((root / mutant.file).read_text(encoding="utf-8"))
            found.append(mutant)
    return found


def main(arguments=None, root: Path = ROOT, libraries=LIBRARIES) -> int:
    """Run a list and print what is then written at its head; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("list", nargs="?", help=f"its name in tests/mutants/{FRESH} (default: the latest)")
    parser.add_argument("--only", nargs="+", metavar="ID", default=["*"], help="these alone, say solver.kernel.*")
    parser.add_argument("--part", metavar="I/N", default="1/1", help="the I-th of N parts: each N-th mutant")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="how many at a time (default: 2)")
    parser.add_argument("--seconds", type=float, default=NIGHT, metavar="S", help="of tests a mutant (default: all)")
    parser.add_argument("--map", type=Path, metavar="FILE", help="keep here which functions each test runs")
    parser.add_argument("--page", type=Path, metavar="FILE", help="put the lists' figures on this page, run nothing")
    options = parser.parse_args(arguments)
    if options.page:
        options.page.write_text(with_figures(options.page.read_text(encoding="utf-8"), root), encoding="utf-8")
        return 0
    batch = next(one for one in reversed(batches(root)) if options.list in (None, one.name))
    part, parts = map(int, options.part.split("/"))
    mutants = [one for one in there(batch, root) if any(fnmatch(one.id, pattern) for pattern in options.only)]
    mutants, begun = mutants[part - 1 :: parts], time.monotonic()
    os.environ |= {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL")}
    for library in libraries:
        import_module(library)
    verdicts = []
    with tempfile.TemporaryDirectory(prefix="mutants-", ignore_cleanup_errors=True) as temporary:
        folders = [Path(temporary) / f"tree{i}" for i in range(options.jobs)]
        for folder in folders:
            copy(root, folder)
        for verdict in judged(mutants, folders, options.map, options.seconds):
            verdicts.append(verdict)
            print(f"{len(verdicts)} of {len(mutants)}: {verdict.mutant.id} {verdict}", flush=True)
    minutes = (time.monotonic() - begun) / 60
    print(f"{minutes:.0f} min with {options.jobs} processes, {len(mutants)} of {len(batch.mutants)}:")
    print("\n".join(f"{name}/: {killed} of {size}" for name, (killed, size) in sorted(totals(verdicts).items())))
    left = {one.id for one in batch.mutants} - {v.mutant.id for v in verdicts}
    print("untried = " + json.dumps(sorted(left), indent=4))
    print("survived = " + json.dumps(sorted(v.mutant.id for v in verdicts if not v.killed), indent=4))
    return 0


if __name__ == "__main__":
    sys.exit(main())

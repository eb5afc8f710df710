"""Would the tests notice? `make mutants`; the mutants are in tests/mutants/mutants.toml.

Each mutant runs in a copy of the tree, in a process forked from this one, which has imported the libraries but nothing
of the project. Tests that fail on the code as it is prove nothing: their mutants count as survived.

Exit code: 0 when at least 95 % of the mutants of the solver and of those of the study are killed, otherwise 1.
"""

import argparse
import os
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from datetime import UTC, datetime
from fnmatch import fnmatch
from importlib import import_module
from pathlib import Path

from copies import NIGHT, Task, answers, copy
from mutants import ROOT, WANTED, Mutant, Verdict, read, table, totals

LIBRARIES = (
    "numpy", "scipy.special", "scipy.optimize", "scipy.interpolate", "scipy.sparse", "scipy.integrate", "dask.array",
    "xarray", "netCDF4", "matplotlib.pyplot", "matplotlib.backends.backend_pdf", "mpmath", "hypothesis", "pytest",
)  # fmt: skip
PATIENCE, SLOWER = 60.0, 10.0  # seconds that a mutant gets, and times of what its tests take without it


class Watch:
    """Plugin of pytest: which tests fail, and the seconds of each."""

    def __init__(self):
        self.failed, self.seconds = [], defaultdict(float)

    def pytest_runtest_logreport(self, report):
        self.seconds[report.nodeid] += report.duration
        self.failed += [report.nodeid] if report.failed else []

    def pytest_collectreport(self, report):
        self.failed += [report.nodeid] if report.failed else []


def tested(folder: Path, tests: list[str], results: Path | None, *options: str, plugins=()) -> dict:
    """Run tests: exit code, those that failed, seconds of each. results: of the studies, if they are as always."""
    import hypothesis
    import pytest

    hypothesis.settings.register_profile("mutants", derandomize=True, database=None)
    hypothesis.settings.load_profile("mutants")
    os.environ |= {"ROUGHCOAT_RESULTS": str(results)} if results else {}
    watch, chosen = Watch(), [f"tests/{test}" for test in tests]
    always = ["-q", "-p", "no:cacheprovider", f"--rootdir={folder}", f"--basetemp={folder.with_suffix('.tmp')}"]
    always += ["-W", "ignore::pytest.PytestAssertRewriteWarning"]  # hypothesis is imported already
    code = pytest.main([*always, *options, *chosen], plugins=[watch, *plugins])
    return {"code": int(code), "failed": watch.failed, "seconds": watch.seconds}


def results_in(folder: Path) -> list[str]:
    """Compute the studies of the tests into a folder; returns the modules that it takes: their mutants do so again."""
    from conftest import compute_results

    compute_results(folder)
    names = (name.removeprefix("study.") if name.startswith("study.studies.") else name for name in sys.modules)
    return [name for name in names if name.startswith(("solver.", "study.", "studies."))]


def judged(mutants: list[Mutant], folders: list[Path], everything: bool) -> Iterator[Verdict]:
    """Verdicts as they come. everything: all tests there are for mutants that their own do not kill."""
    results = folders[0].with_name("kept-results")
    ((_, computing),) = answers([Task("results", lambda _: results_in(results))], folders)
    if isinstance(computing, str):
        raise RuntimeError(f"the studies of the tests cannot be computed: {computing}")
    seconds, failed = undisturbed(mutants, folders, results)

    def task(mutant, tests, limit):
        text = mutant.applied((folders[0] / mutant.file).read_text(encoding="utf-8"))
        kept = None if mutant.id.rpartition(".")[0] in computing else results
        return Task(mutant, lambda folder: tested(folder, tests, kept, "-x"), limit, (mutant.file, text))

    tasks, again = [], []
    for mutant in mutants:
        broken, own = [node for node in failed if covered(node, mutant.tests)], defaultdict(float)
        for node in (node for node in seconds if covered(node, mutant.tests)):
            own[node.removeprefix("tests/").partition("[")[0]] += seconds[node]
        if broken or not own:
            yield Verdict(mutant, False, f"but {broken[0]} fails without it" if broken else "but has no tests")
        else:
            quickest_first = sorted(own, key=own.get)
            tasks.append(task(mutant, quickest_first, PATIENCE + SLOWER * sum(own.values())))
    for done, found in answers(tasks, folders):
        verdict = judge(done.key, found)
        if everything and not verdict.killed:
            again.append(task(done.key, ["."], NIGHT))
        else:
            yield verdict
    for done, found in answers(again, folders):
        yield judge(done.key, found)


def undisturbed(mutants: list[Mutant], folders: list[Path], results: Path) -> tuple[dict[str, float], list[str]]:
    """Seconds of each test on the code as it is, and those that fail."""
    seconds, failed, files = {}, [], defaultdict(set)
    for test in (test for mutant in mutants for test in mutant.tests):
        files[test.partition("::")[0]].add(test)
    tasks = [Task(file, lambda folder, file=file: tested(folder, sorted(files[file]), results)) for file in files]
    for task, found in answers(tasks, folders):
        whole = isinstance(found, dict) and found["code"] in (0, 1)
        if not whole:
            print(f"{task.key}: {found}", file=sys.stderr)
        failed += found["failed"] if whole else [f"tests/{test}" for test in sorted(files[task.key])]
        seconds |= found["seconds"] if whole else {}
    print(f"{len(seconds)} tests of the code as it is: {sum(seconds.values()):.0f} s, failed: {failed}", flush=True)
    return seconds, failed


def covered(node: str, tests: list[str]) -> bool:
    """Whether a test (as pytest names it) is one of `tests`, or in one of these files."""
    return any(f"{node}[".startswith((f"tests/{test}::", f"tests/{test}[")) for test in tests)


def judge(mutant: Mutant, found) -> Verdict:
    if isinstance(found, str):
        return Verdict(mutant, True, found.strip().splitlines()[-1])
    by = [node.removeprefix("tests/") for node in found["failed"]] or [f"pytest, which ends with {found['code']}"]
    return Verdict(mutant, True, by[0]) if found["code"] else Verdict(mutant, False)


def main(arguments=None, root: Path = ROOT, libraries=LIBRARIES) -> int:
    """Run the mutants and print their table; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--only", nargs="+", metavar="ID", default=["*"], help="these alone, say solver.kernel.*")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="how many at a time (default: 2)")
    parser.add_argument("--all", action="store_true", help="try what survives with all the tests there are")
    parser.add_argument("--table", type=Path, metavar="FILE", help="write the table to a file")
    options = parser.parse_args(arguments)
    mutants = [mutant for mutant in read(root) if any(fnmatch(mutant.id, pattern) for pattern in options.only)]
    os.environ |= {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL")}
    for library in libraries:
        import_module(library)
    begun, verdicts = time.monotonic(), {}
    with tempfile.TemporaryDirectory(prefix="mutants-", ignore_cleanup_errors=True) as temporary:
        folders = [Path(temporary) / f"tree{i}" for i in range(options.jobs)]
        for folder in folders:
            copy(root, folder)
        for verdict in judged(mutants, folders, options.all):
            verdicts[verdict.mutant.id] = verdict
            print(f"{len(verdicts)} of {len(mutants)}: {verdict.mutant.id} {verdict}", flush=True)
    found = [verdicts[mutant.id] for mutant in mutants]
    remark = f"{datetime.now(UTC):%Y-%m-%d}, {(time.monotonic() - begun) / 60:.0f} min with {options.jobs} processes:"
    text = table(found, root, remark)
    print(text)
    if options.table:
        options.table.write_text(text, encoding="utf-8")
    return 0 if all(killed >= WANTED * size for killed, size in totals(found).values()) else 1


if __name__ == "__main__":
    sys.exit(main())

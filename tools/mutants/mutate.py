"""Would the tests notice? `make mutants SEED=20261129 N=100`: mistakes drawn by a seed, and whether tests notice them.

operators.py makes them. Each kind of mistake is drawn equally often, in the files that have changed since --base, or in
all files. Every test that runs the file of a mistake is tried: first those that run its function, the quickest first.

Exit code: 0 if at least 90 % of the mistakes in the solver, in the study and in the explorer are noticed, otherwise 1.
"""

import argparse
import os
import random
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import by_hand
from copies import NIGHT, copy
from operators import Change, changes
from trials import LIBRARIES, Verdict, compiled, judged, runs_of

ROOT = by_hand.ROOT
WANTED = 0.9  # share of the mistakes in each part that must be noticed
SUFFIXES = {".py", ".js", ".c", ".h"}


def files_of(root: Path, base: str | None) -> list[str]:
    """The files of the program, or only those that have changed since a commit."""
    tops = ("solver", "study", "studies")
    names = [str(path.relative_to(root)) for top in tops for path in sorted((root / top).rglob("*"))]
    if base:
        text = subprocess.check_output(["git", "diff", "--name-only", base, "--", *tops], cwd=root, text=True)
        names = [name for name in names if name in text.split()]
    return [name for name in names if Path(name).suffix in SUFFIXES]


def drawn(root: Path, files: list[str], seed: int) -> Iterator[Change]:
    """Mistakes in the order that a seed gives; each once, and each kind as often as the others."""
    kinds = defaultdict(list)
    for name in files:
        for change in changes(name, (root / name).read_text(encoding="utf-8")):
            kinds[change.kind].append(change)
    chance = random.Random(seed)
    for kind in sorted(kinds):
        chance.shuffle(kinds[kind])
    while kinds:
        kind = chance.choice(sorted(kinds))
        yield kinds[kind].pop()
        if not kinds[kind]:
            del kinds[kind]


def part(file: str) -> str:
    """The part of the program to which a file belongs: the explorer is a separate program."""
    return "explorer" if file.startswith("study/explorer/") else file.partition("/")[0]


def table(verdicts: list[Verdict]) -> list[str]:
    """Lines: the number of noticed mistakes in each part, and of others in each room."""
    parts, rooms = defaultdict(list), defaultdict(list)
    for verdict in verdicts:
        parts[part(verdict.change.file)].append(verdict.killed)
        rooms[str(Path(verdict.change.file).parent)].append(verdict.killed)
    lines = [f"{name}: {sum(killed)} of {len(killed)} noticed" for name, killed in sorted(parts.items())]
    left = [f"{name} {len(killed) - sum(killed)} of {len(killed)}" for name, killed in sorted(rooms.items())]
    return [
        *lines,
        "not noticed: " + ", ".join(count for count in left if not count.startswith("0 ") and " 0 of" not in count),
    ]


def main(arguments=None, root: Path = ROOT, libraries=LIBRARIES) -> int:
    """Draw mistakes, try each, and print the verdict; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seed", type=int, default=0, help="another seed, other mistakes; say, the date")
    parser.add_argument("--number", type=int, default=100, metavar="N", help="how many (default: 100)")
    parser.add_argument("--base", metavar="COMMIT", help="of files that have changed since then alone")
    parser.add_argument("--only", metavar="PREFIX", default="", help="of files alone whose path begins so")
    parser.add_argument("--by-hand", action="store_true", help="those of tests/mutants/by_hand.toml instead")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="how many at a time (default: 2)")
    parser.add_argument("--seconds", type=float, default=NIGHT, metavar="S", help="of tests a mistake (default: all)")
    parser.add_argument("--map", type=Path, metavar="FILE", help="keep here which functions each test runs")
    options = parser.parse_args(arguments)
    files = [name for name in files_of(root, options.base) if name.startswith(options.only)]
    source = by_hand.changes(root) if options.by_hand else drawn(root, files, options.seed)
    os.environ |= {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL")}
    for library in libraries:
        import_module(library)
    start, verdicts, chosen = time.monotonic(), [], {}
    with tempfile.TemporaryDirectory(prefix="mutants-", ignore_cleanup_errors=True) as temporary:
        folders = [Path(temporary) / f"tree{i}" for i in range(options.jobs)]
        for folder in folders:
            copy(root, folder)
        for change in source:
            if len(chosen) == (len(files) * 1000 if options.by_hand else options.number):
                break
            if (changed := compiled(change, root, Path(temporary) / "core")) is not None:
                chosen[change] = changed
        runs_of_tests = runs_of(folders, options.map)
        print(
            f"{len(runs_of_tests['tests'])} tests, of the code as it is failed: {runs_of_tests['failed']}", flush=True
        )
        for verdict in judged(chosen, folders, runs_of_tests, options.seconds):
            verdicts.append(verdict)
            change, text = verdict.change, (root / verdict.change.file).read_text(encoding="utf-8")
            print(f"{len(verdicts)} of {len(chosen)}: {change.file}:{change.line(text)} {change.kind}: "
                  f"{change.shown(text)}: {verdict}", flush=True)  # fmt: skip
    minutes = (time.monotonic() - start) / 60
    print(f"seed {options.seed}, {len(verdicts)} mistakes, {minutes:.0f} min with {options.jobs} processes")
    print("\n".join(table(verdicts)))
    shares = defaultdict(list)
    for verdict in verdicts:
        shares[part(verdict.change.file)].append(verdict.killed)
    return 0 if all(sum(killed) >= WANTED * len(killed) for killed in shares.values()) else 1


if __name__ == "__main__":
    sys.exit(main())

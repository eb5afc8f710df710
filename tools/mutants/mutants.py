"""The mutants of mutants.toml and of the fresh lists, and the tables of what became of them.

`make mutants` runs the former (mutate.py), `make fresh_mutants` the latest of the latter (fresh.py).
"""

import os
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
FRESH = "fresh"  # folder of the fresh lists, in tests/mutants
WANTED = 0.95  # share of the mutants of each package that must be killed
HEAD = """# Mutants

Each mutant breaks the code in one place. It is killed when a test fails, or takes far longer than without it. There are
lists of two kinds.

## Fresh lists: how much the tests notice

The lists in tests/mutants/fresh were written before their authors looked at the tests. All tests that run the file of a
mutant were tried, once, at the commit of the table, without the mutants whose line had changed. A list is never mended,
and no test is written for one of its mutants alone: so these are the figures that say what the tests notice. `make
fresh_mutants` tries the latest list again. Where not all of these tests were tried the row says so, and its figures are
lower bounds. That of 2026-11-25 has no row: it was first tried with a few seconds of tests a mutant (`fresh.py
--seconds`), which killed 71 of 99 in solver/ and 96 of 123 in study/. 2026-11-25b waits for a machine with time.

{fresh}

## Kept list: what the tests must go on noticing

The mutants of tests/mutants/mutants.toml name the tests that ought to notice. New code brings new ones, and those that
survive are answered by a test: so nearly all are killed, which says no more than that no test has gone blind. `make
mutants` runs them and writes this page.

{totals}

| mutant | place | change | killed by |
| --- | --- | --- | --- |
{rows}
"""


@dataclass(frozen=True)
class Mutant:
    """One change of one file, and the tests that ought to notice."""

    id: str
    file: str
    old: str
    new: str
    tests: list[str]

    def applied(self, text: str) -> str:
        """The text of the file with the change. Raises ValueError unless `old` is there exactly once."""
        if text.count(self.old) != 1:
            raise ValueError(f"{self.id}: {self.file} has this {text.count(self.old)} times: {self.old}")
        return text.replace(self.old, self.new)

    def line(self, text: str) -> int:
        """Number of the first line that changes."""
        same = os.path.commonprefix([self.old, self.new])
        return 1 + text[: text.index(self.old) + len(same)].count("\n")


@dataclass(frozen=True)
class Verdict:
    """What became of a mutant; `by`: the first test that failed, or why its tests prove nothing."""

    mutant: Mutant
    killed: bool
    by: str = ""

    def __str__(self):
        return f"killed by {self.by}" if self.killed else f"SURVIVED {self.by}".strip()


class Batch(NamedTuple):
    """A fresh list. about : `written`, the date; `commit`, of the code and of the tests that were tried; `survived`,
    the mutants that these did not kill; `untried`, those whose line had gone, or that were left out at random;
    `remark`, what else is to be said of it"""

    name: str
    about: dict
    mutants: list[Mutant]


def read(root: Path = ROOT) -> list[Mutant]:
    """The mutants of a tree: [PACKAGE.ROOM.MODULE.NAME] with `old`, `new`, and `tests` relative to tests/.

    They are of the file MODULE.py, or of the `file` that they name.
    """
    return list(_within(tomllib.loads((root / "tests/mutants/mutants.toml").read_text(encoding="utf-8")), ()))


def batches(root: Path = ROOT) -> list[Batch]:
    """The fresh lists of a tree, the latest last. Their mutants name no tests."""
    found = []
    for path in sorted((root / "tests/mutants" / FRESH).glob("*.toml")):
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
        about = tables.pop("about")
        found.append(Batch(path.stem, about, list(_within(tables, ()))))
    return found


def _within(tables: dict, path: tuple[str, ...]) -> Iterator[Mutant]:
    """The mutants of nested tables, `path` the names of the tables around."""
    for name, entry in tables.items():
        if "old" in entry:
            yield Mutant(".".join((*path, name)), **{"file": f"{'/'.join(path)}.py", "tests": []} | entry)
        else:
            yield from _within(entry, (*path, name))


def totals(verdicts: list[Verdict]) -> dict[str, tuple[int, int]]:
    """package -> mutants killed, and all of them."""
    packages = dict.fromkeys(verdict.mutant.file.partition("/")[0] for verdict in verdicts)
    found = {name: [v.killed for v in verdicts if v.mutant.file.startswith(f"{name}/")] for name in packages}
    return {name: (sum(killed), len(killed)) for name, killed in found.items()}


def table(verdicts: list[Verdict], root: Path, remark: str) -> str:
    """The table in Markdown."""
    rows = []
    for verdict in verdicts:
        mutant = verdict.mutant
        line = mutant.line((root / mutant.file).read_text(encoding="utf-8"))
        change = f"{_code(mutant.old)} → {_code(mutant.new)}"
        by = verdict.by if verdict.killed else f"**{verdict}**"
        rows.append(f"| {mutant.id} | {mutant.file}:{line} | {change} | {by} |")
    lines = [f"{remark}\n"]
    for name, (killed, size) in totals(verdicts).items():
        lines.append(f"- {name}/: {killed} of {size} killed ({killed / size:.1%})")
    return HEAD.format(fresh=_figures(batches(root)), totals="\n".join(lines), rows="\n".join(rows))


def with_figures(page: str, root: Path) -> str:
    """The page with the figures of the fresh lists as these say them now; the kept list stays as it is."""
    return re.sub(r"(?m)^\| written \|.*\n(\|.*\n)*", lambda _: f"{_figures(batches(root))}\n", page, count=1)


def _figures(lists: list[Batch]) -> str:
    """The figures of the fresh lists that have been tried, in Markdown."""
    rows = []
    for batch in (one for one in lists if "survived" in one.about):
        tried = [mutant for mutant in batch.mutants if mutant.id not in batch.about.get("untried", ())]
        found = totals([Verdict(mutant, mutant.id not in batch.about["survived"]) for mutant in tried])
        cells = [f"{killed} of {size} ({killed / size:.0%})" for killed, size in map(found.get, ("solver", "study"))]
        rows.append(f"| {batch.about['written']} | {batch.about['commit']} | {' | '.join(cells)} |")
        rows[-1] += f" {batch.about.get('remark', '')} |"
    head = ["| written | commit | solver/ killed | study/ killed | |", "| --- | --- | --- | --- | --- |"]
    return "\n".join([*head, *rows])


def _code(text: str) -> str:
    """Source on one line of a table."""
    line = re.sub(r"\s*\n\s*", " ⏎ ", text.strip()).replace("|", "\\|")
    return f"`` {line} ``" if line else "nothing"

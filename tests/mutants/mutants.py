"""The mutants of mutants.toml, and the table of what became of them. `make mutants` runs them (mutate.py)."""

import os
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WANTED = 0.95  # share of the mutants of each package that must be killed
HEAD = """# Mutants

Written by `make mutants`. It breaks the code in one place at a time, as tests/mutants/mutants.toml says, and runs the
tests that ought to notice: a mutant is killed when one of them fails, or takes far longer than without it.

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


def read(root: Path = ROOT) -> list[Mutant]:
    """The mutants of a tree: [PACKAGE.ROOM.MODULE.NAME] with `old`, `new`, and `tests` relative to tests/.

    They are of the file MODULE.py, or of the `file` that they name.
    """
    return list(_within(tomllib.loads((root / "tests/mutants/mutants.toml").read_text(encoding="utf-8")), ()))


def _within(tables: dict, path: tuple[str, ...]) -> Iterator[Mutant]:
    """The mutants of nested tables, `path` the names of the tables around."""
    for name, entry in tables.items():
        if "old" in entry:
            yield Mutant(".".join((*path, name)), **{"file": f"{'/'.join(path)}.py"} | entry)
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
    return HEAD.format(totals="\n".join(lines), rows="\n".join(rows))


def _code(text: str) -> str:
    """Source on one line of a table."""
    line = re.sub(r"\s*\n\s*", " ⏎ ", text.strip()).replace("|", "\\|")
    return f"`` {line} ``" if line else "nothing"

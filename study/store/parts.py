"""The results of a large study: results/NAME/*.nc, a file for each part of its grid.

A part is a window of the grid, cases that follow each other. Its file is a results file of these cases, and it is the
progress too: its name tells its first case and the study, and it counts if that is what is in it, by its digest of the
study, its coordinates and its first case. So every number is written once, and no key of a case is in
memory or on disk: memory does not grow with the study. In return an edited study computes all of its cases.
"""

from dataclasses import dataclass, field, replace
from itertools import count
from math import inf, prod
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..data.dataset import not_run, parts
from ..data.si import axes_of, dataset_of
from ..files.examine import Condition, Identity, examine, stamp, statuses
from ..files.parts_folder import DIVIDED, FIRST
from ..files.results_file import write
from ..files.seal import is_whole
from ..inputs.definition import LARGE, Definition, usual_block
from ..inputs.grid import cut_out, windows
from ..inputs.vocabulary import NOT_RUN
from .blocks import Store, count_statuses

#: A study of more cases is kept in parts: a smaller one takes some 100 bytes of memory a case, for its keys. So is one
#: of more numbers, whose single file would have more than 4 GB.
CASES, NUMBERS = 4_000_000, LARGE
#: Bytes of the numbers of a part, at most: 1,000,000 cases without profiles, 194,000 with 33 points. 1e8 cases without
#: profiles are then 100 files, fewer than the 128 that xarray keeps open at a time.
PART = 128_000_000
#: Usual blocks in a part, at most: of cases that take long a part has fewer.
BLOCKS = 64
NO_PART = "is no part of the study as it is; move it away"


class Part(NamedTuple):
    """Cases that follow each other, the window of the grid that they are, and their file."""

    cases: range
    window: dict[str, slice]
    path: Path

    @property
    def first(self) -> int:
        return self.cases.start


def is_large(definition: Definition) -> bool:
    """Whether the results of a study are kept in parts."""
    return definition.grid.size > CASES or definition.numbers > NUMBERS


def parts_of(store: Store) -> list[Part]:
    """The parts of a study, in the order of the cases. How it is cut depends on its grid and its output only."""
    definition, found, first = store.definition, [], 0
    grid = definition.grid
    most = max(1, min(PART * grid.size // (8 * definition.numbers), BLOCKS * usual_block(grid)))
    for window in windows(grid, most, most):
        size = prod(len(range(length)[window[dim]]) for dim, length in grid.sizes.items())
        name = f"{first:012d}-{definition.digest[:16]}.nc"
        found.append(Part(range(first, first + size), window, store.parts / name))
        first += size
    return found


def divisions(definition: Definition, parts: list[Part]) -> str:
    """How many parts there are along each dimension of the results that is cut: "h 5, n 2"."""
    starts = {dim: len({part.window[dim].start for part in parts}) for dim in definition.grid.sizes}
    return ", ".join(f"{dim} {count}" for dim, count in definition.in_results(starts).items() if count > 1)


def identities(store: Store, parts: list[Part]) -> list[Identity]:
    """What the file of each part must say of itself. One without its first case is of an earlier version."""
    definition, axes, divided = store.definition, axes_of(store.definition), divisions(store.definition, parts)
    found = []
    for part in parts:
        window = definition.in_results(part.window)
        coordinates = {dim: values[window[dim]] for dim, values in axes.items()}
        found.append(Identity(definition.digest, coordinates, {DIVIDED: divided, FIRST: part.first}))
    return found


def conditions(store: Store, parts: list[Part], most: float = 0) -> list[Condition]:
    """The condition of the file of each part: "sound" if it has the cases of this part, "misplaced" if others.

    most : as of `examine`
    """
    return [examine(part.path, identity, most) for part, identity in zip(parts, identities(store, parts), strict=True)]


def checked(store: Store, parts: list[Part], before: list[Condition] | None = None) -> list[Condition]:
    """As `conditions`, with all bytes read: by the seal, or by the digest where another program has removed that.

    before : the conditions of a moment ago, which are those of files that have not changed
    """
    states = []
    for number, identity in enumerate(identities(store, parts)):
        path = parts[number].path
        if before and before[number].seen == stamp(path):
            states.append(before[number])
        elif path.is_file() and (whole := _is_whole(path)) is not None:
            damaged = Condition(path, "damaged", "is damaged", seen=stamp(path))
            states.append(examine(path, identity, 0) if whole else damaged)
        else:
            states.append(examine(path, identity))
    return states


def _is_whole(path: Path) -> bool | None:
    try:
        return is_whole(path)
    except OSError:  # `examine` says why
        return None


def sound(parts: list[Part], states: list[Condition]) -> list[Part]:
    """The parts whose files are there, with their cases."""
    return [part for part, state in zip(parts, states, strict=True) if state.kind == "sound"]


def wrong(states: list[Condition]) -> list[Condition]:
    """Of the files that are there those that are not the parts that their names say."""
    return [state for state in states if state.kind not in ("sound", "missing")]


def others(store: Store, parts: list[Part]) -> list[Path]:
    """Files among the parts that are none of these: of the study as it was, or of somebody else."""
    return sorted({*store.parts.glob("*.nc")} - {part.path for part in parts})


def put_away(state: Condition) -> Path:
    """Rename the file of a part that is damaged, or is another one; returns its new path."""
    kind = "misplaced" if state.kind == "misplaced" else "damaged"
    paths = (Path(f"{state.path}.{kind}{f'-{number}' * (number > 1)}") for number in count(1))
    path = next(path for path in paths if not path.exists())
    state.path.replace(path)
    return path


def counts(parts: list[Part], missing: int = 0) -> dict[int, int]:
    """status -> number of cases in the files of the parts; and how many are missing."""
    total = {NOT_RUN: missing} if missing else {}
    for part in parts:
        for status, number in count_statuses(statuses(part.path)).items():
            total[status] = total.get(status, 0) + number
    return total


def having(parts: list[Part], status: tuple[int, ...]) -> list[Part]:
    """The parts with a case of one of these statuses."""
    return [part for part in parts if status and np.isin(statuses(part.path), status).any()]


def condition(store: Store) -> Condition:
    """The condition of the first part that is not sound, else of all together. All is read."""
    parts = parts_of(store)
    bad = [state for state in conditions(store, parts, inf) if state.kind != "sound"]
    if bad:
        return bad[0]
    if besides := others(store, parts):
        return replace(examine(besides[0], most=0), kind="misplaced", reason=NO_PART)
    return Condition(store.parts, "sound", digest=store.definition.digest)


@dataclass(eq=False)
class Growing:
    """The parts that are being computed: their numbers until they are whole; then they are written.

    divided : see `divisions`
    blocks : of each block that is computed its part, and the numbers of its cases
    begun : first case of a part -> how many cases it lacks, and its arrays; blocks end about in order, so there are few
    spoiled : first cases of the parts of which a block has failed; written : cases of the parts that are written
    """

    store: Store
    command: str
    divided: str
    blocks: list[tuple[Part, range]]
    begun: dict[int, tuple[int, dict[str, np.ndarray]]] = field(default_factory=dict)
    spoiled: set[int] = field(default_factory=set)
    written: int = 0

    def add(self, number: int, arrays: dict[str, np.ndarray]) -> None:
        """Put the columns of a block into its part, and write that when it is whole."""
        part, block = self.blocks[number]
        if part.first in self.spoiled:
            return
        size = len(part.cases)
        lacks, whole = self.begun.pop(part.first, None) or (size, not_run(self.store.definition, size))
        for name, array in whole.items():
            array[block.start - part.first : block.stop - part.first] = arrays[name]
        if lacks > len(block):
            self.begun[part.first] = lacks - len(block), whole
        else:
            self._write(part, whole)

    def drop(self, number: int) -> None:
        """Forget a part, one of whose blocks has failed."""
        first = self.blocks[number][0].first
        self.spoiled.add(first)
        self.begun.pop(first, None)

    def _write(self, part: Part, arrays: dict[str, np.ndarray]) -> None:
        definition = self.store.definition
        scene = definition.scene and definition.scene.within(part.window)
        here = replace(definition, grid=cut_out(definition.grid, part.window), scene=scene)
        dataset = dataset_of(here, parts(here, arrays, self.command))
        dataset.attrs |= {DIVIDED: self.divided, FIRST: part.first}
        write(dataset, part.path, Condition(part.path, "missing", seen=stamp(part.path)))
        self.written += len(part.cases)

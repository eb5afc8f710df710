"""The order and the report of a run, and what is checked before it begins."""

import tempfile
from dataclasses import dataclass, replace
from math import inf
from numbers import Integral
from pathlib import Path
from typing import TextIO

import numpy as np

from solver import NUMERICS_VERSION

from ..data.dataset import status_words
from ..data.si import axes_of
from ..files.access import Unusable
from ..files.atomic import make_folder, target
from ..files.examine import Condition, Identity, examine, statuses
from ..inputs.definition import LARGE, Definition, StudyError
from ..inputs.reading import same_tables
from ..inputs.vocabulary import NOT_RUN, suggest
from ..store.blocks import Store, lost_cases
from ..store.edits import owner_of
from ..terminal import on_one_line, program, shown
from .cost import describe, estimate
from .progress import screen_of


@dataclass(frozen=True)
class Report:
    """What a run did.

    path : of the results; complete : whether it is written; if not, blocks failed or other parts are missing
    cases : of the study; computed : those computed now; failures : number of a block -> why it failed
    counts : status -> number of cases; {} when there was nothing to do
    """

    path: Path
    cases: int
    computed: int
    failures: dict[int, str]
    counts: dict[int, int]
    complete: bool


@dataclass(frozen=True, eq=False)
class Order:
    """What a run is asked for.

    workers, scheduler : see `engine.computed`
    part : (i, n), compute the i-th of n parts only; the part that ends last writes the results
    retry : compute cases of these statuses again
    fail_fast : stop at the first block that raises or has a failed case; a case without a solution has not failed
    force : replace the results file even if cases in it are lost
    renew : replace it too if the same study file made it with another version of the numerics
    yes : go on however large the study is
    command : of the user, for the history of the results
    stream : where progress is written
    progress : where it is written without a `stream`, see `screen.screen_of`
    """

    definition: Definition
    results: Path
    workers: int | None = None
    scheduler: str | None = None
    part: tuple[int, int] = (1, 1)
    retry: tuple[int, ...] = ()
    fail_fast: bool = False
    force: bool = False
    renew: bool = False
    yes: bool = False
    command: str = ""
    stream: TextIO | None = None
    progress: bool | None = None

    def __post_init__(self):
        def whole(*values) -> bool:
            return all(isinstance(value, Integral) and not isinstance(value, bool) for value in values)

        wrong, pair = [], isinstance(self.part, tuple) and len(self.part) == 2
        if not (pair and whole(*self.part) and 1 <= self.part[0] <= self.part[1]):
            wrong.append(f"part = {shown(self.part)}: must be (I, N), whole numbers with 1 <= I <= N")
        if self.workers is not None and not (whole(self.workers) and self.workers > 0):
            wrong.append(f"workers = {shown(self.workers)}: must be a whole number, 1 or more")
        if not (isinstance(self.retry, (tuple, list)) and whole(*self.retry)):
            wrong.append(f"retry = {shown(self.retry)}: must be a tuple of values of status")
        if wrong:
            raise StudyError(wrong)
        screen_of(self.progress)

    @property
    def store(self) -> Store:
        return Store(self.definition, self.results)

    @property
    def shared(self) -> bool:
        """Whether other runs compute other parts at the same time."""
        return self.part[1] > 1

    def done(self, condition: Condition) -> bool:
        """Whether an examined results file is that of this study, has its title, and holds no case to be tried again.

        A file with another title counts as that of this study if its blocks are not there to write it anew.
        """
        edited = condition.title != (self.definition.title or self.definition.name)
        if not belongs(self.definition, condition) or (edited and self.store.record(condition.digest).exists()):
            return False
        return not (self.retry and np.isin(statuses(self.store.path), self.retry).any())

    def report(self, counts: dict[int, int] | None = None, **what) -> Report:
        """A report; without `counts`, that there was nothing to do."""
        counts = counts or {}
        report = Report(self.store.path, self.definition.grid.size, 0, {}, counts, not counts.get(NOT_RUN))
        return replace(report, **what)


def look(store: Store, most: float = inf) -> Condition:
    """`examine` the results file of a study. One of the same study with other cases is foreign: another program has
    changed it, or it is a part of the results."""
    definition, condition = store.definition, examine(store.path, most=most)
    if not belongs(definition, condition):
        return condition
    state = examine(store.path, Identity(definition.digest, axes_of(definition)), 0)
    if state.kind != "misplaced":
        return condition
    return replace(condition, kind="foreign", reason=f"another program has changed it: {state.reason}")


def belongs(definition: Definition, condition: Condition) -> bool:
    """Whether an undamaged results file is that of this very study."""
    return condition.good and condition.digest == definition.digest


def of_what(condition: Condition, definition: Definition) -> str:
    """To what the results in an undamaged file belong that are not those of this study, see `owner_of`."""
    same = condition.numerics == NUMERICS_VERSION
    return owner_of(condition, definition) if same else "another version of the numerics"


def check_replaceable(order: Order, condition: Condition) -> None:
    """Raise StudyError if replacing the results file would lose cases that are not in this study.

    A file that roughcoat has not written is never replaced.
    """
    store, definition = order.store, order.definition
    if condition.kind in ("foreign", "unreadable"):
        raise Unusable(condition.path, condition.kind, f"{condition.reason}; move it away, or use --results DIR")
    nothing = condition.kind == "missing" or not condition.digest  # nothing in it can be read
    same_file = order.renew and same_tables(condition.text, definition.text)
    if order.force or nothing or same_file or condition.digest == definition.digest:
        return
    way = f"{program()} run --force {definition.name}" if order.renew else "--force"
    made = f'; it was made by "{on_one_line(condition.command, 80)}"' if condition.command else ""
    if condition.numerics != NUMERICS_VERSION:
        owner = f"version {condition.numerics} of the numerics, this is {NUMERICS_VERSION}"
        choice = f"{way} computes them again, --results DIR elsewhere"
        raise StudyError([f"{condition.path}: holds results of {owner}: {choice}{made}"])
    lost = lost_cases(store, condition.digest)
    if lost is None or lost[0]:
        owner = owner_of(condition, definition)
        what = f"{lost[0]} of its {lost[1]} cases are not in this one" if lost else "which cases cannot be told"
        choice = f"{way} replaces them, --results DIR writes elsewhere"
        raise StudyError([f"{condition.path}: holds results of {owner}, {what}: {choice}{made}"])


def status_values(words: list[str]) -> tuple[int, ...]:
    """Values of `status` by their words. Raises StudyError for a word that is none."""
    values = {word: value for value, word in status_words().items()}
    wrong = [f'--status "{word}" is not known{suggest(word, values)}' for word in words if word not in values]
    if wrong:
        raise StudyError(wrong)
    return tuple(values[word] for word in words)


def check_writable(path: Path) -> None:
    """Raise StudyError when the results cannot be written to their folder, or to where a symbolic link leads."""
    folder = path.parent
    try:
        str(path.absolute()).encode()
        make_folder(folder)
        folder = target(path).parent
        with tempfile.TemporaryFile(dir=folder):  # a file without a name: nothing is left if the program is killed
            pass
    except OSError as error:
        reason = "is a file, not a folder" if isinstance(error, FileExistsError) else error.strerror
        raise StudyError([f"{folder}: cannot be written: {reason}"], code=1) from None
    except UnicodeEncodeError:  # Python has lone surrogates for bytes of a path that are not UTF-8
        wrong = f"{path.absolute()}: the path of results must be UTF-8: netCDF can open no other"
        raise StudyError([wrong]) from None


def anything_there(store: Store) -> bool:
    """Whether there may be cases on disk."""
    return store.path.exists() or any(store.folder.glob("*.block"))


def check_size(order: Order) -> None:
    """Raise StudyError, which says the cost, for a study so large that it may be a mistake."""
    definition = order.definition
    if definition.numbers > LARGE and not order.yes:
        cost = describe(estimate(definition, order.workers))
        raise StudyError([f"{definition.name}: {definition.grid.size} cases: {cost}; --yes computes them"])

"""The order and the report of a run, and the checks before it begins."""

import tempfile
from dataclasses import dataclass, replace
from numbers import Integral
from pathlib import Path
from typing import TextIO

import numpy as np

from solver import NUMERICS_VERSION

from ..data.dataset import status_words
from ..files.access import Unusable
from ..files.atomic import make_folder, target
from ..files.examine import Condition, statuses
from ..inputs.definition import LARGE, Definition, StudyError
from ..inputs.reading import same_tables
from ..inputs.vocabulary import NOT_RUN, suggest
from ..store.blocks import lost_cases
from ..store.edits import owner_of
from ..store.window_files import WindowFiles, belongs, of_what
from ..store.windows import Store, Window
from ..terminal import counted, on_one_line, program, shown
from .cost import describe, estimate
from .progress import screen_of


@dataclass(frozen=True)
class Report:
    """The outcome of a run.

    path, complete : path of the results, and whether they are written; if not, blocks failed or other parts are missing
    cases, computed : number of cases in the study, and of those computed now
    failures : number of a block -> reason of its failure
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
    """The options of a run.

    workers, scheduler : see `engine.computed`
    part : (i, n), compute only the i-th of n parts; the part that ends last writes the results
    retry : compute cases with these statuses again
    fail_fast : stop at the first block that raises or has a failed case; a case without a solution has not failed
    force : replace the results file even if cases in it are lost
    renew : also replace it if the same study file made it with another version of the numerics
    yes : compute the study, however large it is
    command : of the user, for the history of the results
    stream : for the progress
    progress : whether progress is written without a `stream`, see `progress.screen_of`
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

    def lacking(self, state: WindowFiles) -> list[Window]:
        """The windows whose results are to be written: they do not exist, or hold cases to be tried again.

        A single file with another title is written again if its blocks exist.
        """
        definition, windows = self.definition, []
        for window, condition in zip(state.windows, state.conditions, strict=True):
            edited = state.is_one and condition.title != (definition.title or definition.name)
            missing = not belongs(definition, condition) or (edited and self.store.record(condition.digest).exists())
            if missing or (self.retry and np.isin(statuses(window.path), self.retry).any()):
                windows.append(window)
        return windows

    def done(self, state: WindowFiles) -> bool:
        """Whether there is nothing to do."""
        return not state.others and not self.lacking(state)

    def report(self, state: WindowFiles, counts: dict[int, int] | None = None, **what) -> Report:
        """A report; without `counts` it says that there was nothing to do."""
        counts = counts or {}
        report = Report(state.path, self.definition.grid.size, 0, {}, counts, not counts.get(NOT_RUN))
        return replace(report, **what)


def check_replaceable(order: Order, state: WindowFiles) -> None:
    """Raise StudyError if results of another study or another version of the numerics would be lost, unless these may
    be replaced.

    A file that roughcoat has not written is never replaced. In a folder of many files nothing but a file is put away.
    """
    rivals = state.rivals()
    stay = [file for file in state.wrong if state.is_one or file.kind == "unreadable" or not file.path.is_file()]
    for file in (*stay, *rivals):
        if file.kind in ("foreign", "unreadable"):
            raise Unusable(file.path, file.kind, f"{file.reason}; move it away, or use --results DIR")
    same_file = order.renew and all(same_tables(file.text, order.definition.text) for file in rivals)
    if rivals and not order.force and not same_file:
        command = f"{program()} run --force {order.definition.name}" if order.renew else "--force"
        refusal = (
            _refusal(order, rivals[0], command) if state.is_one else _refusal_of_many(order, state, rivals, command)
        )
        if refusal:
            raise StudyError([refusal])


def _refusal(order: Order, condition: Condition, command: str) -> str:
    """The reason not to replace a file of other results; "" if all its cases are in this study."""
    maker = f'; it was made by "{on_one_line(condition.command, 80)}"' if condition.command else ""
    if condition.numerics != NUMERICS_VERSION:
        owner = f"version {condition.numerics} of the numerics, this is {NUMERICS_VERSION}"
        choice = f"{command} computes them again, --results DIR elsewhere"
        return f"{condition.path}: holds results of {owner}: {choice}{maker}"
    lost = lost_cases(order.store, condition.digest)
    if lost and not lost[0]:
        return ""
    owner = owner_of(condition, order.definition)
    what = f"{lost[0]} of its {lost[1]} cases are not in this one" if lost else "which cases cannot be told"
    choice = f"{command} replaces them, --results DIR writes elsewhere"
    return f"{condition.path}: holds results of {owner}, {what}: {choice}{maker}"


def _refusal_of_many(order: Order, state: WindowFiles, rivals: list[Condition], command: str) -> str:
    """The reason not to remove files of other results; "" if all their cases are in this study, which takes them."""
    from ..store.former_parts import are_all_kept  # few runs have any

    if are_all_kept(state, rivals):
        return ""
    what = f"holds {counted(len(rivals), 'part')} of {of_what(rivals[0], order.definition)}"
    return f"{state.path}: {what}: {command} removes them, --results DIR writes elsewhere"


def status_values(words: list[str]) -> tuple[int, ...]:
    """Values of `status` by their words. Raises StudyError for an unknown word."""
    values = {word: value for value, word in status_words().items()}
    wrong = [f'--status "{word}" is not known{suggest(word, values)}' for word in words if word not in values]
    if wrong:
        raise StudyError(wrong)
    return tuple(values[word] for word in words)


def check_writable(path: Path) -> None:
    """Raise StudyError when the results cannot be written to their folder, or to the target of a symbolic link."""
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
    except UnicodeEncodeError:  # bytes of a path that are not UTF-8 are lone surrogates in Python
        wrong = f"{path.absolute()}: the path of results must be UTF-8: netCDF can open no other"
        raise StudyError([wrong]) from None


def check_size(order: Order) -> None:
    """Raise StudyError, which states the cost, for a study so large that it may be a mistake."""
    definition = order.definition
    if definition.numbers > LARGE and not order.yes:
        cost = describe(estimate(definition, order.workers))
        raise StudyError([f"{definition.name}: {definition.grid.size} cases: {cost}; --yes computes them"])

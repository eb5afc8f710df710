"""The files of a study on disk: the condition of each window's file, and of all together."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import count
from math import inf
from operator import is_
from pathlib import Path

import xarray as xr

from solver import NUMERICS_VERSION

from ..data.dataset import parts
from ..data.si import axes_of, dataset_of
from ..files.access import Unusable
from ..files.examine import Condition, Identity, examine, stamp, statuses
from ..files.parts_folder import divided, opened_together
from ..files.results_file import LAZY, for_users, opened
from ..files.seal import is_whole
from ..inputs.definition import Definition, StudyError
from ..inputs.vocabulary import NOT_RUN
from .blocks import count_statuses, gather, inventory, laws_in
from .edits import owner_of
from .windows import Store, Window, divisions, identities, is_large, whole_window, windows_of, within

NO_PART = "is not a part of this study; move it away"


@dataclass(frozen=True, eq=False)
class WindowFiles:
    """The files of the windows of a study.

    conditions : of the file of each window
    others : files in the folder of the windows that belong to none of them: to a former study, or to somebody else
    divided : see `divisions`
    """

    store: Store
    windows: list[Window]
    conditions: list[Condition]
    others: list[Path] = field(default_factory=list)
    divided: str = ""

    @property
    def is_one(self) -> bool:
        """Whether the results are one file."""
        return self.windows[0].path == self.store.path

    @property
    def path(self) -> Path:
        """Path of the results file, or of the folder of the results files."""
        return self.store.path if self.is_one else self.store.parts

    @property
    def present(self) -> list[Window]:
        """The windows that have results."""
        pairs = zip(self.windows, self.conditions, strict=True)
        return [window for window, condition in pairs if belongs(self.store.definition, condition)]

    @property
    def absent(self) -> list[Window]:
        """The windows without results."""
        pairs = zip(self.windows, self.conditions, strict=True)
        return [window for window, condition in pairs if not belongs(self.store.definition, condition)]

    @property
    def wrong(self) -> list[Condition]:
        """Conditions of the existing files that are not the results that their names say."""
        return [condition for condition in self.conditions if not condition.good and condition.kind != "missing"]

    @property
    def is_complete(self) -> bool:
        """Whether all windows have results."""
        return not self.absent

    def store_of(self, window: Window) -> Store:
        return within(self.store, window, self.divided)

    def rivals(self) -> list[Condition]:
        """The conditions of files in the place of the results that belong to another study, or to somebody else."""
        digests = "", self.store.definition.digest
        mine = [condition for condition in self.conditions if self.is_one and condition.digest not in digests]
        return mine + [examine(path, most=0) for path in self.others]

    def counts(self, windows: list[Window] | None = None) -> dict[int, int]:
        """status -> number of cases, in these windows or in all."""
        total, absent = dict[int, int](), {window.path for window in self.absent}
        for window in self.windows if windows is None else windows:
            is_absent = window.path in absent
            add_counts(total, self.counts_of_blocks(window) if is_absent else count_statuses(statuses(window.path)))
        return dict(sorted(total.items()))

    def counts_of_blocks(self, window: Window) -> dict[int, int]:
        """status -> number of cases in the blocks of a window without results."""
        if not any(self.store.block_paths(window)):  # then no keys of cases are needed
            return {NOT_RUN: len(window.cases)}
        return count_statuses(inventory(self.store_of(window)).status)

    @property
    def missing(self) -> int:
        """Number of cases that are neither in results nor in blocks."""
        return sum(self.counts_of_blocks(window).get(NOT_RUN, 0) for window in self.absent)

    def summary(self) -> dict:
        """As `study.api.Study.status`."""
        present, wrong, nothing = self.present, self.wrong, {NOT_RUN: self.store.definition.grid.size}
        counts = self.counts() if present or not wrong else {}
        if self.is_complete:
            state = "done"
        elif wrong and not present:
            state = wrong[0].kind
        elif not present and (self.others or self.conditions[0].good):
            state = "outdated"
        else:
            state = "new" if counts == nothing else "partial"
        reasons = [f"{file.path.name} " * (not self.is_one) + file.reason for file in wrong[:1]]
        reasons += [f"{path.name} {NO_PART}" for path in self.others[:1] if state != "outdated"]
        size, reason = self.store.definition.grid.size, "; ".join(reasons)
        return {"state": state, "cases": size, "counts": counts, "path": self.path, "reason": reason}

    def verdict(self) -> Condition:
        """As `study.api.Study.verify`, if all conditions come from `verified`."""
        definition = self.store.definition
        for condition in self.conditions:
            if condition.good and condition.digest != definition.digest:
                reason = f"nothing is damaged, but it holds results of {of_what(condition, definition)}"
                return replace(condition, kind="outdated", reason=reason)
            if self.is_one or condition.kind != "sound":
                return condition
        if self.others:
            return replace(examine(self.others[0], most=0), kind="misplaced", reason=NO_PART)
        return Condition(self.store.parts, "sound", digest=definition.digest)

    def opened(self) -> xr.Dataset:
        """The dataset of the results. Raises StudyError if some are missing, or are not what their names say."""
        if self.is_one:
            return self._file()
        for condition in self.wrong:
            reason = f"{condition.reason}; run the study, which computes it again"
            raise Unusable(condition.path, condition.kind, reason)
        if not self.is_complete:
            count = len(self.present)
            what = f"{count} of {len(self.windows)} parts are there" if count else "does not exist"
            raise StudyError([f"{self.path}: {what}; run the study first"])
        for path in self.others:
            raise Unusable(path, "foreign", NO_PART)
        paths = [window.path for window in self.windows]
        return for_users(opened_together(paths, self.path, divided(self.divided)))

    def partial(self) -> xr.Dataset:
        """The grid with the cases in the blocks of a single window; other cases are NaN with status 127, not run."""
        definition, laws = self.store.definition, laws_in(self.store)
        tables = {word.name: laws[word.version] for word in definition.scans if word.version in laws}
        definition = replace(definition, tables=tables)
        arrays = gather(self.store, inventory(self.store), 0, definition.grid.size)
        return dataset_of(definition, parts(definition, arrays, "partial results"))

    def _file(self) -> xr.Dataset:
        (condition,), definition = self.conditions, self.store.definition
        if belongs(definition, condition):
            return opened(condition)
        if condition.good or condition.kind == "missing":
            what = f"holds results of {of_what(condition, definition)}" if condition.good else "does not exist"
            raise StudyError([f"{self.path}: {what}; run the study first"])
        more = "; run the study, which writes it again" if condition.kind == "damaged" else ""
        raise Unusable(self.path, condition.kind, condition.reason + more)


def add_counts(total: dict[int, int], counts: dict[int, int]) -> None:
    """Add the number of cases of each status to a total."""
    for status, number in counts.items():
        total[status] = total.get(status, 0) + number


def glance(store: Store) -> WindowFiles:
    """The state by the attributes of the files; a single file of up to LAZY bytes in memory is read completely."""
    return _state(store, LAZY, lambda window, identity: examine(window.path, identity, 0))


def verified(store: Store) -> WindowFiles:
    """The state with all numbers compared with their digests."""
    return _state(store, inf, lambda window, identity: examine(window.path, identity))


def checked(store: Store, before: WindowFiles | None = None) -> WindowFiles:
    """The state with all bytes read. Many files are checked by the seal, or by the digest if another program has
    removed the seal.

    before : the state of a moment ago, which is returned if no file has changed since
    """
    conditions = {condition.path: condition for condition in before.conditions} if before else {}

    def unless_changed(path: Path, look: Callable[[], Condition]) -> Condition:
        earlier = conditions.get(path)
        return earlier if earlier and earlier.seen == stamp(path) else look()

    def sealed(window: Window, identity: Identity) -> Condition:
        return unless_changed(window.path, partial(_sealed, window.path, identity))

    state = _state(store, inf, sealed, unless_changed)
    same = before and before.others == state.others and all(map(is_, before.conditions, state.conditions))
    return before if same else state


def _state(
    store: Store, most: float, look: Callable, unless_changed: Callable = lambda path, look: look()
) -> WindowFiles:
    """The state.

    most : a single file of up to so many bytes in memory is read completely
    look : look(window, identity) is the condition of the file of one of many windows
    unless_changed : unless_changed(path, look) is the condition of a single file, by look() if the file has changed
    """
    definition = store.definition
    # a large study may have a single file too, if a former version wrote it
    if not is_large(definition) or belongs(definition, _of_one_file(store, 0)):
        return WindowFiles(
            store, [whole_window(store)], [unless_changed(store.path, partial(_of_one_file, store, most))]
        )
    windows = windows_of(store)
    conditions = list(map(look, windows, identities(store, windows)))
    others = sorted({*store.parts.glob("*.nc")} - {window.path for window in windows})
    return WindowFiles(store, windows, conditions, others, divisions(definition, windows))


def _of_one_file(store: Store, most: float) -> Condition:
    """`examine` the results file of a study of one window.

    A file of the same study with other cases is foreign: another program has changed it, or it belongs to one of
    several windows.
    """
    definition, condition = store.definition, examine(store.path, most=most)
    if not belongs(definition, condition):
        return condition
    state = examine(store.path, Identity(definition.digest, axes_of(definition)), 0)
    if state.kind != "misplaced":
        return condition
    return replace(condition, kind="foreign", reason=f"another program has changed it: {state.reason}")


def _sealed(path: Path, identity: Identity) -> Condition:
    """The condition of one of many files by its seal, or by its digest if it has none."""
    seen = stamp(path)
    try:
        intact = is_whole(path) if path.is_file() else None
    except OSError:  # `examine` says why
        intact = None
    if intact is None:
        return examine(path, identity)
    return examine(path, identity, 0) if intact else Condition(path, "damaged", "is damaged", seen=seen)


def put_away(condition: Condition) -> Path:
    """Rename a damaged or misplaced file of one of many windows; returns its new path."""
    kind = "misplaced" if condition.kind == "misplaced" else "damaged"
    paths = (Path(f"{condition.path}.{kind}{f'-{number}' * (number > 1)}") for number in count(1))
    path = next(path for path in paths if not path.exists())
    condition.path.replace(path)
    return path


def belongs(definition: Definition, condition: Condition) -> bool:
    """Whether a file is undamaged and holds the results of this very study."""
    return condition.good and condition.digest == definition.digest


def of_what(condition: Condition, definition: Definition) -> str:
    """The owner of an undamaged file whose results are not those of this study, in words (`owner_of`)."""
    same = condition.numerics == NUMERICS_VERSION
    return owner_of(condition, definition) if same else "another version of the numerics"

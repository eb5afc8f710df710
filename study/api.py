"""`load` a study file; the `Study` runs, opens and examines its results."""

import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from .data.provenance import command_line
from .files.access import Unusable
from .files.examine import Condition, statuses
from .files.results_file import LAZY, opened
from .inputs.definition import Definition, StudyError
from .inputs.places import study_file
from .inputs.reading import read
from .inputs.vocabulary import NOT_RUN
from .store.blocks import Store, count_statuses, inventory
from .store.clean import clean
from .work.cost import Estimate
from .work.plan import Report, belongs, check_countable, look, of_what
from .work.run import dry_run, partial_dataset, run


@dataclass(frozen=True, eq=False)
class Study:
    """A study file, checked, and the folder of its results.

    home : the folder from which `results` is, if it is relative; None: the working folder of each moment
    """

    definition: Definition
    results: Path
    home: Path | None = None

    def __repr__(self) -> str:
        return f'Study("{self.definition.name}", {self.definition.cases}, {self._store.path.as_posix()})'

    @property
    def _store(self) -> Store:
        return Store(self.definition, self._folder)

    @property
    def _folder(self) -> Path:
        """Folder of the results, short while the program is where it was when the study was loaded."""
        return self.results if self.home in (None, _working_folder()) else self.home / self.results

    def run(self, **options) -> Report:
        """Compute what is missing and write the results file; options as of `study.work.plan.Order`."""
        return run(self.definition, self._folder, command=command_line(), **options)

    def dry_run(self, workers: int | None = None, yes: bool = False, force: bool = False) -> Estimate:
        """What `run` would cost, how many cases it would find computed, and with which error it would end, if any.

        Computes a sample, writes nothing.

        Raises StudyError for a very large study of which something is on disk, unless `yes`: looking takes memory.
        """
        return dry_run(self.definition, self._folder, workers=workers, yes=yes, force=force)

    def status(self, yes: bool = False) -> dict:
        """State, cases, status -> number of cases, path of the results, what is wrong with them.

        With spreads a case counts as often as it is solved; of complete results the statuses are counted once for each.

        The state is "done", "outdated", "partial" or "new". For a results file that cannot be used it is "damaged",
        "foreign" (not written by roughcoat) or "unreadable", and `reason` says what is wrong. A file of up to 200 MB in
        memory is compared with its digest; `verify` compares a larger one too. Cases count as computed if they are in
        blocks. Raises StudyError for a very large study that is neither new nor done, unless `yes`: counting takes
        memory.
        """
        with suppress(FileNotFoundError):  # somebody removed the results meanwhile: look again
            return self._status(yes)
        return self._status(yes)

    def _status(self, yes: bool) -> dict:
        store = self._store
        found = look(store, LAZY)
        state = "outdated" if found.good else {"missing": "new"}.get(found.kind, found.kind)
        state = "done" if belongs(self.definition, found) else state
        counts = {}
        if state == "done":
            counts = count_statuses(statuses(store.path))
        elif state not in ("new", "outdated"):
            pass
        elif not check_countable(store, yes):
            counts = {NOT_RUN: self.definition.grid.size}
        else:
            known = inventory(store)
            counts = count_statuses(known.status)
            state = "partial" if state == "new" and len(known.missing) < len(known.keys) else state
        cases = self.definition.grid.size
        return {"state": state, "cases": cases, "counts": counts, "path": store.path, "reason": found.reason}

    def verify(self) -> Condition:
        """All of the results file against its digest, see `study.files.examine.Condition`."""
        return look(self._store)

    def clean(self) -> list[str]:
        """Remove blocks that hold no case of the study as it is; says which. Never touches results."""
        return clean(self._store)

    def open(self, partial: bool = False) -> xr.Dataset:
        """The results. Raises StudyError when there are none, none of this definition, or they are damaged.

        Any thread may open results, and read them, while others run studies.

        Results of more than 200 MB in memory are opened lazily, as dask arrays in chunks of some thousand cases.

        partial : give the blocks computed so far instead, with status 127 (not run) for the rest
        """
        path, found = self._store.path, look(self._store, LAZY)
        if belongs(self.definition, found):
            return opened(found)
        if partial:
            return partial_dataset(self.definition, self._folder)
        if found.good or found.kind == "missing":
            reason = f"holds results of {of_what(found)}" if found.good else "does not exist"
            raise StudyError([f"{path}: {reason}; run the study first"])
        again = "; run the study, which writes it again" if found.kind == "damaged" else ""
        raise Unusable(path, found.kind, found.reason + again)

    def plot(self, x: str, y: str, hue: str = "", **where):
        """A figure of the results, `y` against `x` with a curve for each `hue`: see `study.plot`."""
        from .figures.lines import plot  # matplotlib takes a while

        return plot(self.open(), x, y, hue, **where)


def load(path, results="results") -> Study:
    """Read and check a study file. Raises StudyError with all that is wrong with it.

    path : of the file, or the name of a study in studies/ or of one that comes with roughcoat, such as "dlc_on_steel"
    results : folder of the results, of the working folder as it is now, wherever the program goes later
    """
    return Study(read(study_file(path)), Path(os.path.expanduser(results)), _working_folder())


def _working_folder() -> Path | None:
    """None if it has been deleted."""
    try:
        return Path.cwd()
    except FileNotFoundError:
        return None

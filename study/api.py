"""`load` a study file; the `Study` runs, opens and examines its results."""

import os
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr

from .data.provenance import command_line
from .files.access import Unusable
from .files.examine import Condition, statuses
from .files.results_file import LAZY, opened
from .inputs.definition import Definition, StudyError
from .inputs.lexicon import with_known
from .inputs.places import study_file
from .inputs.reading import read
from .inputs.vocabulary import NOT_RUN
from .store.blocks import Store, count_statuses, inventory
from .store.clean import clean
from .store.parts import condition, is_large
from .work.cost import Estimate
from .work.large import dry_run_large, open_large, run_large, state_of
from .work.plan import Report, anything_there, belongs, look, of_what
from .work.run import dry_run, partial_dataset, run

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class Study:
    """A study file, checked, and the folder of its results.

    Attributes
    ----------
    definition : what the study computes
    results : folder of the results
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
    def _is_in_parts(self) -> bool:
        """Whether the results are a folder of parts; a file that a former version has made of them counts too."""
        return is_large(self.definition) and not belongs(self.definition, look(self._store, 0))

    @property
    def _folder(self) -> Path:
        """Folder of the results, short while the program is where it was when the study was loaded."""
        return self.results if self.home in (None, _working_folder()) else self.home / self.results

    def run(self, **options: Any) -> Report:
        """Compute what is missing and write the results file.

        Parameters
        ----------
        options : workers, scheduler, part, retry, fail_fast, force, yes, progress: as of `study.work.plan.Order`

        Returns
        -------
        Report : how many cases there are, how many were computed now and how they ended, and where the results are

        Raises
        ------
        StudyError : an option is wrong, or the results file that is there must not be replaced
        OSError : something cannot be written. Blocks that are finished are kept, and the next run goes on from there

        Examples
        --------
        `rc.load("studies/mine.toml").run(workers=4)`: docs/studies.md.
        """
        computing = run_large if self._is_in_parts else run
        return computing(self.definition, self._folder, command=command_line(), **options)

    def dry_run(self, workers: int | None = None, yes: bool = False, force: bool = False) -> Estimate:
        """What `run` would cost, how many cases it would find computed, and with which error it would end, if any.

        Computes a sample, writes nothing.

        Parameters
        ----------
        workers, force : as of `run`
        yes : changes nothing; it is there for programs that give it

        Returns
        -------
        Estimate : cases, seconds, bytes in memory and on disk
        """
        estimating = dry_run_large if self._is_in_parts else dry_run
        return estimating(self.definition, self._folder, workers=workers, force=force)

    def status(self, yes: bool = False) -> dict:
        """What has been computed.

        The state is "done", "outdated", "partial" or "new". For a results file that cannot be used it is "damaged",
        "foreign" (not written by roughcoat) or "unreadable", and `reason` says what is wrong; so it does of a large
        study if a part holds other cases than its name says, which then count as missing. A file of up to 200 MB in
        memory is compared with its digest; `verify` compares a larger one too. Cases count as computed if they are in
        blocks. With spreads a case counts as often as it is solved; of complete results the statuses are counted once
        for each.

        Parameters
        ----------
        yes : changes nothing; it is there for programs that give it

        Returns
        -------
        dict : "state", "cases", "counts" (status -> number of cases), "path" of the results, "reason"
        """
        with suppress(FileNotFoundError):  # somebody removed the results meanwhile: look again
            return self._status()
        return self._status()

    def _status(self) -> dict:
        store = self._store
        if self._is_in_parts:
            state, counts, reason = state_of(store)
            cases = self.definition.grid.size
            return {"state": state, "cases": cases, "counts": counts, "path": store.parts, "reason": reason}
        found = look(store, LAZY)
        state = "outdated" if found.good else {"missing": "new"}.get(found.kind, found.kind)
        state = "done" if belongs(self.definition, found) else state
        counts = {}
        if state == "done":
            counts = count_statuses(statuses(store.path))
        elif state not in ("new", "outdated"):
            pass
        elif not anything_there(store):
            counts = {NOT_RUN: self.definition.grid.size}
        else:
            known = inventory(store)
            counts = count_statuses(known.status)
            state = "partial" if state == "new" and len(known.missing) < len(known.keys) else state
        cases = self.definition.grid.size
        return {"state": state, "cases": cases, "counts": counts, "path": store.path, "reason": found.reason}

    def verify(self) -> Condition:
        """Compare all of the results file with its digest, and with the study: that it has these cases.

        Returns
        -------
        Condition : its `kind` is "sound" where nothing is wrong, else `reason` says what is: `study.files.examine`.
            It is "outdated" for undamaged results of another definition
        """
        if self._is_in_parts:
            return condition(self._store)
        found = look(self._store)
        if not found.good or belongs(self.definition, found):
            return found
        reason = f"nothing is damaged, but it holds results of {of_what(found, self.definition)}"
        return replace(found, kind="outdated", reason=reason)

    def clean(self) -> list[str]:
        """Remove blocks that hold no case of the study as it is. Never touches results.

        Returns
        -------
        list of str : lines that say what was removed, and what stays
        """
        return clean(self._store)

    def open(self, partial: bool = False) -> xr.Dataset:
        """The results.

        Any thread may open results, and read them, while others run studies. Results of more than 200 MB in memory are
        opened lazily, as dask arrays in chunks of some thousand cases.

        Parameters
        ----------
        partial : give the blocks computed so far instead, with status 127 (not run) for the rest

        Returns
        -------
        xarray.Dataset : as `study.solve` gives it

        Raises
        ------
        StudyError : there are none, none of this definition, or they are damaged
        """
        grid = self.definition.grid  # its laws and tables are those of the results
        values = {name: array for name, (_, array) in grid.values.items()}
        return with_known(self._opened(partial), grid.lexicon, values)

    def _opened(self, partial: bool) -> xr.Dataset:
        if self._is_in_parts:
            return open_large(self._store)
        path, found = self._store.path, look(self._store, LAZY)
        if belongs(self.definition, found):
            return opened(found)
        if partial:
            return partial_dataset(self.definition, self._folder)
        if found.good or found.kind == "missing":
            reason = f"holds results of {of_what(found, self.definition)}" if found.good else "does not exist"
            raise StudyError([f"{path}: {reason}; run the study first"])
        again = "; run the study, which writes it again" if found.kind == "damaged" else ""
        raise Unusable(path, found.kind, found.reason + again)

    def plot(self, x: str, y: str, hue: str = "", **where: Any) -> "Figure":
        """A figure of the results: see `study.plot`.

        Parameters
        ----------
        x, y, hue, where : as of `study.plot`

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        StudyError : there are no results, or what `study.plot` raises
        """
        from .figures.plots import plot

        return plot(self.open(), x, y, hue, **where)


def load(path: str | os.PathLike, results: str | os.PathLike = "results") -> Study:
    """Read and check a study file.

    Parameters
    ----------
    path : of the file, or the name of a study in studies/ or of one that comes with roughcoat, such as "dlc_on_steel"
    results : folder of the results, of the working folder as it is now, wherever the program goes later

    Returns
    -------
    Study

    Raises
    ------
    StudyError : the file is not there, or has mistakes: all of them, a line each

    Examples
    --------
    >>> load("main_case")
    Study("main_case", 6 cases (case 6), results/main_case.nc)
    """
    return Study(read(study_file(path)), Path(os.path.expanduser(results)), _working_folder())


def _working_folder() -> Path | None:
    """None if it has been deleted."""
    try:
        return Path.cwd()
    except FileNotFoundError:
        return None

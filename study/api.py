"""`load` a study file; the `Study` runs, opens and examines its results."""

import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr

from .data.provenance import command_line
from .files.examine import Condition
from .inputs.definition import Definition
from .inputs.lexicon import with_known
from .inputs.places import study_file
from .inputs.reading import read
from .scan_laws.words import with_rows
from .store.clean import clean
from .store.window_files import glance, verified
from .store.windows import Store
from .work.cost import Estimate
from .work.plan import Report
from .work.progress import screen_of
from .work.run import dry_run, run

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
        return run(self._ready(options), self._folder, command=command_line(), **options)

    def _ready(self, options: dict[str, Any]) -> Definition:
        """The definition, with the laws of its scans where a case may have to be computed."""
        if not self.definition.scans or (not options.get("retry") and self.status()["state"] == "done"):
            return self.definition
        return with_rows(self.definition, options.get("stream") or screen_of(options.get("progress")))

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
        return dry_run(self._ready({}), self._folder, workers=workers, force=force)

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
            return glance(self._store).summary()
        return glance(self._store).summary()

    def verify(self) -> Condition:
        """Compare all of the results file with its digest, and with the study: that it has these cases.

        Returns
        -------
        Condition : its `kind` is "sound" where nothing is wrong, else `reason` says what is: `study.files.examine`.
            It is "outdated" for undamaged results of another definition
        """
        return verified(self._store).verdict()

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
        state = glance(self._store)
        partly = partial and state.is_one and not state.is_complete
        return with_known(state.partial() if partly else state.opened(), grid.lexicon, values)

    def plot(self, x: str, y: str, hue: str = "", **where: Any) -> "Figure":
        """A figure of the results: see `study.plot`.

        Parameters
        ----------
        x, y, hue, where : as of `study.plot`; so are colour, scale and limits

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

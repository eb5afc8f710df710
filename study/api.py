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
from .store.blocks import laws_in
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
    home : the folder to which `results` is relative, if it is; None: the working folder at the time of the call

    Examples
    --------
    >>> import study
    >>> study.load("main_case").definition.title
    "The paper's main case: rough and smooth, layered (thin and exact) and homogeneous"
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
        """Folder of the results: a short path as long as the working folder is the one where the study was loaded."""
        return self.results if self.home in (None, _working_folder()) else self.home / self.results

    def run(self, **options: Any) -> Report:
        """Compute what is missing and write the results file.

        Parameters
        ----------
        options : workers, scheduler, part, retry, fail_fast, force, yes, progress: see `study.work.plan.Order`

        Returns
        -------
        Report : how many cases there are, how many were computed now and how they ended, and where the results are

        Raises
        ------
        StudyError : an option is wrong, or there is a results file that must not be replaced
        OSError : something cannot be written. Finished blocks are kept, and the next run goes on from there

        Examples
        --------
        >>> import tempfile, study
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     report = study.load("reference_load", results=folder).run()
        >>> report.cases, report.computed
        (1, 1)
        """
        return run(self._ready(options), self._folder, command=command_line(), **options)

    def _ready(self, options: dict[str, Any]) -> Definition:
        """The definition, with the laws of its scans where a case may have to be computed."""
        if not self.definition.scans or (not options.get("retry") and self.status()["state"] == "done"):
            return self.definition
        stream = options.get("stream") or screen_of(options.get("progress"))
        return with_rows(self.definition, stream, laws_in(self._store))

    def dry_run(self, workers: int | None = None, yes: bool = False, force: bool = False) -> Estimate:
        """The cost of `run`, the number of cases that it would find computed, and the error in which it would end.

        Computes a sample, writes nothing.

        Parameters
        ----------
        workers, force : as for `run`
        yes : has no effect; it exists for programs that pass it

        Returns
        -------
        Estimate : cases, seconds, bytes in memory and on disk

        Examples
        --------
        >>> import study
        >>> estimate = study.load("main_case", results="of_an_example").dry_run()
        >>> estimate.cases, estimate.present
        (6, 0)
        """
        return dry_run(self._ready({}), self._folder, workers=workers, force=force)

    def status(self, yes: bool = False) -> dict:
        """The state of the results, and how many cases have been computed.

        The state is "done", "outdated", "partial" or "new". For a results file that cannot be used it is "damaged",
        "foreign" (not written by roughcoat) or "unreadable", and `reason` says what is wrong. `reason` also tells if a
        part of a large study does not hold the cases in its name; these cases count as missing. A file of up to 200 MB
        in memory is compared with its digest; `verify` compares larger files too. Cases in blocks count as computed.
        With spreads a case counts as often as it is solved, but complete results count the status of each case once.

        Parameters
        ----------
        yes : has no effect; it exists for programs that pass it

        Returns
        -------
        dict : "state", "cases", "counts" (status -> number of cases), "path" of the results, "reason"

        Examples
        --------
        >>> import study
        >>> study.load("main_case", results="of_an_example").status()["state"]
        'new'
        """
        with suppress(FileNotFoundError):  # somebody removed the results meanwhile: look once more
            return glance(self._store).summary()
        return glance(self._store).summary()

    def verify(self) -> Condition:
        """Compare the whole results file with its digest, and its cases with those of the study.

        Returns
        -------
        Condition : its `kind` is "sound" if nothing is wrong, otherwise `reason` says what is: `study.files.examine`.
            It is "outdated" for undamaged results of another definition

        Examples
        --------
        >>> import study
        >>> study.load("main_case", results="of_an_example").verify().kind
        'missing'
        """
        return verified(self._store).verdict()

    def clean(self) -> list[str]:
        """Remove blocks that hold no case of the study as it is now. Never touches results.

        Returns
        -------
        list of str : lines that say what was removed, and what stays

        Examples
        --------
        >>> import study
        >>> study.load("main_case", results="of_an_example").clean()
        ['of_an_example/.main_case.blocks: is not there, nothing to remove']
        """
        from .store.clean import clean

        return clean(self._store)

    def open(self, partial: bool = False) -> xr.Dataset:
        """The results.

        Any thread may open results, and read them, while others run studies. Results of more than 200 MB in memory are
        opened lazily, as dask arrays in chunks of some thousand cases.

        Parameters
        ----------
        partial : open the blocks computed so far if the results are incomplete; the other cases have status 127, not
            run

        Returns
        -------
        xarray.Dataset : as `study.solve` gives it

        Raises
        ------
        StudyError : there are no results of this definition, or they are damaged

        Examples
        --------
        >>> import tempfile, study
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     reference = study.load("reference_load", results=folder)
        ...     _ = reference.run()
        ...     contacts = reference.open()
        >>> print(f"{contacts.P.item():.4g}")
        2.704e-05
        """
        grid = self.definition.grid  # it has the laws and tables of the results
        values = {name: array for name, (_, array) in grid.values.items()}
        state = glance(self._store)
        partly = partial and state.is_one and not state.is_complete
        return with_known(state.partial() if partly else state.opened(), grid.lexicon, values)

    def plot(self, x: str, y: str, hue: str = "", **where: Any) -> "Figure":
        """A figure of the results: see `study.plot`.

        Parameters
        ----------
        x, y, hue, where : as for `study.plot`, with colour, scale and limits

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        StudyError : there are no results, or `study.plot` raises it

        Examples
        --------
        >>> import pathlib, tempfile, study
        >>> lines = ["[model]", 'base = "half_space"', 'micro = "smooth"', "[axes]", "P = [1e-5, 2e-5]"]
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     file = pathlib.Path(folder, "loads.toml")
        ...     _ = file.write_text("\\n".join(lines))
        ...     loads = study.load(file, results=folder)
        ...     _ = loads.run()
        ...     figure = loads.plot(x="P", y="a")
        >>> len(figure.axes)
        1
        """
        from .figures.plots import plot

        return plot(self.open(), x, y, hue, **where)


def load(path: str | os.PathLike, results: str | os.PathLike = "results") -> Study:
    """Read and check a study file.

    Parameters
    ----------
    path : path of the file, or the name of a study in studies/ or of one that comes with roughcoat: "dlc_on_steel"
    results : folder of the results, relative to the working folder of this call, even if the program changes it later

    Returns
    -------
    Study

    Raises
    ------
    StudyError : the file does not exist, or has mistakes: a line for each

    Examples
    --------
    >>> load("main_case")
    Study("main_case", 6 cases (case 6), results/main_case.nc)
    """
    return Study(read(study_file(path)), Path(os.path.expanduser(results)), _working_folder())


def _working_folder() -> Path | None:
    """The working folder; None if it has been deleted."""
    try:
        return Path.cwd()
    except FileNotFoundError:
        return None

"""The public functions: `solve` for a grid given in Python, `load` for a study file."""

from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from .blocks import Blocks, compute, finished
from .dataset import command_line, digest_in, labelled, open_results
from .definition import BLOCK, POINTS, Definition, StudyError, complete, read
from .draft import Draft
from .grid import LONGEST_AXIS
from .run import Report, partial_dataset, results_path, run


def solve(*, cases=None, x=POINTS, profiles: bool = True, title: str = "", **parameters) -> xr.Dataset:
    """Solve the contact problem on a grid and return a labelled dataset.

    Parameters
    ----------
    **parameters : exactly one of P, a, D, and any of h, n, nu1, nu2, bonding, base, Nbar, Ra, micro, B, beta, scheme,
        k, rtol, nodes, max_iterations, all dimensionless (see study.vocabulary). Each a scalar, a 1-D sequence (which
        makes a dimension of that name, in the order given) or a DataArray over dimensions of its own.
    cases : list of dictionaries of parameters (and `label`): points that are not a product, the dimension `case`,
        which comes first
    x : number of points r/a of the profiles, or the points, from 0 to 1
    profiles : whether the dataset holds p and lam

    Returns
    -------
    xarray.Dataset over the dimensions of the grid and `x`. A failed case has NaN and its reason in `status`; nothing
    is raised for it.

    Raises
    ------
    StudyError : a ValueError with every message, for input that cannot be used

    Examples
    --------
    >>> import study
    >>> found = study.solve(P=[1e-5, 2e-5], micro="smooth", base="half_space")
    >>> found.a.sel(P=2e-5).round(5).item()
    0.02466
    """
    draft = Draft()
    if cases is not None:
        draft.cases(cases)
    for name, given in parameters.items():
        _add(draft, name, given)
    whole = {"name": "solve", "kind": "contact", "title": title, "text": "", "fit": {}, "block": BLOCK}
    definition = complete(draft, "solve", x=x, profiles=profiles, **whole)
    return labelled(definition, compute(definition, 0, definition.grid.size), "study.solve")


@dataclass(frozen=True, eq=False)
class Study:
    """A study file, checked, and the folder of its results."""

    definition: Definition
    results: Path

    def run(self, *, workers: int | None = None, force: bool = False, stream=None) -> Report:
        """Compute what is missing and write the results file; see `study.run.run`."""
        return run(self.definition, self.results, workers=workers, force=force, command=command_line(), stream=stream)

    def status(self) -> dict:
        """State ("done", "outdated", "partial", "new"), cases, blocks finished and in all, path of the results."""
        blocks, path = Blocks(self.definition, self.results), results_path(self.definition, self.results)
        ready = len(finished(blocks))
        state = "partial" if ready else "new"
        if path.exists():
            state = "done" if digest_in(path) == self.definition.digest else "outdated"
        return {"state": state, "cases": self.definition.grid.size, "blocks": ready, "of": blocks.count, "path": path}

    def open(self, partial: bool = False) -> xr.Dataset:
        """The results. Raises StudyError when there are none, or none of this definition.

        partial : give the blocks computed so far instead, with status 127 (not run) for the rest
        """
        path, state = results_path(self.definition, self.results), self.status()["state"]
        if state == "done":
            return open_results(path)
        if partial and self.definition.kind == "contact":
            return partial_dataset(self.definition, self.results)
        reason = "holds results of another definition" if state == "outdated" else "does not exist"
        raise StudyError([f"{path}: {reason}; run the study first"])


def load(path, results="results") -> Study:
    """Read and check a study file. Raises StudyError with all that is wrong with it."""
    return Study(read(path), Path(results))


def _add(draft: Draft, name: str, given) -> None:
    """Sort a parameter of `solve` by its form: DataArray, 1-D sequence, scalar."""
    if isinstance(given, xr.DataArray):
        draft.array(name, given)
        return
    if hasattr(given, "tolist"):  # numpy and pandas
        given = given.tolist()
    if isinstance(given, (list, tuple, range)):
        draft.axis(name, list(given[: LONGEST_AXIS + 1]), "")  # a range may be endless
    else:
        draft.scalar(name, given, "")

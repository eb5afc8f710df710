"""The public functions: `solve` for a grid given in Python, `load` for a study file."""

import os
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from .data.dataset import parts
from .data.provenance import command_line
from .files.access import Unusable
from .files.examine import Condition
from .files.results_file import open_lazily, open_results
from .in_words import doubts
from .physical.reading import read as read_scene
from .physical.scene import shown
from .physical.study_file import complete as complete_scene
from .physical.study_file import read
from .spec.definition import LARGE, POINTS, Definition, StudyError, complete
from .spec.given import Draft
from .spec.vocabulary import NOT_RUN
from .store.blocks import Store, count_statuses, inventory
from .store.earlier import earlier, statuses
from .store.tidy import clean
from .work.cases import compute, parcel
from .work.cost import Estimate
from .work.plan import Report, belongs, check_countable, look, results_path
from .work.run import dry_run, partial_dataset, run

LAZY = 200_000_000  # bytes of a results file that is not read at once


def solve(*, cases=None, x=POINTS, profiles=True, title: str = "", **parameters) -> xr.Dataset:
    """Solve the contact problem on a grid and return a labelled dataset.

    Parameters
    ----------
    **parameters : exactly one of P, a, D, and any of h, n, m, nu1, nu2, bonding, base, Nbar, Ra, micro, B, beta,
        sigma, cut, scheme, k, rtol, accuracy, model_check, nodes, max_iterations, all dimensionless (see
        study.vocabulary), and those of registered laws. Each a scalar, a 1-D sequence (which makes a dimension of that
        name, in the order given) or a DataArray over dimensions of its own. `micro` may be a `solver.laws.Law` itself
        (docs/extending.md), or "table:" and the path of a CSV file.
        Or physical: R (or R1 and R2 of two bodies, R = 1/(1/R1 + 1/R2), a cup negative), E1, E2, E_punch (Young's
        moduli of layer, body and punch; a punch without is rigid, and so is a body of E2 = "rigid"), nu_punch (0.3),
        and the others as texts with units ("5 mm", "200 ± 10 GPa"), as quantities of pint, or as DataArrays with an
        attribute `units`. n and m follow from the moduli. One without a unit is refused.
    cases : list of dictionaries of parameters (and `label`): points that are not a product, the dimension `case`,
        which comes first
    x : number of points r/a of the profiles, or the points, from 0 to 1
    profiles : whether the dataset holds p and lam, or a list of those that it shall hold
    title : of the dataset

    Returns
    -------
    xarray.Dataset over the dimensions of the grid and `x`. A failed case has NaN and its reason in `status`; nothing
    is raised for it. Physical parameters make physical results, in SI units, and `NAME_spread` where inputs have
    spreads: one standard deviation, to first order. `study.summary` says it in words. A warning tells of cases that
    violate an assumption of the model.

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
    rows = [row for row in cases if isinstance(row, dict)] if isinstance(cases, list) else []
    draft = Draft()
    draft.laws([given.get("micro") for given in (parameters, *rows)])
    scene = read_scene(parameters, cases)
    about = {"title": title, "output": {"x": x, "profiles": profiles}}, "solve", "", "solve"
    if scene:
        definition = complete_scene(draft, scene, [], about, most=LARGE)
    else:
        if cases is not None:
            draft.cases(cases)
        for name, given in parameters.items():
            draft.of_any_form(name, given)
        definition = complete(draft, *about, LARGE)
    arrays = compute(parcel(definition, np.arange(definition.grid.size)))
    found = shown(definition, parts(definition, arrays, "study.solve"))
    if not scene:
        return found
    beyond = doubts(found)
    if beyond:
        warnings.warn("\n".join(["this contact is beyond what the model describes:", *beyond]), stacklevel=2)
    return found


@dataclass(frozen=True, eq=False)
class Study:
    """A study file, checked, and the folder of its results."""

    definition: Definition
    results: Path

    def run(self, **options) -> Report:
        """Compute what is missing and write the results file; options as of `study.work.plan.Order`."""
        return run(self.definition, self.results, command=command_line(), **options)

    def dry_run(self, workers: int | None = None, yes: bool = False) -> Estimate:
        """What `run` would cost, and how many cases it would find computed. Computes a sample, writes nothing.

        Raises StudyError for a very large study of which something is on disk, unless `yes`: looking takes memory.
        """
        return dry_run(self.definition, self.results, workers=workers, yes=yes)

    def status(self, yes: bool = False) -> dict:
        """State, cases, status -> number of cases, path of the results, what is wrong with them.

        The state is "done", "outdated", "partial" or "new", or of a results file that cannot be used "damaged",
        "foreign" (none of ours) or "unreadable"; then `reason` says what is wrong. Attributes, coordinates and statuses
        are verified, the other numbers are by `verify`. Cases of an outdated results file that a run would use again
        count as computed; so do those in blocks. Raises StudyError for a very large study that is neither new nor
        done, unless `yes`: counting takes memory.
        """
        path = results_path(self.definition, self.results)
        found = look(self.definition, path, ("status",))
        state = "outdated" if found.good else {"missing": "new"}.get(found.kind, found.kind)
        state = "done" if belongs(self.definition, found) else state
        counts = {}
        if state == "done":
            counts = count_statuses(statuses(path))
        elif state not in ("new", "outdated"):
            pass
        elif not check_countable(Store(self.definition, self.results), path, yes):
            counts = {NOT_RUN: self.definition.grid.size}
        else:
            known = inventory(Store(self.definition, self.results), earlier(self.definition, found).source)
            counts = count_statuses(known.status)
            state = "partial" if state == "new" and len(known.missing) < len(known.keys) else state
        return {
            "state": state, "cases": self.definition.grid.size, "counts": counts, "path": path, "reason": found.reason
        }  # fmt: skip

    def verify(self) -> Condition:
        """All of the results file against its checksums, see `study.files.examine.Condition`."""
        return look(self.definition, results_path(self.definition, self.results))

    def clean(self) -> list[str]:
        """Remove blocks that do not serve the study as it is; says which. Never touches results."""
        found = look(self.definition, results_path(self.definition, self.results))
        return clean(Store(self.definition, self.results), belongs(self.definition, found))

    def open(self, partial: bool = False) -> xr.Dataset:
        """The results. Raises StudyError when there are none, none of this definition, or they are damaged.

        Any thread may open results, and read them, while others run studies.

        A large file is opened lazily, its variables are dask arrays in chunks of some thousand cases; others are read.

        partial : give the blocks computed so far instead, with status 127 (not run) for the rest
        """
        path = results_path(self.definition, self.results)
        found = look(self.definition, path, ())
        if belongs(self.definition, found):
            return open_lazily(path) if path.stat().st_size > LAZY else open_results(path)
        if partial:
            return partial_dataset(self.definition, self.results)
        if found.good or found.kind == "missing":
            reason = "holds results of another definition" if found.good else "does not exist"
            raise StudyError([f"{path}: {reason}; run the study first"])
        again = "; run the study, which computes again what is damaged" if found.kind == "damaged" else ""
        raise Unusable(path, found.kind, found.reason + again)


def load(path, results="results") -> Study:
    """Read and check a study file. Raises StudyError with all that is wrong with it."""
    return Study(read(os.path.expanduser(path)), Path(os.path.expanduser(results)))

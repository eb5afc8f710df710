"""Run a study: missing cases -> blocks -> workers -> one writer -> results file. What is on disk is the progress."""

import logging
import secrets
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr

from . import micro_law
from .blocks import Failure, cut, guarded, parcel
from .case_key import find
from .cluster import as_they_come, engine
from .dataset import digest_in, labelled, status_words, write
from .definition import LARGE, Definition, StudyError
from .estimate import Estimate, describe, estimate
from .join import write_results
from .lock import held
from .progress import Progress
from .reuse import adopt, check_replaceable, earlier, statuses
from .store import Inventory, Store, add, count_statuses, discard, gather, inventory

log = logging.getLogger(__name__)
WHOLE = (1, 1)


class CannotWrite(StudyError):
    """The study is right, the place for its results is not."""

    code = 1


@dataclass(frozen=True)
class Report:
    """What a run did.

    computed : cases computed now; failures : number of the block -> reason; counts : status -> number of cases, empty
    when there was nothing to do; path : written if `complete`, otherwise cases failed or belong to other parts
    """

    path: Path
    cases: int
    computed: int
    failures: dict[int, str]
    counts: dict[int, int]
    complete: bool


def results_path(definition: Definition, results) -> Path:
    return Path(results) / f"{definition.name}.nc"


def run(
    definition: Definition,
    results="results",
    *,
    workers: int | None = None,
    scheduler: str = "",
    part: tuple[int, int] = WHOLE,
    retry: tuple[int, ...] = (),
    fail_fast: bool = False,
    force: bool = False,
    yes: bool = False,
    command: str = "",
    stream=None,
) -> Report:
    """Compute what is missing and write results/NAME.nc.

    Parameters
    ----------
    workers, scheduler : see `cluster.engine`; part : (i, n), only the i-th of n parts, whichever ends last writes the
        results; retry : compute cases of these statuses again; fail_fast : stop at the first block that raises or holds
        a case that has not converged; force : replace a results file of which cases would be lost; yes : go on however
        large the study is; stream : text stream for progress

    Raises
    ------
    StudyError : the folder cannot be written, or holds results that would be lost, or no scheduler answers; nothing has
        been computed then.
    OSError : writing failed later (a full disk), or the scheduler is lost; blocks written so far stay and are used by
        the next run.
    """
    store, path, shared = Store(definition, Path(results)), results_path(definition, results), part != WHOLE
    nothing = Report(path, definition.grid.size, 0, {}, {}, True)
    if up_to_date(definition, path, retry):
        if store.folder.exists():
            with held(store.lock, wait=False) as alone:
                if alone:
                    discard(store)  # left behind when a run was killed between its last two steps
        return nothing
    check_writable(path)
    check_size(definition, workers, yes)
    with held(store.lock, shared=shared, waiting=lambda: say_waiting(definition.name, stream)):
        if up_to_date(definition, path, retry):  # by the run that this one has waited for
            discard(store)
            return nothing
        if definition.kind == "micro_law":
            write(micro_law.compute(definition, command), path)
            discard(store)
            return replace(nothing, computed=definition.grid.size)
        known = prepared(store, path, retry, force)
        blocks = cut(known.missing, definition.block, part)
        missing = len(known.missing)
        failures = compute_blocks(store, known, blocks, engine(workers, scheduler), fail_fast, stream)
        report = Report(
            path, definition.grid.size, missing - len(known.missing), failures, count_statuses(known.status), False
        )
        if not shared:
            return finished(store, known, report, command)
    with held(store.lock, wait=False) as alone:  # the last part to end finds nobody else there
        return finished(store, inventory(store), report, command) if alone else report


def up_to_date(definition: Definition, path: Path, retry: tuple[int, ...]) -> bool:
    """Whether the results are there already, and hold no case of a status in `retry`."""
    return digest_in(path) == definition.digest and not (retry and np.isin(statuses(path), retry).any())


def check_writable(path: Path) -> None:
    """Raise CannotWrite when the folder of the results cannot be made or written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        probe = path.with_name(f".{path.name}.{secrets.token_hex(4)}.probe")
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise CannotWrite([f"{path.parent}: cannot be written: {error.strerror}"]) from None


def check_size(definition: Definition, workers: int | None, yes: bool) -> None:
    """Raise StudyError for a study so large that it may be a slip, with what it would cost."""
    if definition.numbers > LARGE and not yes:
        cost = describe(estimate(definition, workers))
        raise StudyError([f"{definition.name}: {definition.grid.size} cases: {cost}; --yes computes them"])


def say_waiting(name: str, stream) -> None:
    if stream:
        stream.write(f"{name}: another run of this study is at work; waiting for its end\n")
        stream.flush()


def prepared(store: Store, path: Path, retry: tuple[int, ...], force: bool) -> Inventory:
    """What is on disk, cases of an earlier results file included. Raises StudyError when these would be lost."""
    known, found = inventory(store, retry, force), earlier(store.definition, path)
    if found is None:
        return known
    if not force:
        check_replaceable(store, found, known.keys)
    adopt(store, known, found, retry)
    return inventory(store, retry)


def finished(store: Store, known: Inventory, report: Report, command: str) -> Report:
    """Write the results if no case is missing."""
    if len(known.missing):
        return replace(report, counts=count_statuses(known.status))
    write_results(store, known, report.path, command)
    discard(store)
    return replace(report, counts=count_statuses(known.status), complete=True)


def compute_blocks(
    store: Store, known: Inventory, blocks: list[np.ndarray], engine, fail_fast: bool, stream
) -> dict[int, str]:
    """Compute and store the blocks; returns the failures. A block that raises costs that block only."""
    failures = {}
    if not blocks:
        return failures
    size, words = store.definition.grid.size, status_words()
    progress = Progress(store.definition.name, size, stream, size - len(known.missing)) if stream else None
    try:
        with engine as workers:
            tasks = (parcel(store.definition, index) for index in blocks)
            for number, result in as_they_come(workers, guarded, tasks):
                if isinstance(result, Failure):
                    failures[number] = result.message
                    log.debug("block %d: %s", number, result.trace)
                else:
                    add(store, known, blocks[number], result)
                    unsolved = np.flatnonzero(result["status"])
                    if progress:
                        progress.update(len(result["status"]), len(unsolved))
                    if fail_fast and len(unsolved):
                        first = unsolved[0]
                        failures[number] = f"case {blocks[number][first]}: {words[int(result['status'][first])]}"
                if fail_fast and failures:
                    break
    finally:
        if progress:
            progress.close()
    return failures


def dry_run(definition: Definition, results="results", *, workers: int | None = None) -> Estimate:
    """What `run` would cost, and how many cases it would find computed. Writes nothing."""
    store, path = Store(definition, Path(results)), results_path(definition, results)
    if definition.kind == "micro_law" or up_to_date(definition, path, ()):
        return estimate(definition, workers, definition.grid.size)
    known, found = inventory(store), earlier(definition, path)
    present = known.file >= 0
    if found and found.keys is not None:
        present |= find(known.keys, found.keys, np.zeros(len(found.keys))) >= 0
    return estimate(definition, workers, int(np.count_nonzero(present)))


def partial_dataset(definition: Definition, results) -> xr.Dataset:
    """The grid with the blocks computed so far; the rest is NaN with status 127, not run."""
    store = Store(definition, Path(results))
    return labelled(definition, gather(store, inventory(store), 0, definition.grid.size), "partial results")

"""Run a study: missing blocks -> workers -> one writer -> join -> results file. What is on disk is the progress."""

import logging
import os
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import dask.threaded
import numpy as np
import xarray as xr
from dask.callbacks import Callback

from . import micro_law
from .blocks import Blocks, bounds, compute, discard, finished, join, store
from .dataset import digest_in, labelled, write
from .definition import Definition, StudyError
from .progress import Progress

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Report:
    """What a run did. failures: block -> reason; counts: status -> number of cases; path: written if nothing failed."""

    path: Path
    cases: int
    computed: int
    failures: dict[int, str]
    counts: dict[int, int]


@dataclass(frozen=True)
class Failure:
    """A block that raised: the message and where."""

    message: str
    trace: str


def results_path(definition: Definition, results) -> Path:
    return Path(results) / f"{definition.name}.nc"


def run(
    definition: Definition,
    results="results",
    *,
    workers: int | None = None,
    force: bool = False,
    command: str = "",
    stream=None,
) -> Report:
    """Compute what is missing and write results/NAME.nc.

    Parameters
    ----------
    workers : threads, default one per processor; force : replace a results file of another definition; stream : text
        stream for progress

    Raises
    ------
    StudyError : the folder cannot be written, or holds a results file of another study; nothing has been computed then.
    OSError : writing failed later (a full disk); blocks written so far stay and are used by the next run.
    """
    path, blocks = results_path(definition, results), Blocks(definition, Path(results))
    if prepare(definition, path, force):
        discard(blocks)  # left behind when a run was killed between its last two steps
        return Report(path, definition.grid.size, 0, {}, {})
    if definition.kind == "micro_law":
        write(micro_law.compute(definition, command), path)
        return Report(path, definition.grid.size, definition.grid.size, {}, {})
    present = finished(blocks)
    todo = sorted(set(range(blocks.count)) - set(present))
    progress = Progress(definition.name, definition.grid.size, stream, cases_in(blocks, present)) if stream else None
    try:
        failures = compute_blocks(blocks, todo, workers or available_workers(), progress)
    finally:
        if progress:
            progress.close()
    arrays, absent = join(blocks)
    failures |= {i: "the block on disk cannot be read; run again to compute it" for i in absent if i not in failures}
    if not failures:
        write(labelled(definition, arrays, command), path)
        discard(blocks)
    values, numbers = np.unique(arrays["status"], return_counts=True)
    counts = dict(zip(values.tolist(), numbers.tolist(), strict=True))
    return Report(
        path, definition.grid.size, cases_in(blocks, [i for i in todo if i not in failures]), failures, counts
    )


def cases_in(blocks: Blocks, chosen: list[int]) -> int:
    """Number of cases in some blocks."""
    return sum(stop - start for start, stop in (bounds(blocks, i) for i in chosen))


def prepare(definition: Definition, path: Path, force: bool) -> bool:
    """Whether the results are there already. Raises StudyError when they cannot or must not be written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        probe = path.with_name(f".{path.name}.{os.getpid()}.probe")
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise StudyError([f"{path.parent}: cannot be written: {error.strerror}"]) from None
    if not path.exists():
        return False
    found = digest_in(path)
    if found != definition.digest and not force:
        owner = f"another definition (digest {found[:8]})" if found else "no study known here"
        choice = "--force replaces them, --results DIR writes elsewhere"
        raise StudyError([f"{path}: holds results of {owner}, not of this one ({definition.digest[:8]}): {choice}"])
    return found == definition.digest


def partial_dataset(definition: Definition, results) -> xr.Dataset:
    """The grid with the blocks computed so far; the rest is NaN with status 127, not run."""
    arrays, _ = join(Blocks(definition, Path(results)))
    return labelled(definition, arrays, "partial results")


def available_workers() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def compute_blocks(blocks: Blocks, todo: list[int], workers: int, progress: Progress | None) -> dict[int, str]:
    """Compute and store the blocks; returns the failures. A block that raises costs that block only."""
    failures = {}

    def finish(i: int, result) -> None:
        if isinstance(result, Failure):
            failures[i] = result.message
            log.debug("block %d: %s", i, result.trace)
            return
        store(blocks, i, result)
        if progress:
            progress.update(len(result["status"]), int(np.count_nonzero(result["status"])))

    tasks = {i: partial(guarded, blocks.definition, *bounds(blocks, i)) for i in todo}
    if len(tasks) == 1 or workers == 1:
        for i, task in tasks.items():
            finish(i, task())
    elif tasks:
        with written_as_they_come(finish):
            dask.threaded.get({i: (task,) for i, task in tasks.items()}, list(tasks), num_workers=workers)
    return failures


def guarded(definition: Definition, start: int, stop: int):
    """`compute`, with an exception as a value."""
    try:
        return compute(definition, start, stop)
    except Exception as error:
        return Failure(f"cases {start} to {stop - 1}: {type(error).__name__}: {error}", traceback.format_exc())


@contextmanager
def written_as_they_come(finish: Callable) -> Iterator[None]:
    """Hand each result of dask to `finish(key, result)` in this thread, then forget it: memory stays bounded."""

    def posttask(key, result, _graph, state, _worker):
        state["cache"][key] = None
        finish(key, result)

    with Callback(posttask=posttask):
        yield

"""Run a study: missing cases -> blocks -> workers -> blocks on disk -> results file."""

import logging
from collections.abc import Iterator
from contextlib import closing, nullcontext
from dataclasses import replace
from pathlib import Path

import xarray as xr

from ..data.dataset import failed_cases, parts, status_words
from ..data.si import dataset_of
from ..files.atomic import target
from ..files.examine import Condition, stamp
from ..files.lock import held
from ..inputs.definition import Definition, StudyError
from ..store.blocks import Inventory, Store, add, gather, inventory, remove_litter
from ..store.earlier import check_replaceable, earlier
from ..store.tidy import tidy, withdraw
from ..store.writer import writing
from ..terminal import say
from .cases import Failure, blocks_of, can_travel, guarded, parcel
from .cost import Estimate, estimate
from .plan import Order, Report, check_countable, check_size, check_writable, look
from .progress import Progress
from .screen import screen_of
from .workers import as_they_come, engine

log = logging.getLogger(__name__)


def run(definition: Definition, results="results", **options) -> Report:
    """Compute what is missing and write results/NAME.nc. `options` as of `Order`.

    Raises StudyError when the folder cannot be written, or holds results that would be lost, or no scheduler answers;
    nothing has been computed or written then. Raises OSError when writing failed later (a full disk), or the scheduler
    is lost; blocks written so far stay and are used by the next run.
    """
    order = Order(definition, Path(results), **options)
    found = look(order.store)
    if order.done(found):
        if order.store.folder.exists():  # a run was killed before it removed its blocks, or other blocks are there
            return _finish_if_last(order, order.report())
        return order.report()
    check_size(order)
    made = [folder for folder in (order.store.folder, order.results) if not folder.exists()]
    check_writable(order.store.path)
    try:
        with held(order.store.lock, shared=order.shared, waiting=lambda: say_waiting(order)):
            if stamp(order.store.path) != found.seen:  # the run for which this one has waited has written it
                found = look(order.store)
            report = _compute(order, found)
        return _finish_if_last(order, report) if order.shared else report
    except StudyError:
        if made:
            withdraw(order.store, made)
        raise
    except FileNotFoundError:
        if order.done(look(order.store)):  # on a file system without locks another run has ended and removed the blocks
            return order.report()
        raise


def _compute(order: Order, found: Condition) -> Report:
    """Compute what is missing, and write the results unless other runs compute other parts."""
    if order.done(found):
        return order.report(kept=tidy(order.store))
    if found.kind == "damaged":
        kept = f"computing again what is damaged, {target(order.store.path)}.damaged keeps it"
        log.warning("%s: %s; %s", order.store.path, found.reason, kept)
    known = prepared(order, found)
    missing = len(known.missing)
    writer = nullcontext(iter(())) if order.shared else closing(writing(order.store, known, order.command, found))
    with writer as steps:
        failures = compute_blocks(order, known, steps)
        kept = "" if order.shared else _finish(order, known, steps)
    return order.report(known, computed=missing - len(known.missing), failures=failures, kept=kept)


def _finish_if_last(order: Order, report: Report) -> Report:
    """If no other run holds the lock, this one is the last of several: it writes the results and removes the blocks."""
    with held(order.store.lock, wait=False) as alone:
        if not alone:
            return report
        found = look(order.store)
        if order.done(found):
            return replace(report, complete=True, kept=tidy(order.store))
        known = prepared(replace(order, retry=()), found)
        with closing(writing(order.store, known, order.command, found)) as steps:
            kept = _finish(order, known, steps)
        return order.report(known, computed=report.computed, failures=report.failures, kept=kept)


def _finish(order: Order, known: Inventory, steps: Iterator[None]) -> str:
    """If no case is missing, take the other steps and remove the blocks. Returns what `tidy` does, else ""."""
    if len(known.missing):
        return ""
    for _ in steps:
        pass
    return tidy(order.store, known)


def say_waiting(order: Order) -> None:
    say(f"{order.definition.name}: waiting for another run of this study to end", order.stream)


def prepared(order: Order, file: Condition) -> Inventory:
    """What is on disk, in blocks and in an earlier results file. Raises StudyError when cases of that would be lost."""
    if not order.shared:
        remove_litter(order.store)
    found = earlier(order.definition, file)
    known = inventory(order.store, found.source, order.retry, order.force or order.renew)
    check_replaceable(order.store, found, known.keys, order.force, order.renew)
    return known


def compute_blocks(order: Order, known: Inventory, steps: Iterator[None]) -> dict[int, str]:
    """Compute and store the missing cases, with a step of the results file after each block; returns the failures.

    A block that raises does not stop the others.
    """
    blocks, failures = blocks_of(known.missing, order.definition.block, order.part), {}
    if not blocks:
        return failures
    size = order.definition.grid.size
    stream, passing = order.stream or screen_of(order.progress), order.stream is None
    shown = Progress(order.definition.name, size, stream, size - len(known.missing), passing=passing)
    many = len(blocks) if order.processes and can_travel(order.definition) else 0
    with shown as progress, engine(order.workers, order.scheduler, many) as workers:
        tasks = (parcel(order.definition, index) for index in blocks)
        for number, result in as_they_come(workers, guarded, tasks):
            if isinstance(result, Failure):
                failures[number] = result.message
                log.debug("block %d: %s", number, result.trace)
            else:
                add(order.store, known, blocks[number], result)
                next(steps, None)
                failed = failed_cases(result["status"])
                progress.update(len(result["status"]), len(failed))
                if order.fail_fast and len(failed):
                    case, value = blocks[number][failed[0]], int(result["status"][failed[0]])
                    failures[number] = f"case {case}: {status_words()[value]}"
            if order.fail_fast and failures:
                break
    return failures


def dry_run(definition: Definition, results="results", *, workers=None, yes=False, force=False) -> Estimate:
    """As `study.api.Study.dry_run`."""
    order = Order(definition, Path(results))
    found = look(order.store)
    if order.done(found):
        return estimate(definition, workers, definition.grid.size)
    if not check_countable(order.store, yes):
        return estimate(definition, workers)
    there = earlier(definition, found)
    known = inventory(order.store, there.source, force=force)
    cost = estimate(definition, workers, definition.grid.size - len(known.missing))
    try:
        check_replaceable(order.store, there, known.keys, force)
    except StudyError as refused:
        return replace(cost, refused=refused)
    return cost


def partial_dataset(definition: Definition, results) -> xr.Dataset:
    """The grid with the blocks computed so far; the rest is NaN with status 127, not run."""
    store = Store(definition, Path(results))
    arrays = gather(store, inventory(store), 0, definition.grid.size)
    return dataset_of(definition, parts(definition, arrays, "partial results"))

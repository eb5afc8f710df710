"""Run a study: missing cases -> workers -> blocks on disk -> results file, an export of the blocks."""

import logging
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import xarray as xr

from ..data.dataset import failed_cases, parts, status_words
from ..data.si import dataset_of
from ..files.atomic import target
from ..files.examine import Condition, stamp
from ..files.lock import held
from ..inputs.definition import Definition, StudyError
from ..store.blocks import Inventory, Store, add, count_statuses, gather, inventory, remove_litter
from ..store.writer import exporting
from ..terminal import end_if_interrupted, say
from .cases import Failure, blocks_of
from .cost import Estimate, estimate
from .engine import computed
from .plan import Order, Report, anything_there, check_replaceable, check_size, check_writable, look
from .progress import Progress, screen_of

log = logging.getLogger(__name__)


def run(definition: Definition, results="results", **options) -> Report:
    """Compute what is missing and write results/NAME.nc. `options` as of `Order`.

    Raises StudyError when the folder cannot be written, or holds results that would be lost, or no scheduler answers;
    nothing has been computed then. Raises OSError when writing failed later (a full disk), or the scheduler is lost;
    blocks written so far stay and are used by the next run.
    """
    order = Order(definition, Path(results), **options)
    condition = look(order.store)
    if order.done(condition):
        return order.report()
    check_replaceable(order, condition)
    check_size(order)
    check_writable(order.store.path)
    with held(order.store.lock, shared=order.shared, waiting=lambda: say_waiting(order)):
        if stamp(order.store.path) != condition.seen:  # by the run for which this one has waited
            condition = look(order.store)
            if order.done(condition):
                return order.report()
            check_replaceable(order, condition)
        if condition.kind == "damaged":
            kept = f"it is written again, {target(order.store.path)}.damaged keeps it"
            log.warning("%s: %s; %s", order.store.path, condition.reason, kept)
        report = _compute(order, condition)
    return _export_if_last(order, report) if order.shared else report


def _compute(order: Order, condition: Condition) -> Report:
    """Compute what is missing, and write the results meanwhile, unless other runs compute other parts."""
    store = order.store
    if order.shared:
        return _compute_missing(order, inventory(store, order.retry), lambda: None)
    remove_litter(store)
    stock = inventory(store, order.retry)
    with exporting(store, stock, order.command, condition) as export:
        report = _compute_missing(order, stock, export.advance)
        export.advance()
    return report


def _compute_missing(order: Order, stock: Inventory, stored: Callable) -> Report:
    """Compute the missing cases of this run's part; `stored` is called after each block."""
    missing = stock.missing
    blocks = blocks_of(missing, order.definition.block, order.part)

    def keep(number: int, arrays: dict) -> None:
        add(order.store, stock, blocks[number], arrays)
        stored()

    failures = compute_blocks(order, blocks, len(stock.keys) - len(missing), keep)
    computed = len(missing) - len(stock.missing)
    return order.report(count_statuses(stock.status), computed=computed, failures=failures)


def _export_if_last(order: Order, report: Report) -> Report:
    """Write the results if no other run holds the lock. Then this run is the last of several."""
    with held(order.store.lock, wait=False) as alone:
        if not alone:
            return report
        condition = look(order.store)
        if replace(order, retry=()).done(condition):
            return replace(report, complete=True)
        check_replaceable(order, condition)
        remove_litter(order.store)
        stock = inventory(order.store)
        with exporting(order.store, stock, order.command, condition) as export:
            export.advance()
        counts = count_statuses(stock.status)
        return order.report(counts, computed=report.computed, failures=report.failures)


def say_waiting(order: Order) -> None:
    say(f"{order.definition.name}: waiting for another run of this study to end", order.stream)


def compute_blocks(
    order: Order, blocks: Sequence, present: int, keep: Callable, drop: Callable = lambda number: None
) -> dict[int, str]:
    """Compute blocks and keep them; returns the failures. A block that raises does not stop the others.

    blocks : the numbers of the cases of each; present : cases of the study that were there before
    keep : keep(number of a block, its columns) stores it; drop(number) hears of one that has failed
    """
    failures = {}
    if not blocks:
        return failures
    stream, passing = order.stream or screen_of(order.progress), order.stream is None
    shown = Progress(order.definition.name, order.definition.grid.size, stream, present, passing=passing)
    results = computed(order.definition, blocks, order.workers, order.scheduler, storing=True)
    with shown as progress, closing(results):
        for number, result in results:
            if isinstance(result, Failure):
                failures[number] = result.message
                log.debug("block %d: %s", number, result.trace)
                drop(number)
            else:
                keep(number, result)
                failed = failed_cases(result["status"])
                progress.update(len(result["status"]), len(failed))
                if order.fail_fast and len(failed):
                    case, value = blocks[number][failed[0]], int(result["status"][failed[0]])
                    failures[number] = f"case {case}: {status_words()[value]}"
            if order.fail_fast and failures:
                break
            end_if_interrupted()
    return failures


def dry_run(definition: Definition, results="results", *, workers=None, force=False) -> Estimate:
    """As `study.api.Study.dry_run`."""
    order = Order(definition, Path(results), force=force)
    condition = look(order.store)
    if order.done(condition):
        return estimate(definition, workers, definition.grid.size)
    if not anything_there(order.store):
        return estimate(definition, workers)
    cost = estimate(definition, workers, definition.grid.size - len(inventory(order.store).missing))
    try:
        check_replaceable(order, condition)
    except StudyError as refused:
        return replace(cost, refused=refused)
    return cost


def partial_dataset(definition: Definition, results) -> xr.Dataset:
    """The grid with the blocks computed so far; the rest is NaN with status 127, not run."""
    store = Store(definition, Path(results))
    arrays = gather(store, inventory(store), 0, definition.grid.size)
    return dataset_of(definition, parts(definition, arrays, "partial results"))

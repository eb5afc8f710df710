"""Run a study: missing cases -> workers -> blocks on disk -> results files, exports of the blocks."""

import logging
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack, closing, suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..data.dataset import failed_cases, status_words
from ..files.atomic import make_folder, target
from ..files.lock import lock_file
from ..inputs.definition import Definition, StudyError
from ..store.blocks import add, count_statuses, inventory, put_in_memory, write_rest
from ..store.window_files import WindowFiles, add_counts, checked, glance, put_away
from ..store.windows import Window
from ..store.writer import Export, exporting
from ..terminal import end_if_interrupted, say
from .cases import Failure, blocks_of
from .cost import Estimate, estimate
from .engine import computed
from .plan import Order, Report, check_replaceable, check_size, check_writable
from .progress import Progress, screen_of

log = logging.getLogger(__name__)
#: Seconds for which the blocks of one of many windows are only in memory: a killed run loses no more than that. A
#: window of ordinary cases is complete in less time; writing its blocks would take 9 to 14 % of the time of a run.
BRIEF = 10.0


def run(definition: Definition, results="results", **options) -> Report:
    """Compute the missing cases and write the results.

    options : the fields of `Order`

    Raises StudyError when the folder cannot be written, or holds results that would be lost, or no scheduler answers;
    nothing has been computed then. Raises OSError when writing fails later (a full disk), or the scheduler is lost;
    the blocks written so far stay, and the next run uses them.
    """
    order = Order(definition, Path(results), **options)
    state = checked(order.store)
    if order.done(state):
        return order.report(state)
    check_replaceable(order, state)
    check_size(order)
    check_writable(state.windows[0].path)
    with lock_file(order.store.lock, shared=order.shared, waiting=lambda: say_waiting(order)):
        now = checked(order.store, state)
        if now is not state:  # the run for which this one waited has changed it
            if order.done(now):
                return order.report(now)
            check_replaceable(order, now)
        _make_room(order, now)
        report = _compute(order, now)
    return _export_if_last(order, report) if order.shared and now.is_one else report


def _make_room(order: Order, state: WindowFiles) -> None:
    """Remove files that are in the way of the results, and warn of damaged files that stay under another name.

    Former parts of the study are removed after the cases that it still has are stored as blocks.
    """
    if state.others:  # --force allows it, or no case is lost
        from ..store.former_parts import take_over  # here, since few runs have former parts

        make_folder(order.store.folder)
        take_over(state, state.rivals())
    for path in state.others:
        path.unlink(missing_ok=True)
    if not order.shared:
        order.store.remove_litter()
    for file in state.wrong:
        if state.is_one:
            note = f"it is written again, {target(file.path)}.damaged keeps it"
            log.warning("%s: %s; %s", file.path, file.reason, note)
            continue
        with suppress(FileNotFoundError):  # another run has put it away
            aside = put_away(file)
            log.warning("%s: %s; it is computed again, %s keeps it", file.path, file.reason, aside)


def _compute(order: Order, state: WindowFiles) -> Report:
    """Compute this run's share of the missing cases, and write the results meanwhile."""
    make_folder(state.windows[0].path.parent)
    with Harvest(order, state) as harvest:
        blocks = [block for _, block in harvest.blocks]
        failures = compute_blocks(order, blocks, harvest.present, harvest.keep)
        harvest.end()
    return order.report(state, harvest.counts(), computed=harvest.computed, failures=failures)


class Harvest:
    """The windows whose results a run computes.

    blocks : the window and the numbers of the cases, for each block to be computed
    present, computed : number of cases that existed before, and of those computed since

    As a context manager it leaves no half-written file behind. The results file of a study of one window is begun at
    once; if other runs compute other blocks of it, the last run writes the file. One of many windows belongs to a
    single run, and its file is begun with the first block. If the window is complete within BRIEF seconds, its blocks
    are never written to the disk.
    """

    def __init__(self, order: Order, state: WindowFiles):
        self.order, self.state, self.computed = order, state, 0
        self._begun, self._ended, self._opened = dict[int, tuple[Export, ExitStack]](), dict[int, dict](), ExitStack()
        share, shares = (1, 1) if state.is_one else order.part
        lacking = {window.cases.start: window for window in order.lacking(state)}
        mine = [window for window in state.windows[share - 1 :: shares] if window.cases.start in lacking]
        self.present = order.definition.grid.size - sum(len(window.cases) for window in lacking.values())
        self.blocks = [(window, block) for window in mine for block in self._blocks_of(window)]

    def __enter__(self) -> "Harvest":
        return self

    def __exit__(self, *error) -> None:
        self._opened.__exit__(*error)

    def keep(self, number: int, arrays: dict[str, np.ndarray]) -> None:
        """Store the columns of a block, and write the files that are then complete."""
        window, index = self.blocks[number]
        export, _ = self._begun.get(window.cases.start) or self._begin(window)
        is_brief = export.store.window and time.monotonic() - export.since < BRIEF
        put = put_in_memory if is_brief else add
        put(export.store, export.stock, np.asarray(index) - window.cases.start, arrays)
        self.computed += len(index)
        self._advance(window.cases.start)

    def end(self) -> None:
        """Write the files that are complete, even if none of their cases was missing. In windows with a failed block,
        write the other blocks."""
        for first, (export, _) in [*self._begun.items()]:
            self._advance(first)
            if export.pieces:
                write_rest(export.store, export.stock)

    def counts(self) -> dict[int, int]:
        """status -> number of cases of the study."""
        total, stocks = dict[int, int](), {first: export.stock for first, (export, _) in self._begun.items()}
        for counts in (*self._ended.values(), *(count_statuses(stock.status) for stock in stocks.values())):
            add_counts(total, counts)
        rest = [window for window in self.state.windows if window.cases.start not in self._ended.keys() | stocks.keys()]
        add_counts(total, glance(self.order.store).counts(rest) if rest else {})
        return dict(sorted(total.items()))

    def _blocks_of(self, window: Window) -> list[Sequence]:
        """The numbers of the missing cases of a window, in blocks."""
        missing, order = window.cases, self.order
        if self.state.is_one:
            missing = self._begin(window)[0].stock.missing
        elif any(order.store.block_paths(window)):
            missing = missing.start + inventory(self.state.store_of(window), order.retry).missing
            if not len(missing):  # a run was killed before it wrote the results
                self._begin(window)
        self.present += len(window.cases) - len(missing)
        return blocks_of(missing, order.definition.block, order.part if self.state.is_one else (1, 1))

    def _begin(self, window: Window) -> tuple[Export, ExitStack]:
        store, opened = self.state.store_of(window), self._opened.push(ExitStack())
        condition = self.state.conditions[self.state.windows.index(window)]
        export = exporting(store, inventory(store, self.order.retry), self.order.command, condition)
        self._begun[window.cases.start] = opened.enter_context(export), opened
        return self._begun[window.cases.start]

    def _advance(self, first: int) -> None:
        export, opened = self._begun[first]
        if self.state.is_one and self.order.shared:
            return
        export.advance()
        if not export.pieces and not self.state.is_one:
            self._ended[first] = count_statuses(export.stock.status)
            del self._begun[first]
            opened.close()


def _export_if_last(order: Order, report: Report) -> Report:
    """Write the results if no other run holds the lock. Then this run is the last of several."""
    with lock_file(order.store.lock, wait=False) as is_alone:
        if not is_alone:
            return report
        state = checked(order.store)
        if replace(order, retry=()).done(state):
            return replace(report, complete=True)
        check_replaceable(order, state)
        order.store.remove_litter()
        stock = inventory(order.store)
        with exporting(order.store, stock, order.command, state.conditions[0]) as export:
            export.advance()
        counts = count_statuses(stock.status)
        return order.report(state, counts, computed=report.computed, failures=report.failures)


def say_waiting(order: Order) -> None:
    say(f"{order.definition.name}: waiting for another run of this study to end", order.stream)


def compute_blocks(order: Order, blocks: Sequence, present: int, keep: Callable) -> dict[int, str]:
    """Compute blocks and store them; returns the failures. A block that raises does not stop the others.

    blocks : the numbers of the cases of each block
    present : number of cases of the study that existed before
    keep : keep(number of a block, its columns) stores a block
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
    state = glance(order.store)
    cost = estimate(definition, workers, definition.grid.size - state.missing)
    try:
        check_replaceable(order, state)
    except StudyError as refused:
        return replace(cost, refused=refused)
    return cost

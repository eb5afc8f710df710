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
from ..files.lock import held
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
#: Seconds for which the blocks of one of many windows are in memory alone: a run that is killed loses no more. Ordinary
#: cases make a window whole in less; to write their blocks would take 9 to 14 % of the time of a run.
BRIEF = 10.0


def run(definition: Definition, results="results", **options) -> Report:
    """Compute what is missing and write the results. `options` as of `Order`.

    Raises StudyError when the folder cannot be written, or holds results that would be lost, or no scheduler answers;
    nothing has been computed then. Raises OSError when writing failed later (a full disk), or the scheduler is lost;
    blocks written so far stay and are used by the next run.
    """
    order = Order(definition, Path(results), **options)
    state = checked(order.store)
    if order.done(state):
        return order.report(state)
    check_replaceable(order, state)
    check_size(order)
    check_writable(state.windows[0].path)
    with held(order.store.lock, shared=order.shared, waiting=lambda: say_waiting(order)):
        now = checked(order.store, state)
        if now is not state:  # by the run for which this one has waited
            if order.done(now):
                return order.report(now)
            check_replaceable(order, now)
        _make_room(order, now)
        report = _compute(order, now)
    return _export_if_last(order, report) if order.shared and now.is_one else report


def _make_room(order: Order, state: WindowFiles) -> None:
    """Remove what is in the way of the results, and say which damaged files stay under another name."""
    for path in state.others:  # as --force has said
        path.unlink(missing_ok=True)
    if not order.shared:
        order.store.remove_litter()
    for file in state.wrong:
        if state.is_one:
            kept = f"it is written again, {target(file.path)}.damaged keeps it"
            log.warning("%s: %s; %s", file.path, file.reason, kept)
            continue
        with suppress(FileNotFoundError):  # another run has put it away
            aside = put_away(file)
            log.warning("%s: %s; it is computed again, %s keeps it", file.path, file.reason, aside)


def _compute(order: Order, state: WindowFiles) -> Report:
    """Compute what is missing, this run's part of it, and write the results meanwhile."""
    make_folder(state.windows[0].path.parent)
    with Harvest(order, state) as harvest:
        blocks = [block for _, block in harvest.blocks]
        failures = compute_blocks(order, blocks, harvest.present, harvest.keep)
        harvest.end()
    return order.report(state, harvest.counts(), computed=harvest.computed, failures=failures)


class Harvest:
    """The windows whose results a run brings in.

    blocks : the window and the numbers of the cases of each block that is computed
    present : cases that were there before; computed : those that have been computed

    As a context manager it leaves no half-written file behind. The results file of a study of one window is begun at
    once. If other runs compute other blocks of it, the last of them writes the file. One of many windows is of one run
    alone, and is begun with its first block. If it is whole within BRIEF seconds, its blocks are never on the disk.
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
        """Put the columns of a block on the disk, and write what is whole then."""
        window, index = self.blocks[number]
        export, _ = self._begun.get(window.cases.start) or self._begin(window)
        is_brief = export.store.window and time.monotonic() - export.since < BRIEF
        put = put_in_memory if is_brief else add
        put(export.store, export.stock, np.asarray(index) - window.cases.start, arrays)
        self.computed += len(index)
        self._advance(window.cases.start)

    def end(self) -> None:
        """Write what is whole, also if no case of it was missing, and the blocks of windows of which one has failed."""
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
            if not len(missing):  # a run that was killed has not come to write the results
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
    with held(order.store.lock, wait=False) as alone:
        if not alone:
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
    """Compute blocks and keep them; returns the failures. A block that raises does not stop the others.

    blocks : the numbers of the cases of each; present : cases of the study that were there before
    keep : keep(number of a block, its columns) stores it
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

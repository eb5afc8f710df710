"""Large studies, whose results are in parts: missing parts -> blocks -> workers -> files; and what is there."""

import logging
from dataclasses import replace
from pathlib import Path

import xarray as xr

from ..files.access import Unusable
from ..files.atomic import make_folder
from ..files.examine import examine
from ..files.lock import held
from ..files.results_file import open_parts
from ..inputs.definition import Definition, StudyError
from ..inputs.reading import same_tables
from ..store.blocks import Store
from ..store.parts import (
    Growing,
    Part,
    counts,
    divisions,
    having,
    others,
    parts_of,
    present,
    put_damaged_away,
)
from ..terminal import program
from .cases import blocks_of
from .cost import Estimate, estimate
from .plan import Order, Report, check_size, check_writable
from .run import compute_blocks, say_waiting

log = logging.getLogger(__name__)


def run_large(definition: Definition, results="results", **options) -> Report:
    """As `study.work.run.run`, of a study whose results are in parts."""
    order = Order(definition, Path(results), **options)
    store, parts = order.store, parts_of(order.store)
    check_others(order, parts)
    check_size(order)
    check_writable(store.parts / "part")
    with held(store.lock, shared=order.shared, waiting=lambda: say_waiting(order)):
        check_others(order, parts)
        for path in others(store, parts):  # as --force has said
            path.unlink(missing_ok=True)
        if not order.shared:
            for path in store.parts.glob(".*.tmp"):  # of runs that were killed while they wrote
                path.unlink(missing_ok=True)
        there = present(store, parts)
        for part in put_damaged_away(there):
            log.warning("%s: is damaged; it is computed again, %s.damaged keeps it", part.path, part.path)
        again = having(present(store, there), order.retry)
        done = {part.first for part in present(store, there)} - {part.first for part in again}
        return _compute(order, parts, done)


def _compute(order: Order, parts: list[Part], done: set[int]) -> Report:
    """Compute the parts that are not done, those of this run's share."""
    store, (share, shares) = order.store, order.part
    missing = [part for part in parts[share - 1 :: shares] if part.first not in done]
    if not missing and len(done) == len(parts):
        return order.report(path=store.parts)
    blocks = [(part, block) for part in missing for block in blocks_of(part.cases, order.definition.block)]
    growing = Growing(store, order.command, divisions(order.definition, parts), blocks)
    cases = sum(len(part.cases) for part in parts if part.first in done)
    make_folder(store.parts)
    failures = compute_blocks(order, [block for _, block in blocks], cases, growing.add, growing.drop)
    there = present(store, parts)
    report = order.report(counts(there, lacking(store, there)), path=store.parts)
    return replace(report, computed=growing.written, failures=failures)


def lacking(store: Store, there: list[Part]) -> int:
    """How many cases are not in the parts that are there."""
    return store.definition.grid.size - sum(len(part.cases) for part in there)


def dry_run_large(definition: Definition, results="results", *, workers=None, force=False) -> Estimate:
    """As `study.api.Study.dry_run`, of a study whose results are in parts."""
    order = Order(definition, Path(results), force=force)
    parts = parts_of(order.store)
    cost = estimate(definition, workers, definition.grid.size - lacking(order.store, present(order.store, parts)))
    try:
        check_others(order, parts)
    except StudyError as refused:
        return replace(cost, refused=refused)
    return cost


def check_others(order: Order, parts: list[Part]) -> None:
    """Raise StudyError if the folder has results of another study or another version, unless they may be replaced."""
    there = others(order.store, parts)
    if not there or order.force:
        return
    condition = examine(there[0], most=0)
    if condition.kind in ("foreign", "unreadable"):
        raise Unusable(condition.path, condition.kind, f"{condition.reason}; move it away, or use --results DIR")
    if order.renew and same_tables(condition.text, order.definition.text):
        return
    way = f"{program()} run --force {order.definition.name}" if order.renew else "--force"
    what = f"holds {len(there)} parts of another definition or version of the numerics"
    raise StudyError([f"{order.store.parts}: {what}: {way} removes them, --results DIR writes elsewhere"])


def state_of(store: Store) -> tuple[str, dict[int, int]]:
    """The state of large results, as of `study.api.Study.status`, and status -> number of cases."""
    parts = parts_of(store)
    there = present(store, parts)
    state = "partial" if there else "outdated" if others(store, parts) else "new"
    return "done" if len(there) == len(parts) else state, counts(there, lacking(store, there))


def open_large(store: Store) -> xr.Dataset:
    """The dataset of all parts, lazily. Raises StudyError if some are missing."""
    parts = parts_of(store)
    there = present(store, parts)
    if len(there) < len(parts):
        what = f"{len(there)} of {len(parts)} parts are there" if there else "does not exist"
        raise StudyError([f"{store.parts}: {what}; run the study first"])
    if others(store, parts):
        raise StudyError([f"{store.parts}: holds parts of another definition besides; move them away"])
    return open_parts(store.parts)

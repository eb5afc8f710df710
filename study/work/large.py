"""Large studies, whose results are in parts: missing parts -> blocks -> workers -> files; and what is there."""

import logging
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import xarray as xr

from ..files.access import Unusable
from ..files.atomic import make_folder
from ..files.examine import Condition, examine
from ..files.lock import held
from ..files.parts_folder import divided, opened_together
from ..files.results_file import for_users
from ..inputs.definition import Definition, StudyError
from ..inputs.reading import same_tables
from ..store.blocks import Store
from ..store.parts import (
    NO_PART,
    Growing,
    Part,
    checked,
    conditions,
    counts,
    divisions,
    having,
    others,
    parts_of,
    put_away,
    sound,
    wrong,
)
from ..terminal import counted, program
from .cases import blocks_of
from .cost import Estimate, estimate
from .plan import Order, Report, check_size, check_writable, of_what
from .run import compute_blocks, say_waiting

log = logging.getLogger(__name__)


def run_large(definition: Definition, results="results", **options) -> Report:
    """As `study.work.run.run`, of a study whose results are in parts."""
    order = Order(definition, Path(results), **options)
    store, parts = order.store, parts_of(order.store)
    states = checked(store, parts)
    check_replaceable_parts(order, parts, states)
    done = _done(order, parts, states)
    if len(done) == len(parts) and not others(store, parts):
        return order.report(path=store.parts)
    check_size(order)
    check_writable(store.parts / "part")
    with held(store.lock, shared=order.shared, waiting=lambda: say_waiting(order)):
        states = checked(store, parts, states)
        check_replaceable_parts(order, parts, states)
        for path in others(store, parts):  # as --force has said
            path.unlink(missing_ok=True)
        if not order.shared:
            for path in store.parts.glob(".*.tmp"):  # of runs that were killed while they wrote
                path.unlink(missing_ok=True)
        for state in wrong(states):
            with suppress(FileNotFoundError):  # another run has put it away
                aside = put_away(state)
                log.warning("%s: %s; it is computed again, %s keeps it", state.path, state.reason, aside)
        return _compute(order, parts, _done(order, parts, states))


def _done(order: Order, parts: list[Part], states: list[Condition]) -> set[int]:
    """The first cases of the parts that need not be computed."""
    there = sound(parts, states)
    return {part.first for part in there} - {part.first for part in having(there, order.retry)}


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
    there = sound(parts, conditions(store, parts))
    report = order.report(counts(there, lacking(store, there)), path=store.parts)
    return replace(report, computed=growing.written, failures=failures)


def lacking(store: Store, there: list[Part]) -> int:
    """How many cases are not in the parts that are there."""
    return store.definition.grid.size - sum(len(part.cases) for part in there)


def dry_run_large(definition: Definition, results="results", *, workers=None, force=False) -> Estimate:
    """As `study.api.Study.dry_run`, of a study whose results are in parts."""
    order = Order(definition, Path(results), force=force)
    parts = parts_of(order.store)
    states = conditions(order.store, parts)
    cost = estimate(definition, workers, definition.grid.size - lacking(order.store, sound(parts, states)))
    try:
        check_replaceable_parts(order, parts, states)
    except StudyError as refused:
        return replace(cost, refused=refused)
    return cost


def check_replaceable_parts(order: Order, parts: list[Part], states: list[Condition]) -> None:
    """Raise StudyError if the folder has what is no file, or of another program, where the parts are, or results of
    another study or another version, unless these may be replaced."""
    besides = [examine(path, most=0) for path in others(order.store, parts)]
    files = [state for state in wrong(states) if not state.path.is_file() or state.kind == "unreadable"]
    for state in (*files, *(state for state in besides if state.kind in ("foreign", "unreadable"))):
        raise Unusable(state.path, state.kind, f"{state.reason}; move it away, or use --results DIR")
    same_file = order.renew and all(same_tables(state.text, order.definition.text) for state in besides)
    if order.force or same_file or not besides:
        return
    way = f"{program()} run --force {order.definition.name}" if order.renew else "--force"
    of_these = of_what(besides[0], order.definition)
    what = f"holds {counted(len(besides), 'part')} of {of_these}"
    raise StudyError([f"{order.store.parts}: {what}: {way} removes them, --results DIR writes elsewhere"])


def state_of(store: Store) -> tuple[str, dict[int, int], str]:
    """The state of large results, as of `study.api.Study.status`, status -> number of cases, and what is wrong."""
    parts = parts_of(store)
    states = conditions(store, parts)
    there, bad, besides = sound(parts, states), wrong(states), others(store, parts)
    if len(there) == len(parts):
        state = "done"
    elif there or bad:
        state = "partial" if there else bad[0].kind
    else:
        state = "outdated" if besides else "new"
    reasons = [f"{one.path.name} {one.reason}" for one in bad[:1]]
    reasons += [f"{path.name} {NO_PART}" for path in besides[:1] if state != "outdated"]
    return state, counts(there, lacking(store, there)), "; ".join(reasons)


def open_large(store: Store) -> xr.Dataset:
    """The dataset of all parts, lazily. Raises StudyError if some are missing, or are others than their names say."""
    parts = parts_of(store)
    states = conditions(store, parts)
    there = sound(parts, states)
    for state in wrong(states):
        raise Unusable(state.path, state.kind, f"{state.reason}; run the study, which computes it again")
    if len(there) < len(parts):
        what = f"{len(there)} of {len(parts)} parts are there" if there else "does not exist"
        raise StudyError([f"{store.parts}: {what}; run the study first"])
    for path in others(store, parts):
        raise Unusable(path, "foreign", NO_PART)
    return for_users(
        opened_together([part.path for part in parts], store.parts, divided(divisions(store.definition, parts)))
    )

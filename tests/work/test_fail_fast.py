"""Cases that fail: the others are computed, unless the run shall stop; a case without a solution has not failed."""

import io

from children import wait_for
from line_study import ending, load, store_block

from study.work import cases, progress

DIVERGED, THIN_LAYER_NOT_APPLICABLE, LIFT_OFF = 3, 4, 8  # statuses


def test_a_failed_case_does_not_stop_the_others_unless_asked(file, monkeypatch, computed, quiet):
    ending(monkeypatch, {6: DIVERGED})
    report = load(file).run(workers=1, fail_fast=True)
    assert report.failures == {1: "case 6: diverged"}
    assert not report.complete and report.computed == 10, "the block that stopped the run is kept"
    wait_for(quiet)
    report = load(file).run(workers=1)
    assert report.complete and report.counts == {0: 22, DIVERGED: 1}
    assert set(computed) == {0, 5, 10, 15, 20}
    assert computed.count(0) == computed.count(5) == 1, "what was stored before the stop is kept, the failed case too"


def test_a_block_that_raises_stops_the_run_if_asked(file, monkeypatch, computed):
    real = cases.compute

    def compute(wanted):
        if wanted.first == 5:
            raise ZeroDivisionError("on purpose")
        return real(wanted)

    monkeypatch.setattr(cases, "compute", compute)
    report = load(file).run(workers=1, fail_fast=True)
    assert report.failures == {1: "cases 5 to 9: ZeroDivisionError: on purpose"}
    assert report.computed == 5


def test_blocks_that_wait_when_a_run_stops_are_not_computed(file, monkeypatch, computed):
    ending(monkeypatch, {0: DIVERGED})
    report = load(file).run(workers=1, fail_fast=True)
    assert report.failures == {0: "case 0: diverged"} and report.computed == 5
    assert computed == [0]


def test_progress_counts_what_failed_and_begins_with_what_is_on_disk(file, monkeypatch):
    store_block(load(file), 0, 5)
    ending(monkeypatch, {6: DIVERGED, 7: DIVERGED, 10: THIN_LAYER_NOT_APPLICABLE, 11: LIFT_OFF})
    monkeypatch.setattr(progress, "EVERY", 0)
    shown = io.StringIO()
    report = load(file).run(workers=1, stream=shown)
    assert report.complete and report.failures == {}
    assert [line.rpartition(" failed, ")[0] for line in shown.getvalue().splitlines()] == [
        "line: 10 of 23 cases, 2",
        "line: 15 of 23 cases, 2",
        "line: 20 of 23 cases, 2",
        "line: 23 of 23 cases, 2",
    ]


def test_a_case_without_a_solution_does_not_stop_a_run(file, monkeypatch):
    ending(monkeypatch, {6: THIN_LAYER_NOT_APPLICABLE, 12: LIFT_OFF, 19: DIVERGED})
    report = load(file).run(workers=1, fail_fast=True)
    assert report.failures == {3: "case 19: diverged"} and report.computed == 20

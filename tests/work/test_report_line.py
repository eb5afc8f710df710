"""Lines that the commands print: of a run, where cases without a solution are no failures, of blocks, of states."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from study.commands.computing import cost_line, failure_lines, report_line, state_line
from study.work.cost import Estimate
from study.work.plan import Report


def line(counts: dict[int, int], cases: int = 24_320) -> str:
    return report_line(Report(Path("results/validity.nc"), cases, 7, {}, counts, complete=True), "validity")


@pytest.mark.parametrize(
    ("counts", "remark"),
    [
        ({0: 24_320}, ""),
        ({0: 23_424, 4: 896}, ", 896 thin_layer_not_applicable: no solution exists, which is not a failure"),
        ({8: 5, 4: 3}, ", 3 thin_layer_not_applicable, 5 lift_off: no solution exists, which is not a failure"),
        ({0: 1, 1: 2}, ", 2 of them not converged (2 iteration_limit): see `status` in the file"),
        (
            {3: 1, 2: 40, 4: 6},
            ", 6 thin_layer_not_applicable: no solution exists, which is not a failure"
            ", 41 of them not converged (40 limit_cycle, 1 diverged): see `status` in the file",
        ),
    ],
)
def test_cases_without_a_solution_are_no_failures(counts, remark):
    assert line(counts) == f"results/validity.nc: 24320 cases, 7 computed now{remark}"


def test_a_run_with_nothing_to_do_or_only_a_part_says_so():
    done = Report(Path("results/a.nc"), 9, 0, {}, {}, complete=True)
    assert report_line(done, "a") == "results/a.nc is up to date (9 cases), nothing to do"
    part = Report(Path("results/a.nc"), 9, 4, {}, {0: 6, 127: 3}, complete=False)
    assert report_line(part, "a") == "a: 4 cases computed now, 3 of 9 are left to other parts"


def test_one_case_and_one_block_are_one():
    done = Report(Path("results/a.nc"), 1, 0, {}, {}, complete=True)
    assert report_line(done, "a") == "results/a.nc is up to date (1 case), nothing to do"
    done = Report(Path("results/a.nc"), 1, 1, {}, {0: 1}, complete=True)
    assert report_line(done, "a") == "results/a.nc: 1 case, 1 computed now"
    part = Report(Path("results/a.nc"), 2, 1, {}, {0: 1, 127: 1}, complete=False)
    assert report_line(part, "a").startswith("a: 1 case computed now, 1 of 2 ")
    failed = Report(Path("results/a.nc"), 1, 0, {0: "full disk"}, {}, complete=False)
    assert failure_lines(failed, "a")[-1].startswith("a: 1 block failed; ")
    assert cost_line("a", Estimate(1, 0, 125.0, 5e8, 7e8, 1.4e9)).startswith("a: 1 case, 0 of them computed; ")


def test_failed_blocks_stand_in_their_order():
    report = Report(Path("results/a.nc"), 9, 4, {10: "full disk", 2: "MemoryError"}, {}, complete=False)
    assert failure_lines(report, "a") == [
        "a: block 2 failed: MemoryError",
        "a: block 10 failed: full disk",
        "a: 2 blocks failed; the others are kept, and the same command tries again",
    ]


def test_the_state_of_a_study_counts_what_is_done():
    definition = SimpleNamespace(name="fig04", title="Loads", times=1)
    state = {"cases": 2000, "counts": {0: 480, 1: 20, 127: 1500}, "state": "partial", "path": "r.nc", "reason": ""}
    assert state_line(definition, state) == "fig04                  2000 cases  partial (500 of 2000 cases)  Loads"
    assert state_line(definition, state | {"state": "done"}) == "fig04                  2000 cases  done  Loads"
    damaged = state | {"state": "damaged", "path": "results/fig04.nc", "reason": "is damaged: a", "counts": {}}
    assert state_line(definition, damaged).split("\n") == [
        "fig04                  2000 cases  damaged  Loads",
        "    results/fig04.nc: is damaged: a",
    ]


def test_the_cost_of_a_study_counts_what_is_computed():
    text = cost_line("fig04", Estimate(2000, 500, 125.0, 5e8, 7e8, 1.4e9))
    assert text == (
        "fig04: 2000 cases, 500 of them computed; the others: about 2 min 5 s, at most 0.5 GB of memory and 1.4 GB of "
        "disk; the results are 0.7 GB"
    )

"""The line at the end of a run tells cases that have no solution from cases that the solver failed on."""

from pathlib import Path

import pytest

from study.answers import report_line
from study.order import Report


def line(counts: dict[int, int], cases: int = 24_320) -> str:
    return report_line(Report(Path("results/validity.nc"), cases, 7, {}, counts, complete=True), "validity")


@pytest.mark.parametrize(
    ("counts", "remark"),
    [
        ({0: 24_320}, ""),
        ({0: 23_424, 4: 896}, ", 896 thin_layer_not_applicable: no solution exists, which is no failure"),
        ({8: 5, 4: 3}, ", 3 thin_layer_not_applicable, 5 lift_off: no solution exists, which is no failure"),
        ({0: 1, 1: 2}, ", 2 of them not converged (2 iteration_limit): see `status` in the file"),
        (
            {3: 1, 2: 40, 4: 6},
            ", 6 thin_layer_not_applicable: no solution exists, which is no failure"
            ", 41 of them not converged (40 limit_cycle, 1 diverged): see `status` in the file",
        ),
    ],
)
def test_cases_without_a_solution_are_no_failures(counts, remark):
    assert line(counts) == f"results/validity.nc: 24320 cases, 7 computed now{remark}"

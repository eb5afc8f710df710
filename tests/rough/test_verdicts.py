"""What becomes of a case that is solved on panels: the verdict after each round."""

import numpy as np
import pytest

from solver import Solution, Status
from solver.rough.answer import Answer, Verdict, after_panels, before_panels, unfinished

RTOL, NONE = 1e-6, np.zeros(1)


def answered(error, status=Status.CONVERGED, gap=False, tension=0.0):
    """An answer of one case with that error."""
    solution = Solution.of(1, 0, error=error, status=status, p0=1.0, P=error)
    return Answer(solution, np.array([tension]), np.array([gap]), np.zeros(1, np.int8), None)


@pytest.mark.parametrize(
    ("found", "floor", "clear", "spent", "verdict"),
    [
        (answered(1e-7), 0.0, False, False, Verdict.SOLVED),
        (answered(1e-7), 0.0, False, True, Verdict.SOLVED),
        (answered(1e-5), 0.0, False, False, Verdict.COARSE),
        (answered(1e-5), 0.0, False, True, Verdict.SPENT),
        (answered(1e-5), 2e-6, False, False, Verdict.FLOOR),
        (answered(1e-5), 2e-6, False, True, Verdict.FLOOR),
        (answered(1e-7, gap=True), 0.0, False, False, Verdict.LIFTED),
        (answered(1e-7, tension=1e-3), 0.0, False, True, Verdict.LIFTED),
        (answered(1e-7, tension=1e-3), 0.0, True, False, Verdict.SOLVED),
        (answered(1e-5, tension=5e-5), 2e-6, False, False, Verdict.COARSE),  # that may be no more than the error
    ],
)
def test_the_verdict_after_a_round(found, floor, clear, spent, verdict):
    best, after = after_panels(answered(1e-4).solution, found, np.array([floor]), RTOL, clear, spent)
    assert after == verdict
    assert best.error[0] == (1e-4 if verdict == Verdict.LIFTED else found.solution.error[0])


def test_the_better_solution_stays():
    best = answered(1e-5).solution
    assert after_panels(best, answered(1e-4), NONE, RTOL, True, False) == (best, Verdict.COARSE)
    assert after_panels(best, answered(1e-7, gap=True), NONE, RTOL, True, False)[0] is best
    open_ = answered(np.nan, Status.ITERATION_LIMIT).solution
    assert after_panels(open_, answered(1e-7, gap=True), NONE, RTOL, True, False) == (open_, Verdict.OPEN)


def test_tension_that_was_there_is_there_still():
    assert before_panels(answered(1e-5, tension=1e-3)) == Verdict.LIFTED
    assert before_panels(answered(1e-5)) == Verdict.COARSE
    assert before_panels(answered(1e-5, Status.ITERATION_LIMIT)) == Verdict.OPEN
    assert unfinished(Verdict.LIFTED, True) == Verdict.LIFTED
    assert unfinished(Verdict.COARSE, True) == Verdict.SPENT
    assert unfinished(Verdict.COARSE, False) == Verdict.COARSE

"""Hard layers about as thick as the contact: plates that nearly lift off in the centre, where the pressure is small."""

import numpy as np
import pytest

from solver import Problem, Status, solve

#: n, h/a, and at a = E1* = 1 P, D and p(0). From a Fredholm equation in long double: P and D to 14 digits, p(0) to
#: 1e-10.
PLATES = np.array(
    [
        [2e5, 0.15, 1.9470942335584e-03, 3.0433698272027e01, 1.3820584293031e-05],
        [2e5, 0.1, 7.4994038285071e-04, 1.7216903168328e01, 1.0923631285056e-05],
        [2e4, 0.15, 3.2029052093922e-03, 1.0280772832505e01, 8.7765951630819e-05],
    ]
)


@pytest.mark.parametrize("control", ["a", "P", "D"])
def test_rounding_of_a_small_pressure(control):
    """p(0) is 20 to 160 times smaller than the largest pressure. It was up to 12 times as far off as `error` here, a
    hundred times in other cases, and farther than rtol."""
    n, h, P, D, p0 = PLATES.T
    a = 0.01
    truth = {"a": np.full(3, a), "P": P * n * a**3, "D": D * a**2, "p0": p0 * n * a}
    for rtol in (1e-6, 1e-9, 1e-10):
        found = solve(Problem.of(**{control: truth[control]}, h=h * a, n=n, micro="smooth", rtol=rtol))
        error = np.max([np.abs(getattr(found, name) / own - 1) for name, own in truth.items()], axis=0)
        assert (error < found.error).all(), f"{rtol}: {error / found.error}"
        assert (error < rtol)[found.status == Status.CONVERGED].all()


def test_a_plate_without_a_small_pressure():
    """Where p(0) is no small part of the largest pressure, rounding does not count, even under a hard layer."""
    found = solve(Problem.of(a=0.01, h=[1e-3, 0.1], n=[20.0, 2e4], micro="smooth", rtol=1e-10))
    assert (found.status == Status.CONVERGED).all()

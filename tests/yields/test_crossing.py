"""The search for the first crossing, on stresses that are a number."""

from types import SimpleNamespace

import numpy as np
from numpy.testing import assert_allclose

from solver.yields.crossing import NUMBERS, first_crossing


def test_the_stress_itself_decides_near_the_strength():
    """It is the place; the coarse one, smaller by a tenth, would cross later and enclose another place."""
    start = np.geomspace(0.05, 0.9, 12)

    def stress(index, at, coarse):
        none = np.zeros(len(at))
        return at * (0.9 if coarse else 1.0), none, none, SimpleNamespace(**dict.fromkeys(NUMBERS, at))

    crossing = first_crossing(stress, start, np.full(12, 10.0))
    assert crossing.crossed.all()
    assert_allclose(crossing.at, 1.0, rtol=2e-7)


def test_a_stress_that_rises_ever_more_steeply_takes_few_steps():
    """Without the halved value at the place above, which stays, false position is given up."""
    start, calls = np.geomspace(0.2, 0.9, 12), np.zeros(12, dtype=int)

    def stress(index, at, coarse):
        calls[index] += 1
        none = np.zeros(len(at))
        return np.exp(at**40 - 1), none, none, SimpleNamespace(**dict.fromkeys(NUMBERS, at))

    crossing = first_crossing(stress, start, np.full(12, 10.0))
    assert crossing.crossed.all() and calls.max() < 30, calls
    assert_allclose(crossing.at, 1.0, rtol=2e-7)

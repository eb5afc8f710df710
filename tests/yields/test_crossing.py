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


def test_steps_of_an_octave_at_once_pass_no_crossing_that_single_steps_see():
    """A stress that is above the strength on a narrow hill alone, in places where steps become short."""
    tops = np.array([0.35, 0.5, 0.83, 1.7, 2.9])

    def stress(index, at, coarse):
        value = np.maximum(1.02 * np.exp(-((np.log(at / tops[index]) / 0.45) ** 2)), 0.01)
        return value, 0 * at, 0 * at, SimpleNamespace(**dict.fromkeys(NUMBERS, at))

    start, last = np.full(5, 0.05), np.full(5, 10.0)
    alone, together = (
        first_crossing(stress, start, last, same_grid=same_grid)
        for same_grid in (None, lambda index, at: np.full(len(at), 1e9))
    )
    assert alone.crossed.all() and together.crossed.all()
    assert_allclose(together.at, tops * np.exp(-0.45 * np.sqrt(np.log(1.02))), rtol=1e-6)
    assert_allclose(together.at, alone.at, rtol=1e-6)

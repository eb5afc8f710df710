"""Bracketing, and the second attempt that uses it."""

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal
from solver_cases import LOAD, difference, one

from solver.numerics.bracket import false_position

ROOT = np.array([-40.0, -1.0, 0.0, 0.3, 7.0, 300.0])


def function(x, index):
    """Increasing, of very unequal slopes on the two sides of its root."""
    d = x - ROOT[index]
    return np.where(d > 0, 20 * d, 0.01 * d) + d**3


def test_roots_near_and_far():
    tolerance = np.full(6, 1e-10)
    x, g = false_position(function, np.zeros(6), tolerance)
    assert_allclose(x, ROOT, rtol=0, atol=1e-7)
    assert_array_equal(g, function(x, np.arange(6)))


def test_a_smooth_function_takes_few_steps():
    """Halving both ends in turn, each step only halved the error: 30 and more evaluations."""
    asked = []
    x, _ = false_position(lambda x, i: asked.append(x) or np.expm1(3 * (x - 0.37)), np.zeros(1), np.full(1, 1e-12))
    assert_allclose(x, 0.37, rtol=0, atol=1e-12)
    assert len(asked) <= 13


def test_company_changes_nothing_and_the_finished_are_left_alone():
    asked = np.zeros(6, dtype=int)

    def counted(x, index):
        asked[index] += 1
        return function(x, index)

    together, _ = false_position(counted, np.zeros(6), np.full(6, 1e-10))
    in_company = asked.copy()
    for i in range(6):
        asked[:] = 0
        alone, _ = false_position(lambda x, index, i=i: counted(x, index + i), np.zeros(1), np.full(1, 1e-10))
        assert alone[0] == together[i]
        assert asked[i] == in_company[i]


def test_no_value_is_given_up():
    """NaN on one side: that case is not searched, and its last value is not a small one."""
    x, g = false_position(
        lambda x, index: np.where((index == 0) & (x > 0), np.nan, x - 1), np.zeros(2), np.full(2, 1e-9)
    )
    assert np.isnan(g[0])
    assert_allclose(x[1], 1, rtol=1e-9, atol=0)


def test_a_radius_that_newton_loses():
    """A film 100,000 times as stiff as what it lies on, without roughness: the load hardly depends on the radius."""
    case = {"h": 1e-4, "n": 1e5, "base": "layered", "micro": "smooth"}
    s = one(P=LOAD, **case)
    assert s.status[0] == 0
    by_radius = one(a=s.a, **case)
    assert difference(by_radius, s)[0] < 1e-5

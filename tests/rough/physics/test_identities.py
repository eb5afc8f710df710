"""One problem in two ways: models that come to the same, and the ends of what is allowed."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import LOAD, MAIN, one

from solver import Model, Problem, Status, solve

NUMBERS = ("a", "P", "D", "p0", "A0", "dP_dD", "p")


@pytest.mark.parametrize("control", [{"P": LOAD}, {"a": 0.04}, {"D": 1e-3}], ids=str)
def test_a_power_law_with_exponent_one_is_springs(control):
    """A = B Ra p/E* on a half-space is a smooth punch on a thin layer with C = B Ra/E*: here h/n."""
    x = np.array([0.0, 0.5, 0.9])
    rough = one(x, **control, base="half_space", micro="power_law", B=10.0, Ra=0.004, beta=1.0, rtol=1e-10)
    springs = one(x, **control, base="thin_layer", micro="smooth", h=0.02, n=0.5, bonding="frictionless", rtol=1e-10)
    assert rough.status[0] == springs.status[0] == Status.CONVERGED
    for name in ("a", "P", "D", "p0", "dP_dD", "p"):
        assert_allclose(getattr(rough, name), getattr(springs, name), rtol=1e-9, atol=0, err_msg=name)
    assert_allclose(rough.A0, 0.04 * rough.p0, rtol=1e-12, atol=0)


def test_springs_add():
    """On a thin layer they are so much more of it, h/n = 0.04 + 0.04."""
    rough = one(P=LOAD, base="thin_layer", micro="power_law", B=0.04 * 0.5 / 0.004, Ra=0.004, beta=1.0, rtol=1e-10)
    springs = one(P=LOAD, base="thin_layer", micro="smooth", h=0.04, n=0.5, rtol=1e-10)
    for name in ("a", "D", "p0", "dP_dD"):
        assert_allclose(getattr(rough, name), getattr(springs, name), rtol=1e-9, atol=0, err_msg=name)


EDGES = [
    {"beta": 1.0}, {"nodes": 4}, {"nodes": 256}, {"nu1": 0.5}, {"nu2": 0.5}, {"nu1": -0.999, "nu2": -0.999},
    {"k": 0.0}, {"max_iterations": 0}, {"rtol": 0.999}, {"base": "auto", "accuracy": 0.999},
]  # fmt: skip


@pytest.mark.parametrize("edge", EDGES, ids=str)
def test_the_ends_of_what_is_allowed_are_allowed(edge):
    case = MAIN | {"base": "thin_layer", "micro": "power_law", "rtol": 0.5} | edge
    assert solve(Problem.of(P=LOAD, **case)).status[0] == Status.CONVERGED


OUTSIDE = [
    {"beta": 1.0 + 1e-12}, {"beta": 0.0}, {"nodes": 3}, {"nodes": 257}, {"nu1": 0.5 + 1e-12}, {"nu1": -1.0},
    {"nu2": 0.5 + 1e-12}, {"nu2": -1.0}, {"k": -1e-12}, {"k": np.inf}, {"max_iterations": -1}, {"rtol": 1.0},
    {"rtol": 0.0}, {"base": "auto", "accuracy": 1.0}, {"base": "auto", "accuracy": 0.0}, {"P": np.inf}, {"h": np.inf},
    {"R": np.inf}, {"E2": 0.0}, {"B": 0.0}, {"Nbar": np.inf}, {"Ra": 0.0}, {"n": 1e-10},
]  # fmt: skip


@pytest.mark.parametrize("outside", OUTSIDE, ids=str)
def test_beyond_them_is_a_status(outside):
    case = MAIN | {"base": "thin_layer", "micro": "power_law", "P": LOAD} | outside
    s = solve(Problem.of(**case))
    assert s.status[0] == Status.INVALID_INPUT and s.model_used[0] in (Model.NONE, Model.THIN_LAYER)
    assert np.isnan(s.a[0]) and np.isnan(s.p[0]).all()


@pytest.mark.parametrize("base", ["half_space", "thin_layer", "layered"])
def test_what_a_case_does_not_need_may_be_anything(base):
    """A smooth punch has no asperities; a half-space no layer; only a power law has B and beta."""
    nothing = {"Nbar": np.nan, "Ra": -1.0, "B": 0.0, "beta": 7.0}
    layer = {"h": -1.0, "n": np.nan, "nu1": 3.0, "nu2": -7.0} if base == "half_space" else {}
    assert solve(Problem.of(**MAIN | nothing | layer, P=LOAD, base=base, micro="smooth")).status[0] == 0
    unused = {"B": 0.0, "beta": 7.0, "accuracy": 0.0}
    assert solve(Problem.of(**MAIN | unused | layer, P=LOAD, base=base, micro="disc_cell")).status[0] == 0

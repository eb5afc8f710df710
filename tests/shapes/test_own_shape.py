"""A shape of somebody else's (steep_ball.py), as docs/own_shape.md says: smooth and rough."""

import numpy as np
import pages
import pytest
import steep_ball
from conftest import ROOT
from numpy.testing import assert_allclose
from scipy.integrate import quad

from solver import Problem, Status, solve
from solver.known import register
from solver.shapes import shape_of

CASE = {"shape": "steep_ball", "steepness": 2.0}


@pytest.fixture(autouse=True)
def known(forgetful):
    """The shape is known within a test, and forgotten after it."""
    register(steep_ball.KIND)


def test_the_page_shows_it():
    assert (ROOT / "tests/shapes/steep_ball.py").read_text(encoding="utf-8") in pages.blocks(
        "docs/own_shape.md", "python"
    )


def test_it_is_what_its_slope_says():
    a, shape = 0.2, shape_of(Problem.of(P=1.0, base="half_space", micro="smooth", **CASE))
    F = quad(lambda z: a * shape.slope(np.array([[a * np.sin(z)]])).item(), 0, np.pi / 2, epsabs=0, epsrel=1e-13)[0]
    load = quad(lambda t: F - shape.lifted(np.array([[t]])).item(), 0, a, epsabs=0, epsrel=1e-13)[0]
    assert_allclose(shape.lifted(np.array([[a]])).item(), F, rtol=1e-12)
    assert_allclose(shape.lifted_load(np.array([a])), load, rtol=1e-12)
    drop = 2 / a**2 * (shape.height(np.array([[a]])) - shape.height(np.array([[0.6 * a]])))
    assert_allclose(shape.drop(np.array([a]), np.array([0.8])), drop, rtol=1e-13)


@pytest.mark.parametrize("control", ["a", "P", "D"])
def test_on_a_half_space_it_is_sneddons(control):
    a, c = 0.1, 2.0
    exact = {"a": a, "P": 4 / 3 * a**3 + 9 * np.pi / 8 * c * a**4, "D": a**2 + 3 * np.pi / 4 * c * a**3}
    case = {control: exact[control], "base": "half_space"} | CASE
    smooth = solve(Problem.of(**case, micro="smooth", rtol=1e-8))
    rough = solve(Problem.of(**case, Nbar=1e12, Ra=1e-4, rtol=1e-5))
    for name, value in exact.items():
        assert_allclose(getattr(smooth, name), value, rtol=1e-8, atol=0)
        assert_allclose(getattr(rough, name), value, rtol=1e-4, atol=0)  # asperities yield by 1e-6 D here
    assert smooth.status.tolist() == rough.status.tolist() == [Status.CONVERGED]


def test_rough_on_a_layer_it_is_what_finer_panels_say():
    case = {"P": 1e-3, "h": 0.05, "n": 0.3, "Nbar": 250000.0, "Ra": 0.004} | CASE
    coarse, fine = (solve(Problem.of(**case, rtol=rtol)) for rtol in (1e-4, 1e-8))
    for name in ("a", "P", "D", "p0", "p_max", "Ar_An"):
        far = abs(getattr(coarse, name)[0] / getattr(fine, name)[0] - 1)
        assert far <= coarse.error[0] <= 1e-4, name

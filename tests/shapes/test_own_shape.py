"""A shape of somebody else's (worn_tip.py), as docs/extending.md says: smooth and rough."""

import numpy as np
import pages
import pytest
import worn_tip
from conftest import ROOT
from numpy.testing import assert_allclose
from scipy.integrate import quad

from solver import Problem, Status, solve
from solver.parameters import PARAMETERS
from solver.shapes import SHAPES, register, shape_of

CASE = {"shape": "worn_tip", "wear": 0.3}


@pytest.fixture(autouse=True)
def known(monkeypatch):
    """The shape is known within a test, and forgotten after it."""
    monkeypatch.setitem(PARAMETERS, "shape", PARAMETERS["shape"])
    monkeypatch.setitem(PARAMETERS, "wear", worn_tip.KIND.parameters["wear"]._replace(needed_by=("shape", ())))
    monkeypatch.setitem(SHAPES, "worn_tip", worn_tip.KIND)
    register(worn_tip.KIND)


def test_the_page_shows_it():
    assert (ROOT / "tests/shapes/worn_tip.py").read_text(encoding="utf-8") in pages.blocks(
        "docs/extending.md", "python"
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
    a, c, B = 0.1, 0.3, worn_tip.B
    exact = {"a": a, "P": 2 * (2 / 3 * a**3 + 0.6 * B * c * a**2.5), "D": a**2 + c * B * a**1.5}
    case = {control: exact[control], "base": "half_space"} | CASE
    smooth = solve(Problem.of(**case, micro="smooth", rtol=1e-8))
    rough = solve(Problem.of(**case, Nbar=1e16, Ra=1e-4, rtol=1e-5))
    for name, value in exact.items():
        assert_allclose(getattr(smooth, name), value, rtol=1e-8, atol=0)
        assert_allclose(getattr(rough, name), value, rtol=1e-4, atol=0)  # A/D is 2e-5 here
    assert smooth.status.tolist() == rough.status.tolist() == [Status.CONVERGED]


def test_rough_on_a_layer_it_is_what_finer_panels_say():
    case = {"P": 1e-3, "h": 0.05, "n": 0.3, "Nbar": 250000.0, "Ra": 0.004} | CASE
    coarse, fine = (solve(Problem.of(**case, rtol=rtol)) for rtol in (1e-4, 1e-8))
    for name in ("a", "P", "D", "p0", "p_max", "Ar_An"):
        far = abs(getattr(coarse, name)[0] / getattr(fine, name)[0] - 1)
        assert far <= coarse.error[0] <= 1e-4, name

"""Load and depth, what the shape makes of them and what adhesion takes, against contacts that are solved."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem, solve
from solver.shapes import shape_of
from solver.smooth.adhesion.curve_terms import curve_terms
from solver.smooth.radius import Radii

LAYER = {"h": 0.3, "nu1": 0.45, "bonding": "bonded"}
GRADED = {"h": 0.3, "n": [0.5, 2.0], "nu": 0.3, "profile": "exponential", "bonding": "bonded"}
#: Inputs, and to what P and D agree: a graded layer is extrapolated from fewer sublayers here.
CASES = {
    "half-space under a punch": ({"base": "half_space", "m": 0.3}, 1e-12),
    "layer under a punch": (LAYER | {"n": 1e-3, "m": 0.2}, 1e-10),
    "sphere on a rigid base": (LAYER | {"n": 0.0, "shape": "sphere"}, 1e-10),
    "frustum": (LAYER | {"n": 0.5, "shape": "frustum", "flat_radius": 0.05, "half_angle": 70.0}, 1e-10),
    "dmt": ({"base": "half_space", "adhesion": "dmt"}, 1e-12),
    "maugis": ({"base": "half_space", "adhesion": "maugis", "sigma0": 0.01}, 1e-9),
    "graded": ({"layers": [GRADED], "rtol": 1e-5}, 1e-4),
}


@pytest.mark.parametrize("name", CASES)
def test_differences_are_the_contact(name):
    inputs, rtol = CASES[name]
    asked = Problem.of(a=np.full(3, 0.2), w_adhesion=np.array([1e-6, 1e-5, 1e-4]), micro="smooth", **inputs)
    x = Radii(shape_of(asked)).of(asked.value)[:, None]
    parts = curve_terms(asked, x)
    solved = solve(asked, np.array([0.0]))
    assert np.isfinite(solved.P).all()
    P, D = (parts.values[i] - parts.values[i + 2] for i in (0, 1))
    assert_allclose(P[:, 0], solved.P, rtol=rtol, atol=0)
    assert_allclose(D[:, 0], solved.D, rtol=rtol, atol=0)
    more, less = curve_terms(asked, x + 1e-4), curve_terms(asked, x - 1e-4)
    slopes = (more.values - less.values) / 2e-4
    assert_allclose(parts.slopes, slopes, rtol=1e-5, atol=1e-6 * np.abs(parts.values).max())

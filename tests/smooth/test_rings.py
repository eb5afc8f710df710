"""Rings of attraction, the parts of the shape and of the stress, against Maugis' closed forms and contacts that are
solved."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem, solve
from solver.shapes import shape_of
from solver.smooth.adhesion.curve_terms import curve_terms
from solver.smooth.adhesion.rings import rings
from solver.smooth.radius import Radii

STICKS = {"micro": "smooth", "adhesion": "maugis"}
LAYER = {"h": 0.3, "nu1": 0.45, "n": 0.5, "bonding": "bonded"}
#: Inputs, and to what numbers agree.
CASES = {
    "half-space under a punch": ({"base": "half_space", "m": 0.3}, 1e-9),
    "sphere on a layer": (LAYER | {"shape": "sphere"}, 1e-9),
    "frustum": (LAYER | {"shape": "frustum", "flat_radius": 0.05, "half_angle": 70.0, "m": 0.2}, 1e-7),
}


def test_on_a_half_space_the_parts_are_the_closed_forms():
    """Maugis (1992), with E* = 3K/4: 1e-9, also of rings of 1e-4 of the radius and of ones 100 times as wide."""
    problem = Problem.of(base="half_space", a=0.1, w_adhesion=1e-4, sigma0=0.01, **STICKS)
    over = np.array([1e-4, 1e-2, 0.3, 1.0, 100.0])
    made = rings(problem, np.log(np.full((1, 5), 0.1)), 0.1 * over[None])
    m, tan = 1 + over, np.sqrt(over * (2 + over))
    t, a = np.arctan(tan), 0.1
    assert_allclose(made.gap[0], a**2 / np.pi * (tan + (m**2 - 2) * t), rtol=1e-9, atol=0)
    assert_allclose(made.opening[0], 4 * a / np.pi * (tan * t - over), rtol=1e-9, atol=0)
    assert_allclose(made.load[0], -2 * a**2 * (tan + m**2 * t), rtol=1e-12, atol=0)
    assert_allclose(made.depth[0], -2 * a * tan, rtol=1e-12, atol=0)


@pytest.mark.parametrize("name", CASES)
def test_parts_are_the_contact(name):
    """A contact with the work of adhesion of a ring has, with the parts of the shape, its load and depth."""
    inputs, rtol = CASES[name]
    sigma, a = np.array([2e-3, 1e-2, 3e-2]), np.full(3, 0.2)
    about = {"a": a, "sigma0": sigma, **STICKS, **inputs}
    problem = Problem.of(w_adhesion=np.ones(3), **about)
    x = Radii(shape_of(problem)).of(a)[:, None]
    gap, opening, load, depth = (part[:, 0] for part in rings(problem, x, np.array([[0.003], [0.05], [0.3]])))
    solution = solve(Problem.of(w_adhesion=sigma * (gap + sigma * opening), **about), np.array([0.0]))
    free = curve_terms(problem.but(adhesion=np.full(3, "jkr")), x).values[:2, :, 0]
    assert_allclose(free[0] + sigma * load, solution.P, rtol=rtol, atol=0)
    assert_allclose(free[1] + sigma * depth, solution.D, rtol=rtol, atol=0)

"""Smooth contacts at a = R, which the tables of first yield have, beside the contacts of the solver."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem, solve
from solver.scaling import dimensionless
from solver.yields.contact import of_contacts
from solver.yields.similar.under_load import extremes_at, radius_under
from solver.yields.similar.unit_contacts import Sought, are_similar, unit_contacts

BODIES = {"nu1": 0.25, "nu2": 0.35, "m": 0.5, "bonding": "bonded"}


def test_numbers_and_stresses_are_those_of_the_solver():
    """To its rtol and to the 1e-6 of extremes; of rigid bodies in the unit of the layer."""
    h, n = np.array([1.0, 0.3, 0.05, 0.3]), np.array([5.0, 0.2, 5.0, 0.0])
    problem = Problem.of(a=0.12, h=0.12 * h, n=n, R=3.0, E2=7.0, micro="smooth", rtol=1e-8, **BODIES)
    solution, layer = solve(problem), of_contacts(problem, solve(problem), names=("mises1",))["mises1"]
    made = unit_contacts(dimensionless(problem), h, Sought("layer", 0.0))
    a = solution.a / problem.R
    assert_allclose(made.P * a**3 * problem.E2 * problem.R**2, solution.P, rtol=1e-7)
    assert_allclose(made.D * a**2 * problem.R, solution.D, rtol=1e-7)
    assert_allclose(made.p0 * a * problem.E2, solution.p0, rtol=1e-7)
    assert_allclose(made.mises * a * problem.E2, layer[0], rtol=2e-6)
    assert_allclose([made.r, made.z], layer[1:], rtol=0, atol=2e-3)
    assert are_similar(problem, np.full(4, 0.2)).all()
    assert_allclose(extremes_at(problem, solution.a, ("mises1",))["mises1"][0], layer[0], rtol=2e-6)
    assert_allclose(radius_under(problem, solution.P, 2 * solution.a), solution.a, rtol=1e-7)


def test_few_nodes_are_enough_for_the_coarse_grid():
    problem = Problem.of(a=1.0, h=1.0, n=np.array([0.1, 3.0, 30.0]), micro="smooth", **BODIES)
    for t in (0.5, 0.02):
        for body in ("layer", "body"):
            fine, coarse = (
                unit_contacts(problem, np.full(3, t), Sought(body, 0.0), None, coarse).mises for coarse in (False, True)
            )
            assert np.all(coarse > 0.85 * fine) and np.all(coarse < 1.002 * fine), (t, body)


@pytest.mark.parametrize(
    "other",
    [
        {"base": "half_space"},
        {"base": "thin_layer"},
        {"base": "auto"},
        {"shape": "power", "shape_power": 4.0, "shape_coefficient": 1.0},
        {"micro": "disc_cell", "Nbar": 1e6, "Ra": 0.01},
        {"w_adhesion": 1e-6},
        {"h": 1e-5},
        {"n": -1.0},
    ],
    ids=lambda other: next(iter(other)),
)
def test_which_contacts_have_no_tables(other):
    given = {"a": 0.1, "h": 0.02, "n": 2.0, "micro": "smooth", **BODIES} | other
    assert not are_similar(Problem.of(**given), np.full(1, 0.2))[0]

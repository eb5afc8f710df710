"""The residual of the discrete equation, and gaps, of which none is asked, on states written by hand."""

import numpy as np
import pytest

from solver import Problem
from solver.body.half_space import half_space
from solver.laws import LAWS, Curve
from solver.numerics.mesh import mesh_of
from solver.rough import newton
from solver.rough.equation import _ROUNDING, Cases, Evaluation, Unknowns, evaluate
from solver.rough.newton import solve_on
from solver.rough.start import first_guess
from solver.scaling import as_cases
from solver.shapes.paraboloid import Paraboloid

ONE = np.ones(1)


def evaluation(q, F, G):
    """At two nodes, with X = Y = Z = 1, a law whose g is 1e-3, and ln a beside the given one by G."""
    q, F, one = np.array([q]), np.array([F]), np.ones((1, 1))
    curve = Curve(q=q, g=np.full_like(q, 1e-3), dq=np.ones_like(q), dg=np.ones_like(q))
    body = half_space(0 * ONE)
    cases = Cases("a", LAWS["smooth"].bind(ONE), body, ONE, Paraboloid(2 * ONE))
    return Evaluation(cases, Unknowns(q, np.array([G])), body.at(ONE, mesh_of(2)), curve, one, one, one, q, q[:, 0], F)


@pytest.mark.parametrize(("F", "G", "expected"), [([1e-3, -0.2], 0.1, 0.2), ([1e-3, -0.2], -0.5, 0.5)])
def test_the_residual_is_the_largest_of_nodes_and_control(F, G, expected):
    assert evaluation([1.0, 1.0], F, G).residual.item() == expected


def test_a_gap_is_height_without_pressure():
    """Without pressure the surface hangs below the asperities: F - Z g of it is a gap. Tension is none."""
    np.testing.assert_array_equal(evaluation([1.0, 0.0], [0.5, 0.5], 0.0).gap, [[0, 0.5 - 1e-3]])
    np.testing.assert_array_equal(evaluation([1.0, -0.1], [0.5, 0.5], 0.0).gap, [[0, 0]])
    np.testing.assert_array_equal(evaluation([1.0, 0.0], [0.5, -0.5], 0.0).gap, [[0, 0]])


def test_of_a_gap_no_residual_is_asked():
    """Tension is none, nor is a residual beside pressure."""
    assert evaluation([1.0, 0.0], [1e-3, 0.5], 0.0).residual.item() == 1e-3
    assert evaluation([1.0, -0.1], [1e-3, 0.5], 0.0).residual.item() == 0.5
    assert evaluation([1.0, 0.1], [1e-3, 0.5], 0.0).residual.item() == 0.5


def test_an_iterate_without_pressure_in_the_centre_has_an_error_bar():
    """One of the paper's scheme: its p(0) is no small part of anything, and 0/0 made it a case without numbers."""
    assert evaluation([1.0, 0.0], [0.0, 0.0], 0.0).floor.item() == 8 * np.finfo(float).eps


@pytest.mark.parametrize("nodes", [12, 64])
@np.errstate(all="ignore")  # as in the solver
def test_rounding_of_soft_layers(nodes):
    """The residual of solutions under a load, over four further steps, times the softness of the layer. What is above
    _ROUNDING costs a case one step more: 2 in 800 under three BLAS kernels, 14 under one of an old processor."""
    random = np.random.default_rng(0)
    h, n = 0.04 * 10 ** random.uniform(-2, 0, 200), 10 ** random.uniform(-6, -1, 200)
    layer = {"h": h, "n": n, "nu1": random.choice([0.3, 0.49, 0.5], 200), "bonding": ["bonded", "frictionless"] * 100}
    cases = as_cases(Problem.of(P=1e-5, **layer, micro="smooth", base="layered"))
    at, found = solve_on(evaluate(cases, first_guess(cases, mesh_of(nodes)), mesh_of(nodes))).at, []
    for _ in range(4):
        at = newton.step(at)
        found.append(at.residual * cases.body.softness(np.exp(at.state.eta)))
    assert 0.1 < np.median(found) / np.finfo(float).eps < 1
    assert np.mean(np.array(found) > _ROUNDING) < 0.05

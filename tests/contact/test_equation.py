"""The residual of the discrete equation, gaps, of which none is asked, and its matrix, on states written by hand."""

import numpy as np
import pytest

from solver import Problem
from solver.contact import driver
from solver.contact.equation import Evaluation, Operator, State, evaluate
from solver.laws import Curve
from solver.numerics.mesh import mesh
from solver.scaling import as_cases, dimensionless


def evaluation(q, F, G, weights=()):
    """At two nodes, with X = Y = Z = 1 and a law whose g is 1e-3."""
    q, F, one = np.array([q]), np.array([F]), np.ones((1, 1))
    curve = Curve(q=q, g=np.full_like(q, 1e-3), dq=np.ones_like(q), dg=np.ones_like(q))
    base = Operator(q, q[:, 0], q, q[:, 0], list(weights))
    return Evaluation(q, one, one, one, curve, base, F, np.array([G]))


@pytest.mark.parametrize(("F", "G", "expected"), [([1e-3, -0.2], 0.1, 0.2), ([1e-3, -0.2], -0.5, 0.5)])
def test_the_residual_is_the_largest_of_nodes_and_control(F, G, expected):
    assert evaluation([1.0, 1.0], F, G).residual.item() == expected


def test_a_gap_is_height_without_pressure():
    """Without pressure the surface hangs below the asperities: F - Z g of it is a gap. Tension is none."""
    np.testing.assert_array_equal(evaluation([1.0, 0.0], [0.5, 0.5], 0.0).gap, [[0, 0.5 - 1e-3]])
    np.testing.assert_array_equal(evaluation([1.0, -0.1], [0.5, 0.5], 0.0).gap, [[0, 0]])
    np.testing.assert_array_equal(evaluation([1.0, 0.0], [0.5, -0.5], 0.0).gap, [[0, 0]])


def test_of_a_gap_no_residual_is_asked_under_a_plate():
    layer = [object()]  # weights of the exact layer: only there can asperities hang over the surface
    assert evaluation([1.0, 0.0], [1e-3, 0.5], 0.0, layer).residual.item() == 1e-3
    assert evaluation([1.0, -0.1], [1e-3, 0.5], 0.0, layer).residual.item() == 0.5
    assert evaluation([1.0, 0.0], [1e-3, 0.5], 0.0).residual.item() == 0.5


def test_the_matrix_of_a_layer_follows_the_radius():
    """It is formed anew for the case whose radius has moved by more than a thousandth; the other keeps its own."""
    grid = mesh(8)
    problem = Problem.of(a=[0.04, 0.04], h=0.02, n=0.5, micro="smooth")
    cases = as_cases(*dimensionless(problem))
    at = np.log([0.04, 0.04])
    first, moved = (evaluate(cases, State(np.ones((2, 8)), eta), grid) for eta in (at, at + [1e-2, 1e-5]))
    lagged = driver._matrix(None, first, at, grid)
    np.testing.assert_array_equal(lagged[0], first.base.matrix(grid))
    K, of = driver._matrix(lagged, moved, at + [1e-2, 1e-5], grid)
    expected = [moved.base.matrix(grid)[0], first.base.matrix(grid)[1]]
    np.testing.assert_allclose(K, expected, rtol=0, atol=1e-13 * np.abs(K).max())  # sums in another company
    np.testing.assert_array_equal(of, at + [1e-2, 0])
    assert np.abs(K[0] / first.base.matrix(grid)[0] - 1).max() > 1e-4

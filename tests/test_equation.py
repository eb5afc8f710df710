"""The residual of the discrete equation, and the gaps that are not asked of it, on states written by hand."""

import numpy as np
import pytest

from solver.equation import Evaluation, Operator
from solver.micro import Curve


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

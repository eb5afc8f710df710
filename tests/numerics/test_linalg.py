"""Stacks of systems: eliminated together or one by one, the same solutions; bad members spoil no others."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import layer_of

from solver.numerics.linalg import solve_stack
from solver.numerics.mesh import mesh_of

MANY = 300


def operators(n, base, random):
    """K (B or 1, n, n) of a half-space or of random layers."""
    if base == "half_space":
        return mesh_of(n).K[None]
    h, stiffness = 10.0 ** random.uniform(-1, 1, MANY), 10.0 ** random.uniform(-3, 3, MANY)
    nu1, nu2, bonded = random.uniform(0, 0.49, MANY), np.full(MANY, 0.3), random.random(MANY) < 0.5
    return layer_of(h=h, n=stiffness, nu1=nu1, nu2=nu2, bonded=bonded).at(np.ones(MANY), mesh_of(n)).K


@pytest.mark.parametrize("base", ["half_space", "layered"])
@pytest.mark.parametrize("n", [5, 12, 32])
def test_solutions(n, base):
    """Of 300 at once those of numpy.linalg.solve, with asperities from none to far softer than the base."""
    random = np.random.default_rng(1)
    K = operators(n, base, random)
    slope = random.uniform(-2, 4, (MANY, 1))
    diagonal = 10 ** random.uniform(-9, 3, (MANY, 1)) * mesh_of(n).s ** slope * random.uniform(0.5, 2, (MANY, n))
    diagonal[:20] = 0.0
    rhs = random.standard_normal((MANY, n, 2))
    x = solve_stack(K, diagonal, rhs)
    matrix = K + diagonal[:, :, None] * np.eye(n)
    size = np.abs(matrix) @ np.abs(x) + np.abs(rhs)
    assert (np.abs(matrix @ x - rhs) / size).max() < n * np.finfo(float).eps
    expected = np.linalg.solve(matrix, rhs)
    condition = np.linalg.cond(matrix)[:, None, None]
    assert np.all(np.abs(x - expected) <= 1e-14 * condition * np.abs(expected).max(axis=1, keepdims=True))


@pytest.mark.parametrize("count", [MANY, 7])
def test_bad_members_alone_are_bad(count):
    """A singular matrix and one that is not a number give NaN, one that needs an exchange of rows its solution."""
    random = np.random.default_rng(2)
    K = np.tile(mesh_of(6).K, (count, 1, 1))
    K[0], K[1], K[2, 3, 3], K[3] = 0.0, np.eye(6)[::-1], np.nan, -mesh_of(6).K
    rhs = random.standard_normal((count, 6, 1))
    x = solve_stack(K, np.zeros((count, 6)), rhs)
    assert np.isnan(x[0]).all()
    assert np.isnan(x[2]).any()
    assert_allclose(x[1], rhs[1, ::-1], rtol=0, atol=0)
    good = np.r_[1, 3:count]
    assert_allclose(x[good], np.linalg.solve(K[good], rhs[good]), rtol=1e-11, atol=0)


def test_an_indefinite_member_of_a_shared_operator():
    """Its pivots are not all positive: it gets its solution nevertheless."""
    random, K = np.random.default_rng(3), mesh_of(6).K
    diagonal, rhs = random.random((MANY, 6)), random.standard_normal((MANY, 6, 2))
    diagonal[5] = -1.0
    x = solve_stack(K[None], diagonal, rhs)
    assert_allclose(x, np.linalg.solve(K + diagonal[:, :, None] * np.eye(6), rhs), rtol=1e-11, atol=0)


def test_a_negative_pivot_near_zero_costs_no_digits():
    """Without an exchange of rows [[-1e-14, 1], [1, 1]] loses fourteen of them."""
    K = np.tile(np.eye(2), (MANY, 1, 1))
    K[0] = [[-1e-14, 1.0], [1.0, 1.0]]
    x = solve_stack(K, np.zeros((MANY, 2)), np.tile([[1.0], [3.0]], (MANY, 1, 1)))
    assert_allclose(x[0, :, 0], [2.0, 1.0], rtol=1e-13, atol=0)  # 1e-14 is what the pivot changes

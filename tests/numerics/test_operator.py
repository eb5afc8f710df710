"""Quadrature, nodes and the half-space operator: closed forms, reciprocity, spectral convergence."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import beta, ellipe, factorial, hyp2f1

from solver import Problem
from solver.numerics.mesh import half_space_rows, mesh_of
from solver.numerics.quadrature import gauss_legendre, lagrange, log_rule, pieces, radau_nodes
from solver.scaling import as_cases, dimensionless
from solver.shapes.paraboloid import HERTZ

#: Points in s = sqrt(1 - x²), from the edge to the centre.
S = np.concatenate([[0.0, 1e-12, 1e-6, 1e-3], np.linspace(0.05, 0.95, 19), [1 - 1e-3, 1 - 1e-6, 1.0]])


def displacement_of_power(m, s):
    """H[s^m]: the displacement under (1 - x²)^(m/2) (Weber-Schafheitlin), for u = (4/π) H in units of a/E*.

    2F1(1/2, -(m + 1)/2; 1; x²) is a polynomial for odd m; x² = 1 - s² is near 1 at the edge, where it is Gauss's value.
    """
    x2 = (1 - s) * (1 + s)
    return np.pi / 4 * beta(m / 2 + 1, 0.5) * hyp2f1(0.5, -(m + 1) / 2, 1, x2)


@pytest.mark.parametrize("n", [4, 12, 24, 48])
def test_polynomial_pressures_are_exact(n):
    rows = half_space_rows(radau_nodes(n), S)
    for m in {0, 1, 2, 3, n // 2, n - 1}:
        expected = displacement_of_power(m, S)
        assert_allclose(rows @ radau_nodes(n) ** m, expected, rtol=0, atol=1e-14, err_msg=f"s^{m}")


def test_points_of_a_narrow_panel_far_away_are_where_the_rule_has_them():
    """As differences of places they were wrong by the rounding of s over the length of the panel."""
    breaks = (0.0, 2.0**-30, 0.3, 1.0)
    for piece in pieces(np.array([0.7]), breaks, 12):
        narrow = piece._replace(local=piece.local[piece.panel == 0]) if len(piece.local) > 1 else piece
        if 0 in piece.panel:
            t, _ = gauss_legendre(18)
            assert_allclose(np.sort(narrow.local[0]), t, rtol=0, atol=1e-14)


def test_uniform_pressure():
    """p = 1: u = (4/π) a/E* E(x), Johnson (1985) 3.29a."""
    s = S[1:]
    assert_allclose(half_space_rows(radau_nodes(8), s).sum(axis=1), ellipe((1 - s) * (1 + s)), rtol=1e-14, atol=0)


def test_hertz_and_the_next_pressure():
    """p = s: u = (π/4)(2 - x²); p = s³: u = (3π/64)(8 - 8x² + 3x⁴); H = π u/4."""
    x2, rows, nodes = 1 - S**2, half_space_rows(radau_nodes(8), S), radau_nodes(8)
    assert_allclose(rows @ nodes, np.pi / 4 * np.pi / 4 * (2 - x2), rtol=3e-15, atol=0)
    assert_allclose(rows @ nodes**3, np.pi / 4 * 3 * np.pi / 64 * (8 - 8 * x2 + 3 * x2**2), rtol=5e-15, atol=0)


@pytest.mark.parametrize("n", [4, 16, 64])
def test_mesh_parts(n):
    mesh = mesh_of(n)
    s = mesh.s
    assert mesh.n == n
    assert s[-1] == 1
    assert mesh.x[-1] == 0
    assert np.all(np.diff(s) > 0)
    for m in {0, 1, 2, min(3, n - 1), n - 1, 2 * n - 3}:
        assert_allclose(mesh.w @ s**m, 1 / (m + 2), rtol=1e-14 * max(10, m), atol=0)
    assert_allclose(mesh.K @ s, HERTZ * s**2, rtol=0, atol=1e-14)
    assert_allclose(mesh.edge @ s, HERTZ, rtol=1e-14, atol=0)
    assert_allclose(mesh.K @ np.ones(n), ellipe(mesh.x**2) - 1, rtol=0, atol=1e-13)
    assert mesh_of(n) is mesh
    with pytest.raises(ValueError, match="read-only"):
        mesh.K[0, 0] = 0


def test_reciprocity():
    """∫ p1 u2 = ∫ p2 u1: Betti, for all pairs of polynomials on a mesh."""
    n = 10
    nodes = radau_nodes(n)
    distance, weight = log_rule(20)  # the displacement has s² log s at the edge
    u = half_space_rows(nodes, np.minimum(distance, 1.0))
    work = lagrange(nodes, distance).T @ ((weight * distance)[:, None] * u)
    assert_allclose(work, work.T, rtol=0, atol=1e-15 * np.abs(work).max() * 10)
    assert np.linalg.eigvalsh(0.5 * (work + work.T)).min() > 0  # and an elastic body stores energy


def test_spectral_convergence():
    """A pressure analytic in s: the error falls by more than two digits for every two nodes, down to rounding."""
    expected = sum(displacement_of_power(m, S) * 2.0**m / factorial(m) for m in range(60))
    rows = [half_space_rows(radau_nodes(n), S) @ np.exp(2 * radau_nodes(n)) for n in (4, 6, 8, 10, 12)]
    error = np.abs(np.array(rows) - expected).max(axis=1)
    assert np.all(error[1:] < error[:-1] / 100)
    assert error[-1] < 1e-12


def test_algebraic_singularity_converges_algebraically():
    """s^1.2 at the edge: at least n^-4, so that the test above tells the two apart."""
    expected = displacement_of_power(1.2, S)
    found = [half_space_rows(radau_nodes(n), S) @ radau_nodes(n) ** 1.2 for n in (8, 16, 32, 64)]
    error = [np.abs(u - expected).max() for u in found]
    rate = np.log2(np.array(error[:-1]) / error[1:])
    assert np.all((rate > 3) & (rate < 8))


@pytest.mark.parametrize("base", ["half_space", "thin_layer", "layered"])
@pytest.mark.parametrize("size", [1, 3])
def test_part_of_a_batch(base, size):
    """What the operator gives has a row for each case: no case of one leaves no row, whatever the batch shares."""
    problem = Problem.of(a=np.linspace(0.02, 0.04, size), h=0.02, n=0.5, Nbar=250000, Ra=0.004, base=base)
    cases = as_cases(dimensionless(problem))
    mesh, q = mesh_of(6), np.linspace(1, 2, size)[:, None] * mesh_of(6).s
    whole = cases.body.at(cases.value, mesh)
    for index in (np.arange(0), np.array([size - 1])):
        part, alone = whole.take(index), cases.body.take(index).at(cases.value[index], mesh)
        rows = (*part.products(q[index]), *part.slopes(q[index]))
        for found, expected in zip(rows, (*alone.products(q[index]), *alone.slopes(q[index])), strict=True):
            assert found.shape == expected.shape == (len(index), *(6,) * (found.ndim - 1))
            assert_allclose(found, expected, rtol=0, atol=1e-14)  # rounding of products of order 1


def test_quadrature():
    points, weights = gauss_legendre(7)
    assert_allclose(weights @ points[:, None] ** np.arange(14), 1 / np.arange(1, 15), rtol=1e-14, atol=0)
    distance, weight = log_rule(16)
    assert_allclose(weight @ (np.log(distance) * distance**3), -1 / 16, rtol=1e-14, atol=0)
    assert_allclose(weight @ np.log(distance), -1, rtol=1e-14, atol=0)


def test_interpolation():
    nodes = radau_nodes(40)
    points = np.concatenate([nodes[::7], np.linspace(0, 1, 33)])
    values = lagrange(nodes, points)
    assert_allclose(values.sum(axis=1), 1, rtol=1e-13, atol=0)
    assert_allclose(values @ np.cos(5 * nodes), np.cos(5 * points), rtol=0, atol=1e-13)
    assert_allclose(values[:6], np.eye(40)[::7], rtol=0, atol=0)

"""The layered operator's quadrature in k against another, its few nodes, and kernels that are used again."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import j0
from solver_cases import layer_of

from solver.body import tables
from solver.body.wave_rule import STIFFEST, few, quadrature
from solver.kernels.closed_form import decaying_part
from solver.kernels.two_layers import SAMPLER
from solver.numerics import batch
from solver.numerics.mesh import mesh_of
from solver.numerics.quadrature import gauss_legendre


def layers(eta, seed):
    """Materials for h/a (B,): n from 1e-3 to 1e3, both bondings."""
    random = np.random.default_rng(seed)
    n = np.exp(random.uniform(np.log(1e-3), np.log(1e3), len(eta)))
    return layer_of(h=eta, n=n, bonded=random.random(len(eta)) < 0.5)


@pytest.mark.parametrize("n", [16, 32])
@pytest.mark.parametrize("octave", [-8, -7, -5, -3, -1, 0, 1, 4, 10])
def test_the_rule(octave, n):
    """To 1e-11 of the larger of L(0) and L(inf), against panels that halve towards k = 0 and go on."""
    mesh = mesh_of(n)
    layer = layers(2.0 ** (octave + np.r_[1e-9, 1 - 1e-9, np.random.default_rng(octave + 9).random(10)]), octave + 9)
    end = 1.5 * quadrature(octave, 0)[0][-1]
    ends = np.unique(np.r_[0.0, end * 2.0 ** -np.arange(40.0), np.arange(0.0, end, 30.0)])
    t, w = gauss_legendre(48)
    k, w = (ends[:-1, None] + np.diff(ends)[:, None] * t).ravel(), (np.diff(ends)[:, None] * w).ravel()
    W = w * layer.kernel.decaying_part(k * layer.h[:, None])[0]
    phi, J = tables.transform(mesh, k), j0(k[:, None] * mesh.x) - j0(k)[:, None]
    q = mesh.s + mesh.s**2
    edge, Kq = np.pi / 2 * (W * j0(k)) @ phi + mesh.edge, np.pi / 2 * (W * (phi @ q)) @ J + mesh.K @ q
    found = layer.at(np.ones(len(layer.h)), mesh)
    scale = 1e-11 * np.maximum(1.0, layer.kernel.n)
    assert np.all(np.abs(found.edge - edge).max(axis=1) < scale)
    assert np.all(np.abs(found.products(q + 0 * edge)[0] - Kq).max(axis=1) < scale)


@pytest.mark.parametrize("stiffness", range(4))
@pytest.mark.parametrize("octave", [-8, -5, -2, 0, 3])
def test_few_nodes_determine_the_operator(octave, stiffness):
    """That of L - 1, and about as well that of u dL/du, of other layers than those by which they were chosen, limits
    included: beside all nodes, over the size of the operator."""
    random, size, mesh = np.random.default_rng(octave + 100), 60, mesh_of(16)
    low, high = np.log([1e-9, *STIFFEST][stiffness : stiffness + 2])
    n = np.r_[STIFFEST[stiffness], np.exp(random.uniform(low, high, size - 1))]
    nu1, nu2 = random.choice([0.0, 0.5, 0.3, -0.9, *random.random(5) / 2], (2, size))
    layer = [v[:, None] for v in (n, nu1, nu2, random.random(size) < 0.5)]
    k, weight = quadrature(octave, stiffness)
    own, eta = few(SAMPLER, octave, stiffness), 2.0 ** (octave + np.r_[0.0, 1.0, random.random(size - 2)])
    whole, part = decaying_part(k * eta[:, None], *layer), decaying_part(own.k * eta[:, None], *layer)
    J, phi, J_edge = j0(k[:, None] * mesh.x) - j0(k)[:, None], tables.transform(mesh, k), j0(k)
    scale = np.maximum(np.abs(weight * whole[0] / (1 + k * k)).sum(axis=1), 1.0)
    for all_of_it, few_of_it, allowed in zip(whole, part, (1e-13, 1e-11), strict=True):
        left = few_of_it @ own.spread - weight * all_of_it
        matrix, edge = np.einsum("bk,ki,kj->bij", left, J, phi, optimize=True), (left * J_edge) @ phi
        assert (np.abs(matrix).max(axis=(1, 2)) / scale).max() < allowed
        assert (np.abs(edge).max(axis=1) / scale).max() < allowed


def test_the_kernel_of_the_same_radii_serves_again():
    """On another mesh; that of the others is formed anew. Films too."""
    random = np.random.default_rng(2)
    layer, step = layers(10 ** random.uniform(-3.5, 1, 40), 2), np.where(np.arange(40) % 2, 0.0, 1e-9)
    known = layer.at(np.ones(40), mesh_of(12))
    found, anew = (layer.at(np.exp(step), mesh_of(8), near) for near in (known, None))
    # in other company: rounding of sums over some 120 nodes, of which BLAS kernels choose the order
    scale = np.maximum(1.0, layer.kernel.n)
    assert np.all(np.abs((found.K - anew.K) @ mesh_of(8).s).max(axis=1) < 1e-14 * scale)
    for part in found.parts:
        kept = [np.flatnonzero(other.index == part.index[0]) for other in known.parts]
        (before,) = (other.L1[rows[0]] for other, rows in zip(known.parts, kept, strict=True) if len(rows))
        assert np.array_equal(part.L1[0], before) == (step[part.index[0]] == 0)


def test_a_part_of_an_operator_and_the_whole_of_its_parts():
    """Those of some cases, as if formed for them alone."""
    mesh, random = mesh_of(8), np.random.default_rng(3)
    layer, order = layers(10 ** random.uniform(-4, 1, 30), 3), random.permutation(30)
    whole, places = layer.at(np.ones(30), mesh), [np.sort(order[:4]), np.sort(order[4:])]
    parts, q = [whole.take(place) for place in places], random.random((30, 8))
    alone, again = layer.take(places[0]).at(np.ones(4), mesh), batch.join(parts, places)
    assert_allclose(parts[0].K, alone.K, rtol=0, atol=1e-14 * np.abs(alone.K).max())
    for found, expected, own in ((parts[0], alone, q[:4]), (again, whole, q)):
        half_space = own @ mesh.K.T
        for one, other in zip(found.slopes(own), expected.slopes(own), strict=True):
            assert_allclose(one, other, rtol=0, atol=1e-13 * np.abs(other).max())
        between = [op.between(own, mesh.s, half_space) for op in (found, expected)]
        assert_allclose(*between, rtol=0, atol=1e-13 * np.abs(between[1]).max())
    np.testing.assert_array_equal(again.K, whole.K)
    np.testing.assert_array_equal(again.edge, whole.edge)


def test_matrix_products_and_displacement_between_agree():
    """On the nodes themselves; films too."""
    mesh = mesh_of(8)
    layer, q = layers(10 ** np.random.default_rng(3).uniform(-4, 1, 30), 3), np.tile(mesh.s, (30, 1))
    found = layer.at(np.ones(30), mesh)
    Kq, edge_q = found.products(q)
    size = np.abs(found.K).max(axis=(1, 2))
    assert np.all(np.abs(found.K @ mesh.s - Kq).max(axis=1) < 1e-13 * size)
    assert np.all(np.abs(found.edge @ mesh.s - edge_q) < 1e-13 * np.abs(found.edge).max(axis=1))
    between = found.between(q, mesh.s[:-1], (q @ mesh.K.T)[:, :-1])
    assert np.all(np.abs(between - Kq[:, :-1]).max(axis=1) < 1e-12 * size)


def test_slopes_are_those_of_the_products():
    """By ln a, against a difference; films too."""
    mesh, step = mesh_of(8), 1e-4
    layer, q = layers(10 ** np.random.default_rng(4).uniform(-4, 1, 30), 4), np.tile(mesh.s, (30, 1))
    (before, at_edge), (after, at_edge_after) = (
        layer.at(np.exp([sign * step] * 30), mesh).products(q) for sign in (-1, 1)
    )
    d_Kq, d_edge_q = layer.at(np.ones(30), mesh).slopes(q)
    scale = np.maximum(1.0, layer.kernel.n)
    assert np.all(np.abs((after - before) / (2 * step) - d_Kq).max(axis=1) < 1e-6 * scale)
    assert np.all(np.abs((at_edge_after - at_edge) / (2 * step) - d_edge_q) < 1e-6 * scale)

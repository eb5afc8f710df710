"""The layered operator's quadrature in k: both rules against a third, and weights that are moved instead of formed."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import j0

from solver.body import tables
from solver.body.kernel import decaying_part
from solver.body.layered import (
    Layer,
    half_space_share,
    layer_edge,
    layer_matrix,
    layer_products,
    layer_weights,
    take_weights,
)
from solver.body.wave_rule import COARSE, FILM, few, quadrature
from solver.numerics.mesh import mesh
from solver.numerics.quadrature import gauss_legendre


def layers(eta, seed):
    """Materials for h/a (B,): n from 1e-3 to 1e3, both bondings."""
    random, one = np.random.default_rng(seed), np.ones(len(eta))
    n = np.exp(random.uniform(np.log(1e-3), np.log(1e3), len(eta)))
    return Layer(eta, n, 0.3 * one, 0.3 * one, random.random(len(eta)) < 0.5, 0 * one)


@pytest.mark.parametrize("n", [16, 32])
@pytest.mark.parametrize("octave", [-8, -7, -5, -3, -1, 0, 1, 4, 10])
def test_both_rules(octave, n):
    """To 1e-11, and to COARSE, of the larger of L(0) and L(inf), against panels that halve towards k = 0 and go on."""
    grid = mesh(n)
    layer = layers(2.0 ** (octave + np.r_[1e-9, 1 - 1e-9, np.random.default_rng(octave + 9).random(10)]), octave + 9)
    end = 1.5 * quadrature(octave, 0)[0][-1]
    ends = np.unique(np.r_[0.0, end * 2.0 ** -np.arange(40.0), np.arange(0.0, end, 30.0)])
    t, w = gauss_legendre(48)
    k, w = (ends[:-1, None] + np.diff(ends)[:, None] * t).ravel(), (np.diff(ends)[:, None] * w).ravel()
    material = [v[:, None] for v in layer.material]
    W = w * decaying_part(k * layer.h[:, None], *material)[0]
    phi, J = tables.transform(grid, k), j0(k[:, None] * grid.x) - j0(k)[:, None]
    q = grid.s + grid.s**2
    edge, rows_q = (W * j0(k)) @ phi, (W * (phi @ q)) @ J
    for coarse, error in ((False, 1e-11), (True, COARSE)):
        weights = layer_weights(layer, np.ones(len(layer.h)), coarse=coarse)
        found = layer_products(weights, q + 0 * edge, grid)
        scale = error * np.maximum(1.0, layer.n)
        assert np.all(np.abs(layer_edge(weights, grid) - edge).max(axis=1) < scale)
        assert np.all(np.abs(found.rows_q - rows_q).max(axis=1) < scale)


def test_the_coarse_rule_has_half_the_nodes():
    for octave in (-1, 0, 1):
        fine, coarse = (len(quadrature(octave, 0, rule)[0]) for rule in (False, True))
        assert coarse < 0.66 * fine


@pytest.mark.parametrize("octave", [-8, -6, -3, 0, 20])
def test_few_nodes_determine_the_kernel(octave):
    """L - 1, and about as well u dL/du, of other soft layers than those by which they were chosen, limits included."""
    random, size = np.random.default_rng(octave + 100), 2000
    eta = 2.0 ** (octave + np.r_[0.0, 1.0, random.random(size - 2)])
    n = np.r_[2.0, 1e-8, 0.0, 2 * random.random(size // 2), 10 ** random.uniform(-8, 0, size // 2 - 3)]
    nu1, nu2 = random.choice([0.0, 0.5, 0.3, *random.random(5) / 2], (2, size))
    layer = [v[:, None] for v in (n, nu1, nu2, random.random(size) < 0.5)]
    for coarse, error, d_error in ((False, 2e-14, 1e-12), (True, 3e-10, 5e-9)):
        k, weight = quadrature(octave, 0, coarse)
        own = few(octave, 0, coarse)
        assert len(own.nodes) < 0.8 * len(k)
        for values, allowed in zip(decaying_part(k * eta[:, None], *layer), (error, d_error), strict=True):
            assert np.abs(values[:, own.nodes] @ (own.spread / weight) - values).max() < allowed


def test_stiff_layers_and_films_have_no_few_nodes():
    assert few(-1, 6, True) is None
    assert few(FILM, 0, False) is None


def test_weights_within_reach_are_moved_to_first_order():
    """The others are formed anew; films too."""
    grid, random = mesh(12), np.random.default_rng(2)
    layer, a = layers(10 ** random.uniform(-3.5, 1, 40), 2), np.ones(40)
    known = layer_weights(layer, a)
    step = np.where(np.arange(40) % 2, 1e-5, 1e-2)
    moved, anew = layer_weights(layer, np.exp(step), known, reach=1e-4), layer_weights(layer, np.exp(step))

    def displacement(weights):  # films differ in what they leave to the half-space
        rows_q = layer_products(weights, np.tile(grid.s, (40, 1)), grid).rows_q
        return half_space_share(weights)[:, None] * (grid.K @ grid.s) + np.pi / 2 * rows_q

    scale = 1 / np.maximum(1.0, layer.n)
    found, first = (np.abs(displacement(w) - displacement(anew)).max(axis=1) * scale for w in (moved, known))
    # formed anew, in other company: rounding of sums over some 120 nodes, of which BLAS kernels choose the order
    assert np.all(found[step > 1e-4] < 1e-14)
    assert 0 < found[step < 1e-4].max() < 1e-9
    assert first[step < 1e-4].max() > 1e-7, "else nothing had to be moved"


def test_a_part_of_the_weights():
    """Those of some cases, as if formed for them alone."""
    grid = mesh(8)
    layer, index = layers(10 ** np.random.default_rng(3).uniform(-4, 1, 30), 3), np.array([2, 3, 11, 29])
    part = take_weights(layer_weights(layer, np.ones(30)), index)
    alone = layer_weights(layer.take(index), np.ones(4))
    matrix = layer_matrix(part, grid)
    assert_allclose(matrix, layer_matrix(alone, grid), rtol=0, atol=1e-14 * np.abs(matrix).max())


@pytest.mark.parametrize("step", [0.0, 0.1])
def test_matrix_edge_and_products_agree(step):
    """Of weights as they are formed, and moved; films too."""
    grid = mesh(8)
    layer, a = layers(10 ** np.random.default_rng(3).uniform(-4, 1, 30), 3), np.full(30, np.exp(step))
    weights = layer_weights(layer, a, layer_weights(layer, np.ones(30)), reach=1.0)
    matrix, edge = layer_matrix(weights, grid), layer_edge(weights, grid)
    found = layer_products(weights, np.tile(grid.s, (30, 1)), grid)
    assert np.all(np.abs(matrix @ grid.s - found.rows_q).max(axis=1) < 1e-13 * np.abs(matrix).max(axis=(1, 2)))
    assert np.all(np.abs(edge @ grid.s - found.edge_q) < 1e-13 * np.abs(edge).max(axis=1))

"""The kernel of a stack of layers against 60 digits of a boundary value problem, other formulas, and its limits."""

import csv
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import j0

from solver.body import tables
from solver.body.wave_rule import STIFFEST, few, quadrature
from solver.kernels.closed_form import layered_kernel
from solver.kernels.random_stacks import SAMPLER, random_stacks
from solver.kernels.stack import Stack
from solver.kernels.two_layers import thin_layer_coefficients
from solver.numerics.mesh import mesh_of

REFERENCES = Path(__file__).parents[1] / "references"


def rows(name):
    with open(REFERENCES / name, newline="") as file:
        return list(csv.DictReader(file))


STACKS, VALUES = rows("stacks.csv"), rows("given_kernel.csv")
EACH = pytest.mark.parametrize("row", STACKS, ids=lambda row: row["stack"])


def stack_of(row):
    """The :class:`Stack` of one row of stacks.csv."""
    layers = [[float(v) for v in text.split()] for text in row["layers_top_first_h_Estar_nu"].split("|")]
    h, E, nu = (np.array([column]) for column in zip(*layers, strict=True))
    words = [text.split() for text in row["interfaces_below_each"].split("|")]
    springs = [dict(part.split("=") for part in word[1:]) for word in words]
    cn, ct = (np.array([[float(v.get(name, 0)) for v in springs]]) * E[0, 0] / h[0, 0] for name in ("cn", "ct"))
    free = np.array([[word[0] == "frictionless" for word in words]])
    rigid = row["base_Estar_nu"] == "rigid"
    E_base, nu2 = (E[0, 0], 0.3) if rigid else (float(v) for v in row["base_Estar_nu"].split())
    return Stack(E / E_base, nu, h / h[0, 0], free, cn, ct, np.array([nu2]), np.array([rigid]))


def random_ones(seed, size, layers=3):
    """Ordinary stacks, which have no springs."""
    random = np.random.default_rng(seed)
    n, h = np.exp(random.uniform(-2, 2, (2, size, layers)))
    h[:, 0], none = 1.0, np.zeros((size, layers))
    nu, free = random.uniform(-0.5, 0.5, (size, layers)), random.random((size, layers)) < 0.3
    return Stack(n, nu, h, free, none, none, random.uniform(0, 0.5, size), np.zeros(size, dtype=bool))


@EACH
def test_the_kernel(row):
    """L to 1e-14. L - 1 to 1e-14 beyond u = 0.7, where it falls to 1e-34; below, of the larger of itself and L."""
    values = [other for other in VALUES if other["stack"] == row["stack"]]
    u, L, L1 = (np.array([[float(other[name]) for other in values]]) for name in ("u_k_h1", "L", "L_minus_1"))
    kernel = stack_of(row)
    assert_allclose(kernel.whole(u), L, rtol=1e-14, atol=0)
    computed, _ = kernel.decaying_part(u)
    assert np.all(np.abs(computed - L1) <= 1e-14 * np.where(u > 0.7, np.abs(L1), np.maximum(np.abs(L1), L)))


@EACH
def test_the_derivative(row):
    """u dL/du against a difference of the fourth order."""
    kernel, u, step = stack_of(row), np.geomspace(1e-4, 12, 50)[None], 1e-3
    _, slope = kernel.decaying_part(u)
    L = {i: kernel.decaying_part(u * np.exp(i * step))[0] for i in (-2, -1, 1, 2)}
    difference = (8 * (L[1] - L[-1]) - (L[2] - L[-2])) / (12 * step)
    # its error: step⁴ times a fifth derivative, which is up to (2u)⁵ times as large, and rounding over the step
    size = np.abs(kernel.decaying_part(u)[0]) * (1 + 2 * u) ** 5 + np.abs(slope)
    assert np.all(np.abs(difference - slope) < 1e-10 * size + 1e-12 * np.maximum(kernel.L0[:, None], 1.0))


@pytest.mark.parametrize("bonded", [True, False])
@pytest.mark.parametrize("n", [1e-6, 1e-3, 0.5, 3.0, 1e3, 1e6, 1e9])
def test_one_layer_is_two_layers(n, bonded):
    """1e-12 against closed forms that have nothing in common with the recursion."""
    u, ratios = np.geomspace(1e-6, 30, 80)[None], np.array([[-0.7, 0.0, 0.3, 0.45, 0.5]]).T
    nu, nu2 = (v.ravel() for v in np.meshgrid(ratios, ratios))
    one = np.ones((len(nu), 1))
    kernel = Stack(n * one, nu[:, None], one, one < bonded, 0 * one, 0 * one, nu2, nu > 1)
    kernel = kernel._replace(free=np.full(one.shape, not bonded))
    exact = layered_kernel(u, n, nu[:, None], nu2[:, None], bonded)
    L1, uL = kernel.decaying_part(u * one)
    scale = np.where(u > 0.7, np.abs(exact.L1), max(1.0, n))
    assert np.all(np.abs(L1 - exact.L1) < 1e-12 * scale)
    assert np.all(np.abs(uL - exact.uL) < 1e-12 * np.maximum(scale, np.abs(exact.uL)))
    assert_allclose(kernel.whole(u * one), exact.L, rtol=1e-12, atol=0)


@pytest.mark.parametrize("bonded", [True, False])
def test_one_layer_on_a_rigid_base(bonded):
    u, nu, one = np.geomspace(1e-3, 20, 60)[None], np.array([-0.5, 0.0, 0.3, 0.49, 0.5]), np.ones((5, 1))
    free, rigid = np.full((5, 1), not bonded), np.ones(5, dtype=bool)
    kernel = Stack(one, nu[:, None], one, free, 0 * one, 0 * one, nu, rigid)
    exact = layered_kernel(u, 0.0, nu[:, None], 0.3, bonded)
    assert_allclose(kernel.whole(u * one), exact.L, rtol=1e-12, atol=0)
    # where L is 1e-9 of the terms it is made of, as under nu = 1/2, it is right to a relative 1e-12 all the same
    assert kernel.whole(np.full(5, 1e-3)).min() < 1e-9 or not bonded


def test_equal_layers_are_one():
    """A layer cut into three is the layer; a layer of the material of its base is not there."""
    u, none, rigid = np.geomspace(1e-3, 20, 40)[None], np.zeros((1, 3)), np.zeros(1, dtype=bool)
    cut = Stack(none + 5.0, none + 0.2, np.array([[1.0, 2.0, 0.5]]), none > 0, none, none, rigid + 0.4, rigid)
    exact = layered_kernel(3.5 * u, 5.0, 0.2, 0.4, True)
    assert_allclose(cut.whole(u), exact.L, rtol=1e-13, atol=0)
    bare = Stack(none + 1.0, none + 0.2, none + 1.0, none > 0, none, none, rigid + 0.2, rigid)
    assert_allclose(bare.whole(u), 1.0, rtol=1e-14, atol=0)
    assert np.abs(bare.decaying_part(u)[0]).max() < 1e-15


def test_springs_between_a_bond_and_no_friction():
    """Of ct = 0 and cn = 0 a bond, of ct without limit no friction."""
    stacks, u = random_ones(1, 20), np.geomspace(1e-3, 10, 30) * np.ones((20, 1))
    free, none = stacks.free, np.zeros((20, 3))
    bonded, stiff, soft = (stacks._replace(free=free & False, ct=np.where(free, ct, none)) for ct in (0.0, 1e-13, 1e13))
    # along the layer springs of 1e13 carry some 1e-13 of the traction, over u
    assert_allclose(soft.whole(u), stacks.whole(u), rtol=1e-9, atol=0)
    assert_allclose(stiff.whole(u), bonded.whole(u), rtol=1e-11, atol=0)


@EACH
def test_long_waves(row):
    """L(0), and the slope there, which groups of layers that are bonded to each other add."""
    kernel = stack_of(row)
    scale = 1e-6 / kernel.stiffness  # of u: below it the next term of L is too small to count
    u = np.array([1.0, 2.0, 4.0]) * scale[:, None]
    L = kernel.whole(u)[0] - kernel.L0
    extrapolated = (8 * L[0] - 3 * L[1] + L[2] / 4) / (3 * scale[0])
    terms = np.abs(kernel.L0) + np.abs(kernel.slope)
    assert_allclose(extrapolated, kernel.slope[0], rtol=0, atol=1e-5 * terms[0] + 1e-15)


def test_slopes_of_single_layers_add_up():
    """Of layers bonded to the base, as thin_layer_coefficients has them."""
    stacks = random_ones(2, 30)._replace(free=np.zeros((30, 3), dtype=bool))
    parts = [
        stacks.n[:, 0] / n * h * thin_layer_coefficients(n, nu, stacks.nu2, True)[1]
        for n, nu, h in zip(stacks.n.T, stacks.nu.T, stacks.depth.T, strict=True)
    ]
    assert_allclose(stacks.slope, sum(parts), rtol=1e-13, atol=1e-13)


def test_short_waves():
    stacks = random_ones(3, 30)
    assert_allclose(stacks.whole(np.full(30, 25.0)), 1.0, rtol=1e-14, atol=0)
    L1, uL = stacks.decaying_part(np.full((30, 1), 300.0))
    assert np.all(np.isfinite(L1) & np.isfinite(uL) & (np.abs(L1) < 1e-200))


def test_blocks_change_nothing(monkeypatch):
    stacks, u = random_ones(4, 50), np.geomspace(0.01, 10, 200) * np.ones((50, 1))
    exact = stacks.decaying_part(u)
    monkeypatch.setattr("solver.kernels.stack._BLOCK", 10**9)
    for blocked, whole in zip(exact, stacks.decaying_part(u), strict=True):
        assert_allclose(blocked, whole, rtol=1e-13, atol=1e-15)


def test_sixteen_layers_do_not_overflow():
    random = np.random.default_rng(5)
    n = 10.0 ** random.uniform(-9, 9, (40, 16))
    none, u = np.zeros((40, 16)), np.geomspace(1e-9, 300, 30) * np.ones((40, 1))
    kernel = Stack(n, none + 0.5, none + 1, none > 0, none, none, none[:, 0] + 0.3, none[:, 0] > 0)
    assert np.isfinite(kernel.whole(u)).all() and np.isfinite(kernel.decaying_part(u)).all()


@pytest.mark.parametrize(("stiffness", "most"), [(0, 1e-12), (1, 1e-9), (2, 3e-8)])
@pytest.mark.parametrize("octave", [-5, 0, 3])
def test_few_nodes_determine_a_stack(octave, stiffness, most):
    """Other stacks than those by which they were chosen, beside all nodes, over the size of the operator. At most
    5e-13, 5e-11 and 5e-9 of six layers is left out, of 300 stacks each (1e-16 in the middle)."""
    random, mesh, size = np.random.default_rng(octave + 100), mesh_of(16), 100
    low, high = np.log([1.0, *STIFFEST][stiffness : stiffness + 2])
    kernel = random_stacks(random, np.exp(random.uniform(low, high, size)))
    k, weight = quadrature(octave, stiffness)
    nodes, eta = few(SAMPLER, octave, stiffness), 2.0 ** (octave + random.random((size, 1)))
    all_of_it = weight * kernel.decaying_part(k * eta)[0]
    left = kernel.decaying_part(nodes.k * eta)[0] @ nodes.spread - all_of_it
    J, phi = j0(k[:, None] * mesh.x) - j0(k)[:, None], tables.transform(mesh, k)
    scale = np.maximum(np.abs(all_of_it / (1 + k * k)).sum(axis=1), 1.0)
    matrix = np.einsum("bk,ki,kj->bij", left, J, phi, optimize=True)
    errors = np.abs(matrix).max(axis=(1, 2)) / scale
    assert np.median(errors) < 1e-13 and errors.max() < most


def test_random_stacks_have_stiff_and_soft_layers():
    """Below the layer at the surface there are stiffer and softer ones, and the base may be either."""
    stacks = random_stacks(np.random.default_rng(1), np.full(300, 100.0))
    n = stacks.n[~stacks.rigid.astype(bool)]
    for ratio in (n[:, 0], n[:, 1] / n[:, 0]):
        assert ratio.max() > 3 and ratio.min() < 1 / 3
    assert np.median(stacks.stiffness) > 50

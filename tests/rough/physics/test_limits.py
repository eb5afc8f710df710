"""Limits: smooth punches, Hertz, springs; roughness and layers that vanish, asperities that yield alone."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import solve as dense_solve
from solver_cases import BASES, LOAD, MAIN, ROUGH_KINDS, difference, one

from solver.closed_forms import hertz, thin_layer_on_rigid_base
from solver.numerics.mesh import mesh_of
from solver.shapes.paraboloid import HERTZ

X = np.sin(np.pi / 2 * np.linspace(0, 1, 80))
rough_kinds = pytest.mark.parametrize(("base", "law"), ROUGH_KINDS, ids=["-".join(kind) for kind in ROUGH_KINDS])


@rough_kinds
def test_vanishing_roughness_is_smooth(base, law):
    """A → 0 as the asperities become many: the rough answer tends to the smooth one, at first order in A(p0)/D."""
    smooth = one(P=LOAD, base=base, micro="smooth")
    Nbar, B = 250000 * 10.0 ** np.array([3, 4, 5]), 0.1 * 10.0 ** -np.array([3, 4, 5])
    rough = one(P=LOAD, base=base, micro=law, Nbar=Nbar, B=B)
    assert np.all(rough.status == 0)
    gap = rough.D / smooth.D - 1
    assert np.all(gap > 0)
    assert_allclose(gap[1:] / gap[:-1], 0.1, rtol=0.1, atol=0)


@rough_kinds
def test_roughness_and_layer_widen_the_contact(base, law):
    """At one load Hertz's contact is the smallest, deepest pressed at the centre and stiffest."""
    s, H = one(P=LOAD, base=base, micro=law), hertz(P=LOAD)
    assert s.a[0] > H.a
    assert s.D[0] > H.D
    assert s.p0[0] < H.p0
    assert s.dP_dD[0] < 2 * s.a[0]  # less than a flat punch of the same radius on the base alone


@pytest.mark.parametrize("control", ["P", "a", "D"])
def test_smooth_half_space_is_hertz(control):
    H = hertz(a=np.array([1e-6, 0.03, 0.2]))
    s = one(**{control: getattr(H, control)}, base="half_space", micro="smooth", x=[0.0, 0.6, 1.0])
    for name in H._fields:
        assert_allclose(getattr(s, name), getattr(H, name), rtol=1e-14, atol=0)
    assert_allclose(s.dP_dD, 2 * H.a, rtol=1e-14, atol=0)
    assert_allclose(s.p, H.p0[:, None] * [1, 0.8, 0], rtol=1e-14, atol=0)
    assert np.all(s.iterations == 0)
    assert np.all(s.nodes == 0)
    assert np.all(s.Ar_An == 1)
    assert np.all(s.A0 == 0)


def test_smooth_thin_layer_by_a_dense_solve():
    """The diagonalised operator against an ordinary solve of (X K + Y) q = s² on a mesh of its own, a given."""
    mesh, a, C = mesh_of(40), 0.04, MAIN["h"] / MAIN["n"]
    p = dense_solve(8 / np.pi / a * mesh.K + 2 * C / a**2 * np.eye(40), mesh.s**2)
    s = one(a=a, micro="smooth", rtol=1e-10, x=mesh.x)
    assert_allclose(s.p[0], p, rtol=0, atol=2e-10 * p.max())
    assert_allclose(s.P[0], 2 * np.pi * a**2 * mesh.w @ p, rtol=1e-10, atol=0)
    assert_allclose(s.D[0], a**2 / 2 + 4 / np.pi * a * mesh.edge @ p, rtol=1e-10, atol=0)


@pytest.mark.parametrize("bonding", ["frictionless", "bonded"])
def test_soft_thin_layer_is_springs(bonding):
    """n → 0: the closed form for a rigid base, approached at first order in n."""
    n = np.array([1e-3, 1e-4, 1e-5])
    s = one(P=LOAD * n, n=n, micro="smooth", bonding=bonding)
    springs = thin_layer_on_rigid_base(P=LOAD * n, h=MAIN["h"], bonded=bonding == "bonded", E=n)
    for name in ("a", "D", "p0"):
        gap = np.abs(getattr(s, name) / getattr(springs, name) - 1)
        assert_allclose(gap[1:] / gap[:-1], 0.1, rtol=0.05, atol=0, err_msg=name)
        assert gap[-1] < 1e-4


def test_vanishing_layer_is_hertz():
    """C → 0: Hertz, at first order in h (up to the logarithm of the boundary layer)."""
    h = np.array([1e-6, 1e-7, 1e-8])
    s = one(P=LOAD, h=h, micro="smooth", rtol=1e-9)
    gap = np.abs(s.D / hertz(P=LOAD).D - 1)
    assert_allclose(gap[1:] / gap[:-1], 0.1, rtol=0.03, atol=0)
    assert gap[-1] < 1e-6


def test_rough_thin_layer_tends_to_the_half_space():
    """h → 0 at any n: also a rough layer is gone, with the asperities as hard as the layer (n = 1 here)."""
    layered = one(P=LOAD, n=1.0, h=np.array([1e-5, 1e-6]), micro="disc_cell", rtol=1e-9)
    half_space = one(P=LOAD, base="half_space", micro="disc_cell", rtol=1e-9)
    gap = difference(layered, half_space)
    assert gap[1] < 1e-4
    assert_allclose(gap[1] / gap[0], 0.1, rtol=0.1, atol=0)


def test_hertz_is_one_row_of_the_operator():
    """What the first guess builds on. Its rule sums over 266 points on each side of a node: a few roundings."""
    assert_allclose(mesh_of(8).K @ mesh_of(8).s, HERTZ * mesh_of(8).s ** 2, rtol=0, atol=3e-15)


@pytest.mark.parametrize("base", BASES)
def test_large_scale_limit_of_asperities(base):
    """Roughness so soft that the base is rigid: p(r) is the law's own inverse of (a² - r²)/2 (power law, β = 1/2)."""
    s = one(P=1e-9, Nbar=1e8, B=50.0, micro="power_law", base=base, x=X)
    n = MAIN["n"] if base == "thin_layer" else 1.0
    a = s.a[0]
    alone = n * (a**2 * (1 - X**2) / 2 / (50.0 * MAIN["Ra"])) ** 2
    assert_allclose(s.p[0], alone, rtol=0, atol=5e-3 * alone.max())

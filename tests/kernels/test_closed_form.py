"""The exact kernel L(u) against 25 digits, against the boundary-value problem behind it, and in its limits."""

from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solver.kernels.closed_form import layered_kernel
from solver.kernels.two_layers import thin_layer_coefficients

#: See make_kernel_reference.py beside it.
TABLE = np.genfromtxt(Path(__file__).parents[1] / "references" / "kernel_reference.csv", delimiter=",", names=True)
INPUTS = (TABLE["u"], TABLE["n"], TABLE["nu1"], TABLE["nu2"], TABLE["bonded"] == 1)
BONDS = pytest.mark.parametrize("bonded", [False, True], ids=["frictionless", "bonded"])


def test_reference():
    """L and L - 1 relative to themselves, u dL/du to the larger of itself and |L - 1|; u to 100, n from 1e-8 to 1e8."""
    found = layered_kernel(*INPUTS)
    assert_allclose(found.L, TABLE["L"], rtol=1e-13, atol=0)
    assert_allclose(found.L1, TABLE["L1"], rtol=1e-13, atol=0)
    size = np.maximum(np.abs(TABLE["uL"]), np.abs(TABLE["L1"]))
    assert np.all(np.abs(found.uL - TABLE["uL"]) <= 1e-13 * size)


def test_one_interface_at_a_time_is_the_same():
    """A batch of one interface takes another way than a mixed one."""
    mixed = layered_kernel(*INPUTS)
    for kind in (INPUTS[-1], ~INPUTS[-1]):
        alone = layered_kernel(*(v[kind] for v in INPUTS))
        for one, both in zip(alone, mixed, strict=True):
            assert_allclose(one, both[kind], rtol=1e-14, atol=0)


def test_the_order_in_memory_does_not_matter():
    """Rows beside columns, every other element: the table's numbers, stiff layers at small u among them."""
    for kind in (INPUTS[-1], ~INPUTS[-1]):
        rows = np.flatnonzero(kind)[: kind.sum() // 6 * 6]
        L, L1 = TABLE["L"][rows].reshape(-1, 6), TABLE["L1"][rows].reshape(-1, 6)
        inputs = [v[rows].reshape(-1, 6) for v in INPUTS]
        for arranged in (np.asfortranarray, lambda v: np.repeat(v, 2, axis=1)[:, ::2]):
            found = layered_kernel(*(arranged(v) for v in inputs))
            assert_allclose(found.L, L, rtol=1e-13, atol=0)  # what layered_kernel promises
            assert_allclose(found.L1, L1, rtol=1e-13, atol=0)


# ---- the boundary-value problem, lengths in 1/k, z downwards, displacements U J1 and W J0, stresses over 2 k
# ---------------------------------------------------------------


def decaying(z, nu, G):
    """U, W, σz, τ of the two solutions that decay downwards, (A + B z) e^(-z) in U; rows of four."""
    e = mp.exp(-z)
    return [[e, e, -G * e, -G * e], [z * e, (z + 3 - 4 * nu) * e, -G * (z + 2 - 2 * nu) * e, -G * (z + 1 - 2 * nu) * e]]


def growing(z, nu, G):
    """The same two of e^(+z): z and W and τ change their sign."""
    sign = (1, -1, 1, -1)
    return [[s * v for s, v in zip(sign, row, strict=True)] for row in decaying(-z, nu, G)]


def boundary_value(u, n, nu1, nu2, bonded):
    """L = E1* k W(0)/2 under a unit pressure: four constants of the layer, two of the half-space, solved as they are.

    Bonded: U, W, σz, τ continuous at the interface. Frictionless: W and σz continuous, τ = 0 on both sides.
    """
    u, n, nu1, nu2 = (mp.mpf(float(v)) for v in (u, n, nu1, nu2))
    G1, G2 = n * (1 - nu1), 1 - nu2  # E2* = 2: G = E*(1 - ν)/2
    zero = mp.mpf(0)
    top = [*decaying(zero, nu1, G1), *growing(zero, nu1, G1)]
    above = [*decaying(u, nu1, G1), *growing(u, nu1, G1)]
    below = decaying(zero, nu2, G2)  # z from the interface
    rows = [[v[2] for v in top] + [0, 0], [v[3] for v in top] + [0, 0]]
    if bonded:
        rows += [[v[i] for v in above] + [-v[i] for v in below] for i in range(4)]
    else:
        rows += [[v[i] for v in above] + [-v[i] for v in below] for i in (1, 2)]
        rows += [[v[3] for v in above] + [0, 0], [0] * 4 + [v[3] for v in below]]
    constants = mp.lu_solve(mp.matrix(rows), mp.matrix([mp.mpf(-1) / 2, 0, 0, 0, 0, 0]))
    W = sum(c * v[1] for c, v in zip(constants[:4], top, strict=True))
    return 2 * n * W / 2  # E1* = 2 n


@BONDS
def test_boundary_value_problem(bonded):
    """The formulas are the solution of the layer's equations, to the digits of the table."""
    rows = np.flatnonzero((INPUTS[-1] == bonded) & (TABLE["u"] > 1e-3))[:: 7 if not bonded else 83]
    assert len(rows) > 8
    text = (Path(__file__).parents[1] / "references" / "kernel_reference.csv").read_text(encoding="utf-8").splitlines()
    with mp.workdps(60):
        for i in rows:
            exact = boundary_value(*(v[i] for v in INPUTS))
            assert abs(mp.mpf(text[i + 1].split(",")[5]) / exact - 1) < mp.mpf(10) ** -23


def random_materials(size, seed):
    rng = np.random.default_rng(seed)
    n, nu1, nu2 = 10 ** rng.uniform(-8, 8, size), *rng.uniform(-0.999, 0.5, (2, size))
    nu1[::5], nu2[::7] = 0.5, 0.5
    return n, nu1, nu2


@BONDS
def test_random_against_the_boundary_value_problem(bonded):
    """No table: materials, also n = 1 + 1e-9, and u at random; the float64 result itself."""
    n, nu1, nu2 = random_materials(40, 1)
    n[::8] = 1 + 1e-9
    u = 10 ** np.random.default_rng(2).uniform(-8, 1.9, 40)
    found = layered_kernel(u, n, nu1, nu2, bonded)
    with mp.workdps(90):
        exact = [boundary_value(*case, bonded) for case in zip(u, n, nu1, nu2, strict=True)]
        assert_allclose(found.L, [float(v) for v in exact], rtol=1e-13, atol=0)
        assert_allclose(found.L1, [float(v - 1) for v in exact], rtol=1e-12, atol=0)  # some change sign near by


@BONDS
def test_ends(bonded):
    """L(0) = n, L(∞) = 1, and L - 1 and the slope vanish like e^(-2u) without an overflow."""
    n, nu1, nu2 = random_materials(200, 3)
    start, end = layered_kernel(0.0, n, nu1, nu2, bonded), layered_kernel(1e4, n, nu1, nu2, bonded)
    assert_allclose(start.L, n, rtol=1e-14, atol=0)
    assert_allclose(start.L1, n - 1, rtol=1e-13, atol=1e-16)
    assert_array_equal(start.uL, 0)
    assert_allclose(end.L, 1, rtol=0, atol=1e-15)
    assert_array_equal(end.L1, 0)
    assert_array_equal(end.uL, 0)
    u = np.array([[20.0], [60.0], [300.0]])
    far = layered_kernel(u, n, nu1, nu2, bonded)
    bound = 4 * (u * u + u + 1) * np.exp(-2 * u)
    assert np.all(np.abs(far.L1) < bound)
    assert np.all(np.abs(far.uL) < 2 * u * bound)
    assert np.all(np.median(np.abs(far.L1), axis=1) > 1e-3 * bound[:, 0])


def test_no_layer():
    """Bonded, the same material: L = 1 for any u."""
    u = np.geomspace(1e-8, 100, 30)[:, None]
    for value, L in zip(
        layered_kernel(u, 1.0, *[np.array([-0.9, 0, 0.3, 0.45, 0.5])] * 2, True), (1, 0, 0), strict=True
    ):
        assert_allclose(value, L, rtol=0, atol=2e-16)


def test_rigid_base():
    """n → 0: the layer on a rigid base, at first order in n where u > 0."""
    u = np.geomspace(0.01, 20, 30)
    for nu in (0.0, 0.3, 0.499):
        g = 3 - 4 * nu
        rigid = (g * np.sinh(2 * u) - 2 * u) / (g * np.cosh(2 * u) + 2 * u**2 + (1 + g**2) / 2)
        gap = [np.abs(layered_kernel(u, n, nu, 0.3, True).L / rigid - 1).max() for n in (1e-7, 1e-8)]
        assert 8 < gap[0] / gap[1] < 11
        assert gap[1] < 1e-3
    rigid = (np.cosh(2 * u) - 1) / (np.sinh(2 * u) + 2 * u)
    gap = [np.abs(layered_kernel(u, n, 0.3, 0.3, False).L / rigid - 1).max() for n in (1e-7, 1e-8)]
    assert 9 < gap[0] / gap[1] < 11


@BONDS
def test_thin_layer_coefficients(bonded):
    """L - A1 - A2 u is of second order, of third without friction."""
    n, nu1, nu2 = (v.ravel() for v in np.meshgrid([0.01, 0.3, 1.0, 3.0], [-0.9, 0.0, 0.3, 0.5], [-0.9, 0.3, 0.5]))
    A1, A2 = thin_layer_coefficients(n, nu1, nu2, bonded)
    u = 1e-3 * 2.0 ** -np.arange(2)[:, None]
    rest = np.abs(layered_kernel(u, n, nu1, nu2, bonded).L - A1 - A2 * u)
    keep = rest[1] > 1e-13  # else all further terms vanish, as for n = 1 and the same material
    assert np.all(rest[0, keep] > (3.9 if bonded else 7.9) * rest[1, keep])
    assert np.all(rest[0] < 20e-6 * (1 + n**2))
    assert keep.sum() > 30


def test_incompressible_film():
    """ν1 = ν2 = 1/2, bonded: L = n + (2/3)(1 - n²) u³ + …"""
    n, u = np.array([0.1, 0.5, 2.0]), np.array([[2e-3], [1e-3]])
    rise = (layered_kernel(u, n, 0.5, 0.5, True).L - n) / u**3
    assert_allclose(2 * rise[1] - rise[0], 2 / 3 * (1 - n**2), rtol=3e-5, atol=0)
    assert_allclose(rise[1], 2 / 3 * (1 - n**2), rtol=0.02, atol=0)


@BONDS
def test_slope(bonded):
    """u dL/du by Richardson's central difference, over the switches inside."""
    n, nu1, nu2 = random_materials(100, 4)
    u = np.geomspace(1e-4, 15, 60)[:, None]

    def central(step):
        above, below = (layered_kernel(u * np.exp(sign * step), n, nu1, nu2, bonded).L1 for sign in (1, -1))
        return (above - below) / (2 * step)

    found = layered_kernel(u, n, nu1, nu2, bonded)
    estimate = (4 * central(2e-3) - central(4e-3)) / 3
    size = np.abs(found.L1) + np.abs(found.uL)
    assert np.max(np.abs(estimate - found.uL) / size) < 1e-6


@BONDS
def test_no_jump_along_u(bonded):
    """L is smooth across u = 0.8 and wherever else a series takes over."""
    n, nu1, nu2 = random_materials(60, 5)
    t = np.linspace(np.log(1e-3), np.log(5), 4000)[:, None]
    L = np.log(layered_kernel(np.exp(t), n, nu1, nu2, bonded).L)
    third = np.diff(L, 3, axis=0)
    smooth = np.abs(third[1:-1]) <= 3 * np.maximum(np.abs(third[:-2]), np.abs(third[2:])) + 5e-14
    assert smooth.all()


@BONDS
def test_scalars(bonded):
    """Numbers in, numbers out."""
    for u in (0.0, 0.01, 3.0):
        for alone, row in zip(
            layered_kernel(u, 0.5, 0.3, 0.2, bonded), layered_kernel([u], 0.5, 0.3, 0.2, bonded), strict=True
        ):
            assert np.shape(alone) == ()
            assert alone == row[0]

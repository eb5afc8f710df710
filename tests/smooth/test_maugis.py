"""Attraction in a ring, after Maugis and Dugdale: another code on layers, closed forms and limits on a half-space."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rows import SMOOTH, material, rows

from solver import Problem, Status, solve
from solver.body import BODIES
from solver.shapes import shape_of
from solver.smooth.adhesion import maugis
from solver.smooth.adhesion.jkr import Jkr
from solver.smooth.adhesion.maugis import Maugis

ROWS = rows("given_maugis.csv")
HALF_SPACE = {"base": "half_space", "w_adhesion": 1e-4, "adhesion": "maugis"} | SMOOTH


@pytest.mark.parametrize("row", ROWS, ids=[f"{row['case']:g}" for row in ROWS])
def test_another_code(row):
    """1e-9, by the load; the pressure ends at -sigma0."""
    case = material(row) | {"w_adhesion": row["w"], "adhesion": "maugis", "sigma0": row["sigma0"], "rtol": 1e-9}
    contact = solve(Problem.of(P=row["P"], **case, **SMOOTH))
    assert contact.status == Status.CONVERGED
    for name in "aPD":
        assert_allclose(getattr(contact, name), row[name], rtol=1e-9, atol=0)
    assert_allclose(contact.p[0, 1], -row["sigma0"], rtol=1e-12, atol=0)


@pytest.mark.parametrize("sigma", [1e-4, 1e-2])
def test_half_space(sigma):
    """Maugis' closed forms at c/a = m, with λ = 2 σ₀ (R/(π w K²))^(1/3), K = 4E/3: 1e-10.

    1 = (λ a²/2) [q + (m² - 2) θ] + (4 λ² a/3) [q θ - m + 1], q = sqrt(m² - 1), θ = arccos(1/m), a in (π w R²/K)^(1/3).
    """
    w, K = 1e-4, 4 / 3
    unit, lam = (np.pi * w / K) ** (1 / 3), 2 * sigma / (np.pi * w * K**2) ** (1 / 3)
    contact = solve(Problem.of(a=[0.03, 0.1], sigma0=sigma, **HALF_SPACE))
    a = contact.a / unit
    low, high = np.ones(2), np.full(2, 1e3)
    for _ in range(100):
        m = (low + high) / 2
        q, theta = np.sqrt(m**2 - 1), np.arccos(1 / m)
        rest = lam * a**2 / 2 * (q + (m**2 - 2) * theta) + 4 / 3 * lam**2 * a * (q * theta - m + 1) - 1
        low, high = np.where(rest < 0, m, low), np.where(rest < 0, high, m)
    P = (a**3 - lam * a**2 * (q + m**2 * theta)) * np.pi * w
    D = (a**2 - 4 / 3 * a * lam * q) * unit**2
    assert_allclose(contact.P, P, rtol=1e-10, atol=0)
    assert_allclose(contact.D, D, rtol=1e-10, atol=0)


def test_limits():
    """-P_off/(π w) goes from 2, of DMT, to 1.5, of JKR, as σ₀ rises; z0 says the same as σ₀ = w/(0.97 z0)."""
    ratios = [-solve(Problem.of(P=0.0, sigma0=s, **HALF_SPACE)).P_off[0] / (np.pi * 1e-4) for s in (1e-5, 1e-2, 1.0)]
    assert 1.9999 < ratios[0] < 2 and ratios[0] > ratios[1] > ratios[2] and 1.5 < ratios[2] < 1.501
    one, other = (solve(Problem.of(D=1e-3, **HALF_SPACE | v)) for v in ({"sigma0": 0.01}, {"z0": 1e-4 / 0.97 / 0.01}))
    assert_allclose(one.P, other.P, rtol=1e-12, atol=0)
    assert solve(Problem.of(D=1e-3, sigma0=1e-5, **HALF_SPACE)).a_off == 0


def states(**case):
    """The :class:`~solver.smooth.state.State` of the rings at the radii `a` of a case, and of the edge that
    tears, without a search for pull-off."""
    part = Problem.of(**case, adhesion="maugis", **SMOOTH)
    numbers = shape_of(part), BODIES[str(part.base[0])](part), part.w_adhesion
    return Maugis(*numbers, part.sigma0).at(part.value), Jkr(*numbers).at(part.value)


def test_stiffness_is_the_slope_of_the_curve():
    """dP/dD from two radii, 1e-5."""
    layer = {"h": 0.05, "n": 0.3, "nu1": 0.4, "bonding": "bonded", "w_adhesion": 1e-4, "sigma0": 3e-2}
    ring, _ = states(a=[0.0999, 0.1, 0.1001], **layer)
    assert_allclose((ring.P[2] - ring.P[0]) / (ring.D[2] - ring.D[0]), ring.stiffness[1], rtol=1e-5, atol=0)
    solution = solve(Problem.of(a=0.1, adhesion="maugis", **layer, **SMOOTH))
    assert_allclose([solution.P[0], solution.D[0]], [ring.P[1], ring.D[1]], rtol=1e-12, atol=0)


@pytest.mark.parametrize(
    "shape",
    [
        {"shape": "sphere"},
        {"shape": "cone", "half_angle": 60.0},
        {"shape": "frustum", "flat_radius": 0.1, "half_angle": 70.0},
    ],
    ids=lambda shape: shape["shape"],
)
def test_other_shapes_tend_to_jkr(shape):
    """P and D at a radius go to those of an edge that tears, like 1/sigma0²; and at 10 they are there to 2e-5."""
    layer = {"a": 0.2, "h": 0.1, "n": 0.3, "nu1": 0.4, "bonding": "bonded", "w_adhesion": 1e-4} | shape
    ring, edge = states(**layer, sigma0=[1.0, 10.0])
    for name in "PD":
        off = getattr(ring, name) / getattr(edge, name) - 1
        assert 0 < off[1] < 2e-5
        assert_allclose(off[0] / off[1], 100, rtol=0.02, atol=0)


@pytest.mark.parametrize("h", [0.1, 0.004])
def test_thin_layers(h):
    """However thin the layer is against the contact, the ring is the edge that tears, to 1e-3, as on thick layers, and
    its error is below that: the functions of the basis turn often there."""
    ring, edge = states(a=[0.2], h=h, n=0.3, nu1=0.4, bonding="bonded", w_adhesion=1e-4, sigma0=1.0)
    for name in "PD":
        assert_allclose(getattr(ring, name), getattr(edge, name), rtol=1e-3, atol=0)
        assert getattr(ring, f"{name}_error") < 1e-3 * np.abs(getattr(ring, name))


def test_a_basis_that_is_too_small_says_so(monkeypatch):
    """The errors of the state cover what 16 more functions change in P and D, a hundred roundings or more."""
    thin = {"a": [0.2], "h": 0.03, "n": 0.3, "nu1": 0.4, "bonding": "bonded", "w_adhesion": 1e-4, "sigma0": 0.1}
    exact, size_of = states(**thin)[0], maugis.size_of
    monkeypatch.setattr(maugis, "size_of", lambda *octave: size_of(*octave) - 16)
    coarse, _ = states(**thin)
    for name in "PD":
        off = np.abs(getattr(coarse, name) / getattr(exact, name) - 1)
        assert 2e-14 < off < getattr(coarse, f"{name}_error") / np.abs(getattr(exact, name)) < 1e3 * off


def test_a_depth():
    """The depth of the state at a radius leads back to it."""
    at = solve(Problem.of(a=0.1, sigma0=0.01, **HALF_SPACE))
    again = solve(Problem.of(D=at.D, sigma0=0.01, **HALF_SPACE))
    assert again.status == Status.CONVERGED
    assert_allclose([again.a[0], again.P[0]], [at.a[0], at.P[0]], rtol=1e-10, atol=0)


def test_where_nothing_touches_any_more():
    """Under a depth below that of pull-off no case of the batch has a radius."""
    apart = solve(Problem.of(D=-0.1, sigma0=0.01, **HALF_SPACE))
    assert apart.status == Status.PULLED_OFF and np.isnan(apart.a)
    assert -0.1 < apart.D_off[0] < 0


def test_a_flat_punch_is_refused():
    contact = solve(Problem.of(P=0.0, shape="flat", flat_radius=0.1, sigma0=0.01, **HALF_SPACE))
    assert contact.status == Status.INVALID_INPUT

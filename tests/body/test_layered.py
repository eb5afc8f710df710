"""The exact layered base against two formulations that share nothing with it (:mod:`layered_independent`)."""

from pathlib import Path

import numpy as np
import pytest
from layered_independent import answers, fredholm, kernel, rough
from numpy.testing import assert_allclose
from solver_cases import LOAD, MAIN, difference

from solver import Problem, Status, solve
from solver.body import BODIES

NAMES = ("P", "D", "p0", "dP_dD")
RADIUS = 0.04
#: (Ra, Nbar) and (B, beta) of Table 1 of the paper.
TABLE1 = [
    (0.004, 250000.0, 0.1, 0.50),
    (0.004, 62500.0, 0.3, 0.53),
    (0.004, 15625.0, 1.0, 0.57),
    (0.002, 250000.0, 0.3, 0.53),
    (0.001, 250000.0, 1.0, 0.57),
]


def smooth(eta, n, nu1, nu2, bonded, rtol):
    """Dimensionless P, D, p(0), dP/dD (B, 4) of the solver, and the solution."""
    case = {"h": eta * RADIUS, "n": n, "nu1": nu1, "nu2": nu2, "bonding": np.where(bonded, "bonded", "frictionless")}
    s = solve(Problem.of(a=RADIUS, base="layered", micro="smooth", rtol=rtol, **case))
    unit = (n * RADIUS**3, RADIUS**2 + 0 * n, n * RADIUS, n * RADIUS)
    return np.stack([getattr(s, name) / u for name, u in zip(NAMES, unit, strict=True)], axis=1), s


def compare(cases, rtol, bound):
    """The solver at `rtol` against the Fredholm equation, within `bound`."""
    table = np.array(cases, dtype=float)
    found, s = smooth(*table.T[:4], table[:, 4] == 1, rtol)
    expected = np.array([fredholm(*row[:4], row[4] == 1) for row in table])
    assert np.all(s.status == Status.CONVERGED)
    error = np.abs(found / expected - 1)
    worst = error.max(axis=1).argmax()
    assert error.max() < bound, (table[worst], error[worst])
    assert np.all(error.max(axis=1) < 10 * s.error + 1e-10), "the estimated error is honest"


GRID = [
    (1 / ratio, n, nu1, nu2, bonded)
    for ratio in (0.05, 0.5, 2.0, 10.0, 20.0)
    for n in (1e-3, 0.05, 1.0, 10.0)
    for bonded, nu1, nu2 in ((0, 0.3, 0.3), (1, 0.0, 0.5), (1, 0.3, 0.3), (1, 0.5, 0.0), (1, 0.5, 0.5))
]


@pytest.mark.parametrize("first", [1.0, 10.0, 40.0])
@pytest.mark.parametrize("n", [0.01, 30.0])
def test_waves_that_no_mesh_has(n, first):
    """The shift of the edge is (h/π) ∫ |ln L(u)/L(u1)| du/u² over all u > u1 = h/(a s1²), to 1 %, by another rule."""
    body = BODIES["layered"](Problem.of(a=[RADIUS], h=0.05, n=n, nu1=0.4, base="layered", micro="smooth"))
    t = np.linspace(0, 1, 20_001)[1:]  # u = u1/t, and du/u² = -dt/u1
    L = body.whole((first / t)[None])[0]
    expected = body.h / np.pi * np.trapezoid(np.abs(np.log(L / L[-1])), t) / first
    assert_allclose(body.unseen(np.array([RADIUS]), np.sqrt(body.h / RADIUS / first)[0]), expected / RADIUS, rtol=0.01)


def test_fredholm_on_a_grid():
    """a/h from 0.05 to 20; the nearly incompressible film on a stiff base among them. 1e-6 is asked at a/h = 20."""
    compare(GRID, 1e-9, 1e-8)


def test_fredholm_at_random():
    rng = np.random.default_rng(3)
    size = 50
    eta, n = 1 / np.exp(rng.uniform(np.log(0.05), np.log(20), size)), 10 ** rng.uniform(-3, 1, size)
    compare(np.stack([eta, n, *rng.uniform(0, 0.5, (2, size)), rng.random(size) < 0.6], axis=1), 1e-9, 1e-8)


def test_stiff_coatings():
    """n ≫ 1: the layer is a plate, whose kernel falls at u ~ n^(-1/3), and, bonded, a membrane, at u ~ 1/n."""
    materials = ((0, 0.3, 0.3), (1, 0.3, 0.3), (1, 0.5, 0.0), (1, 0.5, 0.5), (1, -0.9, -0.9))
    cases = [
        (eta, n, nu1, nu2, b) for eta in (1.0, 30.0) for n in (30.0, 1e3, 6e3, 1e4, 1e6) for b, nu1, nu2 in materials
    ]
    compare(cases, 1e-9, 1e-8)
    compare([(0.15, n, nu1, nu2, b) for n in (1e2, 2e3) for b, nu1, nu2 in materials], 1e-9, 1e-8)


def test_auxetic_and_soft():
    """Negative Poisson ratios, and layers so soft that the base is rigid."""
    pairs = ((-0.9, -0.9), (-0.9, 0.5), (0.5, -0.9), (0.45, 0.0))
    compare([(eta, n, *pair, 1) for eta in (0.1, 1.0) for n in (1e-8, 1e-4, 0.3) for pair in pairs], 1e-9, 1e-8)


def test_reference_row():
    """Row 1 of Table 1 with the power law, frictionless, as the project holds it."""
    s = solve(Problem.of(P=2.70408e-5, base="layered", micro="power_law", rtol=1e-10, **MAIN))
    found = [v[0] for v in (s.a, s.p0, s.D, s.Ar_An, s.p_max)]
    assert s.status[0] == Status.CONVERGED
    assert_allclose(
        found, [0.03663608144, 0.01093673418, 1.0183556416e-3, 0.2084340497, 0.0536397585], rtol=1e-9, atol=0
    )


def table1(micro, bonded, **more):
    Ra, Nbar, B, beta = np.array(TABLE1).T
    case = MAIN | {"Ra": Ra, "Nbar": Nbar, "B": B, "beta": beta, "bonding": "bonded" if bonded else "frictionless"}
    return solve(Problem.of(P=LOAD, base="layered", micro=micro, **case, **more))


@pytest.mark.parametrize("bonded", [False, True], ids=["frictionless", "bonded"])
@pytest.mark.parametrize("micro", ["disc_cell", "power_law"])
def test_table1(micro, bonded):
    """Five rows: at rtol = 1e-9 to 1e-8 of twice the nodes, and of collocation at other nodes."""
    s = table1(micro, bonded, rtol=1e-9)
    assert np.all(s.status == Status.CONVERGED)
    finer = table1(micro, bonded, rtol=0.5, nodes=2 * s.nodes)
    assert difference(s, finer).max() < 1e-8
    for i, (Ra, Nbar, B, beta) in enumerate(TABLE1):
        expected = rough(40, micro, s.a[i], 0.02, 0.5, 0.3, 0.3, bonded, Nbar, Ra, B, beta)
        assert_allclose(answers(s, i), expected, rtol=1e-8, atol=0)


@pytest.mark.parametrize("micro", ["disc_cell", "power_law"])
def test_rough_on_other_layers(micro):
    """Collocation again: thin and thick, soft and hard, rubber, unequal Poisson ratios; n = 3000 has D from u ~ 1/n."""
    layers = [
        (0.005, 0.1, 0.3, 0.3, False),
        (0.01, 10.0, 0.3, 0.3, True),
        (0.01, 0.02, 0.5, 0.3, True),
        (0.04, 100.0, 0.25, 0.3, False),
        (0.1, 3000.0, 0.2, 0.3, True),
        (1.0, 0.5, 0.45, 0.5, True),
    ]
    h, n, nu1, nu2, bonded = map(np.array, zip(*layers, strict=True))
    case = MAIN | {"h": h, "n": n, "nu1": nu1, "nu2": nu2, "bonding": np.where(bonded, "bonded", "frictionless")}
    s = solve(Problem.of(a=0.03, base="layered", micro=micro, rtol=1e-9, **case))
    assert np.all(s.status == Status.CONVERGED)
    for i, layer in enumerate(layers):
        expected = rough(48, micro, 0.03, *layer, MAIN["Nbar"], MAIN["Ra"])
        assert_allclose(answers(s, i), expected, rtol=1e-8, atol=0, err_msg=str(layer))


def test_the_kernel_of_the_references():
    """Against 25 digits: rounding of L - 1, or of L where that changes sign, is all there is."""
    table = np.genfromtxt(Path(__file__).parents[1] / "references" / "kernel_reference.csv", delimiter=",", names=True)
    found = [kernel(row["u"][None], row["n"], row["nu1"], row["nu2"], row["bonded"] == 1)[0] for row in table]
    assert_allclose(found, table["L1"], rtol=1e-12, atol=1e-15)


def test_references_close_on_themselves():
    """Both formulations with half as many nodes again: their digits are earned."""
    for case in ((0.05, 1e-3, 0.5, 0.5, True), (0.1, 10.0, 0.3, 0.3, False), (2.0, 0.5, 0.0, 0.5, True)):
        assert_allclose(fredholm(*case), fredholm(*case, count=72 + int(9 / case[0])), rtol=3e-10, atol=0)
    case = (0.04, 0.02, 0.5, 0.3, 0.3, True, 250000.0, 0.004)
    assert_allclose(rough(40, "power_law", *case), rough(60, "power_law", *case), rtol=2e-9, atol=0)
    assert_allclose(fredholm(1.0, 1.0, 0.3, 0.3, True), [4 / 3, 1, 2 / np.pi, 2], rtol=1e-14, atol=0)  # Hertz

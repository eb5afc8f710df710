"""Asperities of random heights: against quadrature of the equations, one height, Greenwood and Tripp, and contacts."""

from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad
from scipy.optimize import brentq
from solver_cases import difference

import study
from solver import Problem, solve
from solver.known import register
from solver.laws import disc_cell, heights, spread
from solver.numerics.caches import Cache
from study.studies.literature.formulas import GREENWOOD_TRIPP

pytestmark = pytest.mark.usefixtures("forgetful")

LAW = heights.LAW
CASE = {"Nbar": 250_000.0, "Ra": 0.004, "h": 0.02, "n": 0.5}
A_STAR = 1 / (np.pi * CASE["Nbar"] * CASE["Ra"])


def bound(spread, cut):
    """The law of one case, its spread over A*."""
    one = np.ones(1)
    return LAW.bind(one, Nbar=one, Ra=one, sigma=one * spread / np.pi, cut=one * cut)


def exact(y, sigma, cut):
    """q and the means at y (1, m) without a table."""
    one = np.ones((1, 1))
    edges = np.array([[0.0, 2 * cut]])
    density = partial(heights.NORMAL.at, cut=cut)
    return spread.pressure(edges, density, 1.0, y, sigma * one, (cut * sigma + 1 / 3) * one)


@pytest.fixture(autouse=True)
def quiet():
    """As in the solver."""
    with np.errstate(all="ignore"):
        yield


@pytest.mark.parametrize("sigma", [1e-6, 0.003, 0.1, 0.5, 2.0, 20.0])
@pytest.mark.parametrize("cut", [3.0, 5.0])
def test_the_tables(sigma, cut):
    """Between the knots: q and A within 5e-6, λ within 2e-4, far beyond filled cells too."""
    y = np.exp(np.linspace(np.log(2e-4), np.log(1e3), 701))[None]
    q, at = exact(y, sigma, cut)
    own = bound(sigma, cut)
    found = own.evaluate(y)
    assert_allclose(found.q, q, rtol=5e-6, atol=0)
    assert_allclose(found.g, spread.depth(y, q, cut * sigma + 1 / 3)[0], rtol=5e-6, atol=0)
    assert_allclose(own.area(y, q), at.area, rtol=heights.ERROR, atol=0)
    assert (found.dq > 0).all() and (found.dg > 0).all()
    assert_allclose(found.g[0, -1], cut * sigma + 1 / 3, rtol=1e-3)  # the mean relief


@pytest.mark.parametrize("spread", [0.02, 0.2])
def test_against_the_equations(spread):
    """b of each height from (6), its load from (7) with the others smeared, the mean by adaptive quadrature. Units B̄ =
    Ra = 1 and p* = 2 E/3 = 1."""
    E, cut = 1.5, 3.0
    share = quad(lambda z: np.exp(-(z**2) / 2), -cut, cut)[0]

    for y in (0.05, 0.4, 1.5):
        q, at = exact(np.array([[y]]), spread, cut)
        p, A = q[0, 0], (y / (1 + q[0, 0])) ** 2

        def spot(z, p=p, A=A):
            approach = A - (cut - z) * spread
            if approach <= -2 * p / E:
                return 0.0
            return brentq(lambda b: b**2 - 2 * p / E * np.sqrt(1 - b**2) - approach, 0, 1, xtol=1e-15)

        def load(z, p=p):
            b = spot(z)
            return (4 * E / 3 * b**3 + 2 * p * (np.arcsin(b) - b * np.sqrt(1 - b**2))) / np.pi

        lowest = max(-cut, cut - (A + 2 * p / E) / spread)
        mean = [quad(lambda z, f=f: f(z) * np.exp(-(z**2) / 2) / share, lowest, cut, epsabs=0, epsrel=1e-10)[0]
                for f in (load, lambda z: spot(z) ** 2)]  # fmt: skip
        assert_allclose(p, mean[0], rtol=1e-8, atol=0)
        assert_allclose(at.area[0, 0], mean[1], rtol=1e-8, atol=0)
        highest = spot(cut)
        peak = 2 * E * highest / np.pi + 2 * p / np.pi * np.arcsin(highest)
        assert_allclose(LAW.peak(y, p, spread, cut), peak, rtol=1e-9, atol=0)


def test_one_height_is_the_disc_cell():
    y = np.geomspace(1e-6, 1e3, 40)[None]
    own, disc = bound(0.0, 4.0).evaluate(y), disc_cell.spot_curve(y)
    assert_allclose(own.q, disc.q, rtol=1e-14, atol=0)
    assert_allclose(own.g, disc.g, rtol=1e-14, atol=0)
    assert_allclose(own.dq, disc.dq, rtol=1e-13, atol=0)
    assert_allclose(own.dg[y < 5], disc.dg[y < 5], rtol=1e-12, atol=0)
    for base in ("half_space", "layered"):
        given = CASE | {"P": 1e-5, "base": base, "rtol": 1e-9, "nodes": 32}
        same = solve(Problem.of(**given, micro="disc_cell"))
        found = solve(Problem.of(**given, micro=LAW, sigma=0.0))
        assert difference(found, same)[0] < 1e-11


@pytest.mark.parametrize("spread", [0.003, 0.1, 0.5])
def test_derivatives_inverses_and_edge(spread):
    own, y = bound(spread, 4.0), np.geomspace(1e-4, 5, 25)[None]
    step = 1e-4 * y
    below, at, above = map(own.evaluate, (y - step, y, y + step))
    assert_allclose((above.q - below.q) / (2 * step), at.dq, rtol=1e-6, atol=0)
    assert_allclose((above.g - below.g) / (2 * step), at.dg, rtol=1e-6, atol=0)
    assert (at.dq > 0).all() and (at.dg > 0).all()
    assert_allclose(own.from_pressure(at.q), y, rtol=1e-11, atol=0)
    assert_allclose(own.from_displacement(at.g), y, rtol=1e-9, atol=0)
    few = own.evaluate(np.array([[1e-4, 2e-4]])).q[0]
    assert_allclose(few[1] / few[0], 2**5, rtol=1e-4)  # p ~ A^(5/2)
    if spread > 0.03:
        gamma, beta = own.edge()
        assert_allclose(gamma * few[0] ** beta, 1e-8, rtol=1e-4)


@pytest.mark.parametrize(("mu", "at_four"), [(1, 5e-3), (4, 5e-3), (17, 1.3e-2)])
def test_without_a_field_it_is_greenwood_and_tripp(mu, at_four):
    """p(0) and a_eff; μ = (8/3) Nbar σ sqrt(2 R Ra). The cut moves them by 5e-4 at most at 5 σ, by more at 4 σ."""
    alpha, (p0, a_eff) = np.array(list(GREENWOOD_TRIPP[mu])), np.array(list(GREENWOOD_TRIPP[mu].values())).T
    free = register(heights.law("free_heights", heights.NORMAL, field=0.0, version="1"))
    a, Ra = 0.01, 1e-6
    sigma = alpha * a**2
    points, weights = np.polynomial.legendre.leggauss(40)
    x, w = (points + 1) / 2, weights / 2
    for cut, most in ((4.0, at_four), (5.0, 5e-4)):
        given = {"Nbar": 0.375 * mu / (sigma * np.sqrt(2 * Ra)), "Ra": Ra, "sigma": sigma, "cut": cut}
        s = solve(Problem.of(P=4 / 3 * a**3, base="half_space", micro=free, rtol=1e-5, **given), x)
        assert (s.status == 0).all()
        assert_allclose(s.p0 / (2 * a / np.pi), p0, rtol=most, atol=0)
        found = 3 * np.pi / 4 * s.a * (s.p @ (x * w)) / (s.p @ w)
        assert_allclose(found / a, a_eff, rtol=most, atol=0)


@pytest.mark.parametrize("base", ["half_space", "thin_layer", "layered"])
def test_accuracy(base):
    """Every case converges, and the truth (on 96 nodes) is within the error, for each control."""
    given = CASE | {"base": base, "micro": "normal_heights", "sigma": A_STAR * np.array([0.005, 0.05, 0.2])}
    P = solve(Problem.of(P=[1e-6, 1e-5, 5e-5], **given, rtol=1e-5))
    assert (P.status == 0).all()
    for control in ("P", "a", "D"):
        case = given | {control: getattr(P, control)}
        found = solve(Problem.of(**case, rtol=1e-5))
        fine = solve(Problem.of(**case, rtol=1e-9, nodes=96))
        assert (found.status == 0).all() and (found.error <= 1e-5).all()
        assert (difference(found, fine) <= found.error + np.maximum(fine.error, 1e-9)).all()


@pytest.mark.parametrize("micro", ["normal_heights", "uniform_heights"])
def test_any_spread(micro):
    """From far below A* to far above it, where the highest summits fill their cells at the edge already. The more they
    spread, the larger and the softer the contact."""
    sigma, P = np.array([1e-4, 0.1, 1.0, 10.0, 100.0])[:, None] * A_STAR, [1e-7, 1e-5, 1e-3]
    given = CASE | {"P": P, "base": "half_space", "micro": micro, "rtol": 1e-4}
    s = [solve(Problem.of(**given, sigma=float(one[0]))) for one in sigma]
    assert all((one.status == 0).all() for one in s)
    for name, way in (("a", 1), ("p0", -1), ("Ar_An", -1), ("D", 1)):
        assert (way * np.diff([getattr(one, name) for one in s], axis=0) > 0).all(), name


def test_uniform_heights_by_quadrature():
    """Without a field of the neighbours, and spots small: q = (2/5) (2/π)/(2 √3 σ) (δ^(5/2) - (δ - 2 √3 σ)^(5/2))."""
    sigma, width = 1e-4, 2e-4 * np.sqrt(3)
    free = heights.law("free", heights.EVEN, field=0.0)
    one = np.ones(1)
    own = free.bind(one, Nbar=one, Ra=one, sigma=sigma / np.pi * one)
    y = np.geomspace(1e-3, 0.3, 40)[None]
    found = own.evaluate(y)
    both = found.g**2.5 - np.maximum(found.g - width, 0) ** 2.5
    assert_allclose(found.q, 0.8 / np.pi / width * both, rtol=3e-4, atol=0)


def test_the_tables_do_not_depend_on_company(monkeypatch):
    """A case among many spreads has the numbers that it has alone."""
    sigma = A_STAR * np.geomspace(0.01, 10, 30)
    given = CASE | {"P": 1e-5, "base": "half_space", "micro": "normal_heights", "rtol": 1e-4}
    many = solve(Problem.of(**given, sigma=sigma))
    monkeypatch.setattr(heights, "_cache", Cache(1e7))
    alone = solve(Problem.of(**given, sigma=sigma[17]))
    assert_allclose(many.D[17], alone.D[0], rtol=1e-11)
    assert (np.diff(many.D) > 0).all()


def test_through_a_study():
    given = {"P": 1e-5, "x": 3} | CASE
    found = study.solve(**given, micro="normal_heights", sigma=[0.0, 0.1 * A_STAR], cut=[3.0, 4.0])
    assert (found.status == 0).all() and found.sizes == {"sigma": 2, "cut": 2, "x": 3}
    assert_allclose(found.a[0, 0], found.a[0, 1], rtol=1e-6)
    assert (found.a[1, 1] > found.a[1, 0]) and (found.p0[1] < found.p0[0]).all()
    above = found.D - found.cut * found.sigma  # depth of the mean plane
    assert_allclose(above[1, 0], above[1, 1], rtol=0.01)
    assert study.to_physical(found, R=0.01, E2_star=2e11).sigma.attrs["units"] == "m"
    with pytest.raises(study.StudyError, match='sigma is missing: micro = "normal_heights" needs it'):
        study.solve(**given, micro="normal_heights")


def test_a_histogram(tmp_path):
    """One class of heights is a uniform law; a finely divided normal density is the normal law; a study takes it."""
    given = CASE | {"P": [1e-6, 1e-5], "base": "half_space", "rtol": 1e-5}
    width = 0.4 * A_STAR
    two = tmp_path / "even.csv"
    two.write_text(f"# heights of a map\nz, share\n{-width / 4},3\n{width / 4},3\n")
    found = solve(Problem.of(**given, micro=f"table:{two}"))
    even = solve(Problem.of(**given, micro="uniform_heights", sigma=width / (2 * np.sqrt(3))))
    assert (found.status == 0).all() and difference(found, even).max() < 2e-5

    sigma, z = 0.2 * A_STAR, np.linspace(-3, 3, 32)
    z = (z[1:] + z[:-1]) / 2
    fine = tmp_path / "normal.csv"
    fine.write_text("\n".join(["z,share", *(f"{one * sigma},{np.exp(-(one**2) / 2)}" for one in z)]))
    found = study.solve(P=[1e-5], Nbar=250_000.0, Ra=0.004, base="half_space", micro=f"table:{fine}", rtol=1e-4)
    normal = solve(Problem.of(**given, micro="normal_heights", sigma=sigma, cut=3.0))
    assert found.status == 0
    for name in ("p0", "p_max", "Ar_An"):
        assert_allclose(found[name].values, getattr(normal, name)[1:], rtol=0.01)


@pytest.mark.parametrize(("classes", "width"), [(2, 0.01), (5, 0.3), (32, 0.01), (32, 3.0)])
def test_the_tables_of_a_histogram(classes, width):
    share = np.random.default_rng(1).uniform(0.2, 1, classes)
    law = heights.histogram("table:x", np.linspace(0, width, classes), share, "1")
    one, y = np.ones(1), np.exp(np.linspace(np.log(1e-3), np.log(500), 301))[None]
    own = law.bind(one, Nbar=one / np.pi, Ra=one)  # A* = 1
    bins, c = law.curve.args[0], np.zeros((1, 1))
    q, at = spread.pressure(bins.edges(c), partial(bins.at, cut=c), 1.0, y, one[None], bins.mean(c) + 1 / 3)
    found = own.evaluate(y)
    assert_allclose(found.q, q, rtol=1e-4, atol=0)
    assert_allclose(own.area(y, q), at.area, rtol=heights.STEPPED, atol=0)
    assert (found.dq > 0).all() and (found.dg > 0).all()
    assert_allclose(
        bins.mean(c), width + width / (classes - 1) / 2 - np.linspace(0, width, classes) @ share / share.sum()
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("z,share\n0,1\n", "has 1 rows: must have at least 2"),
        ("z,share\n0,1\n1e-5,1\n3e-5,1\n", "column z: must ascend in equal steps"),
        ("z,share\n0,1\n1e-5,-1\n", 'column share, row 2: "-1": must be a finite number > 0'),
        ("z,share\n" + "\n".join(f"{i}e-7,1" for i in range(33)), "has 33 rows: must have at most 32"),
    ],
)
def test_a_histogram_that_is_none(tmp_path, text, words):
    file = tmp_path / "mine.csv"
    file.write_text(text)
    with pytest.raises(study.StudyError, match=words):
        study.solve(P=1e-5, Nbar=250_000.0, Ra=0.004, base="half_space", micro=f"table:{file}")


def test_places_are_looked_up_some_at_a_time(monkeypatch):
    """To the same bits, however many: also one at a time, and a last part that is shorter."""
    table = np.log(np.cumsum(np.random.default_rng(0).random((3, spread.KNOTS)), axis=1))
    y, group = np.geomspace(1e-5, 1e8, 7 * 5).reshape(7, 5), np.array([0, 2, 1, 1, 0, 2, 2])
    whole = spread.look_up(table, group, y)
    for most in (1, 10):
        monkeypatch.setattr(spread, "_LOOKED_UP", most)
        assert all(map(np.array_equal, whole, spread.look_up(table, group, y)))

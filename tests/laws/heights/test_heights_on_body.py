"""Asperities of random heights on the coated body itself: today's laws without a layer, the disc cell without a spread,
and resolved cells of random heights."""

from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver.kernels.two_layers import TwoLayers
from solver.laws import LAWS, heights, periodic_rows, spread
from solver.laws.cell import cell_law as cell
from solver.laws.cell import random_heights as on_body
from solver.laws.cell import summits
from solver.laws.cell.family import families

RANDOM = np.random.default_rng(8)
HISTOGRAM = heights.histogram("table:x", np.linspace(0, 0.003, 6), RANDOM.random(6) + 0.2, "1")
OF_HEIGHTS = {"normal": LAWS["normal_heights"], "uniform": LAWS["uniform_heights"], "histogram": HISTOGRAM}


@pytest.fixture(autouse=True)
def quiet():
    """As in the solver."""
    with np.errstate(all="ignore"):
        yield


def bounds(law, n: list, pitch: float, sigma: list) -> tuple:
    """The law on layers at a pitch over h and a spread over A*, of their bodies' material where n = 1; on half-spaces;
    and the disc cell on these bodies."""
    n, sigma = np.array(n), np.array(sigma)
    nu = np.full(len(n), 0.3)
    kernel, m, h = TwoLayers(n, nu, nu, n > 0), 0 * n, 0.01 + 0 * n
    few = {"Nbar": 1 / (pitch * h) ** 2, "Ra": 0.2 + 0 * n}
    A_star = 1 / (np.pi * few["Nbar"] * few["Ra"])
    rest = {"sigma": sigma * A_star, "cut": 4.0 + 0 * n}
    values = few | {name: rest[name] for name in law.parameters if name in rest}
    disc = LAWS["disc_cell"].on_body(kernel, m, h, n, **few)
    return law.on_body(kernel, m, h, n, **values), law.bind(n, **values), disc


@pytest.mark.parametrize("name", OF_HEIGHTS)
def test_without_what_lies_below_they_are_the_laws_of_a_half_space(name):
    """To what 24 points in place of 32 leave out of a mean: most where all summits touch, 4e-9."""
    law, bare, _ = bounds(OF_HEIGHTS[name], [1.0, 1.0, 1.0, 1.0], 8.0, [0.0, 0.03, 0.3, 5.0])
    p = np.geomspace(1e-9, 0.999, 25) * cell.end(law)[:, None]
    for numbers, wanted in zip(law.at(p), bare.at(p), strict=True):
        assert_allclose(numbers, wanted, rtol=1e-8)
    assert_allclose(law.at(cell.end(law)[:, None]).lam, 0.55, rtol=0.03)  # a knot is 2 % of λ


def test_without_a_spread_they_are_the_disc_cell():
    """Exactly; and with a small one nearly, for the mean field of equal spots is the disc cell's."""
    law, _, disc = bounds(LAWS["normal_heights"], [5.0, 0.3, 5.0, 0.3], 4.0, [0.0, 0.0, 1e-6, 1e-6])
    p = np.geomspace(1e-3, 0.5, 12) * cell.end(law)[:, None]
    for numbers, wanted in zip(law.at(p), disc.at(p), strict=True):
        assert_allclose(numbers[:2], wanted[:2], rtol=1e-12)
        assert_allclose(numbers[2:], wanted[2:], rtol=2e-3)  # c σ/A, of 4e-6/2e-3 at the least A


@pytest.mark.parametrize("name", ["normal", "uniform"])
def test_derivatives_and_inverses(name):
    law, *_ = bounds(OF_HEIGHTS[name], [0.2, 5.0, 50.0], 6.0, [0.3, 2.0, 0.1])
    y = np.geomspace(3e-4, 1e3, 200) * np.ones((3, 1))
    curve, up, down = (law.evaluate(y * np.exp(step)) for step in (0.0, 1e-5, -1e-5))
    for i in (0, 1):
        assert_allclose(y * curve[i + 2] / curve[i], np.log(up[i] / down[i]) / 2e-5, rtol=1e-4)  # at knots
        assert (np.diff(curve[i]) > 0).all()
    assert_allclose(law.guess(curve.q), y, rtol=1e-3)
    assert_allclose(law.from_pressure(curve.q), y, rtol=1e-12)
    inside = law.p_star[:, None] * curve.q < cell.end(law)[:, None]
    assert (law.peak(y, curve.q) > law.p_star[:, None] * curve.q)[inside].all()
    assert (law.from_pressure(np.zeros((3, 1))) == 0).all()


def lookup_of(n: float, pitch: float) -> tuple:
    one = np.ones(1)
    kernel = TwoLayers(n * one, 0.3 * one, 0.3 * one, one > 0)
    (disc,), _ = families("disc", pitch * one, kernel, 0 * one)
    summit = summits.summit(("test", n, pitch), disc, kernel, 0 * one, 0)
    return kernel, disc, summit.row(summit.terms)


@pytest.mark.parametrize(("n", "pitch"), [(1.0, 8.0), (5.0, 4.0), (0.2, 16.0), (50.0, 10.0)])
def test_summits_of_equal_heights_are_the_disc_cell(n, pitch):
    _, disc, row = lookup_of(n, pitch)
    c = np.array([0.01, 0.1, 0.4, 0.9]) * disc.reach * np.sqrt(np.pi)
    G, P, Q, B, F, D = (summits.at(row[None], i, c[None])[0][0] for i in range(6))
    v, theta = np.sqrt(1 - c * c), np.arcsin(c)
    q = 2 / np.pi * c**3 * np.exp(P) / (1 - 2 / np.pi * (theta - v * c + F))
    A = c**2 * np.exp(G) - 4 / 3 * q * (v + B)
    p_max = 3 / np.pi * c * np.exp(Q) + 2 / np.pi * q * (theta + D)
    unit = 2 / (3 * np.sqrt(np.pi))  # p* in units E l/Ra
    assert_allclose([unit * q, A / np.pi, unit * p_max], disc.at(c / np.sqrt(np.pi)), rtol=1e-6)
    if n == 1:
        assert_allclose([G, P, Q, B, F, D], 0.0, atol=1e-12)


def test_means_have_the_slopes_they_say():
    """By central differences: of q less the mean load by q, and of the mean load by the approach. Some of the spots are
    where the straight lines begin, whose second derivative the points see to 1e-5."""
    *_, row = lookup_of(5.0, 4.0)
    look, cut, sigma = summits.Lookup(row), np.array([[4.0]]), np.array([[0.4]])
    at, q, delta = partial(heights.NORMAL.at, cut=cut), np.array([[1e-4, 3e-3, 0.05]]), np.array([[0.2, 0.5, 0.8]])

    def more(q, delta):
        means = on_body.means(look, heights.NORMAL.edges(cut), at, q, delta, sigma)
        return means.load - q * means.rest, means

    step = 1e-5
    by_q = (more(q * (1 + step), delta)[0] - more(q * (1 - step), delta)[0]) / (2 * step * q)
    by_delta = (more(q, delta * (1 + step))[0] - more(q, delta * (1 - step))[0]) / (2 * step * delta)
    assert_allclose(more(q, delta)[1].fall, -by_q, rtol=2e-5)
    assert_allclose(3 / np.pi * more(q, delta)[1].c, by_delta, rtol=2e-5)


@pytest.mark.parametrize(("n", "pitch"), [(5.0, 8.0), (0.1, 8.0)])
def test_resolved_cells_of_random_heights(n, pitch):
    """Thirty-six summits of one period, 20 points a pitch, on the layer and by the mean field of the same heights: A
    and λ within 10 %, where the law on the half-space errs by 20 to 130 %."""
    kernel, _, row = lookup_of(n, pitch)
    points, side, p = 20, 6, 0.004
    depths = 0.06 * np.random.default_rng(1).normal(size=(side, side))
    depths = depths.max() - depths  # unit l²/Ra; A* is 1/pi there
    x = (np.arange(side * points) + 0.5) / points
    shape = ((x % 1 - 0.5)[:, None] ** 2 + (x % 1 - 0.5) ** 2) / 2 + depths[x.astype(int)][:, x.astype(int)]
    resolved = periodic_rows(-shape, 1 / points, [p], lambda k: 1 + kernel.decaying_part(k[None] / pitch)[0][0])

    def mean_field(row):
        """A and λ at p."""
        look, q = summits.Lookup(row), p * 1.5 * np.sqrt(np.pi)
        zeta, k, low, high = np.pi * depths.ravel(), np.full(depths.size, 2 / 3 * q), -0.5, 3.0
        for _ in range(50):
            delta = (low + high) / 2
            theta = on_body.angle(delta - zeta, k, look.at)
            spots = on_body.spots(theta, k, *look.at(np.sin(theta)))
            load = 2 / np.pi * (spots.load + q * spots.more)
            low, high = (delta, high) if load.mean() < q else (low, delta)
        return np.array([delta / np.pi, spots.c2.mean()])

    wanted = np.array([resolved[0][0], resolved[1][0]])
    assert_allclose(mean_field(row), wanted, rtol=0.1)
    assert (np.abs(mean_field(np.concatenate([row[:4], 0 * row[4:]])) / wanted - 1) > 0.2).all()


def test_tables_are_one_for_each_family_and_spread():
    law, *_ = bounds(LAWS["uniform_heights"], [5.0, 5.0, 0.5, 5.0], 4.0, [0.3, 0.3, 0.3, 0.7])
    body = law.law.curve.__self__
    table, group = body.tables(*law.own)
    assert len(table) == 3 and group[0] == group[1] and len({*group.tolist()}) == 3
    assert table.shape[-1] == spread.KNOTS

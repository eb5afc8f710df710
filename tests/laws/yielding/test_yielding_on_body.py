"""Asperities that yield on the coated body itself: the disc cell there, and today's law where there is no layer."""

import numpy as np
from numpy.testing import assert_allclose

from solver.kernels.two_layers import TwoLayers
from solver.laws import LAWS, elastic_plastic
from solver.laws.cell import cell_law as cell

LAW = LAWS["elastic_plastic"]
Y = np.geomspace(1e-6, 3.0, 120)


def bounds(size: int, pitch: tuple, seed: int) -> tuple:
    """The law on random bodies at pitches over h between two numbers, on the half-space of their layers, and the disc
    cell on these bodies; and the hardness (size, 1)."""
    random = np.random.default_rng(seed)
    n, nu1, nu2 = 10 ** random.uniform(-2, 2, size), *random.uniform(0, 0.5, (2, size))
    kernel, m = TwoLayers(n, nu1, nu2, random.random(size) < 0.6), random.choice([0.0, 0.5], size)
    h, Ra, E = random.uniform(0.001, 0.1, size), random.uniform(0.1, 1.0, size), n / (1 + m)
    l = np.exp(random.uniform(*np.log(pitch), size)) * h
    hardness = E * 10 ** random.uniform(-1.7, -0.5, size) * l / Ra
    few = {"Nbar": 1 / l**2, "Ra": Ra}
    values = few | {"hardness": hardness, "yield_strength": hardness / 2.84, "nu": nu1}
    elastic = LAWS["disc_cell"].on_body(kernel, m, h, E, **few)
    return LAW.on_body(kernel, m, h, E, **values), LAW.bind(E, **values), elastic, hardness[:, None]


def test_without_what_lies_below_it_is_the_law_of_a_half_space():
    law, bare, *_ = bounds(6, (0.1, 0.100001), seed=1)
    p = np.geomspace(1e-9, 0.99, 20) * cell.end(law)[:, None]
    for numbers, wanted in zip(law.at(p), bare.at(p), strict=True):
        assert_allclose(numbers, wanted, rtol=1e-11)
    assert_allclose(law.law.yielded(*law.own), bare.law.yielded(*bare.own), rtol=1e-10)


def test_below_the_elastic_limit_it_is_the_disc_cell():
    law, _, elastic, _ = bounds(20, (0.5, 16.0), seed=2)
    y, yields = np.tile(Y, (20, 1)), law.law.yielded(*law.own)
    below, curve, wanted = y**2 < yields, law.evaluate(y), elastic.evaluate(y)
    assert 200 < below.sum() < 2200
    for values, of_disc in zip(curve, wanted, strict=True):
        assert (values[below] == of_disc[below]).all()
    assert_allclose(law.peak(y, curve.q)[below], elastic.peak(y, curve.q)[below], rtol=1e-14)
    assert (curve.q < wanted.q)[~below & (y**2 > 1.001 * yields)].all()


def test_it_is_continuous_where_spots_begin_to_yield():
    law, *_ = bounds(20, (0.5, 16.0), seed=3)
    yields = law.law.yielded(*law.own)
    low, high = (np.where(yields < 0.5, np.sqrt(yields), 0.1) * side for side in (1 - 1e-9, 1 + 1e-9))
    for of in (lambda y: law.evaluate(y).q, lambda y: law.evaluate(y).g, lambda y: law.peak(y, law.evaluate(y).q)):
        assert_allclose(of(low), of(high), rtol=1e-8)  # 2e-9 times the powers of y
    assert law.bent(low, low).sum() == 0
    assert (law.bent(high, high) == (yields < 0.5)[:, 0]).all()


def test_derivatives_rise_and_inverse():
    law, *_ = bounds(20, (0.5, 16.0), seed=4)
    y = np.tile(Y, (20, 1))
    curve, up, down = (law.evaluate(y * np.exp(step)) for step in (0.0, 1e-5, -1e-5))
    corner = np.abs(np.log(y / cell.number(law.own[0], "end"))) < 1e-4
    corner |= np.abs(np.log(y**2 / law.law.yielded(*law.own))) < 1e-4
    flat = (y > cell.number(law.own[0], "turn")) & (np.gradient(elastic_plastic._mean(y, *law.own[:2])[0], axis=1) == 0)
    corner |= flat ^ np.roll(flat, 1, axis=1) | flat ^ np.roll(flat, -1, axis=1)
    for i in (0, 1):
        slope = np.log(up[i] / down[i]) / 2e-5
        assert_allclose((y * curve[i + 2] / curve[i])[~corner], slope[~corner], rtol=1e-8)
        assert (np.diff(curve[i]) > 0).all()
    assert_allclose(law.from_pressure(curve.q), y, rtol=1e-12)


def test_flowing_spots_carry_the_hardness_on_any_body():
    """Their mean pressure p/λ tends to H where they are few, and so does the pressure in their middle."""
    law, _, _, hardness = bounds(12, (0.5, 16.0), seed=5)
    soft = law._replace(own=(law.own[0], 1e6 * law.own[1], *law.own[2:]), p_star=1e6 * law.p_star)
    y = np.full((12, 1), 1e-2)
    q = soft.evaluate(y).q
    assert_allclose(soft.p_star[:, None] * q / y**2, hardness, rtol=0.03)
    assert_allclose(soft.peak(y, q), hardness, rtol=0.03)


def test_the_law_ends_with_the_disc_cell():
    law, *_ = bounds(6, (2.0, 16.0), seed=6)
    assert_allclose(law.at(cell.end(law)[:, None]).lam, cell.number(law.own[0], "end") ** 2, rtol=1e-10)


def test_what_has_flowed_stays_so_where_a_hard_film_bends():
    """The mean pressure of elastic spots falls from b/h = 1.2 on under a film of n = 30; x does not, and the part of
    the load that is lost stays."""
    one, pitch = np.ones(1), 16.0
    kernel = TwoLayers(30 * one, 0.25 * one, 0.3 * one, one > 0)
    values = {"Nbar": one, "Ra": one, "hardness": one / 2, "yield_strength": one / 2 / 2.84, "nu": 0.25 * one}
    law = LAW.on_body(kernel, 0 * one, one / pitch, 30 * one, **values)
    y = np.linspace(0.02, 0.6, 400)[None]
    elastic = LAWS["disc_cell"].on_body(kernel, 0 * one, one / pitch, 30 * one, Nbar=one, Ra=one).evaluate(y)
    mean, x = elastic.q / y**2, elastic_plastic._mean(y, *law.own[:2])[0][0]
    assert (np.diff(mean[0, y[0] < 0.3]) < 0).any()
    assert (np.diff(x) >= 0).all() and (np.diff(x) == 0).sum() > 30
    lost = 1 - (law.evaluate(y).q / elastic.q)[0]
    assert lost[-1] > 0.01 and (np.diff(lost) >= -1e-15).all()

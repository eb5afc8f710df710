"""The pressure inside a spot: its transform and load, and the table of where it is largest."""

import numpy as np
import pytest
from cells import cell
from numpy.testing import assert_allclose

from solver.kernels.stack import Stack
from solver.laws.cell import peak
from solver.laws.cell.axis import transform
from solver.laws.cell.rows import of_kernel
from solver.laws.cell.spot import Cell, spots
from solver.numerics import special
from solver.numerics.quadrature import gauss_legendre

REACH = np.sqrt(0.55 / np.pi)


def looked_at(of_cell, b, count=2001):
    """The largest pressure of spots of radii b and its radius over b, by a parabola through the largest of many."""
    r = np.linspace(0, 1, count)
    spot = spots(of_cell, b)
    q = peak.pressures(spot, np.sqrt((1 - r) * (1 + r)))
    top, at = np.empty((2, len(b)))
    for i, row in enumerate(q):
        j = np.argmax(row)
        if j == 0:
            top[i], at[i] = row[0], 0.0
            continue
        left, middle, right = row[j - 1 : j + 2]
        bend = 2 * middle - left - right
        top[i] = middle + (right - left) ** 2 / (8 * bend)
        at[i] = r[j] + r[1] * (right - left) / (2 * bend)
    return spot.p_max, top, at


@pytest.mark.parametrize("lattice, pitch, n", [("square", 8.0, 10.0), ("hex", 20.0, 0.1), ("disc", 40.0, 3.0)])
def test_its_hankel_transform_is_that_of_phi(lattice, pitch, n):
    """∫ q J0(kr) r dr = ∫ phi cos kt dt, at k = 0 the load over 2 pi."""
    spot = spots(cell(lattice, pitch, n), [0.3])
    x, weights = gauss_legendre(200)
    r = 0.3 * np.sqrt((1 - x) * (1 + x))  # x over b is the variable in which q is smooth, r dr = -b² x dx
    q, k = peak.pressures(spot, x)[0], np.array([0.0, 1.0, 7.0, 30.0, 100.0])
    hankel = (special.j0(k[:, None] * r) * q * x * weights).sum(axis=1) * 0.09
    assert_allclose(hankel, transform(spot, k), rtol=0, atol=1e-12 * transform(spot, k[:1])[0])
    assert_allclose(2 * np.pi * hankel[0], spot.p[0], rtol=1e-12)
    assert_allclose(peak.pressures(spot, np.ones(1))[0], spot.p_max, rtol=1e-12)


@pytest.mark.parametrize("lattice, pitch, n, bonded", [("square", 8.0, 50.0, True), ("disc", 12.0, 5.0, False)])
def test_the_table_is_the_largest_pressure_of_each_spot(lattice, pitch, n, bonded):
    """1e-7 of the pressure; the parabola has the place to 1e-6, and to 1e-2 where that leaves the middle. The two cells
    have a ring that opens, and one that the middle overtakes too."""
    one = cell(lattice, pitch, n, 0.25, 0.3, bonded)
    table = peak.peaks(one, REACH)
    b = np.exp(np.linspace(np.log(0.5 / pitch), np.log(REACH), 150))
    p_max, top, at = looked_at(one, b)
    p, r = table.at(b, p_max)
    assert_allclose(p, top, rtol=1e-7)
    assert_allclose(r, at, atol=1e-2)
    wide = at > 0.2
    assert_allclose(r[wide], at[wide], atol=2e-6)
    assert 50 < wide.sum() < 150 and (r[p == p_max] == 0).all()
    assert table.ring[-1] == bonded
    assert not table.lifts_off(b).any()


@pytest.mark.parametrize("n, bonded, seen", [(4, True, 1.9), (10, True, 1.35), (100, True, 1.15), (10, False, 1.25)])
def test_where_the_peak_leaves_the_middle(n, bonded, seen):
    """The radii over h from which on the specification has seen a ring, and how much more it has at most."""
    one = cell("hex", 16.0, n, 0.25, 0.3, bonded)
    table = peak.peaks(one, REACH)
    assert seen - 0.1 < np.exp(table.ends[:-1][table.ring][0]) * 16 < seen
    largest = {10: 1.22, 100: 3.3}
    b = np.linspace(1.0 / 16, REACH, 60)
    p_max = spots(one, b).p_max
    p, r = table.at(b, p_max)
    if bonded and n in largest:
        assert (p / p_max).max() == pytest.approx(largest[n], rel=0.02)
        assert 0.7 < r[np.argmax(p / p_max)] < 0.9


def test_a_table_begins_no_later_than_the_ring(monkeypatch):
    """Without the bounds of hardness and radius from which on it is looked for: stiff, sliding and incompressible
    layers, and stacks, have no ring outside of these."""
    monkeypatch.setattr(peak, "NARROW", 0.3)
    monkeypatch.setattr(peak, "_HARD", 0.2)
    for nu, bonded in ((0.0, True), (0.5, False)):
        for n in (1.9, 2.2, 1e6):
            table = peak.peaks(cell("hex", 6.0, n, nu, 0.5, bonded), REACH)
            rings = np.exp(table.ends[:-1][table.ring]) * 6
            assert (rings > 1.05).all() and (n > 10 or not len(rings))
    zero, no = np.zeros((1, 2)), np.full((1, 2), False)
    for n in ([1.0, 30.0], [30.0, 1.0], [2.0, 200.0]):
        shape = np.array([n]), zero + 0.3, np.array([[1.0, 0.5]])
        stack = Stack(*shape, no, zero, zero, np.full(1, 0.3), no[0, :1])
        table = peak.peaks(Cell("hex", 6.0, of_kernel(stack, 0.0)), REACH)
        assert (np.exp(table.ends[:-1][table.ring]) * 6 > 1.05).all()


def test_below_soft_and_thick_layers_it_is_in_the_middle():
    for of_cell in (
        cell("hex", 8.0, 0.1),
        cell("disc", 1.0, 50.0),
        Cell("square", 8.0),
        cell("hex", 8.0, 50.0, m=40.0),
    ):
        table = peak.peaks(of_cell, REACH)
        p, r = table.at(np.array([0.01, 0.4]), np.array([1.0, 2.0]))
        assert p.tolist() == [1, 2] and r.tolist() == [0, 0] and not table.lifts_off(np.array([0.4])).any()


def test_a_plate_on_a_body_100000_times_softer_lifts_off():
    """Where the pressure in the middle is below 0: from b = 3.1 h on, in no case of n = 1e4."""
    table = peak.peaks(cell("hex", 60.0, 1e5), REACH)
    b = np.array([2.9, 3.05, 3.4, 10.0]) / 60
    p_max = spots(cell("hex", 60.0, 1e5), b).p_max
    assert table.lifts_off(b).tolist() == [False, False, True, True] and p_max[1] > 0 > p_max[2]
    assert not peak.peaks(cell("hex", 30.0, 1e4), REACH).lifts_off(np.array([REACH])).any()

"""The field below a spot of a periodic cell: sums of lone spots over the lattice, equilibrium, and its values at the
surface and at the interface."""

from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver.fields import of_pressure
from solver.fields.below_spots import ROUGH, below_spot
from solver.kernels.two_layers import TwoLayers
from solver.laws.cell.axis import axis_stresses
from solver.laws.cell.peak import pressures
from solver.laws.cell.rows import of_kernel
from solver.laws.cell.spot import Cell, spots

HARD = {"n": 5.0, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded"}
SLIDING = {"n": 0.3, "nu1": 0.45, "nu2": 0.2, "bonding": "frictionless"}


def cell_of(lattice: str, pitch: float, lam: float, n, nu1, nu2, bonding):
    """The cell, its spot, and the layers."""
    layers = TwoLayers(*(np.array([value]) for value in (n, nu1, nu2, bonding == "bonded")))
    cell = Cell(lattice, pitch, of_kernel(layers, 0.0))
    return cell, spots(cell, [np.sqrt(lam / np.pi)]), layers


@pytest.mark.parametrize("body, bodies", [(False, HARD), (True, SLIDING)])
def test_it_is_the_sum_of_lone_spots_less_the_uniform_pressure(body, bodies):
    """sz, of spots up to 20 pitches away: those farther away make some n z³/R³ of p. In the direction pi/8 the part
    with cos 4 angle, which the mean over the angle has not, is 0, and that with cos 8 angle is (r/d)^8."""
    cell, spot, layers = cell_of("square", 2.0, 0.1, **bodies)
    b, p, h, z, r = spot.b[0], spot.p[0], 0.5, 0.6 if body else 0.3, 0.15
    field = below_spot(cell, spot, layers, np.array([0.0, r]), np.array([z]), body)
    i = np.arange(-20, 21)
    centres = np.array([(x, y) for x in i for y in i if x * x + y * y <= 400])
    for column, at in enumerate([(0.0, 0.0), r * np.array([np.cos(np.pi / 8), np.sin(np.pi / 8)])]):
        away, count = np.unique(np.round(np.hypot(*(at - centres).T), 12), return_counts=True)
        lone = of_pressure(partial(_of_spot, spot), away / b, z / b, h=h / b, **bodies)["sz"]
        assert_allclose(field[2, 0, column], count @ lone + p, rtol=0, atol=4e-4 * p)


def _of_spot(spot, x):
    return pressures(spot, np.sqrt((1 - x) * (1 + x)))[0]


@pytest.mark.parametrize("lattice, bodies", [("hex", HARD), ("disc", SLIDING)])
def test_on_the_axis_and_at_the_surface(lattice, bodies):
    cell, spot, layers = cell_of(lattice, 8.0, 0.2, **bodies)
    b, p_max, h = spot.b[0], spot.p_max[0], 1 / 8
    r = b * np.array([0.0, 0.3, 0.9, 1.0])
    for z, body in ((np.array([0.0, 1e-3 * b, 0.4 * h, h]), False), (h * np.array([1.0, 1.7]), True)):
        field = below_spot(cell, spot, layers, r, z, body)
        sr, sz = axis_stresses(cell, spot, layers, z, int(body))
        assert_allclose(field[:, :, 0], [sr, sr, sz, 0 * sz], rtol=0, atol=1e-12 * p_max)
        assert_allclose(below_spot(cell, spot, layers, np.zeros(1), z, body)[..., 0], field[..., 0], atol=1e-12 * p_max)
        assert_allclose(below_spot(cell, spot, layers, r, z, body, ROUGH), field, rtol=0, atol=1e-7 * p_max)
    surface = below_spot(cell, spot, layers, r, np.zeros(1), False)[2:, 0]
    q = pressures(spot, np.sqrt(np.maximum(1 - (r / b) ** 2, 0.0)))[0]
    assert_allclose(surface, [spot.p[0] - q, 0 * q], rtol=0, atol=1e-12 * p_max)
    above, below = (below_spot(cell, spot, layers, r, np.array([h]), body)[2:] for body in (False, True))
    assert_allclose(above, below, rtol=0, atol=1e-12 * p_max)
    assert (np.abs(above[1]) < 1e-12 * p_max).all() == (bodies is SLIDING)


@pytest.mark.parametrize("body", [False, True])
def test_it_is_in_equilibrium(body):
    """Central differences over 1e-3 of the place err by 1e-6 of the stress over the place."""
    cell, spot, layers = cell_of("square", 4.0, 0.3, **HARD)
    r, z, step = 0.7 * spot.b[0], 0.31 if body else 0.17, 1e-3
    near = 1 + step * np.array([-1, 0, 1])
    sr, st, sz, trz = below_spot(cell, spot, layers, r * near, z * near, body)
    by_r = [(stress[1, 2] - stress[1, 0]) / (2 * step * r) for stress in (sr, trz)]
    by_z = [(stress[2, 1] - stress[0, 1]) / (2 * step * z) for stress in (trz, sz)]
    along = by_r[0] + (sr[1, 1] - st[1, 1]) / r + by_z[0]
    down = by_r[1] + trz[1, 1] / r + by_z[1]
    assert_allclose([along, down], 0.0, atol=1e-5 * np.abs(by_r + by_z).max())


def test_a_layer_of_the_bodys_material_is_none():
    one = {"n": 1.0, "nu1": 0.3, "nu2": 0.3, "bonding": "bonded"}
    r, z = np.array([0.0, 0.05]), np.array([0.02, 0.1])
    fields = [below_spot(*cell_of("hex", pitch, 0.1, **one), r, z, False) for pitch in (2.0, 9.0)]
    assert_allclose(*fields, rtol=0, atol=1e-13)

"""The limits of the law on the coated body, and how fast it tends to them."""

import csv

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver.kernels.two_layers import TwoLayers
from solver.laws import cell_rows, lattice
from solver.laws.cell import spot, sums


def table(name):
    """The rows of lattices.csv up to λ = 0.4: p, A, λ, p_max, and what half the points of its grid change of these."""
    with lattice.FILE.open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["lattice"] == name and float(row["lam"]) <= 0.4]
    names = "p", "A", "lam", "p_max", "A_change", "lam_change", "p_max_change"
    return (np.array([float(row[column]) for row in rows]) for column in names)


@pytest.mark.parametrize(("name", "mean"), [("square", (1.2e-4, 1.3e-4, 5e-5)), ("hex", (2e-6, 8e-5, 6e-7))])
def test_without_a_layer_it_is_the_table_of_lattices(name, mean):
    """At its pressures, within the error of the law that is made of it; nearer where the spots are round, up to λ =
    0.13, within the table's own change. `mean`: what the mean over the angle adds to that up to λ = 0.4."""
    p, A, lam, p_max, *changes = table(name)
    cell, b = spot.Cell(name, 1.0), np.sqrt(lam / np.pi)
    for _ in range(6):
        b *= np.cbrt(p / spot.spots(cell, b).p)
    spots = spot.spots(cell, b)
    assert_allclose(spots.p, p, rtol=1e-9)
    for value, wanted, change, more in zip(
        (spots.A, np.pi * b**2, spots.p_max), (A, lam, p_max), changes, mean, strict=True
    ):
        off = np.abs(value / wanted - 1)
        assert (off < lattice.ERROR).all()
        assert (off[lam < 0.13] < 1e-9 + change[lam < 0.13]).all() and (off < 1e-9 + change + more).all()


THICK = np.array([0.5, 0.6, 0.7])


@pytest.mark.parametrize("name", ["square", "hex"])
def test_a_thick_layer_differs_as_l_of_the_longest_wave(name):
    """p, A and p_max are off by a number times L(Gh) - 1, which falls as e^(-2 Gh): the same number for each body, to
    the next wave and the square of L - 1."""
    bare = np.array(cell_rows(name, 0.1, 0.01, 1.0, 0.3, 0.3, "bonded"))[:, None]
    over = []
    for n, nu1, bonding in (10.0, 0.25, "bonded"), (0.2, 0.4, "frictionless"):
        body = TwoLayers(*(np.array([v]) for v in (n, nu1, 0.3, bonding == "bonded")))
        G = 2 * np.pi / sums.LATTICES[name] * (1 if name == "square" else 2 / np.sqrt(3))
        off = np.array(cell_rows(name, 0.1, THICK, n, nu1, 0.3, bonding)) / bare - 1
        over.append(off / body.decaying_part(G / THICK[None])[0][0])
    assert_allclose(over[0], over[1], rtol=6e-4)
    assert_allclose(over[0], over[0][:, :1] * np.ones(3), rtol=3e-3)


def test_a_layer_nearly_like_its_body_differs_as_n_less_1():
    bare = np.array(cell_rows("square", 0.1, 0.01, 1.0, 0.3, 0.3, "bonded"))[:, None]
    off = np.array(cell_rows("square", 0.1, 8.0, [1.01, 1.001, 0.999], 0.3, 0.3, "bonded")) / bare - 1
    assert_allclose(off[:, 0] / off[:, 1], 10, rtol=5e-3)
    assert_allclose(off[:, 1], -off[:, 2], rtol=2e-3)


def test_a_thin_layer_is_the_body_alone_as_h_ln_h():
    """The half-space of E2*. A soft layer changes p by a number times h (c + ln(l/h)): this over h grows by equal steps
    from double to double, to the next power of h."""
    bare, pitch = cell_rows("square", 0.05, 0.01, 1.0, 0.3, 0.3, "bonded"), np.array([100.0, 200.0, 400.0])
    p, A, p_max = cell_rows("square", 0.05, pitch, 0.2, 0.25, 0.3, "bonded")
    for off in p / 5 / bare[0] - 1, A / bare[1] - 1, p_max / 5 / bare[2] - 1:
        assert ((off < 0) & (off > -0.4)).all()
        assert ((off[1:] / off[:-1] > 0.5) & (off[1:] / off[:-1] < 0.71)).all()
    steps = np.diff((p / 5 / bare[0] - 1) * pitch)
    assert_allclose(steps[1], steps[0], rtol=0.02)

"""The state of layer and body under a wave: against 113 bits, the kernel L, reciprocity, and the two ways of it."""

import numpy as np
import pytest
from field_rows import table
from numpy.testing import assert_allclose

from solver.kernels.closed_form import layered_kernel
from solver.kernels.transfer import Bodies, StatePart, antiplane, decaying, radial_sum, wave_state
from solver.kernels.two_layers import TwoLayers

NORMAL, TANGENTIAL = (-1.0, 0.0), (0.0, 1.0)
ROWS = table("transfer")


def some_bodies(random, count):
    n = 10 ** random.uniform(-6, 6, count)
    n[::7] = 0.0
    return TwoLayers(n, *random.uniform(0, 0.5, (2, count)), random.random(count) < 0.5)


@pytest.mark.parametrize("load", ["normal", "tangential"])
@pytest.mark.parametrize("kind", [StatePart.LAYER, StatePart.BODY])
@pytest.mark.parametrize("thin", [True, False])
def test_reference(load, kind, thin):
    """u, w, S, T and M, relative to the largest of a state. Its last digit, and rounding of e^(-100) = 4e-44, count."""
    rows = ROWS[(ROWS["load"] == load) & (ROWS["side"] == (kind == StatePart.BODY)) & ((ROWS["kh"] < 1) == thin)]
    bodies = Bodies.of(TwoLayers(rows["n"], rows["nu1"], rows["nu2"], rows["bonded"] == 1))
    v = wave_state(kind, bodies, rows["kh"], rows["kh"] * rows["zh"], NORMAL if load == "normal" else TANGENTIAL, thin)
    computed = np.array([*v, radial_sum(v, bodies.nu2 if kind == StatePart.BODY else bodies.nu1)])
    wanted = np.array([rows[name] for name in "uwSTM"])
    assert len(rows) > 50
    assert np.all(np.abs(computed - wanted) <= 1e-13 * np.abs(wanted).max(axis=0) + 1e-28)


def test_the_kernel():
    """w at the surface is L."""
    random = np.random.default_rng(1)
    layers, X = some_bodies(random, 400), 10 ** random.uniform(-6, 2, 400)
    wanted = layered_kernel(X, *layers).L
    for thin in (True, False):
        here = (X < 1) == thin
        bodies = Bodies.of(layers.take(here))
        w = wave_state(StatePart.LAYER, bodies, X[here], 0 * X[here], NORMAL, thin)[1]
        assert_allclose(w / (2 * (1 - bodies.nu1)), wanted[here], rtol=2e-12, atol=1e-15)


def test_reciprocity():
    """The radial displacement by a normal traction is the normal one by a radial traction."""
    random = np.random.default_rng(2)
    layers, X = some_bodies(random, 400), 10 ** random.uniform(-3, 2, 400)
    for thin in (True, False):
        here = (X < 1) == thin
        ends = [
            wave_state(StatePart.LAYER, Bodies.of(layers.take(here)), X[here], 0.0, load, thin)
            for load in (NORMAL, TANGENTIAL)
        ]
        assert_allclose(-ends[0][0], ends[1][1], rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("load", [NORMAL, TANGENTIAL])
@pytest.mark.parametrize("kind", list(StatePart))
def test_thin_and_thick_agree_where_they_meet(load, kind):
    random = np.random.default_rng(3)
    bodies, X = Bodies.of(some_bodies(random, 300)), random.uniform(0.6, 1.5, 300)
    x = X * (1 + random.random(300) if kind == StatePart.BODY else random.random(300))
    thin, thick = (np.array(wave_state(kind, bodies, X, x, load, way)) for way in (True, False))
    assert np.all(np.abs(thin - thick) <= 1e-13 * (1 + np.abs(thick).max(axis=0)))


@pytest.mark.parametrize("load", [NORMAL, TANGENTIAL])
def test_the_difference_is_that_to_a_half_space(load):
    random = np.random.default_rng(4)
    bodies, X = Bodies.of(some_bodies(random, 300)), 10 ** random.uniform(-2, 1, 300)
    x = X * random.random(300)
    for thin in (True, False):
        here = (X < 1) == thin
        some = Bodies(*(v[here] for v in bodies))
        whole, less = (
            np.array(wave_state(kind, some, X[here], x[here], load, thin))
            for kind in (StatePart.LAYER, StatePart.DIFFERENCE)
        )
        half_space = np.array(decaying(x[here], some.nu1, *load))
        assert np.all(np.abs(less + half_space - whole) <= 1e-13 * (1 + np.abs(whole).max(axis=0)))
        Q, across = (
            np.array(antiplane(kind, some, X[here], x[here])) for kind in (StatePart.LAYER, StatePart.DIFFERENCE)
        )
        half_space = np.exp(-x[here]) * np.array([1.0, -2.0])[:, None]
        assert_allclose(across + half_space, Q, rtol=1e-13, atol=1e-13)


def test_antiplane_waves_keep_to_the_interface():
    """The shear stress goes on into the body, and so does the displacement, v'/G; a frictionless interface has none."""
    random = np.random.default_rng(5)
    layers, X = some_bodies(random, 200), 10 ** random.uniform(-2, 1, 200)
    bodies = Bodies.of(layers)
    above, below = (np.array(antiplane(kind, bodies, X, X)) for kind in (StatePart.LAYER, StatePart.BODY))
    soft = layers.bonded & (layers.n > 0)
    assert_allclose(above[0][soft], below[0][soft], rtol=1e-12, atol=1e-14)
    assert_allclose(above[1][soft], (bodies.alpha * below[1])[soft], rtol=1e-11, atol=1e-14)
    assert_allclose(above[1][layers.bonded & (layers.n == 0)], 0.0, rtol=0, atol=1e-14)
    assert np.all(below[:, ~soft] == 0) and np.all(np.abs(above[0][~layers.bonded]) < 1e-13)

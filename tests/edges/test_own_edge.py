"""An edge of somebody else's in one file, jkr.py: adhesion. Nothing in the solver knows of it."""

from pathlib import Path

import numpy as np
import pytest
from jkr import JKR
from numpy.testing import assert_allclose
from solver_cases import layer_of

from solver import Status
from solver.body.half_space import half_space
from solver.contact.adaptive import solve_newton
from solver.contact.equation import Cases
from solver.laws import LAWS
from solver.numerics.mesh import mesh_of

X = np.array([0.0, 0.5, 0.9, 1.0])


def cases(body, w, control, value):
    w, value = np.broadcast_arrays(np.atleast_1d(w), np.atleast_1d(value))
    return Cases(control, LAWS["smooth"].bind(body.E), body, value.astype(float), edge=JKR(w, body.E))


def solved(part, rtol=1e-9, x=X):
    size = len(part.value)
    with np.errstate(all="ignore"):  # as in solver.solve: what goes wrong is a status
        return solve_newton(part, np.full(size, rtol), np.zeros(size, int), 0, x)


def on_half_space(a, w, E):
    """P, D, p at X, dP/da, dD/da."""
    pulled = np.sqrt(2 * np.pi * w * E / a)
    s = np.sqrt(1 - X**2)
    with np.errstate(divide="ignore"):
        p = 2 * E / np.pi * a[:, None] * s - pulled[:, None] / np.pi / s
    P, D = 4 / 3 * E * a**3 - 2 * a**2 * pulled, a**2 - a * pulled / E
    return P, D, p, 4 * E * a**2 - 3 * a * pulled, 2 * a - pulled / E / 2


@pytest.mark.parametrize("m", [0.0, 0.4])
def test_half_space(m):
    """At given radii, of pulled contacts and of pressed ones: 1e-10, for q is the polynomial s."""
    body, w = half_space(np.full(4, m)), 1e-5
    a = np.array([0.01, 0.02, 0.04, 0.08])
    found = solved(cases(body, w, "a", a))
    P, D, p, dP, dD = on_half_space(a, w, body.E)
    assert found.status.tolist() == [Status.CONVERGED] * 4 and P[0] < 0 < P[-1]
    assert_allclose(found.P, P, rtol=1e-10, atol=0)
    assert_allclose(found.D, D, rtol=1e-10, atol=0)
    assert_allclose(found.p, p, rtol=1e-10, atol=0)  # -inf at the edge
    assert_allclose(found.p0, p[:, 0], rtol=1e-10, atol=0)
    assert_allclose(found.dP_dD, dP / dD, rtol=1e-9, atol=0)


#: See the file: other numbers of another equation.
FILE = Path(__file__).parents[1] / "references" / "adhesive_layers.csv"
LAYERS = np.genfromtxt(FILE, delimiter=",", names=True, dtype=None, encoding="utf-8", skip_header=3)


def on_layers(rtol, control="a", rows=slice(None), a=None):
    case = LAYERS[rows]
    layer = {name: case[name] for name in ("h", "n", "nu1", "nu2", "m")}
    body = layer_of(**layer, bonded=case["bonding"] == "bonded")
    return case, solved(cases(body, case["w"], control, case[control] if a is None else a), rtol)


@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_layers_at_given_radii(rtol):
    """Soft, stiff and incompressible layers, rigid bases, an elastic punch, all in one batch: the errors of P, D and
    p(0) are within `error`, which is within rtol."""
    case, found = on_layers(rtol)
    assert found.status.tolist() == [Status.CONVERGED] * len(case)
    for name in ("P", "D", "p0"):
        assert np.all(np.abs(getattr(found, name) / case[name] - 1) <= found.error)


@pytest.mark.parametrize("control", ["P", "D"])
def test_layers_that_are_pressed(control):
    """The radius under a load or at a depth that is found in the first place: of half of the contacts, those whose
    P and D are well above 0."""
    rows = np.flatnonzero((LAYERS["P"] > 0) & (LAYERS["D"] > 0))[[0, 2, 4, 6, 8]]
    case, found = on_layers(1e-8, control, rows)
    assert found.status.tolist() == [Status.CONVERGED] * 5
    assert_allclose(found.a, case["a"], rtol=1e-8, atol=0)


def test_the_stiffness_is_the_slope_of_the_load():
    """Against a central difference along the curve P(D), whose h² is 1e-8; on films of which the edge is not known,
    no number."""
    (_, low), (_, found), (_, high) = (on_layers(1e-11, a=LAYERS["a"] * np.exp(step)) for step in (-1e-4, 0, 1e-4))
    assert_allclose(found.dP_dD, (high.P - low.P) / (high.D - low.D), rtol=1e-5, atol=0)
    film = solved(cases(layer_of(h=1e-4), 1e-6, "a", [0.1]), 1e-6)
    assert film.status.tolist() == [Status.DIVERGED] and np.isnan(film.P).all()


def test_a_batch_is_its_cases():
    """Cases that leave the iteration at different steps and meshes come together again."""
    _, found = on_layers(1e-9, a=LAYERS["a"] * 1.1)
    for i in (0, 9, 20):
        _, alone = on_layers(1e-9, rows=[i], a=LAYERS["a"][[i]] * 1.1)
        assert_allclose([alone.P[0], alone.D[0]], [found.P[i], found.D[i]], rtol=1e-11, atol=0)
        assert_allclose(alone.p[0], found.p[i], rtol=1e-8, atol=0)


def test_the_operator_of_an_added_pressure():
    """Its products are linear in q, those of its edge are the same by themselves, and its slopes are differences by
    ln a, of a half-space and of layers; a part of it and the whole of its parts are as they were."""
    mesh, step, size = mesh_of(12), 1e-4, 4
    for body in (half_space(np.full(size, 0.4)), layer_of(h=np.geomspace(0.02, 0.3, size), n=3.0, m=0.4)):
        edge, a = JKR(np.geomspace(1e-7, 1e-5, size), body.E), np.geomspace(0.03, 0.08, size)
        q = np.outer(np.arange(1.0, 1 + size), mesh.s) + 0.1 * mesh.s**2
        operator = edge.at(body, a, mesh)
        Kq, at_edge = operator.products(q)
        assert_allclose(operator.at_edge(q), at_edge, rtol=1e-13, atol=0)
        none, none_at_edge = operator.products(0 * q)
        plain, plain_at_edge = body.at(a, mesh).products(q)
        assert_allclose(Kq, none + plain, rtol=0, atol=1e-13)
        assert_allclose(at_edge, none_at_edge + plain_at_edge, rtol=1e-12, atol=0)
        (low, low_edge), (high, high_edge) = (
            edge.at(body, a * np.exp(sign * step), mesh).products(q) for sign in (-1, 1)
        )
        slope, slope_edge = operator.slopes(q)
        assert_allclose(slope, (high - low) / (2 * step), rtol=0, atol=1e-6)  # of step² and of rounding over the step
        assert_allclose(slope_edge, (high_edge - low_edge) / (2 * step), rtol=0, atol=1e-6)
        places = [np.array([1, 3]), np.array([0, 2])]
        whole = operator.join([operator.take(place) for place in places], places)
        for found, expected in zip(
            (*whole.products(q), *whole.slopes(q)), (Kq, at_edge, slope, slope_edge), strict=True
        ):
            assert_allclose(found, expected, rtol=0, atol=1e-13)

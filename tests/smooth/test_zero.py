"""Contacts that stick where load, depth or the work of adhesion pass through 0."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rows import SMOOTH

from solver import Problem, Status, solve
from solver.sensitivity import sensitivities

BODIES = [{"base": "half_space"}, {"h": 0.05, "n": 20.0, "nu1": 0.3, "nu2": 0.3, "bonding": "bonded"}]
LAWS = [{}, {"adhesion": "maugis", "sigma0": 0.01}, {"adhesion": "maugis", "z0": 0.02}, {"adhesion": "dmt"}]
IDS = ["jkr", "maugis", "wide", "dmt"]


@pytest.mark.parametrize("law", LAWS, ids=IDS)
@pytest.mark.parametrize("body", BODIES, ids=["half_space", "layered"])
def test_a_load_of_0(law, body):
    """The contact without a load, by its own radius and depth, and loads near it: converged, and P is off by no more
    than its error times P_off."""
    case = body | law | SMOOTH | {"w_adhesion": 1e-5, "rtol": 1e-9}
    loads = solve(Problem.of(P=[0.0, 1e-9, -1e-9, 1e-18], **case))
    assert np.all(loads.status == Status.CONVERGED) and np.all(loads.error < 1e-10)
    for control in "aD":
        contact = solve(Problem.of(**{control: getattr(loads, control)}, **case))
        assert np.all(contact.status == Status.CONVERGED) and np.all(contact.error < 1e-10)
        assert np.all(np.abs(contact.P - loads.P) <= (contact.error + loads.error) * np.abs(loads.P_off))
        assert_allclose(contact.a, loads.a, rtol=1e-10, atol=0)


def test_the_radius_of_a_load_of_0():
    """a³ = 9π w/2 on a half-space: P is 0 to rounding."""
    contact = solve(Problem.of(a=0.05209397078678046, w_adhesion=1e-5, base="half_space", **SMOOTH))
    assert contact.status == Status.CONVERGED and contact.error < 1e-11
    assert np.abs(contact.P) < 1e-12 * np.abs(contact.P_off)


@pytest.mark.parametrize("law", LAWS[:3], ids=IDS[:3])
def test_a_depth_of_0(law):
    """A depth of 0 has a pull; by its load or radius, D is 0 to its error times D_off, also of a power 3/2, whose D_off
    under a load is 0."""
    for shape in ({}, {"shape": "power", "shape_power": 1.5, "shape_coefficient": 1.0}):
        case = BODIES[0] | law | SMOOTH | shape | {"w_adhesion": 1e-5}
        at = solve(Problem.of(D=0.0, **case))
        assert at.status == Status.CONVERGED and at.P < 0 and at.error < 1e-8
        contact = solve(Problem.of(a=at.a, **case))
        assert contact.status == Status.CONVERGED and np.abs(contact.D) < 1e-8 * np.abs(at.D_off)


@pytest.mark.parametrize("law", LAWS[1:], ids=IDS[1:])
@pytest.mark.parametrize("w", [1e-40, 1e-300])
@pytest.mark.parametrize("shape", [{}, {"shape": "cone", "half_angle": 60.0}], ids=["paraboloid", "cone"])
def test_a_work_below_rounding(shape, w, law):
    """The contact is the one without adhesion."""
    if law["adhesion"] == "dmt" and shape:
        return
    for control in ({"P": 1e-3}, {"a": 0.1}, {"D": 0.01}):
        case = control | BODIES[0] | shape | SMOOTH
        contact, free = solve(Problem.of(**case, **law, w_adhesion=w)), solve(Problem.of(**case))
        assert contact.status == Status.CONVERGED and contact.error < 1e-9 and contact.stable
        assert_allclose([contact.a, contact.P, contact.D], [free.a, free.P, free.D], rtol=1e-12, atol=0)
        assert np.abs(contact.P_off) < 10 * w


@pytest.mark.parametrize("w", [1e-240, 1e-300])
def test_jkr_of_hardly_any_work(w):
    """P_off is -3π w/2, and P = 0 has a³ = 9π w/2, as of any w; a load has the contact without adhesion."""
    case = BODIES[0] | SMOOTH | {"w_adhesion": w}
    contact = solve(Problem.of(P=[0.0, 1e-3], **case))
    assert np.all(contact.status == Status.CONVERGED)
    assert_allclose(contact.P_off, -1.5 * np.pi * w, rtol=1e-9, atol=0)
    assert_allclose(contact.a, [np.cbrt(4.5 * np.pi * w), np.cbrt(0.75e-3)], rtol=1e-9, atol=0)


def test_a_narrow_ring_is_an_edge():
    """Rings of 1e-4, 1e-10 and 1e-20 of a: the numbers of JKR's edge up to 2 times that; where Maugis' own equation has
    no digits they are taken, with an error that says so."""
    case = BODIES[0] | SMOOTH | {"P": 1e-4, "w_adhesion": 1e-5, "rtol": 1e-5}
    edge = solve(Problem.of(**case))
    for sigma in (1.0, 1e3, 1e8):
        ring = solve(Problem.of(**case, adhesion="maugis", sigma0=sigma))
        narrow = np.pi * 1e-5 / 4 / sigma**2 / edge.a_off
        assert ring.status == Status.CONVERGED
        for name in ("a", "D", "P_off", "D_off"):
            off = np.abs(getattr(ring, name) / getattr(edge, name) - 1)
            assert off <= np.maximum(2 * narrow, 1e-6) and off <= np.maximum(ring.error, 2 * narrow)


@pytest.mark.parametrize("body", BODIES, ids=["half_space", "layered"])
def test_pull_in_of_dmt(body):
    """Held by a stiffness k, the punch jumps to D + P/k = 0 with P = P₀(a) - 2π w: at `a_in` the contact has that load
    and depth. On a half-space a² + (4/3 a³ - 2π w)/k = 0 besides. Without the pull P_in would be positive."""
    k, w = np.array([1e-3, 0.01, 0.1, 10.0]), 1e-5
    case = body | SMOOTH | {"w_adhesion": w, "adhesion": "dmt"}
    contact = solve(Problem.of(P=1e-4, k_machine=k, **case))
    at, free = solve(Problem.of(a=contact.a_in, **case)), solve(Problem.of(a=contact.a_in, **body, **SMOOTH))
    assert np.all(contact.P_in < 0) and np.all(contact.P_in > -2 * np.pi * w)
    assert_allclose(contact.P_in, at.P, rtol=1e-9, atol=0)
    assert_allclose(contact.P_in, free.P - 2 * np.pi * w, rtol=1e-9, atol=1e-13)
    assert_allclose(free.D, -contact.P_in / k, rtol=1e-8, atol=0)
    if "base" in body:
        assert_allclose(contact.a_in**2 + (4 / 3 * contact.a_in**3 - 2 * np.pi * w) / k, 0, atol=1e-9 * w)


def test_slopes_where_a_load_is_0():
    """P = 4/3 a³ - sqrt(8π w a³) on a half-space: its derivatives by ln w and ln a at P = 0, and next to it, to 1e-6;
    and their quotient by P as the sensitivity, but of 0 itself."""
    w = 1e-5
    a = np.cbrt(4.5 * np.pi * w) * np.array([1.0, 1 + 1e-9, 1 - 1e-5, 1.001])
    problem = Problem.of(a=a, w_adhesion=w, base="half_space", **SMOOTH)
    contact = solve(problem)
    found = sensitivities(problem, contact, inputs=("a", "w_adhesion"))
    edge = np.sqrt(8 * np.pi * w * a**3)
    assert_allclose(found.slopes["P"], np.stack([4 * a**3 - 1.5 * edge, -edge / 2], axis=1), rtol=1e-6, atol=0)
    assert_allclose(found.logs["P"][1:] * contact.P[1:, None], found.slopes["P"][1:], rtol=1e-6, atol=0)
    assert_allclose(found.slopes["D"], found.logs["D"] * contact.D[:, None], rtol=1e-12, atol=0)


def test_a_load_of_0_on_a_graded_layer():
    """Its error by its own radius is that by the load: what is extrapolated is 0 too."""
    layer = {"h": 0.03, "n": [2.0, 1.5], "nu": 0.3, "profile": "linear", "bonding": "bonded"}
    case = SMOOTH | {"layers": [layer], "w_adhesion": 1e-5, "rtol": 1e-4}
    contact = solve(Problem.of(P=0.0, **case))
    again = solve(Problem.of(a=contact.a, **case))
    assert contact.status == again.status == Status.CONVERGED and again.error < 2 * contact.error
    assert np.abs(again.P) < 1e-4 * np.abs(again.P_off)

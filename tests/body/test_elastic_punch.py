"""Elastic punches: Hertz, exchanged bodies, models that come to the same, and the layer by the Fredholm equation."""

import numpy as np
import pytest
from layered_independent import answers, fredholm, rough
from numpy.testing import assert_allclose

from solver import Problem, Status, solve

ROUGH = {"Nbar": 250000.0, "Ra": 0.004}
LAYER = {"h": 0.02, "n": 0.5, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded"}
NAMES = ("a", "P", "D", "p0", "p_max", "Ar_An", "A0", "dP_dD")


def same(found, expected, rtol):
    assert (found.status == Status.CONVERGED).all() and (expected.status == Status.CONVERGED).all()
    for name in NAMES:
        assert_allclose(getattr(found, name), getattr(expected, name), rtol=rtol, err_msg=name)


@pytest.mark.parametrize("m", [0.1, 1.0, 50.0])
def test_hertz(m):
    """1/E* of both bodies added, in closed form: rounding of a few roots."""
    P, E = np.array([1e-7, 1e-5, 1e-3]), 1 / (1 + m)
    found = solve(Problem.of(P=P, m=m, base="half_space", micro="smooth"))
    a = np.cbrt(0.75 * P / E)
    assert_allclose(found.a, a, rtol=1e-12)
    assert_allclose(found.D, a**2, rtol=1e-12)
    assert_allclose(found.p0, 2 * E * a / np.pi, rtol=1e-12)
    assert_allclose(found.dP_dD, 2 * E * a, rtol=1e-12)


def test_rough_bodies_that_yield_alike():
    """Two half-spaces of 2 are one of 1, for the asperities as well; to the two solutions' rtol."""
    one = solve(Problem.of(P=[1e-6, 1e-4], base="half_space", rtol=1e-10, **ROUGH))
    two = solve(Problem.of(P=[1e-6, 1e-4], base="half_space", rtol=1e-10, E2=2.0, m=1.0, **ROUGH))
    same(two, one, 1e-9)


@pytest.mark.parametrize("control", [{"P": 1e-5}, {"a": 0.03}, {"D": 5e-4}], ids=str)
@pytest.mark.parametrize("micro", [{"micro": "smooth"}, ROUGH, ROUGH | {"micro": "power_law", "B": 0.1, "beta": 0.5}])
def test_layers_that_are_none(control, micro):
    """A layer of the material below, n = 1: the exact layer, a thick one and the half-space have one answer."""
    given = control | micro | {"m": 0.7, "rtol": 1e-9}
    alone = solve(Problem.of(**given, base="half_space"))
    same(solve(Problem.of(**given, **LAYER | {"n": 1.0, "nu2": 0.25}, base="layered")), alone, 1e-8)


@pytest.mark.parametrize("bonding", ["frictionless", "bonded"])
@pytest.mark.parametrize("micro", [{"micro": "smooth"}, ROUGH], ids=["smooth", "rough"])
def test_thin_layers_become_the_exact_one(bonding, micro):
    """The error of the thin layer falls like h/a: its ten times thinner layer errs by a tenth or less."""
    given = {"a": 0.04, "n": 0.5, "m": 2.0, "bonding": bonding, "rtol": 1e-8, "h": [4e-5, 4e-6]} | micro
    given["asperities_on"] = "half_space"  # as thin layers have them
    thin, exact = (solve(Problem.of(**given, base=base)) for base in ("thin_layer", "layered"))
    error = np.abs(thin.P / exact.P - 1)
    assert (thin.status == 0).all() and (exact.status == 0).all()
    assert error[0] < 2e-3 and (error[1] < error[0] / 8 + 4e-8)


def test_a_nearly_rigid_punch_and_a_nearly_rigid_body():
    """m → 0 is continuous; m → ∞ is a soft ball on a rigid body, Hertz with the modulus n/m of the ball."""
    given = {"P": 1e-5, **LAYER, "base": "layered", "micro": "smooth", "rtol": 1e-10}
    same(solve(Problem.of(**given, m=1e-12)), solve(Problem.of(**given)), 1e-9)
    soft = solve(Problem.of(**given | {"P": 1e-12}, m=1e8))
    assert_allclose(soft.a, np.cbrt(0.75 * 1e-12 / (0.5e-8)), rtol=1e-6)


@pytest.mark.parametrize("m", [0.05, 1.0, 20.0])
def test_fredholm(m):
    """Smooth, against the Fredholm equation with L + m; a/h from 0.1 to 10, soft and hard, both interfaces."""
    cases = [(eta, n, 0.3, 0.2, bonded) for eta in (0.1, 1.0, 10.0) for n in (0.02, 5.0) for bonded in (0, 1)]
    table, radius = np.array(cases), 0.04
    eta, n, nu1, nu2, bonded = table.T
    bonding = np.where(bonded == 1, "bonded", "frictionless")
    given = {"h": eta * radius, "n": n, "nu1": nu1, "nu2": nu2, "bonding": bonding, "m": m}
    found = solve(Problem.of(a=radius, base="layered", micro="smooth", rtol=1e-10, **given))
    expected = np.array([fredholm(*row[:4], row[4] == 1, m=m) for row in table])
    Ec = n / (1 + m)
    units = {"P": Ec * radius**3, "D": radius**2 + 0 * n, "p0": Ec * radius, "dP_dD": Ec * radius}
    for i, (name, unit) in enumerate(units.items()):
        assert_allclose(getattr(found, name) / unit, expected[:, i], rtol=1e-9, err_msg=name)


def test_rough_by_collocation():
    """Rough, against a formulation that shares nothing with the solver; 1e-8 is what its 44 nodes resolve."""
    given = {"a": 0.04, "h": 0.02, "n": 0.5, "nu1": 0.3, "nu2": 0.3, "m": 0.8, **ROUGH}
    for bonded in (False, True):
        bonding = "bonded" if bonded else "frictionless"
        found = solve(Problem.of(**given, bonding=bonding, base="layered", rtol=1e-10))
        expected = rough(44, "disc_cell", 0.04, 0.02, 0.5, 0.3, 0.3, bonded, 250000.0, 0.004, m=0.8)
        assert_allclose(answers(found, 0), expected, rtol=1e-8)


def test_auto_and_the_judged_thin_layer():
    given = {"P": [1e-6, 1e-5], "n": 0.3, "m": 1.5, "h": [1e-4, 3e-2], **ROUGH}
    exact = solve(Problem.of(**given, base="layered"))
    for more in ({"base": "auto", "accuracy": 0.05}, {"base": "thin_layer", "model_check": "first_order"}):
        found = solve(Problem.of(**given, **more))
        error = np.max([np.abs(getattr(found, name) / getattr(exact, name) - 1) for name in NAMES[:6]], axis=0)
        assert (found.status == 0).all() and (error <= 1.2 * found.model_error + 1e-5).all()
    assert found.model_error[1] < 3 * error[1], "the estimate knows of the punch"


@pytest.mark.parametrize("m", [1e-3, 0.5, 4.0])
def test_the_closed_form_of_an_elastic_punch_is_that_at_given_radius(m):
    """The largest of the three controls, for each of them; a rigid one has its own."""
    given = {"n": 0.3, "h": [1e-4, 1e-3], "base": "thin_layer", "micro": "smooth", "bonding": "bonded"}
    a = solve(Problem.of(a=[0.02, 0.03], **given, m=m))
    for control in ("P", "D"):
        other = solve(Problem.of(**{control: getattr(a, control)}, **given, m=m))
        assert_allclose(other.model_error, a.model_error, rtol=1e-4)
        rigid = solve(Problem.of(**{control: getattr(a, control)}, **given))
        assert (rigid.model_error < solve(Problem.of(a=rigid.a, **given)).model_error).all()


@pytest.mark.parametrize(("h", "rtol"), [(0.02, 1e-10), (1e-5, 1e-7)], ids=["layer", "film"])
@pytest.mark.parametrize("micro", [{"micro": "smooth"}, ROUGH], ids=["smooth", "rough"])
def test_rigid_and_elastic_punches_in_one_batch(h, rtol, micro):
    """Each has the numbers that it has alone; to the two solutions' rtol."""
    m, given = np.array([0.0, 1.0, 0.0, 3.0]), LAYER | micro | {"h": h, "a": 0.03, "base": "layered", "rtol": rtol}
    together = solve(Problem.of(**given, m=m))
    for i, one in enumerate(m.tolist()):
        same(together.take([i]), solve(Problem.of(**given, m=one)), 10 * rtol)
    assert len(set(np.round(together.P, 12))) == 3, "what a punch yields counts"

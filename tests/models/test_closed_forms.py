"""Closed forms: each quantity from each other, equilibrium, units, limits."""

from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver.closed_forms import hertz, hertz_pressure, thin_layer_on_rigid_base

R, E = 3.0, 7.0


@pytest.mark.parametrize("given", ["P", "a", "D", "p0"])
def test_hertz_from_each(given):
    reference = hertz(a=np.array([1e-8, 0.01, 0.3]), R=R, E=E)
    found = hertz(**{given: getattr(reference, given)}, R=R, E=E)
    for name, value in reference._asdict().items():
        assert_allclose(getattr(found, name), value, rtol=1e-14, atol=0)


def test_hertz_textbook():
    """P = 4/3 E sqrt(R D³), p0 = 3P/(2 pi a²), D from the mean pressure; Johnson (1985) 4.22-4.24."""
    H = hertz(P=2.7040777e-5)  # the load of the paper's main case
    assert_allclose(H.D, 7.43681e-4, rtol=0, atol=5e-10)
    H = hertz(P=0.02, R=R, E=E)
    assert_allclose(4 / 3 * E * np.sqrt(R * H.D**3), 0.02, rtol=1e-14, atol=0)
    assert_allclose(H.p0, 1.5 * 0.02 / (np.pi * H.a**2), rtol=1e-14, atol=0)
    assert_allclose(H.p0, (6 * 0.02 * E**2 / (np.pi**3 * R**2)) ** (1 / 3), rtol=1e-14, atol=0)


def test_hertz_pressure_carries_the_load():
    H = hertz(P=0.02, R=R, E=E)
    t, w = np.polynomial.legendre.leggauss(20)
    phi = np.pi / 4 * (t + 1)
    p = hertz_pressure(np.sin(phi), H.p0)
    load = 2 * np.pi * H.a**2 * np.pi / 4 * (w @ (p * np.sin(phi) * np.cos(phi)))
    assert_allclose(load, 0.02, rtol=1e-13, atol=0)
    assert_allclose(hertz_pressure([0.0, 0.6, 1.0], 2.0), [2, 1.6, 0], rtol=1e-15, atol=0)


@pytest.mark.parametrize("bonded", [False, True])
@pytest.mark.parametrize("given", ["P", "a", "D"])
def test_layer_from_each(given, bonded):
    keep = {"h": 0.01, "nu1": 0.2, "bonded": bonded, "R": R, "E": E}
    reference = thin_layer_on_rigid_base(a=np.array([1e-6, 0.2]), **keep)
    found = thin_layer_on_rigid_base(**{given: getattr(reference, given)}, **keep)
    for name, value in reference._asdict().items():
        assert_allclose(getattr(found, name), value, rtol=1e-13, atol=0)


@pytest.mark.parametrize("bonded", [False, True])
def test_layer_is_a_column_under_the_punch(bonded):
    """p0 = M (D/h): M is E/(1 - ν²) where the interface slips, the modulus of uniaxial strain where it is bonded."""
    nu, young = 0.2, 5.0
    plane = young / (1 - nu**2)
    uniaxial = young * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    L = thin_layer_on_rigid_base(D=1e-4, h=0.01, nu1=nu, bonded=bonded, E=plane)
    assert_allclose(L.p0, (uniaxial if bonded else plane) * 1e-4 / 0.01, rtol=1e-13, atol=0)
    assert_allclose(L.P, np.pi * L.a**2 * L.p0 / 2, rtol=1e-14, atol=0)  # a paraboloid of pressure


def test_bonded_incompressible_layer_has_no_such_limit():
    rubber = {"h": 0.01, "nu1": 0.5, "bonded": True}
    assert np.isposinf(thin_layer_on_rigid_base(a=0.1, **rubber).P)
    assert np.isnan(thin_layer_on_rigid_base(P=0.1, **rubber).p0)


@pytest.mark.parametrize("function", [hertz, partial(thin_layer_on_rigid_base, h=0.01)])
def test_exactly_one_quantity(function):
    with pytest.raises(ValueError, match="exactly one"):
        function()
    with pytest.raises(ValueError, match="exactly one"):
        function(P=1.0, a=1.0)


def test_a_layer_has_a_thickness():
    with pytest.raises(TypeError, match="'h'"):
        thin_layer_on_rigid_base(P=1.0)

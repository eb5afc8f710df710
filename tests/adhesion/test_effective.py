"""The work of adhesion that roughness leaves, against closed forms of a wave."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study

HEIGHT, LENGTH = 1e-8, 1.6e-6
WAVE = study.roughness.height_map(
    np.tile(HEIGHT * np.cos(2 * np.pi * np.arange(256) * 1e-7 / LENGTH), (256, 1)), dx=1e-7
)
RUBBER = {"E2": "1 MPa", "nu2": 0.5, "base": "half_space", "w_adhesion": "50 mJ/m^2"}
SLIDING = {"E1": "1 MPa", "nu1": 0.3, "h": "0.2 um", "E2": "rigid", "bonding": "frictionless"}
SLIDING |= {"w_adhesion": "50 mJ/m^2"}
Q = 2 * np.pi / LENGTH


def energy(E):
    """E q A²/8 of each area: pressure E q A/2, displacement A."""
    return E * Q * HEIGHT**2 / 8


def left(**parameters):
    return study.effective_work(WAVE, **parameters)


def test_of_a_wave_on_a_half_space():
    E = 1e6 / (1 - 0.5**2)
    assert_allclose(0.05 - left(**RUBBER, form="mean", periodic=True), energy(E), rtol=1e-9)
    assert_allclose(0.05 - left(**RUBBER), energy(E), rtol=2e-3)  # a window of 16 waves
    soft = left(**RUBBER, E_punch="1 MPa", nu_punch=0.5, form="mean", periodic=True)
    assert_allclose(0.05 - soft, energy(E / 2), rtol=1e-9)


def test_of_a_wave_on_a_sliding_layer_and_a_stack_of_the_same():
    """L = (cosh 2u - 1)/(sinh 2u + 2u) on a rigid base without friction."""
    u, E = Q * 0.2e-6, 1e6 / (1 - 0.3**2)
    L = (np.cosh(2 * u) - 1) / (np.sinh(2 * u) + 2 * u)
    assert_allclose(0.05 - left(**SLIDING, form="mean", periodic=True), energy(E) / L, rtol=1e-9)
    layer = {"h": "0.1 um", "E1": "1 MPa", "nu": 0.3}
    stack = {"layers": [layer | {"bonding": "bonded"}, layer | {"bonding": "frictionless"}], "E2": "rigid"}
    assert_allclose(left(**stack, w_adhesion="50 mJ/m^2"), left(**SLIDING), rtol=1e-9)


def test_an_elastic_punch_gives_way_beside_a_layer():
    """Compliances add, 1/E = L/E1 + 1/E3: the punch is as soft as the layer, of a layer alone and in a stack."""
    u, E1, E3 = Q * 0.2e-6, 1e6 / (1 - 0.3**2), 1e6 / (1 - 0.4**2)
    L = (np.cosh(2 * u) - 1) / (np.sinh(2 * u) + 2 * u)
    punch, how = {"E_punch": "1 MPa", "nu_punch": 0.4}, {"form": "mean", "periodic": True}
    wanted = energy(1 / (L / E1 + 1 / E3))
    assert_allclose(0.05 - left(**SLIDING, **punch, **how), wanted, rtol=1e-9)
    layer = {"h": "0.1 um", "E1": "1 MPa", "nu": 0.3}
    stack = {"layers": [layer | {"bonding": "bonded"}, layer | {"bonding": "frictionless"}], "E2": "rigid"}
    assert_allclose(0.05 - left(**stack, w_adhesion="50 mJ/m^2", **punch, **how), wanted, rtol=1e-9)
    same = {"E1": "1 MPa", "nu1": 0.5, "h": "0.2 um", "bonding": "bonded"} | RUBBER | {"base": "layered"}
    assert_allclose(0.05 - left(**same, **punch, **how), energy(1 / ((1 - 0.5**2) / 1e6 + 1 / E3)), rtol=1e-9)


def test_the_roughness_may_take_all():
    assert left(**RUBBER | {"w_adhesion": "1 uJ/m^2"}) < 0


@pytest.mark.parametrize(
    "scan, parameters, message",
    [
        (study.roughness.profile(WAVE.z[0], dx=1e-7), RUBBER, "needs a map of heights"),
        (WAVE, RUBBER | {"w_adhesion": None}, "give w_adhesion"),
        (WAVE, RUBBER | {"w_adhesion": ["1 mJ/m^2", "2 mJ/m^2"]}, "has several values"),
        (WAVE, RUBBER | {"periodic": 1}, "must be True or False"),
        (WAVE, RUBBER | {"form": "wavy"}, "allowed are"),
    ],
)
def test_what_is_no_surface(scan, parameters, message):
    with pytest.raises(study.StudyError, match=message):
        study.effective_work(scan, **parameters)

"""Sensitivities and spreads of shapes and of what sticks, through `study.solve` with units."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study

GEL = {"E2": "1 MPa", "nu2": 0.3, "base": "half_space", "micro": "smooth"}
BALL = GEL | {"R": "5 um", "w_adhesion": "50 ± 5 mJ/m^2"}
ASPERITIES = {"Nbar": "1 1/um^2", "Ra": "0.1 um", "micro": "disc_cell"}
RESULTS = ("a", "P", "D", "p0", "p_max", "dP_dD")


@pytest.fixture(autouse=True)
def quiet():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def solved(case, **more):
    contact = study.solve(**case | more, x=2, profiles=False, sensitivities=not more)
    assert study.decode(contact.status).item() == "converged"
    return contact


def test_a_spread_of_an_angle():
    """D ~ 1/sqrt(tan α) under a load, so that the spread of D is (α/sin 2α) of that of α; p(0) is infinite."""
    contact = solved(GEL | {"shape": "cone", "half_angle": "70.3 ± 0.3 deg", "P": "10 uN"})
    angle = np.radians(70.3) / np.sin(np.radians(140.6))
    assert_allclose(contact.D_sensitivity.sel(input="half_angle"), -angle, rtol=1e-7)
    assert_allclose(contact.D_spread / contact.D, angle * 0.3 / 70.3, rtol=1e-7)
    assert_allclose(contact.D_sensitivity.sel(input="E2"), -0.5, rtol=1e-7)
    assert np.isnan(contact.p0_spread) and np.isnan(contact.p0_sensitivity).all()


#: Name -> the case, an input, its text, and its value there.
CASES = {
    "jkr": ({"P": "-0.3 uN"}, "w_adhesion", "{} mJ/m^2", 50),
    "jkr, a machine": ({"D": "20 nm", "k_machine": "1 N/m"}, "w_adhesion", "{} mJ/m^2", 50),
    "jkr, unstable": ({"P": "-0.3 uN", "branch": "unstable"}, "R", "{} um", 5),
    "dmt": ({"P": "-0.3 uN", "adhesion": "dmt"}, "w_adhesion", "{} mJ/m^2", 50),
    "dmt, depth": ({"D": "0.1 um", "adhesion": "dmt"}, "R", "{} um", 5),
    "maugis": ({"P": "-0.3 uN", "adhesion": "maugis", "sigma0": "0.5 MPa"}, "sigma0", "{} MPa", 0.5),
    "tip": (
        {"P": "10 uN", "shape": "blunt_cone", "half_angle": 75, "tip_radius": "300 ± 10 nm"},
        *("tip_radius", "{} nm", 300),
    ),
    "rough tip": (
        ASPERITIES | {"D": "0.3 um", "shape": "rounded_flat", "flat_radius": "0.3 um", "edge_radius": "5 ± 0.1 um"},
        *("edge_radius", "{} um", 5),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_against_moved_inputs(name):
    """Central differences, whose h² times a third derivative is below 1e-5; the rough ones are right to 1e-8/h."""
    case, moved, text, value = CASES[name]
    case = (GEL if "shape" in case else BALL) | case
    contact, h = solved(case), 1e-3
    ends = [solved(case, rtol=1e-8, **{moved: text.format(value * (1 + step))}) for step in (h, -h)]
    for result in RESULTS:
        up, down = (np.log(abs(end[result].item())) for end in ends)
        sensitivity = contact[f"{result}_sensitivity"].sel(input=moved).item()
        assert_allclose(sensitivity, (up - down) / (2 * h), rtol=2e-5, atol=2e-5, err_msg=result)
    if moved == "w_adhesion":
        assert_allclose(contact.a_spread / contact.a, abs(contact.a_sensitivity.sel(input=moved)) * 0.1, rtol=1e-12)

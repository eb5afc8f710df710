"""Designs that want a load at pull-off."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study

GEL = {"R": "5 um", "punch": "rigid", "E1": "5 kPa", "nu1": 0.45, "bonding": "bonded", "body": "glass soda-lime"}
GEL |= {"micro": "smooth", "P": "0 N", "w_adhesion": "1 mJ/m^2"}


def designed(targets, by, **inputs):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of validity, which is not the question here
        return study.design(targets, by, progress=False, **inputs)


def test_a_work_of_adhesion_on_a_half_space():
    """P_off = -1.5 π w R; without derivatives there is no ±."""
    ball = {"R": "5 um", "E2": "1 MPa", "nu2": 0.3, "base": "half_space", "micro": "smooth", "P": "0 N"}
    answer = designed({"P_off": "-20 nN"}, {"w_adhesion": ("0.1 mJ/m^2", "10 mJ/m^2")}, **ball)
    assert_allclose(answer.w_adhesion, 20e-9 / (1.5 * np.pi * 5e-6), rtol=1e-6)
    assert_allclose(answer.P_off, -20e-9, rtol=1e-6)
    assert study.decode(answer.design_status).item() == "found" and np.isnan(answer.w_adhesion_spread).all()
    assert answer.message.item().startswith("P_off = -20 nN at w_adhesion = 848.83 µJ/m²")


def test_a_flat_punch():
    """P_off² = 8 π a³ E w on a half-space (Kendall)."""
    stamp = {"shape": "flat", "flat_radius": "2 um", "E2": "1 MPa", "nu2": 0.3, "base": "half_space"}
    stamp |= {"micro": "smooth", "P": "0 N"}
    answer = designed({"P_off": "-100 nN"}, {"w_adhesion": ("0.01 mJ/m^2", "100 mJ/m^2")}, **stamp)
    assert_allclose(answer.w_adhesion, 1e-14 / (8 * np.pi * 8e-18 * 1e6 / (1 - 0.3**2)), rtol=1e-6)


def test_a_thickness_and_what_is_not_reached():
    """The contact that is designed has that pull-off, when it is solved again."""
    answer = designed({"P_off": "-26 nN"}, {"h": ("0.5 um", "20 um")}, **GEL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        again = study.solve(**GEL, h=f"{answer.h.item()!r} m", x=2, profiles=False)
    assert_allclose(again.P_off, -26e-9, rtol=1e-5)
    answer = designed({"P_off": "-1 uN"}, {"h": ("0.5 um", "20 um")}, **GEL)
    assert study.decode(answer.design_status).item() == "none_below"
    assert "no P_off = -1 µN: with h from" in answer.message.item()


@pytest.mark.parametrize(
    "value, inputs, message",
    [
        ("15 nN", GEL, "must be < 0, a pull"),
        ("-15 nN", {**GEL, "w_adhesion": None}, "without w_adhesion the surfaces do not adhere: give it"),
    ],
)
def test_what_no_punch_does(value, inputs, message):
    inputs = {name: text for name, text in inputs.items() if text is not None}
    inputs |= {} if "w_adhesion" in inputs else {"P": "1 nN"}
    with pytest.raises(study.StudyError, match=message):
        designed({"P_off": value}, {"h": ("0.5 um", "20 um")}, **inputs)

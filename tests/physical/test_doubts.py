"""What the words about a contact doubt or leave open: inputs that nothing real has, spreads too wide, yielding."""

import warnings

import numpy as np
import pytest
from test_physical import COATED, quiet

import study


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            {"E2": "210 mPa", "E1": "200 mPa", "P": "1 pN"},
            "E1 = 0.2 Pa: materials have 1 Pa to 2 TPa; is its unit right?",
        ),
        ({"E2": ["210 GPa", "210 TPa"]}, "E2 = 2.1e+05 GPa: materials have"),
        ({"R": "5 Mm", "h": "1 m"}, "R = 5e+06 m: radii of bodies are 0.1 nm to 1 km; is"),
        ({"h": "2 pm"}, "h = 0.002 nm: layers are 0.05 nm to 1 km thick; is"),
        (
            {"micro": "disc_cell", "Nbar": "1 1/um^2", "Ra": "40 nm"},
            "Ra = 40 nm is small for Nbar = 1 1/µm²: the asperities",
        ),
        ({"h": ["2 um", "1 ± 2 um"]}, "h = 1.0 ± 2.0 µm: this spread is too wide for the ± of the results"),
        ({"R": None, "R1": "10 ± 1 mm", "R2": ["-30 mm", "-11 mm"]}, "R1 = 10.0 ± 1.0 mm: this spread is too wide"),
    ],
)
def test_slips_of_a_prefix_are_noticed(change, sentence):
    """mPa for MPa, Mm for mm: the right kind of unit, and a contact that can be solved."""
    with pytest.warns(UserWarning) as warned:
        given = COATED | {"P": "10 N", "x": 2} | change
        found = study.solve(**{name: value for name, value in given.items() if value is not None})
    assert sentence in str(warned[0].message)
    assert f"Beware: {sentence}" in study.summary(found)


def test_no_real_system_is_absurd():
    softest = {"R": "2.5 um", "E1": "20 Pa", "nu1": 0.5, "E2": "rigid", "h": "2 um", "D": "5 nm", "bonding": "bonded"}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        study.solve(**softest, E_punch="1.2 TPa", micro="smooth", x=2)
        study.solve(R="6 m", E1="1 MPa", E2="210 GPa", h="1 m", P="1 N", micro="smooth", x=2)


def test_a_spread_of_nu_that_reaches_one_half_is_too_wide():
    """A bonded layer yields far less near 0.5, and beyond it there is none: ± of the results was too large."""
    film = {"R": "3 mm", "E1": "5 MPa", "E2": "rigid", "h": "100 um", "bonding": "bonded", "micro": "smooth"}
    for nu1, wide in (("0.49 ± 0.02", True), ("0.49 ± 0.005", False), ("0.0 ± 0.05", False), ("-0.2 ± 0.3", False)):
        text = study.summary(quiet(**film, nu1=nu1, P="1 mN", x=2))
        assert ("Beware: nu1 = 0.490 ± 0.020: this spread is too wide" in text) == wide == ("too wide" in text)


def test_spreads_wider_than_their_inputs_are_doubted():
    """They are no reason to refuse: ± is to first order, and the sentence says that this is not enough."""
    ball = {"E2": "210 GPa", "base": "half_space", "micro": "smooth", "x": 2}
    text = study.summary(quiet(**ball, R="5 mm", P="1 ± 10 N"))
    assert "Beware: P = 1 ± 10 N: this spread is too wide for the ± of the results" in text
    cup = quiet(**ball, R1="5 ± 1 mm", R2="-5.05 mm", P="1 N")
    assert "Beware: R1 = 5.0 ± 1.0 mm: this spread is too wide for the ± of the results" in study.summary(cup)
    # a ~ R^(1/3), and R is a hundred times R1
    np.testing.assert_allclose(cup.a_spread / cup.a, 101 * 0.2 / 3, rtol=1e-6)


STEEL = {"R": "5 mm", "punch": "steel 52100", "body": "steel 52100", "micro": "smooth", "x": 2}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            {"layer": "DLC a-C:H", "h": "2 um", "P": ["10 N", "10 kN"]},
            "1 of 2 cases: The pressure on the layer reaches 0.05 of",
        ),
        ({"base": "half_space", "punch": "PEEK", "P": "10 MN"}, "on the body reaches 0.055 of"),
        ({"base": "half_space", "body": "alumina", "R": "0.1 mm", "P": "10 N"}, "on the punch reaches 0.078 of"),
        (
            {"layer": "diamond", "h": "1 um", "R": "0.1 mm", "P": "10 N", "punch": "rigid"},
            "on the body reaches 0.1 of",
        ),
        (
            {"base": "half_space", "micro": "disc_cell", "Nbar": "0.1 1/um^2", "Ra": "2 um", "P": "10 N"},
            "reaches 0.087 of",
        ),
        ({"layer": "diamond", "h": "1 mm", "R": "0.1 mm", "P": "0.1 N", "punch": "rigid"}, ""),
        ({"layer": "DLC a-C:H", "h": "2 um", "P": "100 N"}, ""),
        ({"layer": "PTFE", "h": "0.2 mm", "P": "50 N"}, ""),
    ],
)
def test_pressures_at_which_metals_yield_are_noticed(change, sentence):
    """A steel ball under 10 kN had 10 GPa and no warning. Plastics and what lies deep under a hard layer have none."""
    found = quiet(**STEEL | change)
    said = [line for line in study.summary(found).splitlines() if "metals yield" in line]
    assert [sentence.split(": ")[-1] in line for line in said] == [True] * bool(sentence)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        study.solve(**STEEL | change)
    assert any("metals yield" in str(one.message) and sentence in str(one.message) for one in caught) == bool(sentence)

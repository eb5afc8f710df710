"""Whether the model describes the contact at which something first yields: its flags, and a comment."""

import warnings

import numpy as np
import pytest

import study
from study.in_words import FarOutside

BALL = {"R": "5 mm", "E2": "208 GPa", "nu2": 0.3, "Y2": "250 MPa"}
COATED = BALL | {"E1": "200 GPa", "nu1": 0.25, "h": "20 um", "bonding": "bonded"}
COARSE = {"micro": "disc_cell", "Nbar": "0.0001 1/um^2", "Ra": "50 um"}
BARE = BALL | {"base": "half_space", "micro": "smooth"}
CASES = {
    "asperities on a layer": COATED | COARSE | {"Nbar": ["0.0001 1/um^2", "0.1 1/um^2"]},
    "a smooth coating": COATED | {"micro": "smooth", "Y1": "1 GPa", "E_punch": "70 GPa", "Y_punch": "100 MPa"},
    "a cup": {**BARE, "R": None, "R1": "5 mm", "R2": "-5.05 mm"},
    "two balls in a cup": {**BARE, "R": None, "R1": ["5 mm", "4 mm"], "R2": "-5.05 mm"},
    "a blunt cone": {**BARE, "R": None, "shape": "blunt_cone", "half_angle": "82 deg", "tip_radius": "1 mm"},
}


@pytest.mark.filterwarnings("ignore:.*beyond what the model describes")
@pytest.mark.parametrize("kind", CASES)
def test_the_flags_are_those_of_the_contact_at_that_load(kind):
    """As `study.solve` has them, which is given no strength."""
    given = {name: value for name, value in CASES[kind].items() if value is not None}
    yielding = study.first_yield(**given)
    without = {name: value for name, value in given.items() if name not in ("Y1", "Y2", "Y_punch")}
    axes = [(name, value) for name, value in given.items() if isinstance(value, list)]
    cases = [without | {name: one} for name, values in axes for one in values] or [without]
    for end in ("Y1", "Y2", "Ya", "Y_punch"):
        loads, flags = (yielding[f"{name}_{end}"].values.ravel().tolist() for name in ("P", "validity"))
        loads = [f"{P} N" if np.isfinite(P) else "" for P in loads]
        contacts = [P and study.solve(**case, P=P, x=2) for case, P in zip(cases, loads, strict=True)]
        assert flags == [contact.validity if P else 0 for contact, P in zip(contacts, loads, strict=True)], end
        assert all(loads) or end not in given
    assert yielding.validity_Y2.dims == yielding.P_Y2.dims


def test_a_comment_says_it_in_words():
    """The body yields when few asperities touch; the asperities later, when the spots merge."""
    found = study.first_yield(**BARE | COARSE | {"Nbar": "0.01 1/um^2", "hardness": "20 GPa"})
    assert found.P_Y2.attrs["comment"].startswith("Fewer than 100 asperities touch")
    assert "spots merge" in found.P_Ya.attrs["comment"] and "Fewer" not in found.P_Ya.attrs["comment"]
    assert (found.first_yield, found.validity_Y2, found.validity_Ya) == (2, 2, 16)
    assert study.decode(found.validity_Y2).item() == "few_spots"
    assert "comment" not in study.first_yield(**COATED, micro="smooth").P_Y2.attrs


def test_no_warning_of_a_contact_that_nobody_asked_for():
    """The user gives no load: a contact of any radius may be far outside the model."""
    soft = {name: value for name, value in (COATED | COARSE).items() if name != "Y2"} | {"E1": "0.5 GPa"}
    with pytest.warns(UserWarning) as caught:
        study.solve(**soft, a="1 um", x=2)
    assert caught[0].category is FarOutside
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert study.first_yield(**soft).first_yield == 0

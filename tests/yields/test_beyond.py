"""Whether the model describes the contact at which something first yields: its flags, and a warning."""

import warnings

import pytest

import study
from study.in_words import FarOutside

BALL = {"R": "5 mm", "E2": "208 GPa", "nu2": 0.3, "Y2": "250 MPa"}
COATED = BALL | {"E1": "200 GPa", "nu1": 0.25, "h": "20 um", "bonding": "bonded"}
COARSE = {"micro": "disc_cell", "Nbar": "0.0001 1/um^2", "Ra": "50 um"}
BARE = BALL | {"base": "half_space", "micro": "smooth"}
CASES = {
    "asperities on a layer": COATED | COARSE | {"Nbar": ["0.0001 1/um^2", "0.1 1/um^2"]},
    "a smooth coating": COATED | {"micro": "smooth"},
    "a cup": {**BARE, "R": None, "R1": "5 mm", "R2": "-5.05 mm"},
    "a blunt cone": {**BARE, "R": None, "shape": "blunt_cone", "half_angle": "82 deg", "tip_radius": "1 mm"},
}


@pytest.mark.filterwarnings("ignore:.*beyond what the model describes")
@pytest.mark.parametrize("kind", CASES)
def test_the_flags_are_those_of_the_contact_at_that_load(kind):
    """As `study.solve` has them, which is given no strength."""
    given = {name: value for name, value in CASES[kind].items() if value is not None}
    found = study.first_yield(**given)
    del given["Y2"]
    cases = [given | {"Nbar": Nbar} for Nbar in given["Nbar"]] if "Nbar" in given else [given]
    loads, flags = found.P_Y2.values.ravel().tolist(), found.validity_Y2.values.ravel().tolist()
    assert flags == [study.solve(**case, P=f"{P} N", x=2).validity for case, P in zip(cases, loads, strict=True)]
    assert found.validity_Y2.dims == found.P_Y2.dims and len(set(flags)) == len(cases)
    assert (found.found_Y1 == 2).all() and (found.validity_Y1 == 0).all()


def test_a_warning_of_what_yields_first():
    """Not of what yields later: the asperities do, when the spots merge."""
    rough = BARE | COARSE | {"Nbar": "0.01 1/um^2", "hardness": "20 GPa"}
    with pytest.warns(UserWarning) as caught:
        found = study.first_yield(**rough)
    assert len(caught) == 1 and caught[0].filename == __file__
    assert str(caught[0].message).startswith(
        "the contact at which something first yields is beyond what the model describes:\nFewer than 100 asperities"
    )
    assert "spots merge" not in str(caught[0].message)
    assert (found.first_yield, found.validity_Y2, found.validity_Ya) == (2, 2, 16)


def test_no_warning_where_all_holds():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert study.first_yield(**COATED, micro="smooth").validity_Y2 == 0


def test_no_warning_of_the_contact_that_is_tried():
    """The user gives no load, so that one of any radius is solved: such a contact may be far outside the model."""
    soft = {name: value for name, value in (COATED | COARSE).items() if name != "Y2"} | {"E1": "0.5 GPa"}
    with pytest.warns(UserWarning) as caught:
        study.solve(**soft, a="1 um", x=2)
    assert caught[0].category is FarOutside
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert study.first_yield(**soft).first_yield == 0

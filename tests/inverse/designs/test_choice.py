"""`feasible` against the numbers themselves, `front` against comparing every contact with every other."""

import warnings

import numpy as np
import pytest

import study

CONTACTS = {"P": [1e-6, 1e-5, 1e-4], "h": [0.005, 0.02, 0.08], "n": [0.05, 0.3, 2.0], "bonding": "bonded"}


@pytest.fixture(scope="module")
def contacts():
    return study.solve(**CONTACTS, Nbar=250000, Ra=0.004)


@pytest.fixture(scope="module")
def physical():
    scene = {"R": "5 mm", "punch": "steel 52100", "body": "steel 52100", "bonding": "bonded", "micro": "smooth"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # thin PTFE is strained more than the model describes
        return study.solve(**scene, layer=["PTFE", "TiN"], h=["2 um", "20 um"], P=["1 N", "10 N"])


def test_limits(contacts):
    good = study.feasible(contacts, p_max="< 0.08", D="<= 5e-4", Ar_An="> 0.1", h=">= 0.02", validity=0)
    v = contacts
    expected = (v.p_max < 0.08) & (v.D <= 5e-4) & (v.Ar_An > 0.1) & (v.h >= 0.02) & (v.validity == 0)
    assert good.dims == contacts.status.dims and good.dtype == bool
    assert (good == expected.transpose(*good.dims)).all() and 0 < good.sum() < good.size


def test_limits_with_units(physical):
    """Of `study.readable` too, whose numbers are in µm and MPa."""
    expected = (physical.p0 < 900e6) & (physical.D < 6e-6)
    for some in (physical, study.readable(physical)):
        good = study.feasible(some, p0="< 900 MPa", D="< 6 um")
        assert (good.values == expected.values).all() and 0 < good.sum() < good.size
    wide = study.feasible(physical, An="> 0.01 mm^2")
    assert (wide == (np.pi * physical.a**2 > 1e-8)).all() and 0 < wide.sum() < wide.size


def test_masks_that_are_allowed(contacts):
    masks = contacts.validity.values
    allowed = int(masks.max())
    assert (study.feasible(contacts, validity=allowed).values == ((masks & ~allowed) == 0)).all()
    assert study.feasible(contacts, validity=0).sum() < study.feasible(contacts, validity=255).sum()


def test_what_is_not_solved_is_not_feasible():
    plates = study.solve(P=1e-5, base="thin_layer", micro="smooth", bonding="bonded", h=0.005, n=[0.1, 5.0])
    assert study.feasible(plates, validity=0, h="> 0").values.tolist() == [True, False]
    assert study.front(plates, least=["h"]).on_front.values.tolist() == [True, False]


def test_a_profile_keeps_to_its_limit_everywhere(contacts):
    good = study.feasible(contacts, p="< 0.02")
    assert (good == (contacts.p < 0.02).all("x")).all() and 0 < good.sum() < good.size


def beaten(costs: np.ndarray) -> list[bool]:
    return [any((other <= mine).all() and (other < mine).any() for other in costs) for mine in costs]


@pytest.mark.parametrize("least", [["p_max", "D"], ["D"], ["p_max", "D", "a"], ["An", "p_max"]])
def test_front_is_what_nothing_beats(contacts, least):
    chosen = study.front(contacts, least=least)
    area = np.pi * contacts.a**2
    columns = [(area if name == "An" else contacts[name]).values.ravel() for name in least]
    expected = [not bad for bad in beaten(np.stack(columns, axis=1))]
    assert chosen.on_front.values.ravel().tolist() == expected and chosen.on_front.dims == contacts.status.dims
    assert 0 < chosen.on_front.sum() < chosen.on_front.size


def test_more_of_what_is_better(contacts):
    chosen = study.front(contacts, least=["p_max"], most=["dP_dD"]).on_front.values.ravel()
    costs = np.stack([contacts.p_max.values.ravel(), -contacts.dP_dD.values.ravel()], axis=1)
    assert chosen.tolist() == [not bad for bad in beaten(costs)]


def test_equal_contacts_do_not_beat_each_other():
    twins = study.solve(P=[1e-5, 2e-5], Y1=[0.1, 0.2], h=0.02, n=0.5, bonding="bonded", micro="smooth")
    assert study.front(twins, least=["D"]).on_front.values.tolist() == [[True, True], [False, False]]


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"p_maxx": "< 1"}, 'the dataset has no "p_maxx"; did you mean "p_max"?'),
        ({"D": "6 um"}, 'D = "6 um": must be a text that begins with <, <=, > or >=, such as "< 250 MPa"'),
        ({"D": 6e-6}, "must be a text that begins with"),
        ({"D": "< 6 MPa"}, 'D = "6 MPa" is a pressure: must be a length'),
        ({"D": "< 6"}, 'D = "6" has no unit'),
        ({"D": "< 6 ± 1 um"}, "a limit has no ±"),
        ({"validity": "none"}, 'validity = "none": must be a whole number, such as validity=0'),
        ({"validity": True}, "must be a whole number"),
        ({"bonding": "< 1"}, "bonding is not a number"),
    ],
)
def test_limits_that_are_refused(physical, limits, message):
    with pytest.raises(study.StudyError) as refusal:
        study.feasible(physical, **limits)
    assert message in str(refusal.value)


def test_fronts_that_are_refused(contacts):
    for least, message in (
        ([], "front: give at least one name"),
        ("D", 'front: least = "D": must be a list of names'),
        (["Dx"], 'front: the dataset has no "Dx"'),
        (["p"], "front: p is a profile"),
    ):
        with pytest.raises(study.StudyError) as refusal:
            study.front(contacts, least=least)
        assert message in str(refusal.value)
    with pytest.raises(study.StudyError, match="front takes a dataset of study.solve"):
        study.front(contacts.p_max, least=["D"])

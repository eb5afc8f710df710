"""Calls of `study.fit` that cannot be used are refused, with the input, its value and what is allowed."""

import numpy as np
import pytest
from measured_curves import DEPTHS, GEL

import study

CURVE = {"D": (DEPTHS, "m"), "P": (np.maximum(DEPTHS, 0.0), "N")}
ROUGH = {"Nbar": "1 1/um^2", "Ra": "1 um", "micro": "disc_cell", "E1": "5 kPa"}

#: What is changed in the call -> parts of the message.
WRONG = [
    ({"free": []}, ["free: name at least one input"]),
    ({"free": None}, ["free = None", "must be names of inputs"]),
    ({"free": 5}, ["free = 5", "must be names of inputs"]),
    ({"free": ["E1", "E1"]}, ["E1 is named twice"]),
    ({"free": ["E3"]}, ['"E3" is not an input that can be fitted']),
    ({"free": ["D0"]}, ['"D0" is not an input that can be fitted']),
    ({"free": ["rtol"]}, ['"rtol" is not an input that can be fitted']),
    ({"free": ["P"]}, ['"P" is not an input that can be fitted']),
    ({"free": ["E_punch"]}, ["E_punch has no value", 'free={"E_punch": (low, high)}']),
    ({"free": {"E1": ("1 MPa", "1 kPa")}}, ["E1 = (1 MPa, 1 kPa)", "below the high one"]),
    ({"free": {"E1": ("1 kPa", "1 kPa")}}, ["E1 = (1 kPa, 1 kPa)", "below the high one"]),
    ({"free": {"E1": ("0 kPa", "1 kPa")}}, ["E1 = (0 kPa, 1 kPa)", "above 0"]),
    ({"free": {"E1": ("1 kPa",)}}, ["E1", "must be (low, high)"]),
    ({"free": {"E1": (1e3, 1e6)}}, ["E1 = 1000.0 has no unit"]),
    ({"free": {"E1": ("1 um", "2 um")}}, ["E1", "is a length: must be a pressure"]),
    ({"free": {"E1": ("1e-9 Pa", "1 MPa")}}, ["E1 = 1e-09 Pa", "must be 0 or in [1e-9, 1e9]"]),
    ({"free": {"h": ("1 um", "1e9 m")}, "E1": "5 kPa"}, ["h = 1000000000.0 m", "must be in"]),
    ({"free": {"nu1": (0.2, 0.6)}, "E1": "5 kPa"}, ["nu1 = 0.6", "must be in (-1, 0.5]"]),
    ({"free": ["E1", "h", "E2"], "E_punch": "70 ± 1 GPa"}, ["at most 3 inputs can be unknown", "E1, h, E2, E_punch"]),
    ({"free": ["E1"], "D": "1 um"}, ["leave out D: curves have it"]),
    ({"free": ["E1"], "E2": None}, ["E2 is missing"]),
    ({"free": ["E1"], "R": None}, ["R is missing"]),
    ({"free": ["E1"], "h": 1.5}, ["h", "no unit"]),
    ({"free": ["E1"], "h": "1.5 nN"}, ["h", "is a force: must be a length"]),
    ({"free": ["E1"], "h": ["1 um", "2 um"]}, ["several values"]),
    ({"free": ["E1"], "thickness": "1 um"}, ['"thickness" is not a parameter']),
    ({"free": ["E1"], "sigma": "1 nm"}, ['sigma = "1 nm" is a length: must be a force']),
    ({"free": ["E1"], "sigma": "1e-9"}, ["sigma", "has no unit"]),
    ({"free": ["E1"], "sigma": -1.0}, ["sigma = -1.0: must be above 0"]),
    ({"free": ["E1"], "sigma": 0.0}, ["sigma = 0.0: must be above 0"]),
    ({"free": ["E1"], "sigma": np.inf}, ["sigma = inf: must be above 0"]),
    ({"free": ["E1"], "sigma": True}, ["sigma = True: must be above 0"]),
    ({"free": ["E1"], "sigma": np.ones(7)}, ["sigma has the shape (7,)"]),
    ({"free": ["E1"], "x": "D", "y": "a"}, ['y = "a"', 'x="P", y="a"']),
    ({"free": ["E1"], "x": "a", "y": "dP_dD"}, ["a is not there"]),
    ({"free": ["E1"], "loss": "cauchy"}, ['loss = "cauchy"', '"huber"']),
    ({"free": ["E1"], "intervals": "mcmc"}, ['intervals = "mcmc"', '"profile"']),
    ({"free": ["E1"], "level": 95}, ["level = 95", "between 0 and 1"]),
    ({"free": ["E1"], "level": True}, ["level = True", "between 0 and 1"]),
    ({"free": ["E1"], "tilt": 1}, ["tilt = 1", "True or False"]),
    ({"free": ["E1"], "progress": "yes"}, ["progress", "True, False or None"]),
    ({"free": ["E1"], "plan": True, "E1": "5 kPa"}, ["plan: give sigma"]),
    ({"free": ["E1"], "plan": True, "sigma": "1 nN"}, ["E1 has no value", "assumed"]),
]
#: Pairs that a curve cannot tell apart, and the rest of the call.
PAIRS = [
    *(("E1", other, {}) for other in ("nu1", "R")),
    ("Nbar", "Ra", ROUGH),
    ("sigma", "cut", ROUGH | {"micro": "normal_heights"}),
    ("B", "beta", ROUGH | {"micro": "power_law"}),
    ("Ra", "sigma", ROUGH | {"micro": "normal_heights"}),
]


def call(**changed):
    given = {"progress": False} | GEL | changed
    return study.fit(CURVE, **{name: value for name, value in given.items() if value is not None or name == "free"})


@pytest.mark.parametrize(("changed", "parts"), WRONG, ids=[str(i) for i in range(len(WRONG))])
def test_refused(changed, parts):
    with pytest.raises(study.StudyError) as error:
        call(**changed)
    assert len(error.value.messages) == 1, error.value.messages
    for part in parts:
        assert part in str(error.value)
    assert "solve:" not in str(error.value)


@pytest.mark.parametrize(("one", "other", "given"), PAIRS)
def test_pairs_that_a_curve_cannot_tell_apart(one, other, given):
    """Both free, or one with ±: said before the curve is read, which is not there."""
    with pytest.raises(study.StudyError, match=f"{one} and {other}: a curve cannot tell them apart"):
        study.fit("no_such_file.csv", free=[one, other], **GEL | given)


def test_a_roughness_with_a_prior_beside_a_free_one():
    with pytest.raises(study.StudyError, match="Nbar and Ra: a curve cannot tell them apart"):
        call(free=["Nbar"], **ROUGH | {"Ra": "1 ± 0.1 um"})


def test_without_units():
    """Curves have units, so the contact has some too."""
    with pytest.raises(study.StudyError, match='"n" is not an input that can be fitted'):
        study.fit(CURVE, free=["n"], h=0.1, nu1=0.4, bonding="bonded", micro="smooth")
    with pytest.raises(study.StudyError, match=r"h = 0\.1 has no unit(.|\n)*R is missing(.|\n)*E2 is missing"):
        study.fit(CURVE, free={"nu1": (0.1, 0.4)}, h=0.1, n=0.1, bonding="bonded", micro="smooth")

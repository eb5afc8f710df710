"""Values and words that people give and a contact cannot have: each is told in a message of its own."""

import json

import numpy as np
import pytest
import xarray as xr

import study
from study.__main__ import main
from study.commands.point import number

BARE = {"P": 1e-4, "micro": "smooth", "base": "half_space"}
YIELDING = {"micro": "smooth", "base": "half_space", "Y2": 0.01}
LINE = "line contacts, of cylinders and rollers"
FRICTION = "must be a finite number, at least 0"


@pytest.fixture(scope="module")
def contact() -> xr.Dataset:
    return study.solve(**BARE)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        *(("mu", value, f"mu = {value}: {FRICTION}") for value in (None, True, np.nan)),
        ("mu", 1e300, "mu = 1e.300: must be at most"),
        ("sigma_res", None, "sigma_res = None: must be a finite number"),
        ("sigma_res", True, "sigma_res = True: must be a finite number"),
        ("sigma_res", -1e300, "sigma_res = -1e.300: must be at most"),
    ],
)
def test_friction_and_residual_stress(contact, name, value, message):
    for call in (study.stresses, study.extremes):
        with pytest.raises(study.StudyError, match=message):
            call(contact, **{name: value})
    with pytest.raises(study.StudyError, match=message):
        study.first_yield(**YIELDING, **{name: value})


def test_radii_that_are_no_numbers(contact):
    with pytest.raises(study.StudyError, match="r = True: must be numbers"):
        study.stresses(contact, r=True)


@pytest.mark.parametrize("word", ["cylinder", "Roller", "line contact", "cylindrical"])
def test_shapes_of_line_contacts(word):
    with pytest.raises(study.StudyError, match=f"must be one of.*{LINE}"):
        study.solve(**BARE, shape=word)


@pytest.mark.parametrize("name", ["length", "L", "Rx", "R_y", "roller", "width", "cylinder_length"])
def test_names_of_line_contacts(name):
    with pytest.raises(study.StudyError, match=LINE):
        study.solve(**BARE, **{name: 1.0})


def test_a_roller_is_no_material():
    with pytest.raises(study.StudyError, match=f"not a material.*{LINE}"):
        study.solve(**BARE, punch="roller")


def test_friction_of_a_contact(capsys):
    """It is not refused as something that is nowhere in the program."""
    assert main(["point", "P=1e-4", "base=half_space", "micro=smooth", "mu=0.3"]) == 2
    said = capsys.readouterr().err
    assert "mu changes the stresses" in said and "not in the model" not in said
    assert main(["point", "P=1e-4", "base=half_space", "micro=smooth", "sigma_res=0.3"]) == 2
    assert "sigma_res adds to the stresses" in capsys.readouterr().err


@pytest.mark.parametrize("flags", [None, 3, "status", np.zeros(2)])
def test_names_of_no_flags(flags):
    with pytest.raises(ValueError, match="^a [a-zA-Z]* is none of status, .*: take an array, contacts.status"):
        study.decode(flags)


def test_names_of_all_flags_of_a_dataset(contact):
    with pytest.raises(ValueError, match="^a Dataset is none of .*: take one of its arrays status, model_used, "):
        study.decode(contact)
    with pytest.raises(ValueError, match="take one of its arrays found_Y1"):
        study.decode(study.first_yield(**YIELDING))


def test_infinite_and_unknown_in_json():
    numbers = [number(xr.DataArray(value)) for value in (np.inf, -np.inf, np.nan, 1.5)]
    assert numbers == ["inf", "-inf", None, 1.5] and json.loads(json.dumps(numbers)) == numbers


def test_the_version_says_that_there_is_no_core(monkeypatch, capsys):
    monkeypatch.setattr("solver.compiled.library.available", lambda: ())
    with pytest.raises(SystemExit):
        main(["--version"])
    assert "without its compiled core (numpy computes, 3 to 6 times slower)" in capsys.readouterr().out

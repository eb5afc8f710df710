"""Real coatings are thinner than the pitch of real roughness: their contacts are within the model."""

import warnings

import numpy as np
import pytest

import study
from solver import Status

#: A ball of steel on a-C:H, TiN and PTFE on steel. Moduli and Poisson ratios are those of the materials, of which no
#: strength is looked at here.
BALL = {"R": "5 mm", "E_punch": "207 GPa", "nu_punch": 0.29, "E2": "207 GPa", "nu2": 0.29, "bonding": "bonded"}
BALL |= {"P": "5 N", "x": 2, "profiles": False, "rtol": 1e-3}  # for flags that is enough
COATINGS = [{"E1": E1, "nu1": nu1} for E1, nu1 in (("200 GPa", 0.25), ("450 GPa", 0.25), ("0.5 GPa", 0.46))]
AXES = {"h": [f"{h} um" for h in (0.5, 1, 2, 5, 20)], "Ra": ["5 um", "50 um"]}
AXES |= {"Nbar": [f"{pitch**-2.0} 1/um^2" for pitch in (1, 3, 10, 30)]}
#: Masks of asperities on a half-space, and the thickest of the thin layers in m.
OF_HALF_SPACE, THIN = 4 | 128, 2.01e-6


@pytest.fixture(scope="module")
def contacts():
    """asperities_on -> the 120 contacts, three datasets of 40."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return {
            word: [study.solve(**BALL, **coating, **AXES, asperities_on=word) for coating in COATINGS]
            for word in ("auto", "half_space")
        }


def test_on_the_layer_none_is_outside_for_its_thickness(contacts):
    """On a half-space all 72 with h up to 2 µm carry a mask of it, and most of the 120."""
    flagged = {
        word: sum(int(((own.validity.where(own.h < THIN, 0).astype(int) & OF_HALF_SPACE) != 0).sum()) for own in each)
        for word, each in contacts.items()
    }
    assert flagged == {"auto": 0, "half_space": 72}
    every = [int(((own.validity & OF_HALF_SPACE) != 0).sum()) for own in contacts["half_space"]]
    assert sum(every) > 90 and all(int(((own.validity & OF_HALF_SPACE) != 0).sum()) == 0 for own in contacts["auto"])


def test_all_are_solved_or_outside_of_the_law(contacts):
    """Those outside have spots that merge, or a soft film under the disc cell: less than a quarter."""
    status = np.concatenate([own.status.values.ravel() for own in contacts["auto"]])
    assert {*status.tolist()} == {Status.CONVERGED, Status.OUTSIDE_LAW} and np.mean(status == Status.OUTSIDE_LAW) < 0.25
    assert all((own.status == Status.CONVERGED).all() for own in contacts["half_space"])


def test_what_they_press_on_is_said(contacts):
    """By the pitch; and its error is known where that is above h."""
    for auto, alone in zip(contacts["auto"], contacts["half_space"], strict=True):
        far = 1 / np.sqrt(auto.Nbar) > (1 + 1e-9) * auto.h
        assert ((study.decode(auto.asperities_used) == "layer") == far).all()
        assert (study.decode(alone.asperities_used) == "half_space").all()
        assert ((alone.model_error > 0) == far).all()

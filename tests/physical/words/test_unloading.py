"""The elastic-plastic law is for loading: where spots that have yielded unload it is said."""

import warnings

import numpy as np
import pytest

import study

PLATE = {"h": 0.004, "n": 100.0, "bonding": "bonded", "Nbar": 250000.0, "Ra": 0.004}
SAID = "The pressure falls somewhere while the load rises"


def warned(**given) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        study.solve(**given)
    return [str(one.message) for one in caught if SAID in str(one.message)]


def test_under_a_layer_that_bends_the_centre_unloads():
    """Its pressure falls while it moves into a ring; of spots that have yielded this is said, with how many cases."""
    given = PLATE | {"micro": "elastic_plastic", "hardness": 1.0}
    contacts = study.solve(**PLATE, P=[5e-6, 1e-5], x=[0.0, 1.0])
    assert contacts.p0.values[1] < 0.7 * contacts.p0.values[0]
    (text,) = warned(**given, P=[1e-6, 1e-5])
    assert f"1 of 2 cases: {SAID}" in text
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert SAID in study.summary(study.solve(**given, P=1e-4))


@pytest.mark.parametrize("change", [{"hardness": 50.0}, {"micro": "disc_cell"}, {"n": 2.0, "P": 1e-5}])
def test_where_nothing_has_yielded_or_falls_it_is_not(change):
    assert warned(**PLATE | {"micro": "elastic_plastic", "hardness": 1.0, "P": 1e-4} | change) == []
    assert np.isfinite(study.solve(**PLATE, P=1e-4).a)

"""Sharp tips in hard bodies: no modulus from a loading, and an unloading is contact throughout."""

import numpy as np
import pytest
from conftest import ROOT

import study

MEASURED = ROOT / "tests/inverse/misfit/measured"
CALL = {"punch": "diamond", "nu2": 0.3, "base": "half_space", "micro": "smooth", "progress": False}
TIPS = [
    {"shape": "berkovich"},
    {"shape": "cone", "half_angle": 70.3},
    {"shape": "blunt_cone", "half_angle": 70.3, "tip_radius": "50 nm"},
]


@pytest.mark.parametrize("tip", TIPS, ids=lambda tip: tip["shape"])
def test_the_loading_of_steel_is_no_elastic_contact(tip):
    fitted = study.fit(MEASURED / "steel_loading.csv", free=["E2"], **tip, **CALL)
    text = str(study.summary(fitted))
    assert fitted.flows and int(fitted.validity.item()) & 512 and fitted.D_valid.item() == -np.inf
    assert (
        "This is not a modulus" in text
        and "beginning of the unloading" in text
        and "none of the checked assump" not in text
    )


def test_a_gel_below_a_sharp_tip_is_elastic():
    D = np.linspace(-0.2, 1, 60) * 1e-6
    P = 2 / np.pi * np.tan(np.radians(70.3)) * 5e3 / (1 - 0.3**2) * np.maximum(D, 0) ** 2
    fitted = study.fit({"D": (D, "m"), "P": (P, "N")}, free=["E2"], shape="cone", half_angle=70.3, **CALL)
    assert not fitted.flows and fitted.E2.item() == pytest.approx(5e3, rel=1e-5)


def test_an_unloading_is_contact_throughout():
    D = np.linspace(250, 230, 100)
    P = 10 * ((D - 225) / 25) ** 1.35 + 0.005 * np.random.default_rng(0).standard_normal(len(D))
    fitted = study.fit({"D": (D, "nm"), "P": (P, "mN")}, free=["E2"], shape="berkovich", **CALL)
    text = str(study.summary(fitted))
    assert "in contact throughout, as an unloading curve is" in text and "it contains no contact" not in text

"""Physical units there and back."""

import numpy as np
import pytest
import xarray as xr

import study
from study.units import factor
from study.vocabulary import PARAMETERS, VOCABULARY

SCALE = {"R": 5e-3, "E2_star": 2e11}


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("P", 2e11 * 25e-6),  # N
        ("D", 5e3),  # µm
        ("p_max", 2e5),  # MPa
        ("Nbar", 0.04),  # mm⁻²: 1/(5 mm)²
        ("dP_dD", 1e9),  # N/m
        ("An", 25.0),  # mm²
        ("Ar_An", 1.0),
    ],
)
def test_factors(name, expected):
    assert factor(name, **SCALE) == pytest.approx(expected, rel=1e-14)


def test_hertz_in_physical_units():
    """A steel ball of 5 mm under 10 N: the textbook formulae in SI units."""
    given = study.from_physical(**SCALE, P=10.0, micro="smooth", base="half_space")
    found = study.to_physical(study.solve(**given), **SCALE)
    a = (3 * 10 * 5e-3 / (4 * 2e11)) ** (1 / 3)
    assert found.P.item() == pytest.approx(10, rel=1e-14)
    assert found.a.item() == pytest.approx(a * 1e6, rel=1e-12)
    assert found.D.item() == pytest.approx(a**2 / 5e-3 * 1e6, rel=1e-12)
    assert found.p0.item() == pytest.approx(1.5 * 10 / (np.pi * a**2) / 1e6, rel=1e-12)
    assert found.dP_dD.item() == pytest.approx(2 * 2e11 * a, rel=1e-9)
    assert [found[name].units for name in ("P", "a", "p0", "dP_dD", "nu1")] == ["N", "um", "MPa", "N m-1", "1"]
    assert "scale" not in found.P.attrs
    assert found.physical_scale == "R = 0.005 m, E2* = 200000000000.0 Pa"


def test_axes_are_converted_and_stay_selectable():
    found = study.to_physical(study.solve(P=[1e-6, 2e-6], micro="smooth", base="half_space"), **SCALE)
    np.testing.assert_allclose(found.indexes["P"], [5.0, 10.0], rtol=1e-14, atol=0)
    assert found.sel(P=10, method="nearest").a.notnull()


def test_there_and_back():
    parameters = {name: 0.25 for name in PARAMETERS if not VOCABULARY[name].choices}
    physical = {name: value * factor(name, **SCALE) for name, value in parameters.items()}
    assert study.from_physical(**SCALE, **physical) == pytest.approx(parameters, rel=1e-15)


def test_forms_are_kept():
    array = xr.DataArray([5e3, 1e4], dims="sample")
    found = study.from_physical(**SCALE, h=array, Ra=[5e3, 1e4], a=5e3, bonding=["bonded"])
    assert found["h"].dims == ("sample",)
    np.testing.assert_allclose(found["h"], [1, 2], rtol=1e-15, atol=0)
    np.testing.assert_allclose(found["Ra"], [1, 2], rtol=1e-15, atol=0)
    assert found["a"] == 1
    assert found["bonding"] == ["bonded"]


def test_reduced_modulus():
    assert study.reduced_modulus(210e9, 0.3) == pytest.approx(230.769230769e9, rel=1e-11)


def test_wrong_calls():
    smooth = study.solve(P=1e-6, micro="smooth", base="half_space")
    with pytest.raises(ValueError, match="in physical units already: R = 0.005 m"):
        study.to_physical(study.to_physical(smooth, **SCALE), **SCALE)
    for bad in (0, -1, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="R = .*: must be > 0 and finite"):
            study.to_physical(smooth, R=bad, E2_star=1e11)
    with pytest.raises(ValueError, match='"Nabr" is not a parameter; did you mean "Nbar"?'):
        study.from_physical(**SCALE, Nabr=3)

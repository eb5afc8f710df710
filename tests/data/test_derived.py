"""Quantities derived from a dataset, against numbers worked out by hand, and the assumptions a case violates."""

import numpy as np
import pytest
import xarray as xr

import study
from solver import Model
from study.data import dataset, derived
from study.inputs.vocabulary import attributes
from study.studies.evidence import validity_maps


def made(**variables) -> xr.Dataset:
    """A dataset of one case as the results of a solver would give it, to set single quantities at will."""
    given = {
        "base": "thin_layer",
        "micro": "disc_cell",
        "P": 2.0,
        "Nbar": 1e6,
        "h": 0.01,
        "n": 0.5,
        "a": 0.02,
        "D": 3e-4,
        "p0": 0.01,
        "lam0": 0.2,
        "model_error": 0.05,
    }
    given |= {"status": np.int8(0), "model_used": np.int8(Model.THIN_LAYER)} | variables
    made = xr.Dataset({name: ((), value) for name, value in given.items() if value is not None})
    made["model_used"].attrs = dataset.model_attributes()
    return made


EXACT = {"model_used": np.int8(Model.LAYERED), "model_error": 0.0}
ON_HALF_SPACE = {"asperities_on": "half_space"}


@pytest.mark.parametrize(
    ("variables", "expected"),
    [
        ({}, 0),
        ({"model_error": 0.101}, 1),
        ({"model_error": 0.099, "h": 0.02}, 0),
        ({"model_error": 0.2, "base": "auto"}, 1),
        ({"model_error": 0.2, "base": "auto", "micro": "smooth", "model_used": np.int8(Model.SMOOTH_THIN_LAYER)}, 1),
        ({"model_error": 0.2, "base": "auto", "model_used": np.int8(Model.LAYER_ALONE)}, 0),
        ({"Nbar": 99 / (np.pi * 0.02**2), "lam0": 1e-3}, 2),
        ({"Nbar": 101 / (np.pi * 0.02**2), "lam0": 1e-3}, 0),
        ({"lam0": 0.4, "Nbar": 0.99e4 * 0.4 / np.pi, "a": 0.19, "h": 0.1}, 4),
        ({"lam0": 0.4, "Nbar": 1.01e4 * 0.4 / np.pi, "a": 0.19, "h": 0.1}, 0),
        ({"n": 1.0}, 8),
        ({"n": 1.0, "base": "auto"}, 0),
        ({"n": 1.0, "model_error": 0.3, "Nbar": 1.0, "lam0": 0.5, "a": 0.3}, 1 | 2 | 4 | 8 | 16 | 32 | 128),
        ({"lam0": 0.2, "Ra": 2.01 * np.sqrt(0.2 / np.pi / 1e6)}, 0),
        ({"lam0": 0.2, "Ra": 1.99 * np.sqrt(0.2 / np.pi / 1e6)}, 64),
        ({"lam0": 0.2, "Ra": None}, 0),
        ({"a": 0.19, "h": 5.01e-4, "lam0": 1e-4}, 0),
        ({"a": 0.19, "h": 4.99e-4, "lam0": 1e-4}, 128),
        ({"a": 0.19, "h": 4.99e-4, "lam0": 1e-4, "base": "auto", **ON_HALF_SPACE}, 128),
        ({"a": 0.19, "h": 4.99e-4, "lam0": 1e-4, "base": "auto"}, 0),
        ({"a": 0.19, "h": 4.99e-4, "lam0": 1e-4, "base": "auto", "micro": "power_law"}, 128),
        ({"a": 0.19, "h": 4.99e-4, "micro": "smooth"}, 0),
        ({"a": 0.19, "h": 4.99e-4, "lam0": 1e-4, "base": "half_space", "model_used": np.int8(Model.HALF_SPACE)}, 0),
        ({"lam0": 0.2, "Ra": 1e-9, "micro": "smooth"}, 0),
        ({"p_max": 0.17, "p0": 0.01}, 64),
        ({"p_max": 0.17, "p0": 0.02}, 0),
        ({"p_max": 0.17, "p0": 0.01, "micro": "smooth"}, 0),
        ({"p_max": 0.09, "p0": 0.01, "m": 1.0}, 64),
        ({"p_max": 0.32, "p0": 0.01, "base": "half_space", "model_used": np.int8(Model.HALF_SPACE)}, 0),
        ({"p_max": 0.33, "p0": 0.01, "base": "half_space", "model_used": np.int8(Model.HALF_SPACE)}, 64),
        ({"lam0": 0.401}, 16),
        ({"lam0": 0.399}, 0),
        ({"lam0": 1.0, "micro": "smooth"}, 0),
        ({"a": 0.201}, 32),
        ({"a": 0.199}, 0),
        ({"D": 1.1e-3, "p0": 0.051}, 32),
        ({"D": 1.1e-3, "p0": 0.049}, 0),
        ({"D": 0.9e-3, "p0": 0.051}, 0),
        ({"D": 1.1e-3, "p0": 0.051, "base": "half_space", "model_used": np.int8(Model.HALF_SPACE)}, 0),
        ({"n": 0.999}, 0),
        ({"base": "layered", "n": 1.0, "h": 0.03, **EXACT}, 0),
        ({"base": "layered", "Nbar": 1.0, **EXACT, **ON_HALF_SPACE}, 2 | 4 | 128),
        ({"base": "layered", "Nbar": 1.0, **EXACT}, 2),
        ({"lam0": 0.39, "Nbar": 0.9e4 * 0.4 / np.pi, "a": 0.19, "h": 0.1, "base": "layered", **EXACT}, 0),
        ({"base": "half_space", "h": 0.001, "n": 2.0, **EXACT}, 0),
        ({"base": "half_space", "h": None, "n": None, **EXACT}, 0),
        ({"micro": "smooth", "Nbar": 1.0}, 0),
        ({"micro": "smooth", "Nbar": None}, 0),
        ({"a": np.nan, "lam0": np.nan, "model_error": np.nan, "n": 2.0, "status": np.int8(3)}, 8),
    ],
    ids=str,
)
def test_validity(variables, expected):
    found = derived.validity(made(**variables))
    assert found.item() == expected
    assert found.dtype == np.int32


def test_high_summits_that_carry_all_are_pressed_too_far():
    """Their b(0) is the mean over all summits, of which most do not touch: it was small, and nothing was said."""
    given = {"P": 1e-5, "h": 0.02, "n": 0.5, "Nbar": 1e8, "Ra": 4e-4, "micro": "normal_heights", "x": 2}
    found = study.solve(**given, sigma=[1e-6, 0.2])
    assert (found.validity & 64).values.tolist() == [0, 64]
    assert found.p_max[1] > 0.32 * 0.5 and derived.spot_radius(found)[1] < 0.5 * 4e-4


def test_validity_has_the_dimensions_of_status():
    given = {"P": 1e-5, "Nbar": [250000, 1e4], "h": [0.1, 0.001], "n": 0.5, "Ra": 0.004, "base": "thin_layer"}
    found = study.solve(**given, bonding=["frictionless", "bonded"])
    assert found.validity.dims == found.status.dims == ("Nbar", "h", "bonding")
    assert ((found.validity & 1).values == np.reshape([1, 0], (1, 2, 1))).all()
    assert ((found.validity & 2).values == np.reshape([0, 2], (2, 1, 1))).all()


ONE = made(dP_dD=0.03)
BY_HAND = {
    "An": (derived.nominal_area(ONE), np.pi * 4e-4),
    "An_ratio": (derived.nominal_area_ratio(ONE, 0.04), 0.25),
    "p_mean": (derived.mean_pressure(ONE), 2 / (np.pi * 4e-4)),
    "spots": (derived.number_of_spots(ONE), np.pi * 400),
    "b0": (derived.spot_radius(ONE), np.sqrt(0.2 / (np.pi * 1e6))),
    "E_eff": (derived.effective_modulus(ONE), 0.75),
}


@pytest.mark.parametrize("name", BY_HAND)
def test_derived_quantities(name):
    found, expected = BY_HAND[name]
    assert found.item() == pytest.approx(expected, rel=1e-14)  # a few roundings
    assert found.name == name and found.attrs == attributes(name)


def test_smooth_cases_have_no_spots():
    for function in (derived.number_of_spots, derived.spot_radius):
        assert np.isnan(function(made(micro="smooth"))) and np.isfinite(function(made()))


@pytest.mark.parametrize(("base", "m", "E1"), [("half_space", 0.0, 1.0), ("layered", 0.0, 0.5), ("layered", 1.0, 0.25)])
def test_peak_pressure_is_the_largest_of_the_spots(base, m, E1):
    """Eq. (13) where λ = 1/2, at the pressure that Eq. (7) has there: arccos(b/B̄) = arcsin(b/B̄) = π/4."""
    cell, b = 1 / np.sqrt(np.pi * 1e6), np.sqrt(0.5 / (np.pi * 1e6))
    p = 2 * E1 * b**3 / (3 * 0.004) / (cell**2 * np.pi / 4 + b * np.sqrt(cell**2 - b**2))
    profiles = {"p": ("x", [0.1 * p, p, 0.0])}
    rough = made(base=base, m=m, Ra=0.004).assign(profiles)
    found = derived.peak_pressure(rough)
    assert found.item() == pytest.approx(2 * E1 * b / (np.pi * 0.004) + 2 * p / np.pi * np.pi / 4, rel=1e-14)
    assert found.dims == () and found.attrs == attributes("p_peak")
    assert derived.peak_pressure(made(base=base, micro="smooth", Ra=0.004).assign(profiles)).item() == p


def test_peak_pressure_of_a_smooth_study_needs_no_roughness():
    found = study.solve(a=[0.02, 0.04], micro="smooth", base="half_space", x=5)
    np.testing.assert_allclose(derived.peak_pressure(found), found.p0, rtol=1e-14, atol=0)


def test_error_of_the_thin_layer():
    both = xr.Dataset({"D": ("base", [1.03e-3, 1e-3])}, {"base": ["thin_layer", "layered"]})
    found = validity_maps.from_layered(both, "D")
    assert found.item() == pytest.approx(0.03, rel=1e-12)  # 1e-14 of a difference from 1
    assert found.attrs == {"long_name": "indentation depth: thin layer over exact layer, less 1"}


@pytest.mark.parametrize("at", [{}, {"P": 0}], ids=["an axis", "one load"])
def test_quantities_of_results_with_units_have_units(at):
    """The same whether they are derived before the conversion or after it; the unit is that of the vocabulary."""
    found = study.solve(P=[1e-6, 2e-6], Nbar=250000, Ra=0.004, h=0.02, n=0.5, x=3).isel(at)
    with_units = study.to_physical(found, R=0.01, E2_star=1e11)
    for name, unit in (("An", "m^2"), ("p_mean", "Pa"), ("E_eff", "Pa"), ("b0", "m"), ("spots", None)):
        formula = derived.QUANTITIES[name]
        before, after = formula(found), formula(with_units)
        factor = {"m^2": 1e-4, "Pa": 1e11, "m": 0.01, None: 1.0}[unit]
        np.testing.assert_allclose(after, before * factor, rtol=1e-13, atol=0)
        assert after.attrs.get("units") == unit and after.attrs["symbol"] == before.attrs["symbol"]
        assert "E2*" not in str(after.attrs)


def test_the_modulus_that_a_bead_feels_on_a_gel():
    """Of a thick gel that of the gel, on a thin one more: E_eff in Pa of a call with units."""
    gel = {"R": "5 um", "E2": np.inf, "E1": "5 kPa", "nu1": 0.5, "P": "1 nN", "micro": "smooth", "bonding": "bonded"}
    found = study.solve(**gel, h=["2 um", "5 mm"], x=3)
    modulus = derived.effective_modulus(found)
    assert modulus.attrs["units"] == "Pa" and modulus[0] > 1.5 * modulus[1]
    assert float(modulus[1]) == pytest.approx(5e3 / (1 - 0.5**2), rel=1e-3)


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_the_largest_pressure_of_results_with_units_is_that_of_the_same_contact_without():
    """On an elastic and on a rigid base, of two axes, with the law that is fitted too."""
    hard = {"R": "5 mm", "E1": "400 GPa", "h": ["2 um", "20 um"], "P": "20 N", "Nbar": "0.1 1/um^2", "Ra": "5 um"}
    for more in ({"E2": ["3 GPa", "210 GPa"], "nu2": 0.2}, {"E2": "rigid", "E_punch": "3 GPa"}):
        for micro in ("disc_cell", "power_law", "smooth"):
            found = study.solve(**hard, **more, micro=micro, x=9)
            peak = derived.peak_pressure(found)
            E2 = found.E2 / (1 - found.nu2**2)
            unit = E2.where(np.isfinite(E2), found.E1 / (1 - found.nu1**2))
            given = {
                "h": found.h / found.R,
                "n": found.n,
                "m": found.m,
                "nu2": found.nu2,
                "P": found.P / unit / found.R**2,
            }
            if micro != "smooth":
                given |= {"Nbar": found.Nbar * found.R**2, "Ra": found.Ra / found.R}
            given = {name: one.drop_vars(one.coords).drop_attrs() for name, one in given.items()}
            plain = study.solve(**given, micro=micro, x=9)
            expected = derived.peak_pressure(plain) * unit.drop_vars(unit.coords)
            np.testing.assert_allclose(*xr.broadcast(peak.drop_vars(peak.coords), expected), rtol=1e-9, atol=0)
            assert peak.attrs["units"] == "Pa" and (peak > 0.99 * found.p_max).all()


def test_the_largest_pressure_has_a_message_where_the_modulus_is_not_known():
    found = study.solve(P=1e-6, micro="smooth", base="half_space", x=3)
    with pytest.raises(ValueError, match="p_peak needs the profile p, which profiles = false leaves out"):
        derived.peak_pressure(found.drop_vars("p"))
    with pytest.raises(ValueError, match="p_peak needs the profile p, which profiles = false leaves out"):
        derived.peak_pressure(found.drop_vars("p"))
    with pytest.raises(ValueError, match="p_peak needs R, E2 and p in SI units, as study.solve gives them"):
        derived.peak_pressure(study.to_physical(found, R=0.01, E2_star=1e11))
    found = study.solve(P="1 N", R="1 mm", E2="1 GPa", micro="smooth", base="half_space", x=3)
    with pytest.raises(ValueError, match="a is in µm: p_peak follows from results in SI units"):
        derived.peak_pressure(study.readable(found))


def test_the_exact_layer_is_the_default_and_has_no_assumption_of_thinness():
    given = {"P": 1e-5, "Nbar": 250000, "Ra": 0.004, "bonding": "bonded", "nu1": 0.5}
    found = study.solve(**given, h=[0.01, 1.0], n=[0.5, 100.0], x=3)
    assert found.base.item() == "layered"
    assert (found.status == 0).all() and ((found.validity & 9) == 0).all()
    thin = study.solve(**given, h=0.01, n=0.5, base="thin_layer")
    assert thin.status.item() == 4, "the thin-layer equation does not apply to bonded rubber"


def test_multiples_of_units_are_not_taken_for_si():
    """The area of a contact of 70 µm was 15 403, in m²; and a in m was compared with 0.2 R."""
    found = study.solve(R="9 mm", E2="9 GPa", base="half_space", P="9 N", micro="smooth", x=3)
    assert derived.nominal_area(found) == np.pi * found.a**2
    bare = derived.nominal_area(found[["a"]].reset_coords(drop=True))  # it was said to be in R^2
    assert bare.attrs["units"] == "m^2" and "scale" not in bare.attrs
    for formula in derived.QUANTITIES.values():
        with pytest.raises(ValueError, match="follows from results in SI units, or without units"):
            formula(study.readable(found))
    with pytest.raises(ValueError, match="validity is computed from results without units"):
        derived.validity(found)


def test_a_quantity_without_a_row_is_refused():
    with pytest.raises(ValueError, match="P_spot has no row in study/inputs/vocabulary.toml: a quantity needs one"):
        derived.quantity("P_spot")

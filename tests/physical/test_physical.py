"""Physical scenes: SI results are the dimensionless ones in other units, spreads are propagated, slips are named."""

import re
import warnings

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import study

pytest.importorskip("pint")
COATED = {"R": "5 mm", "E1": "200 GPa", "nu1": 0.25, "E2": "210 GPa", "nu2": 0.3, "h": "2 um", "micro": "smooth"}
E1_STAR, E2_STAR = 200e9 / (1 - 0.25**2), 210e9 / (1 - 0.3**2)
R = 5e-3


def quiet(**given) -> xr.Dataset:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return study.solve(**given)


def test_a_scene_is_the_dimensionless_contact_in_si():
    """To the rounding of the scales: the numbers inside are the same."""
    found = quiet(**COATED, P=["1 N", "10 N"], x=3)
    loads = [P / (E2_STAR * R**2) for P in (1.0, 10.0)]
    inside = study.solve(P=loads, h=2e-6 / R, n=E1_STAR / E2_STAR, nu1=0.25, nu2=0.3, micro="smooth", x=3)
    for name, scale in (("a", R), ("D", R), ("p0", E2_STAR), ("p", E2_STAR), ("dP_dD", E2_STAR * R)):
        # the last digits of P and h differ, and the iteration closes at a residual of 1e-13
        np.testing.assert_allclose(found[name].values, inside[name].values * scale, rtol=1e-11, atol=0, err_msg=name)
    # the difference of numbers that agree to 1e-8
    np.testing.assert_allclose(found.error, inside.error, rtol=0, atol=1e-12)
    assert found.P.values.tolist() == [1.0, 10.0] and float(found.h) == 2e-6 and float(found.E1) == 200e9
    units = {name: found[name].attrs["units"] for name in ("P", "a", "p0", "dP_dD", "h", "E1", "R")}
    assert units == {"P": "N", "a": "m", "p0": "Pa", "dP_dD": "N/m", "h": "m", "E1": "Pa", "R": "m"}
    assert "scale" not in found.a.attrs


def test_axes_are_found_by_text_and_by_number():
    found = quiet(**COATED | {"h": ["7 nm", "3 um", "0.1 mm"]}, P="10 N", x=2)
    assert found.h.values.tolist() == [7e-9, 3e-6, 1e-4]
    assert found.sel(h="3 um").a == found.sel(h=3e-6).a == found.isel(h=1).a
    assert found.sel(h=["7 nm", "3000 nm"]).h.values.tolist() == [7e-9, 3e-6]
    assert found.sel(h="2.9 um", method="nearest").h == 3e-6
    assert found.sel(h=slice("1 um", "1 mm")).h.values.tolist() == [3e-6, 1e-4]
    with pytest.raises(ValueError, match='h = "3 N" is a force'):
        found.sel(h="3 N")
    with pytest.raises(ValueError, match='h = "3" has no unit'):
        found.sel(h="3")


def test_results_survive_a_file(tmp_path):
    quiet(**COATED, P=["1 N", "10 N"], x=3).to_netcdf(tmp_path / "scene.nc")
    with xr.open_dataset(tmp_path / "scene.nc") as again:
        assert again.sel(P=10.0).a.attrs["units"] == "m" and float(again.R) == R


def test_quantities_of_pint_and_arrays_with_units():
    import pint

    unit = pint.UnitRegistry()
    loads = xr.DataArray([1.0, 10.0], dims="load", attrs={"units": "N"})
    texts = quiet(**COATED, P=["1 N", "10 N"], x=2)
    for given in ({"P": unit.Quantity([1.0, 10.0], "N")}, {"P": loads}, {"P": [unit.Quantity(1, "N"), "10 N"]}):
        np.testing.assert_allclose(quiet(**COATED, **given, x=2).a.values, texts.a.values, rtol=1e-12)


def test_cases_with_units():
    rows = [{"label": "thin", "h": "2 um", "E1": "200 GPa"}, {"label": "soft", "h": "20 um", "E1": "0.5 GPa"}]
    common = {name: value for name, value in COATED.items() if name not in ("h", "E1")}
    found = quiet(cases=rows, **common, P="10 N", x=2)
    assert found.label.values.tolist() == ["thin", "soft"] and found.h.values.tolist() == [2e-6, 2e-5]
    np.testing.assert_allclose(found.a[0], quiet(**COATED, P="10 N", x=2).a, rtol=1e-12)
    with pytest.raises(study.StudyError, match="h must be given in every case, or once for all"):
        study.solve(cases=[rows[0], {"E1": "1 GPa", "label": "x"}], **common, P="10 N")


@pytest.mark.parametrize("layer", [{"E1": "200 GPa", "nu1": 0.2}, {"layer": "DLC a-C:H"}])
def test_a_case_without_a_layer_needs_none(layer):
    """The same numbers as each alone. A layer without a thickness is asked for one."""
    common = {"R": "5 mm", "E_punch": "210 GPa", "body": "steel 52100", "P": "10 N", "micro": "smooth", "x": 2}
    bare, coated = {"base": "half_space"}, {"base": "layered", "h": "2 um", "bonding": "bonded"} | layer
    found = quiet(cases=[bare, coated], **common)
    alone = [quiet(**common, **case).D.item() for case in (bare, coated)]
    np.testing.assert_allclose(found.D, alone, rtol=1e-12)
    n = {"n": 2.0, "h": "2 um", "bonding": "bonded"}
    assert np.isnan(quiet(cases=[bare, n], **common).n).values.tolist() == [True, False]
    unsaid = quiet(cases=[bare, {name: coated[name] for name in coated if name != "base"}], **common)
    np.testing.assert_array_equal(unsaid.D, found.D)
    with pytest.raises(study.StudyError) as caught:
        study.solve(cases=[coated, {"base": "layered", "bonding": "bonded"} | layer], **common)
    assert caught.value.messages == ("solve: h must be given in every case, or once for all",)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([{"h": "2 um"}, {"h": "3 um"}, {"h": "2000 nm"}], "cases 0 and 2 are the same"),
        ([{"layer": "PTFE"}, {"layer": "PEEK"}, {"layer": "PTFE"}], "cases 0 and 2 are the same"),
        ([{"h": "2 um", "label": "x"}, {"h": "3 um", "label": "x"}], 'label[0] and label[1] are both "x": values of'),
        ([{"h": "2 um", "label": "x"}, {"h": "3 um", "label": 3}], "[[cases]] label: must be text"),
    ],
)
def test_cases_that_cannot_be_told_apart(rows, message):
    """As without units, whatever the units are."""
    replaced = ("E1", "nu1") if "layer" in rows[0] else rows[0]
    common = {name: value for name, value in COATED.items() if name not in replaced}
    with pytest.raises(study.StudyError, match=re.escape(message)):
        study.solve(cases=rows, **common, P="10 N")


def test_cases_that_differ_in_a_spread_are_two():
    rows = [{"E1": "200 ± 10 GPa"}, {"E1": "200 ± 20 GPa"}]
    common = {name: value for name, value in COATED.items() if name != "E1"}
    assert quiet(cases=rows, **common, P="10 N", x=2).sizes["case"] == 2


def test_a_steel_ball_on_dlc_on_steel():
    """The layer hardly counts for a: Hertz with two steels. A rigid ball leaves one out; a is then 21 % too small."""
    ball = {"E_punch": "210 GPa", "nu_punch": 0.3}
    found = quiet(**COATED | ball, P="10 N", x=2)
    steels = np.cbrt(0.75 * 10 * R / (E2_STAR / 2))
    assert found.a.item() == pytest.approx(steels, rel=0.03)
    assert quiet(**COATED, P="10 N", x=2).a.item() == pytest.approx(0.79 * steels, rel=0.03)
    inside = {"h": 2e-6 / R, "n": E1_STAR / E2_STAR, "m": E1_STAR / E2_STAR, "nu1": 0.25, "micro": "smooth"}
    assert found.a.item() / R == pytest.approx(study.solve(P=10 / (E2_STAR * R**2), **inside, x=2).a.item(), rel=1e-12)


@pytest.mark.parametrize("base", ["half_space", ["layered", "half_space"]], ids=str)
def test_without_a_layer_the_punch_is_compared_with_the_body(base):
    """Also where E1 is given, for the other cases: m is E2*/E3* there."""
    given = COATED | {"base": base, "E1": "1 GPa", "E_punch": "70 GPa", "nu_punch": 0.2}
    found = quiet(**given, P="1 N", x=2)
    alone = found.sel(base="half_space") if isinstance(base, list) else found
    both = 1 / (1 / E2_STAR + (1 - 0.2**2) / 70e9)
    np.testing.assert_allclose(alone.a, np.cbrt(0.75 * R / both), rtol=1e-12)


def test_a_ratio_of_moduli_in_place_of_the_layer():
    given = {name: value for name, value in COATED.items() if name != "E1"} | {"E_punch": "210 GPa", "P": "1 N", "x": 2}
    several = quiet(**given, n=[0.5, 2.0])
    for n in (0.5, 2.0):
        np.testing.assert_allclose(several.a.sel(n=n), quiet(**given, n=n).a, rtol=1e-12)
    np.testing.assert_allclose(several.m, [0.5, 2.0], rtol=1e-12)


def test_laws_of_others_have_units_as_well():
    from laws import cones

    given = {"R": "1 mm", "E2": "200 GPa", "base": "half_space", "Nbar": "10 1/mm^2", "P": "1 N", "x": 2}
    found = quiet(**given, micro=cones.CONES, alpha=1.3)
    assert found.status == 0 and found.alpha == 1.3 and found.Nbar == pytest.approx(1e7, rel=1e-15)


def test_results_are_not_made_physical_twice():
    found = quiet(**COATED, P="10 N", x=2)
    with pytest.raises(ValueError, match="in physical units already"):
        study.to_physical(found, R=R, E2_star=E2_STAR)


def test_spreads_of_hertz():
    """a = (3 P R/(4 E*))^(1/3): its relative spread is a third of the root of the sum of squares, D's two thirds of
    those of P and E* and a third of that of R."""
    given = {"R": "5 mm ± 2 %", "E2": "210 GPa ± 10 GPa", "P": "10 N ± 0.3 N", "base": "half_space", "micro": "smooth"}
    found = quiet(**given, x=2)
    P, R, E = 0.03, 0.02, 10 / 210
    np.testing.assert_allclose(found.a_spread / found.a, np.hypot(P, np.hypot(R, E)) / 3, rtol=1e-7)
    np.testing.assert_allclose(found.D_spread / found.D, np.sqrt((2 * P) ** 2 + R**2 + (2 * E) ** 2) / 3, rtol=1e-7)
    assert found.P == 10.0 and found.sizes == {"x": 2}


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_spreads_where_the_base_auto_changes_its_model():
    """The step between two models was taken for a derivative: at the change the spread of a was 23 times too large."""
    soft = {"R": "5 mm", "E1": "1 GPa", "E2": "200 GPa", "nu1": 0.3, "nu2": 0.3, "P": "1 N", "Nbar": "4 1/um^2"}
    soft |= {"Ra": "2 um", "profiles": False}
    auto = {"base": "auto", "accuracy": 0.05}
    low, high = 3.0, 6.0  # um, of h: the thin layer, and the exact one
    for _ in range(16):
        h = (low * high) ** 0.5
        thin = study.decode(study.solve(**soft, **auto, h=f"{h} um").model_used) == "thin_layer"
        low, high = (h, high) if thin else (low, h)
    assert 3.0 < low < high < 6.0
    for h in (low, high):
        found, exact = (study.solve(**soft, **base, h=f"{h} um ± 0.5 %") for base in (auto, {"base": "layered"}))
        for name in ("a", "D", "p0", "p_max", "Ar_An"):  # the thin layer's own derivatives err by more than its numbers
            assert float(found[f"{name}_spread"] / exact[f"{name}_spread"]) == pytest.approx(1, abs=0.1), name


def of_rows(values: list, units: str) -> xr.DataArray:
    return xr.DataArray(values, dims="row", attrs={"units": units})


def test_series_of_pandas_and_percent():
    pandas = pytest.importorskip("pandas")
    found = quiet(**COATED | {"nu2": of_rows([30.0], "percent")}, P=pandas.Series(["1 N", "10 N"]), x=2)
    assert found.P.values.tolist() == [1.0, 10.0] and found.nu2.values.tolist() == [0.3]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"h": 2e-6}, 'h = 2e-06 has no unit: must be a length, such as "2 mm"'),
        ({"h": "2 N"}, 'h = "2 N" is a force: must be a length'),
        ({"h": ["2 um", "3"]}, r'h\[1\] = "3" has no unit'),
        ({"h": []}, "h is empty"),
        ({"P": "10 Pa"}, 'P = "10 Pa" is a pressure: must be a force'),
        ({"nu1": "0.3 m"}, 'nu1 = "0.3 m" is a length: must be a number without a unit'),
        ({"R": None}, "R is missing: the radius of the punch"),
        ({"E2": None}, "E2 is missing: Young's modulus of the body"),
        ({"E1": None}, "E1 is missing: Young's modulus of the layer"),
        ({"E1": None, "base": "halfspace"}, '^solve: base = "halfspace": must be one of "half_space", '),
        ({"n": 0.5}, "E1 and n are both given"),
        ({"E_punch": "1 GPa", "m": 0.5}, "E_punch and m are both given"),
        ({"nu_punch": 0.3}, "nu_punch is given without E_punch"),
        ({"nu1": "0.5 ± 0.01"}, "with its spread it must be in"),
        ({"P": [1, "2 N"]}, r"P\[0\] = 1 has no unit"),
        ({"nu1": "0.6"}, r"nu1 = 0.6: must be in \(-1, 0.5\]"),
        ({"E2": "-2 GPa"}, "E2 = -2 GPa: must be > 0"),
        ({"E2": "steel 52100"}, 'must be a pressure, such as "2 MPa"; a material is given as body, in place of E2$'),
        ({"E1": "2 mm"}, 'E1 = "2 mm" is a length: must be a pressure, such as "2 MPa"$'),
        ({"hh": "2 um"}, '"hh" is not a parameter; did you mean "h"'),
        ({"R": "5 km", "h": "2 nm"}, r"h = 2 nm: must be in \[5, 5e\+18\] nm, which is \[1e-12, 1e6\] R, R = 5000 m$"),
        ({"h": xr.DataArray([1e-6], dims="film")}, 'the DataArray has no attribute "units"; a length needs one'),
        ({"P": of_rows([1.0, np.nan], "N")}, r"^solve: P\[1\] = nan N: must be a number$"),
        ({"E2": of_rows([1.0, -2.0], "GPa")}, r"^solve: E2\[1\] = -2 GPa: must be > 0$"),
        ({"nu2": of_rows([0.3], "N")}, 'nu2 = "1 N" is a force: must be a number without a unit'),
        ({"nu2": of_rows([0.2, 0.7], "1")}, r"^solve: nu2\[1\] = 0.7: must be in"),
        ({"nu2": 1}, r"^solve: nu2 = 1: must be in \(-1, 0.5\]$"),
        *(({"cases": rows}, "^cases must be a list of dictionaries, at least one$") for rows in ([], "x", {}, [3])),
        ({"cases": pd.DataFrame({"h": ["2 um"]}), "h": None}, r"cases=table.to_dict\("),
    ],
)
def test_slips_are_named(change, message):
    given = {name: value for name, value in (COATED | {"P": "10 N"} | change).items() if value is not None}
    with pytest.raises(study.StudyError, match=message):
        study.solve(**given)


def test_what_is_beyond_the_model_is_said_once():
    with pytest.warns(UserWarning, match="The strain is not small") as said:
        study.solve(**COATED | {"E1": "10 MPa"}, P="10 N", x=2)
    assert len(said) == 1
    with pytest.warns(UserWarning, match="roughness Ra of ISO"):
        study.solve(**COATED | {"micro": "disc_cell"}, Nbar="400 1/mm^2", Ra="1.0 um", P="10 N", x=2)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        study.solve(**COATED, P="10 N", x=2)
        study.solve(P=1e-2, n=1e-3, h=1e-3, micro="smooth", x=2)  # dimensionless: `validity` says it


def test_the_poisson_ratio_of_a_punch_of_which_none_is_given_is_in_the_results():
    given = COATED | {"E_punch": "210 GPa", "P": "10 N", "x": 2}
    found, said = quiet(**given), quiet(**given, nu_punch=0.3)
    assert found.nu_punch == 0.3 and found.a == said.a
    assert study.summary(found) == study.summary(said).replace("nu_punch = 0.3", "nu_punch = 0.3 (assumed)")

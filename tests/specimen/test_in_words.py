"""A contact in words: every number of the text is that of the dataset, and every doubt is said."""

import re
import warnings

import numpy as np
import pytest
from test_physical import COATED, quiet

import study
from study.data.derived import ASSUMPTIONS
from study.in_words import BROKEN, MODELS, MOST_CASES


def test_a_physical_contact():
    found = quiet(**COATED | {"h": "2 um ± 0.1 um"}, P="10 N", x=2)
    text = study.summary(found)
    assert "R = 5 mm, E1 = 200 GPa, nu1 = 0.25, E2 = 210 GPa, nu2 = 0.3, h = 2.00 ± 0.10 µm, frictionless" in text
    assert "Given: a rigid punch (assumed), R" in text
    number, spread = re.search(r"a +=? *= ([\d.]+) ± ([\d.]+) µm", text).groups()
    assert float(number) == pytest.approx(found.a.item() * 1e6, rel=1e-4)
    assert float(spread) == pytest.approx(found.a_spread.item() * 1e6, rel=0.06), "two digits"
    assert re.search(r"P += 10 N", text)
    assert "Model: the exact layered half-space, without asperities." in text
    assert "None of the assumptions that are checked is violated" in text
    assert "h = 2.00 ± 0.10 µm" in text, "the spread of the input"
    assert "pmax" not in text and repr(text) == str(text)


def test_what_was_not_given_is_said_where_it_counts():
    given = {"R": "5 mm", "E1": "200 GPa", "h": "2 um", "micro": "smooth", "P": "1 N", "x": 2}
    text = study.summary(quiet(**given, E2="210 GPa", E_punch="70 GPa"))
    for name in ("nu1 = 0.3", "nu2 = 0.3", "nu_punch = 0.3", "frictionless"):
        assert f"{name} (assumed)" in text
    text = study.summary(quiet(**given, nu1=0.3, punch="rigid", body="rigid", bonding="frictionless"))
    assert "Given: a rigid punch, a rigid base" in text
    assert "nu1 = 0.3, h = 2 µm, frictionless\n" in text and "assumed" not in text
    half_space = study.summary(
        quiet(R="5 mm", E2="70 GPa", nu2=0.3, punch="rigid", base="half_space", micro="smooth", P="1 N")
    )
    assert "assumed" not in half_space


def test_an_assumption_that_may_be_far_off_has_a_sentence():
    """Bonded, and of rubber, this film carries 2.8 times what it does by the two defaults."""
    film = {"R": "3 mm", "E1": "20 MPa", "E2": "210 GPa", "nu2": 0.3, "h": "50 um", "a": "0.2 mm", "micro": "smooth"}
    found = quiet(**film)
    text = study.summary(found).splitlines()[-2:]
    assert text[0].startswith("Assumed: The layer slides on the body without friction, since bonding is not given.")
    assert text[1] == "Assumed: nu1 = 0.3. Of rubbers and gels, as soft as this, it is nearly 0.5."
    said = quiet(**film, nu1=0.495, bonding="bonded")
    assert "Assumed" not in study.summary(said) and said.P > 2.7 * found.P
    gel = quiet(R="3 um", E2="2 kPa", nu2=0.5, E_punch="1 kPa", base="half_space", micro="smooth", P="1 pN")
    assert study.summary(gel).splitlines()[-1].startswith("Assumed: nu_punch = 0.3. Of rubbers")


def test_what_is_given_and_not_used_is_said():
    rough = {"Nbar": "2 1/um^2", "Ra": "10 um", "sigma": "10 nm"}
    text = study.summary(quiet(**COATED | rough, P="10 N", x=2))
    assert "\nNot used: Nbar = 2 1/µm², Ra = 10 µm, sigma = 10 nm\n\n" in text
    text = study.summary(quiet(**COATED | rough | {"micro": "disc_cell"}, P="10 N", x=2))
    assert "Ra = 10 µm\nNot used: sigma = 10 nm\n\n" in text
    text = study.summary(quiet(**COATED | {"base": "half_space"}, P="10 N", x=2))
    assert "\nNot used: E1 = 200 GPa, h = 2 µm\n\n" in text
    both = study.solve(P=1e-5, h=0.02, n=0.5, micro=["smooth", "power_law"], Nbar=250000, Ra=0.004, x=2)
    said = [part.count("Not used") for part in study.summary(both).split("---")]
    assert said == [0, 1, 0], "those of power_law are used, B and beta are fitted to them"


def test_the_model_error_is_in_the_plus_minus():
    found = quiet(**COATED | {"base": "thin_layer"}, P="10 N", x=2)
    text = study.summary(found)
    spread = re.search(r"p\(0\) += [\d.]+ ± ([\d.]+) (\w+)", text)
    size = {"GPa": 1e9, "MPa": 1e6}[spread[2]]
    total = found.p0 * np.hypot(found.error, found.model_error)
    assert float(spread[1]) * size == pytest.approx(total.item(), rel=0.06)
    assert f"contact it errs by about {100 * found.model_error.item():.2g} %" in text


def test_solved_names_what_error_judges():
    """The six of docs/model.md, of a smooth contact those that are shown, and never dP/dD."""
    smooth = study.summary(study.solve(P=1e-5, base="half_space", micro="smooth", x=2))
    assert re.search(r"^Solved: P, a, D and p\(0\) are within a relative \S+ of the model's solution\.$", smooth, re.M)
    rough = study.summary(study.solve(P=1e-5, base="half_space", Nbar=250000, Ra=0.004, x=2))
    assert "\nSolved: P, a, D, p(0), pmax and Ar/An are within a relative " in rough


def test_an_elastic_punch_is_no_rigid_one():
    text = study.summary(quiet(**COATED, E_punch="210 GPa", nu_punch=0.3, P="10 N", x=2))
    assert "rigid" not in text and "E_punch = 210 GPa, nu_punch = 0.3" in text and " m = " not in text
    spread = study.summary(quiet(**COATED | {"E1": "200 ± 20 GPa"}, E_punch="210 GPa", P="10 N", x=2))
    assert "rigid" not in spread


def test_a_spread_that_is_not_known_is_no_certainty():
    found = quiet(**COATED | {"h": "2 um ± 0.1 um"}, P="10 N", x=2)
    text = study.summary(found.assign(a_spread=found.a_spread * np.nan))
    assert re.search(r"a +=? *= [\d.]+ µm ± unknown", text) and text.count("unknown") == 1


def test_a_dimensionless_contact_and_a_failed_one():
    found = study.solve(P=1e-5, h=0.02, n=0.5, Nbar=250000, Ra=0.004, x=2)
    text = study.summary(found)
    assert f"= {found.a.item():.5g} R" in text and f"= {found.p_max.item():.5g} E2*" in text
    failed = study.solve(P=1e-5, h=0.02, n=0.5, nu1=0.5, bonding="bonded", base="thin_layer", micro="smooth", x=2)
    text = study.summary(failed)
    assert "NOT SOLVED (thin_layer_not_applicable): the thin-layer equation does not apply" in text
    assert "unknown" in text and "holds" not in text


def test_grids_are_written_out_and_long_ones_are_cut():
    text = study.summary(quiet(**COATED, P=["1 N", "10 N"], x=2))
    assert text.count("Given:") == 2 and "--- P = 1 N" in text and "--- P = 10 N" in text
    long = study.solve(P=np.linspace(1e-6, 1e-5, MOST_CASES + 5), base="half_space", micro="smooth", x=2)
    assert "--- and 5 more cases" in study.summary(long)
    with pytest.raises(ValueError, match="this dataset is not one of contacts: it has no status"):
        study.summary(long.drop_vars("status"))


def test_cases_that_xarray_took_out_are_not_there():
    """docs/studies.md shows `contacts.where(contacts.validity == 0)`, which makes all flags floats."""
    found = quiet(**COATED, P=["1 N", "1 MN"], x=2)
    kept = found.where(found.validity == 0)
    assert str(study.summary(kept.isel(P=0))) == study.summary(found.isel(P=0))
    for gone in (kept.isel(P=1), found.reindex(P=[3.0]).isel(P=0)):
        text = study.summary(gone)
        assert "NOT SOLVED (not_run): the case has not been computed." in text and "a      = unknown" in text
        assert "Model" not in text and study.decode(gone.validity).item() == ""
    between = found.isel(P=[0, 0]).assign_coords(P=[1.0, 2.0]).interp(P=1.5)
    assert "Model: the exact layered half-space, without" in study.summary(between)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            {"E2": "210 mPa", "E1": "200 mPa", "P": "1 pN"},
            "E1 = 0.2 Pa: materials have 1 Pa to 2 TPa; is its unit right?",
        ),
        ({"E2": ["210 GPa", "210 TPa"]}, "E2 = 2.1e+05 GPa: materials have"),
        ({"R": "5 Mm", "h": "1 m"}, "R = 5e+06 m: radii of bodies are 0.1 nm to 1 km; is"),
        ({"h": "2 pm"}, "h = 0.002 nm: layers are 0.05 nm to 1 km thick; is"),
        (
            {"micro": "disc_cell", "Nbar": "1 1/um^2", "Ra": "40 nm"},
            "Ra = 40 nm is small for Nbar = 1 1/µm²: the asperities",
        ),
        ({"h": ["2 um", "1 ± 2 um"]}, "h = 1.0 ± 2.0 µm: too wide a spread for the ± of results"),
        ({"R": None, "R1": "10 ± 1 mm", "R2": ["-30 mm", "-11 mm"]}, "R1 = 10.0 ± 1.0 mm: too wide a spread"),
    ],
)
def test_slips_of_a_prefix_are_noticed(change, sentence):
    """mPa for MPa, Mm for mm: the right kind of unit, and a contact that can be solved."""
    with pytest.warns(UserWarning) as warned:
        given = COATED | {"P": "10 N", "x": 2} | change
        found = study.solve(**{name: value for name, value in given.items() if value is not None})
    assert sentence in str(warned[0].message)
    assert f"Beware: {sentence}" in study.summary(found)


def test_no_real_system_is_absurd():
    softest = {"R": "2.5 um", "E1": "20 Pa", "nu1": 0.5, "E2": "rigid", "h": "2 um", "D": "5 nm", "bonding": "bonded"}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        study.solve(**softest, E_punch="1.2 TPa", micro="smooth", x=2)
        study.solve(R="6 m", E1="1 MPa", E2="210 GPa", h="1 m", P="1 N", micro="smooth", x=2)


def test_a_spread_of_nu_that_reaches_one_half_is_too_wide():
    """A bonded layer yields far less near 0.5, and beyond it there is none: ± of the results was too large."""
    film = {"R": "3 mm", "E1": "5 MPa", "E2": "rigid", "h": "100 um", "bonding": "bonded", "micro": "smooth"}
    for nu1, wide in (("0.49 ± 0.02", True), ("0.49 ± 0.005", False), ("0.0 ± 0.05", False), ("-0.2 ± 0.3", False)):
        text = study.summary(quiet(**film, nu1=nu1, P="1 mN", x=2))
        assert ("Beware: nu1 = 0.490 ± 0.020: too wide a spread" in text) == wide == ("too wide" in text)


STEEL = {"R": "5 mm", "punch": "steel 52100", "body": "steel 52100", "micro": "smooth", "x": 2}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            {"layer": "DLC a-C:H", "h": "2 um", "P": ["10 N", "10 kN"]},
            "1 of 2 cases: The pressure on the layer comes to 0.05 of",
        ),
        ({"base": "half_space", "punch": "PEEK", "P": "10 MN"}, "on the body comes to 0.055 of"),
        ({"base": "half_space", "body": "alumina", "R": "0.1 mm", "P": "10 N"}, "on the punch comes to 0.078 of"),
        (
            {"layer": "diamond", "h": "1 um", "R": "0.1 mm", "P": "10 N", "punch": "rigid"},
            "on the body comes to 0.1 of",
        ),
        (
            {"base": "half_space", "micro": "disc_cell", "Nbar": "0.1 1/um^2", "Ra": "2 um", "P": "10 N"},
            "comes to 0.087 of",
        ),
        ({"layer": "diamond", "h": "1 mm", "R": "0.1 mm", "P": "0.1 N", "punch": "rigid"}, ""),
        ({"layer": "DLC a-C:H", "h": "2 um", "P": "100 N"}, ""),
        ({"layer": "PTFE", "h": "0.2 mm", "P": "50 N"}, ""),
    ],
)
def test_pressures_at_which_metals_yield_are_noticed(change, sentence):
    """A steel ball under 10 kN had 10 GPa and no warning. Plastics and what lies deep under a hard layer have none."""
    found = quiet(**STEEL | change)
    said = [line for line in study.summary(found).splitlines() if "metals yield" in line]
    assert [sentence.split(": ")[-1] in line for line in said] == [True] * bool(sentence)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        study.solve(**STEEL | change)
    assert any("metals yield" in str(one.message) and sentence in str(one.message) for one in caught) == bool(sentence)


def test_every_flag_and_model_has_its_words():
    assert set(BROKEN) == set(ASSUMPTIONS.values())
    found = study.solve(P=1e-5, base="half_space", micro="smooth", x=2)
    assert set(MODELS) == set(found.model_used.attrs["flag_meanings"].split()) - {"none"}


def test_the_micro_law_and_its_own_error():
    found = study.solve(
        P=1e-5,
        h=0.02,
        n=0.5,
        Nbar=250_000,
        Ra=0.004,
        sigma=1e-6,
        micro=["square_lattice", "normal_heights", "disc_cell"],
    )
    lattice, heights, disc = (study.summary(found.isel(micro=i)) for i in (0, 1, 2))
    assert "frictionless, square lattice, Nbar" in lattice and "Not used: sigma" in lattice
    assert "the micro law itself errs by about 0.02 %" in lattice and "exact layered contact" not in lattice
    assert "sigma = 1e-06 R, cut = 4" in heights and "the micro law itself errs by about 0.02 %" in heights
    assert "itself errs" not in disc


def test_a_parameter_that_no_case_has_is_no_coordinate():
    assert "cut" not in study.solve(P=1e-5, h=0.02, n=0.5, Nbar=250_000, Ra=0.004, x=2).coords


def test_stacked_cases_and_lost_attributes():
    """A MultiIndex was a TypeError, and lost attributes a KeyError."""
    grid = quiet(**COATED, P=["1 N", "10 N"], x=2)
    assert "P      = 10 N" in study.summary(grid.assign_coords(nu1=grid.nu1).stack(case=["P"]))
    with pytest.raises(ValueError, match="status has lost its attributes"):
        study.summary(grid.drop_attrs())


def test_inputs_that_xarray_has_made_variables_or_dropped():
    """All inputs were said to be not used, and a missing one was a KeyError."""
    one = quiet(**COATED, P="1 N", x=2)
    assert str(study.summary(one.reset_coords())) == study.summary(one)
    with pytest.raises(ValueError, match="not one of contacts: it has no micro"):
        study.summary(one.drop_vars("micro"))

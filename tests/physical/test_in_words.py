"""A contact in words: every number of the text is that of the dataset, and every doubt is said."""

import re

import numpy as np
import pytest
from test_physical import COATED, quiet

import study
from study.data.contacts import Contacts
from study.data.derived import ASSUMPTIONS
from study.in_words import MODELS, MOST_CASES, NOT_VIOLATED
from study.rules.rule import RULES


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
    assert "None of the checked assumptions is violated" in text
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


def test_a_body_is_rigid_only_where_that_is_known():
    """`groupby` leaves out m and n: a steel punch was "a rigid punch", and a rigid base "E2 = infinite"."""
    given = {"R": "5 mm", "layer": ["TiN", "CrN"], "h": "2 um", "micro": "smooth", "P": "1 N", "body": "rigid", "x": 2}
    for punch, words in (("rigid", "a rigid punch, a rigid base, R"), ("steel M2", "a rigid base, R = 5 mm, punch of")):
        found = study.solve(**given, punch=punch).groupby("layer").mean()
        assert f"Given: {words}" in study.summary(found.isel(layer=0)) and "inf" not in study.summary(found)


def test_an_assumption_that_may_be_far_off_has_a_sentence():
    """Bonded, and of rubber, this film carries 2.8 times what it does by the two defaults."""
    film = {"R": "3 mm", "E1": "20 MPa", "E2": "210 GPa", "nu2": 0.3, "h": "50 um", "a": "0.2 mm", "micro": "smooth"}
    found = quiet(**film)
    text = study.summary(found).splitlines()[-2:]
    assert text[0].startswith("Assumed: The layer slides on the body without friction because bonding is not given.")
    assert text[1] == "Assumed: nu1 = 0.3. Rubbers and gels, as soft as this, have nearly 0.5."
    said = quiet(**film, nu1=0.495, bonding="bonded")
    assert "Assumed" not in study.summary(said) and said.P > 2.7 * found.P
    gel = quiet(R="3 um", E2="2 kPa", nu2=0.5, E_punch="1 kPa", base="half_space", micro="smooth", P="1 pN")
    assert study.summary(gel).splitlines()[-1].startswith("Assumed: nu_punch = 0.3. Rubbers")


def test_what_is_given_and_not_used_is_said():
    rough = {"Nbar": "2 1/um^2", "Ra": "10 um", "sigma": "10 nm"}
    text = study.summary(quiet(**COATED | rough, P="10 N", x=2))
    assert "\nNot used: Nbar = 2 1/µm², Ra = 10 µm, sigma = 10 nm\n\n" in text
    text = study.summary(quiet(**COATED | rough | {"micro": "disc_cell"}, P="10 N", x=2))
    assert "Ra = 10 µm\nNot used: sigma = 10 nm\n\n" in text
    strong = study.summary(quiet(**COATED | rough | {"micro": "disc_cell", "hardness": "20 GPa"}, P="10 N", x=2))
    assert "hardness = 20 GPa\nNot used: sigma = 10 nm\n\n" in strong, "a rule compares with it"
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


def test_plus_minus_is_the_root_of_the_squares_of_all_three():
    """Each of `error`, `model_error` and the spread alone would be seen to miss by far more than two digits round."""
    found = quiet(**COATED | {"h": "2 um ± 0.1 um"}, P="10 N", x=2)
    value, part = found.p0.item(), 0.01
    for sizes in ((1, 1, 1), (3, 4, 0), (0, 3, 4), (3, 0, 4), (2, 0, 0)):
        error, model_error, spread = (part * size for size in sizes)
        known = {"error": error, "model_error": model_error, "p0_spread": spread * value}
        changed = found.assign({name: found[name].copy(data=number) for name, number in known.items()})
        number, unit = re.search(r"p\(0\) += [\d.]+ ± ([\d.]+) (\w+)", study.summary(changed)).groups()
        total = value * np.sqrt(error**2 + model_error**2 + spread**2)
        assert float(number) * {"GPa": 1e9, "MPa": 1e6}[unit] == pytest.approx(total, rel=0.05), sizes


def test_only_of_a_solved_case_nothing_is_said_to_be_violated():
    """Of a failed one it is not known, though `validity` is 0; of one that is not there `validity` is not either."""
    failed = study.solve(P=1e-5, h=0.02, n=0.5, nu1=0.5, bonding="bonded", base="thin_layer", micro="smooth", x=2)
    limited = study.solve(P=1e-5, h=0.02, n=0.5, Nbar=1e6, Ra=0.004, scheme="picard", max_iterations=2, x=2)
    gone = study.solve(P=[1e-5], base="half_space", micro="smooth", x=2).reindex(P=[2e-5]).isel(P=0)
    for found, validity in ((failed, ""), (limited, ""), (gone, "not_run")):
        assert study.decode(found.status) != "converged" and study.decode(found.validity) == validity
        assert NOT_VIOLATED not in study.summary(found) and "Not checked" not in study.summary(found)
    solved = study.solve(P=1e-5, base="half_space", micro="smooth", x=2)
    assert NOT_VIOLATED in study.summary(solved)


def test_against_what_the_model_errs():
    """On a half-space there is no layer to err against: what is left is the law's own error."""
    rough = {"P": 1e-5, "Nbar": 250_000, "Ra": 0.004, "x": 2}
    for base in ("half_space", "layered"):
        text = study.summary(study.solve(**rough, h=0.02, n=0.5, base=base, micro="square_lattice"))
        assert "; the micro law itself errs by about 0.02 %." in text and "against the exact layer" not in text
    for micro in ("disc_cell", "smooth"):
        text = study.summary(study.solve(**rough, h=0.01, n=0.5, base="thin_layer", micro=micro))
        assert "; against the exact layered contact it errs by about " in text and "itself errs" not in text
        bare = study.summary(study.solve(**rough, base="half_space", micro=micro))
        assert "errs" not in bare


def test_solved_names_what_error_judges():
    """The six of docs/model.md, of a smooth contact those that are shown, and never dP/dD."""
    smooth = study.summary(study.solve(P=1e-5, base="half_space", micro="smooth", x=2))
    assert re.search(r"^Solved: the estimated relative error of P, a, D and p\(0\) is \S+\.$", smooth, re.M)
    rough = study.summary(study.solve(P=1e-5, base="half_space", Nbar=250000, Ra=0.004, x=2))
    assert "\nSolved: the estimated relative error of P, a, D, p(0), pmax and Ar/An is " in rough


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
    with pytest.raises(
        ValueError, match="summary takes what study.solve, fit, design or a function of stresses gives, not int"
    ):
        study.summary(3)
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
        assert "Model" not in text and study.decode(gone.validity).item() == "not_run"
    between = found.isel(P=[0, 0]).assign_coords(P=[1.0, 2.0]).interp(P=1.5)
    assert "Model: the exact layered half-space, without" in study.summary(between)


def test_every_flag_and_model_has_its_words():
    assert all(RULES[name].sentence and RULES[name].mask == mask for mask, name in ASSUMPTIONS.items())
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
    assert "rc.roughness.law(scan)" in heights and "roughness.law" not in lattice + disc


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
    without = [line for line in study.summary(one).splitlines() if not line.startswith(("Strength", "Not checked"))]
    said = str(study.summary(one.reset_coords())).splitlines()
    assert [line for line in said if not line.startswith("Not checked")] == without, (
        "solved again from coordinates alone"
    )
    with pytest.raises(ValueError, match="not one of contacts: it has no micro"):
        study.summary(one.drop_vars("micro"))


def test_a_contact_is_read_once_for_its_summary(monkeypatch):
    """The sentences on spreads and on strengths, which solve it again, share its problem."""
    found = study.solve(R="5 mm", punch="steel 52100", layer="TiN", h="3 um", bonding="bonded", body="steel 52100",
                        P="10 N", micro="smooth")  # fmt: skip
    read, times = Contacts.of.__func__, []
    monkeypatch.setattr(Contacts, "of", classmethod(lambda cls, *given: times.append(given[1]) or read(cls, *given)))
    text = study.summary(found)
    assert "of the variance" in text and "yield at about" in text and times == ["summary"]

"""Rigid bases and two radii in physical scenes, and a rigid base in dimensionless studies."""

import warnings

import numpy as np
import pytest
import xarray as xr

import study

pytest.importorskip("pint")
FILM = {"R": "5 um", "E1": "5 kPa", "nu1": 0.5, "h": "2 um", "bonding": "bonded", "micro": "smooth"}


def quiet(**given) -> xr.Dataset:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return study.solve(**given, x=2)


def test_a_rigid_base_is_the_limit_of_stiff_ones():
    """Glass under a gel is rigid to E1*/E2*, 1e-7; n = 0 in units of E1* is the same contact."""
    rigid, glass = quiet(**FILM, E2="rigid", P="1 nN"), quiet(**FILM, E2="70 GPa", P="1 nN")
    np.testing.assert_allclose(rigid.a, glass.a, rtol=1e-6)
    E1_star = 5e3 / 0.75
    given = {"h": 0.4, "n": 0, "nu1": 0.5, "bonding": "bonded", "micro": "smooth"}
    inside = study.solve(P=1e-9 / (E1_star * 25e-12), **given, x=2)
    np.testing.assert_allclose(rigid.p0, inside.p0 * E1_star, rtol=1e-12)
    assert np.isinf(rigid.E2) and rigid.n == 0 and inside.p0.attrs["scale"] == "E1*"
    assert study.derived.mean_pressure(inside).attrs["scale"] == "E1*"
    text = study.summary(rigid)
    assert (
        "a rigid punch (assumed), a rigid base, R = 5 µm, E1 = 5 kPa" in text and "E2" not in text and "nu2" not in text
    )


@pytest.mark.parametrize("word", ["rigid", "Rigid", "inf", "infinite", np.inf])
def test_words_for_rigid(word):
    assert np.isinf(quiet(**FILM, E2=word, P="1 nN").E2)
    found = quiet(**FILM, body=word, P="1 nN")
    assert np.isinf(found.E2) and found.body == "rigid"


def test_rigid_bases_among_others_and_rigid_punches():
    """In SI units there is no doubt about the unit of moduli, so that both may be on one axis."""
    several = quiet(**FILM, E2=["rigid", "10 kPa"], E_punch=["1 GPa", "rigid"], P="1 nN")
    for E2 in ("rigid", "10 kPa"):
        for E_punch in ("1 GPa", "rigid"):
            alone = quiet(**FILM, E2=E2, E_punch=E_punch, P="1 nN")
            np.testing.assert_allclose(several.D.sel(E2=E2, E_punch=E_punch), alone.D, rtol=1e-12)


def test_dimensionless_numbers_of_two_units_do_not_mix():
    given = {"P": 1e-5, "h": 0.01, "micro": "smooth"}
    with pytest.raises(study.StudyError, match="n = 0, a rigid base, is among other values: its numbers are in E1"):
        study.solve(**given, n=[0, 0.5])
    both = study.solve(**given, n=0, base=["layered", "half_space"], x=2)
    np.testing.assert_allclose(both.a.sel(base="half_space"), np.cbrt(0.75e-5), rtol=1e-12)
    with pytest.raises(study.StudyError, match=r"n = 1e-10: must be 0 or in \[1e-9, 1e9\]"):
        study.solve(**given, n=1e-10)


def test_effective_radii():
    """Hertz depends on 1/R1 + 1/R2 alone; a spread of a radius goes through it."""
    given = {"E2": "210 GPa", "P": "10 N", "base": "half_space", "micro": "smooth"}
    cup = quiet(**given, R1="10 mm", R2=["-20 mm", "10 mm", "-10.1 mm"])
    np.testing.assert_allclose(cup.R, [20e-3, 5e-3, 1.01], rtol=1e-12)
    for R, text in (("20 mm", "-20 mm"), ("5 mm", "10 mm")):
        np.testing.assert_allclose(cup.a.sel(R2=text), quiet(**given, R=R).a, rtol=1e-12)
    assert "R1 = 10 mm, R2 = -20 mm" in study.summary(cup.isel(R2=0))
    spread = quiet(**given, R1="10 mm ± 1 mm", R2="-20 mm")
    # a ~ R^(1/3), dR/R = R dR1/R1²; the step of a tenth of the spread leaves (0.1 · 0.2)²
    np.testing.assert_allclose(spread.a_spread / spread.a, 0.2 / 3, rtol=1e-3)


@pytest.mark.parametrize("flat", ["flat", "inf", np.inf])
def test_a_flat_body_has_an_infinite_radius(flat, tmp_path):
    given = {"E2": "210 GPa", "P": "10 N", "base": "half_space", "micro": "smooth"}
    found = quiet(**given, R1=flat, R2=["5 mm", "6 mm"])
    np.testing.assert_array_equal(found.a, quiet(**given, R=["5 mm", "6 mm"]).a)
    assert "Given: a rigid punch (assumed), R1 = infinite, R2 = 5 mm" in study.summary(found.isel(R2=0))
    found.to_netcdf(tmp_path / "flat.nc")
    with xr.open_dataset(tmp_path / "flat.nc") as back:
        assert np.isinf(back.R1)
    with pytest.raises(study.StudyError, match=r"R1 = inf m, R2 = inf m: 1/R1 \+ 1/R2 must be > 0"):
        study.solve(**given, R1=flat, R2="flat")


def test_a_cup_that_fits_closely_is_beyond_the_model():
    """a = 4.1 mm of a ball of 10 mm, though only 0.004 of the effective radius: mask 32 does not see it."""
    given = {"R1": "10 mm", "E2": "1 GPa", "base": "half_space", "micro": "smooth", "P": "100 N"}
    with pytest.warns(UserWarning, match=r"wide compared with the smaller body \(a > 0.2 of its radius\), as in a cup"):
        found = study.solve(**given, R2=["-20 mm", "-10.1 mm"], x=2)
    np.testing.assert_allclose(found.a[1], np.cbrt(0.75 * 100 * 1.01 * 0.91e-9), rtol=1e-6)  # Hertz
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        study.solve(**given | {"P": "1 N"}, R2="-20 mm", x=2)
    assert "wide compared with" in study.summary(found.isel(R2=1)) and "wide" not in study.summary(found.isel(R2=0))


@pytest.mark.parametrize(
    ("radii", "a", "mask"),
    [
        ({"R1": "10 mm", "R2": "-10.1 mm"}, "2.01 mm", 256),
        ({"R1": "10 mm", "R2": "-10.1 mm"}, "1.99 mm", 0),
        ({"R1": "-10.1 mm", "R2": "10 mm"}, "2.01 mm", 256),
        ({"R1": "10 mm", "R2": "-10.0 ± 0.01 mm"}, "1.99 mm", None),  # no cup
        ({"R1": "10 mm", "R2": "-10.1 ± 0.01 mm"}, "2.01 mm", 256),
        ({"R1": "flat", "R2": "10 mm"}, "2.01 mm", 32 | 256),
        ({"R1": "10 mm", "R2": "10 mm"}, "1.99 mm", 32),
        ({"R1": "10 mm", "R2": "10 mm"}, "2.01 mm", 32 | 256),
        ({"R": "1 m"}, "86 mm", 0),
    ],
)
def test_validity_knows_a_close_cup(radii, a, mask):
    given = {"E2": "1 GPa", "base": "half_space", "micro": "smooth", "a": a}
    if mask is None:
        with pytest.raises(study.StudyError, match="a cup"):
            study.solve(**given, **radii)
        return
    assert quiet(**given, **radii).validity == mask


def test_the_mask_of_a_cup_over_axes_and_cases_and_in_a_file(tmp_path):
    """The mask of each case is that of its own two radii; it is in results files and in what a user writes."""
    rows = [{"R2": "-10.1 mm", "a": "86.6 mm"}, {"R2": "-20 mm", "a": "0.1 mm"}]
    given = {"R1": "10 mm", "E2": "1 GPa", "base": "half_space", "micro": "smooth"}
    found = quiet(cases=rows, **given)
    assert found.validity.values.tolist() == [256, 0] and found.validity.dtype == np.int32
    assert study.decode(found.validity).values.tolist() == ["wide_in_cup", ""]
    found.to_netcdf(tmp_path / "user.nc")
    with xr.open_dataset(tmp_path / "user.nc") as back:
        assert study.decode(back.validity).values.tolist() == ["wide_in_cup", ""]
        assert back.validity.dtype == back.validity.flag_masks.dtype == np.int32
    grid = quiet(**given | {"R1": ["10 mm", "12 ± 0.01 mm"]}, R2=["-12.2 mm", "-1 m"], a="2.2 mm")
    assert grid.validity.values.tolist() == [[256, 256 | 32], [0, 0]]
    text = '[model]\nE2 = "1 GPa"\nbase = "half_space"\nmicro = "smooth"\na = "86.6 mm"\n'
    text += '[axes]\nR1 = ["10 mm", "100 m"]\nR2 = ["-1 km", "-101 m"]\n'
    (tmp_path / "cup.toml").write_text(text)
    loaded = study.load(tmp_path / "cup.toml", tmp_path)
    assert loaded.run(workers=1).complete
    assert loaded.open().validity.values.tolist() == [[32 | 256, 32 | 256], [0, 0]]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"E2": "rigid", "base": "half_space"},
            'E2 is rigid and base = "half_space": there is no layer that could deform',
        ),
        ({"E2": "rigid", "E1": None, "n": 0.5}, "E2 is rigid and n is given: give E1"),
        ({"E1": None, "n": 0}, 'n = 0 is a rigid base: give E2 = "rigid" and E1, the modulus of the layer'),
        ({"E1": None, "n": [0.5, 0]}, 'n = 0 is a rigid base: give E2 = "rigid"'),
        ({"E1": None, "n": "0.5"}, 'n = "0.5": must be a finite number'),
        ({"E1": "rigid"}, 'E1 = "rigid": must be a pressure'),
        ({"E2": "rigid ± 1 GPa"}, 'E2 = "rigid ± 1 GPa": must be a pressure'),
        ({"R": None, "R1": "5 mm"}, 'R2 is missing: R1 and R2 go together; of a flat body R2 = "flat"'),
        ({"R1": "5 mm", "R2": "-8 mm"}, "R and R1 are both given"),
        ({"R": None, "R1": "5 mm", "R2": "-4 mm"}, "R1 = 0.005 m, R2 = -0.004 m: 1/R1 .* must be > 0: a cup"),
        ({"R": None, "R1": "5 mm", "R2": ["9 mm", "-5 mm"]}, "a cup .* must be wider than its ball"),
        ({"R": None, "R1": "5 mm", "R2": "0 mm"}, "R2 = 0 mm: must not be 0"),
        ({"R": None}, "R is missing: the radius of the punch, or R1 and R2 of two bodies"),
        ({"micro": None}, r'Ra is missing: micro = "disc_cell" needs it \(without asperities: micro = "smooth"\)$'),
    ],
)
def test_slips_are_named(change, message):
    given = {name: value for name, value in (FILM | {"E2": "1 GPa", "P": "1 nN"} | change).items() if value is not None}
    with pytest.raises(study.StudyError, match=message):
        study.solve(**given)


@pytest.mark.parametrize("place", [0, 1, 2])
@pytest.mark.parametrize("name", ["R1", "R2"])
def test_one_radius_of_0_among_others(name, place):
    radii = ["10 mm", "20 mm", "30 mm"]
    radii[place] = "0 mm"
    given = {"R1": "5 mm", "R2": "6 mm"} | {name: radii}
    with pytest.raises(study.StudyError, match=rf"{name}\[{place}\] = 0 mm: must not be 0"):
        study.solve(**given, P="1 N", E2="210 GPa", base="half_space", micro="smooth", x=2)

"""Shapes in calls and study files: names, angles, units, the unit of length, what is refused, keys, words."""

import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

import study
from study.inputs.definition import from_call
from study.inputs.identity import case_keys
from study.rules.slope_and_adhesion import SLOPE

ALONE = {"base": "half_space", "micro": "smooth"}
GEL = {"E2": "1 MPa", "nu2": 0.3, **ALONE}


@pytest.fixture(autouse=True)
def quiet():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@pytest.fixture
def tip(tmp_path):
    """Write a table of a tip; gives its word."""
    words = []

    def write(text):
        path = tmp_path / f"tip{len(words)}.csv"
        path.write_text(text, encoding="utf-8")
        words.append(f"table:{path}")
        return words[-1]

    return write


def test_words_of_a_shape_are_read_as_people_write_them():
    found = study.solve(P=1e-4, shape=["Berkovich", "cube corner", "Cube-Corner "][:2], **ALONE)
    assert found.shape.values.tolist() == ["berkovich", "cube_corner"]
    cone = study.solve(P=1e-4, shape="cone", half_angle=np.degrees(np.arctan(np.sqrt(24.5 / np.pi))), **ALONE)
    assert_allclose(found.a.values[0], cone.a, rtol=1e-14)


@pytest.mark.parametrize("angle", [70.3, "70.3 deg", "70.3°", f"{np.radians(70.3):.17g} rad"])
def test_an_angle_is_in_degrees(angle):
    """P = (2/pi) E* tan(alpha) D^2. A text with degrees does not make a study with units."""
    found = study.solve(D=0.01, shape="cone", half_angle=angle, **ALONE)
    assert_allclose(found.half_angle, 70.3, rtol=1e-14)
    assert_allclose(found.P, 2 / np.pi * np.tan(np.radians(70.3)) * 1e-4, rtol=1e-12)


def test_an_angle_may_have_a_spread_and_a_unit_of_its_own_in_an_array():
    found = study.solve(D="10 nm", shape="cone", half_angle="70.0 ± 0.5", **GEL)
    assert_allclose((found.half_angle, found.half_angle_spread), (70, 0.5))
    radians = xr.DataArray(np.radians([60.0, 70.0]), dims="cone", attrs={"units": "rad"})
    assert_allclose(study.solve(D=0.01, shape="cone", half_angle=radians, **ALONE).half_angle, [60, 70], rtol=1e-14)


@pytest.mark.parametrize(
    ("given", "scale", "R"),
    [
        ({"shape": "cone", "half_angle": 70}, "1 um", 1e-6),
        ({"shape": "cone", "half_angle": 70, "R": "3 um"}, "R", 3e-6),
        ({"shape": "flat", "flat_radius": "2 mm"}, "flat_radius", 2e-3),
        ({"shape": "blunt_cone", "half_angle": 70, "tip_radius": "0.1 um"}, "tip_radius", 1e-7),
        ({"shape": "frustum", "half_angle": 70, "flat_radius": "1 um"}, "flat_radius", 1e-6),
        ({"shape": "cone", "half_angle": 70, "base": "layered", "h": "4 um", "E1": "2 MPa"}, "h", 4e-6),
    ],
)
def test_the_unit_of_length(given, scale, R):
    """R, or the first of flat_radius, tip_radius, h, or 1 um. Nothing in SI depends on it."""
    found = study.solve(**GEL | {"P": "1 uN"} | given)
    assert found.attrs["scale"] == scale
    assert_allclose(found.R, R, rtol=1e-14)
    other = study.solve(**GEL | {"P": "1 uN", "R": "7 um"} | {k: v for k, v in given.items() if k != "R"})
    for name in ("a", "D", "dP_dD"):
        assert_allclose(found[name], other[name], rtol=1e-7)  # both are solved to 1e-6 at least
    assert study.sensitivities(found).input.values.tolist().count("R") == (scale == "R")


def test_without_units_the_unit_of_length_is_1():
    assert study.solve(D=0.01, shape="cone", half_angle=70, **ALONE).attrs["scale"] == "1"
    assert "scale" not in study.solve(D=0.01, **ALONE).attrs


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"P": 1e-4, "shape": "cone"}, 'half_angle is missing: shape = "cone" needs it'),
        ({"P": 1e-4, "shape": "cone", "half_angle": 90}, r"must be in \(0, 90\)"),
        ({"P": 1e-4, "shape": "cone", "half_angle": "0 deg"}, r"must be in \(0, 90\)"),
        ({"P": 1e-4, "half_angle": 70}, "half_angle is given, and no case has a shape with it"),
        ({"P": 1e-4, "shape": "sphere", "tip_radius": 0.1}, "tip_radius is given, and no case has"),
        ({"a": 0.1, "shape": "flat", "flat_radius": 0.1}, "its contact radius is flat_radius; give P or D"),
        ({"a": [0.5, 1.0], "shape": "sphere"}, "must be below that of the ball"),
        ({"P": 1e-4, "shape": "cylinder"}, "must be one of"),
        ({"P": 1e-4, "shape": "power", "shape_power": 0.5, "shape_coefficient": 1}, r"must be in \[1, 100\]"),
    ],
)
def test_what_is_refused(given, message):
    with pytest.raises(study.StudyError, match=message):
        study.solve(**given, **ALONE)


def test_a_sphere_needs_its_radius():
    with pytest.raises(study.StudyError, match="R is missing"):
        study.solve(P="1 uN", shape="sphere", **GEL)


def test_a_table_with_units(tip):
    """r²/(2R) with R = 2 um, as rows in um and nm: the numbers of the paraboloid, whatever R is."""
    r = np.linspace(0, 1, 11)
    rows = "\n".join(f"{x:.17g},{1e3 * x * x / 4:.17g}" for x in r)
    word = tip("r [um], f [nm]\n" + rows)
    ball = study.solve(P="0.1 uN", R="2 um", **GEL)
    for R in ({}, {"R": "5 um"}):
        found = study.solve(P="0.1 uN", shape=word, **R, **GEL)
        assert_allclose((found.a, found.D, found.P), (ball.a, ball.D, ball.P), rtol=1e-7)
    assert "table_unit" not in study.summary(found)
    with pytest.raises(study.StudyError, match="give the other inputs with units too"):
        study.solve(P=1e-4, shape=word, **ALONE)


def test_a_table_is_read_anew_and_its_numbers_are_in_the_key(tip):
    def keys(word):
        return case_keys(from_call({"P": 1e-4, "shape": word, **ALONE}, [], False, {}).grid)

    first, same = tip("0,0\n1,1\n2,3\n"), tip("# the same\nr,f\n0,0\n1,1\n2,3\n")
    assert (keys(first) == keys(same)).all()
    Path(first.removeprefix("table:")).write_text("0,0\n1,1\n2,4\n")
    assert (keys(first) != keys(same)).any()
    with pytest.raises(study.StudyError, match="shape: table:.*is not convex beyond the row with r = 1"):
        keys(tip("0,0\n1,1\n2,1.5\n"))


def test_results_of_a_study_have_the_table_of_its_file(tip, tmp_path):
    """Opened by the study; a file alone says nothing of what is in the table."""
    word = tip("0,0\n1,1\n2,3\n")
    text = f'[model]\nP = 1e-4\nshape = "{word}"\nbase = "half_space"\nmicro = "smooth"\n'
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    mine = study.load(tmp_path / "mine.toml", tmp_path / "results")
    mine.run()
    Path(word.removeprefix("table:")).unlink()
    assert study.sensitivities(mine.open()).a_sensitivity.notnull().all()
    with pytest.raises(study.StudyError, match="no shape of this name is registered here"):
        study.sensitivities(study.open_results(tmp_path / "results/mine.nc"))


def test_results_do_not_choose_which_files_are_opened(tip):
    found = study.solve(P=1e-4, shape=tip("0,0\n1,1\n2,3\n"), **ALONE)
    found["shape"] = "table:/etc/passwd"
    with pytest.raises(study.StudyError, match="no shape of this name is registered here"):
        study.sensitivities(found.set_coords("shape"))


def test_defaults_change_no_key():
    old = from_call({"P": 1e-4, **ALONE}, [], False, {})
    for more in ({"shape": "paraboloid"}, {"w_adhesion": 0.0}):
        new = from_call({"P": 1e-4, **ALONE, **more}, [], False, {})
        assert (case_keys(new.grid) == case_keys(old.grid)).all()
    assert not {"shape", "w_adhesion", "half_angle", "stable"} & {*study.solve(P=1e-4, **ALONE).variables}


def test_the_slope_at_the_edge_sets_its_mask():
    """A sphere at a = 0.37 R, cones sharper than 68 degrees; the paraboloid keeps its own rule."""
    edge = SLOPE / np.sqrt(1 + SLOPE**2)  # f' = a/sqrt(1 - a²)
    found = study.solve(a=[0.99 * edge, 1.01 * edge], shape=["sphere", "paraboloid"], **ALONE)
    words = study.decode(found.validity)
    assert words.sel(shape="sphere").values.tolist() == ["", "slope_not_small"]
    assert words.sel(shape="paraboloid").values.tolist() == ["strain_not_small"] * 2
    angles = np.degrees(np.arctan(1 / (SLOPE * np.array([1.01, 0.99]))))
    cones = study.solve(a=0.01, shape="cone", half_angle=angles, **ALONE)
    assert study.decode(cones.validity).values.tolist() == ["slope_not_small", ""]


def test_what_is_infinite_is_said():
    cone = study.solve(P=1e-5, shape="Vickers", **ALONE)
    text = study.summary(cone)
    assert np.isposinf(cone.p0) and "p(0)   = infinite" in text and "The tip is sharp" in text
    assert "a Vickers pyramid, replaced by the cone of the same area (half angle 70.3°)" in text
    assert "1.07 times as large" in text  # 1.067 of Hay, Bolshakov and Pharr at nu = 0.3
    flat = study.solve(P=1e-5, shape="flat", flat_radius=0.1, x=3, **ALONE)
    assert flat.a == 0.1 and np.isposinf(flat.p.values[-1]) and np.isfinite(flat.p0)


def test_stresses_of_a_smooth_shape_and_what_has_none():
    """r²/(2R) as a power is the paraboloid; the stress is that under it."""
    power = {"shape": "power", "shape_power": 2, "shape_coefficient": 0.5}
    layer = {"a": 0.1, "h": 0.05, "n": 3.0, "bonding": "bonded", "micro": "smooth"}
    fields = [study.stresses(study.solve(**layer, **more), r=[0.0, 0.7, 1.2], z=[0.0, 0.3]) for more in ({}, power)]
    for name in ("sr", "st", "sz", "trz", "mises"):
        assert_allclose(fields[1][name], fields[0][name], rtol=1e-7, atol=1e-8)
    flat = study.solve(P=1e-5, shape="flat", flat_radius=0.1, **ALONE)
    sz = study.stresses(flat, r=[0.6, 1.0], z=[0.0]).sz.values.ravel()
    assert_allclose(sz[0], -1e-5 / (2 * np.pi * 0.1**2 * 0.8), rtol=1e-9)
    assert sz[1] == -np.inf
    with pytest.raises(study.StudyError, match="no largest stresses under a flat punch"):
        study.extremes(flat)
    with pytest.raises(study.StudyError, match="no largest stresses under a flat punch"):
        study.first_yield(Y2=0.01, shape="flat", flat_radius=0.1, **ALONE)


@pytest.mark.parametrize(
    ("tip", "at"), [({"shape": "cone", "half_angle": 70}, 0.0), ({"shape": "frustum", "flat_radius": 0.1}, 0.5)]
)
@pytest.mark.filterwarnings("error")
def test_stresses_are_infinite_at_a_tip_and_at_a_corner(tip, at):
    """Where the slope of the profile jumps the pressure is like a logarithm: without a layer, and in the layer alone.
    Of an incompressible body the normal stresses are infinite alike, and their differences finite."""
    tip = {"half_angle": 70} | tip
    for layer in (ALONE, {"h": 0.3, "n": 3.0, "bonding": "bonded", "micro": "smooth"}):
        contact = study.solve(a=0.2, **tip, **layer)
        names = [f"{kind}{2 if layer is ALONE else 1}" for kind in ("mises", "tresca")]
        largest = study.extremes(contact)
        assert all(np.isposinf(largest[name]) and largest[f"{name}_r"] == at for name in names)
        assert layer is ALONE or np.isfinite(largest.mises2)
        fields = study.stresses(contact, r=[at, 0.9], z=[0.0, 0.2])
        assert all(np.isposinf(fields[name].values[0, 0]) for name in ("mises", "tresca"))
        assert all(np.isneginf(fields[name].values[0, 0]) for name in ("s1", "s2", "s3", "sz"))
        assert np.isfinite(fields.mises.values[1:]).all() and np.isfinite(fields.s1.values[1:]).all()
    assert np.isfinite(study.extremes(study.solve(a=0.2, nu2=0.5, **tip, **ALONE)).mises2)


def test_a_picture_of_a_sharp_tip():
    figure = study.plot_stresses(study.solve(a=0.2, shape="cone", half_angle=70, **ALONE))
    assert figure.axes[0].get_title(loc="left") == "(a) body: infinite at the cross"


def test_fits_and_designs_take_shapes():
    """What was computed with 5 kPa is fitted as 5 kPa: tables of two unknowns are right to 5e-6 of P."""
    gel = {"body": "rigid", "nu1": 0.49, "h": "5 um", "bonding": "bonded", "micro": "smooth", "punch": "rigid"}
    cone, depths = {"shape": "cone", "half_angle": 70}, np.linspace(0.05, 1.5, 25)
    contact = study.solve(**gel, **cone, E1="5 kPa", D=[f"{d} um" for d in depths], x=2, profiles=False)
    curve = {"D": (depths, "um"), "P": (contact.P.values, "N")}
    fitted = study.fit(curve, **gel, **cone, free=["E1"], contact_point=False, baseline=False, intervals=None)
    assert_allclose(fitted.E1, 5e3, rtol=1e-4)
    load = float(contact.P[-1])
    designed = study.design(
        {"P": f"{load!r} N"}, by={"half_angle": (50, 80)}, shape="cone", E1="5 kPa", D="1.5 um", **gel
    )
    assert_allclose(designed.half_angle, 70, rtol=1e-5)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        (
            {"shape": "cone", "half_angle": 70, "base": "thin_layer", "h": 0.1, "n": 1},
            "is for shape = .paraboloid.",
        ),
        ({"shape": "frustum", "flat_radius": 0.2, "half_angle": 70, "a": 0.1}, "must be above that of the flat end"),
        ({"w_adhesion": 1e-3, "base": "thin_layer", "h": 0.1, "n": 1}, "has no adhesion"),
    ],
)
def test_a_contact_that_cannot_be_is_one_clear_message(parameters, message):
    call = {"micro": "smooth", "base": "half_space"} | parameters
    with pytest.raises(study.StudyError, match=message):
        study.solve(**call | ({} if "a" in parameters else {"P": 1e-4}))

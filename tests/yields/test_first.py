"""Loads of first yield against references, closed forms and single contacts."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from yielding import first_yield as of_bodies
from yielding import largest

import study
from solver import Problem, solve
from solver.closed_forms import yield_pressure
from solver.yields.contact import of_contacts
from solver.yields.first import WIDEST, first_yield
from solver.yields.protect import protection

REFERENCES = Path(__file__).parents[1] / "fields" / "references"
BARE = {"base": "half_space", "micro": "smooth"}
HARD = {"n": 10.0, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded", "micro": "smooth"}


def rows(name: str) -> np.ndarray:
    path = REFERENCES / f"first_yield_{name}.csv"
    return np.atleast_1d(np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8"))


def named(row) -> str:
    return f"{row['case']} {row['body']}"


@cache
def of_rows(body: str):
    """:func:`first_yield` of all rows of a body in one batch, and which rows these are."""
    some = [row for row in rows("smooth") if row["body"] == body]
    own = {name: [float(row[name]) for row in some] for name in ("n", "nu1", "nu2", "h")}
    own["bonding"] = ["bonded" if row["bonded"] else "frictionless" for row in some]
    problem = Problem.of(P=1.0, micro="smooth", **own)
    found = first_yield(problem, "layer" if body == "layer" else "body", np.array([row["Y"] for row in some]))
    return [named(row) for row in some], found


@pytest.mark.parametrize("row", rows("smooth"), ids=named)
def test_smooth_contacts_of_an_independent_code(row):
    """1e-5 is promised; the references have seven digits, and one is 4e-7 off."""
    names, found = of_rows(row["body"])
    i = names.index(named(row))
    numbers = [found.numbers[name][i] for name in ("P", "a", "D", "p0")]
    assert found.crossed[i]
    assert_allclose(numbers, [row[name] for name in ("P", "a", "D", "p0")], rtol=5e-7)
    assert_allclose([found.r[i], found.z[i]], np.array([row["r"], row["z"]]) / row["a"], rtol=0, atol=1e-3)


def test_a_sphere_on_a_half_space():
    """All in one call, against Hertz and Johnson's closed form."""
    hertz = rows("hertz")
    Y = 0.01  # R = E* = 1: loads are as Y³
    found = study.first_yield(Y2=Y, nu2=hertz["nu"].tolist(), **BARE)
    assert_allclose(found.P_Y2, hertz["PY"] * Y**3, rtol=1e-6)
    assert_allclose(found.a_Y2, hertz["aY"] * Y, rtol=1e-6)
    assert_allclose(found.D_Y2, hertz["deltaY"] * Y**2, rtol=1e-6)
    assert_allclose(found.p0_Y2 / Y, yield_pressure(hertz["nu"]), rtol=1e-6)
    assert_allclose(found.z_Y2, hertz["z_over_a"], atol=1e-3)
    assert (found.found_Y2 == 0).all() and (found.first_yield == 2).all()


@pytest.mark.parametrize("row", rows("sliding"), ids=lambda row: f"mu {row['mu']}")
def test_sliding(row):
    """The place jumps from below the surface to its trailing edge."""
    found = study.first_yield(Y2=0.01, nu2=0.3, mu=float(row["mu"]), **BARE)
    assert found.p0_Y2.item() == pytest.approx(0.01 * row["pY_over_Y_mises"], rel=1e-6)
    assert (found.r_Y2.item(), found.z_Y2.item()) == pytest.approx((row["x"], row["z"]), abs=1e-3)


def test_the_first_of_several_crossings():
    """The stress of this layer falls with the load between h/a = 0.384 and 0.18: of 6.5 h E2*/R the first crossing is
    at a twelfth of the load of the last."""
    found = study.first_yield(Y1=6.5 * 0.005, h=0.005, **HARD)
    assert found.P_Y1.item() == pytest.approx(5.4e-6, rel=0.01)
    beyond = study.solve(a=0.005 / 0.18, h=0.005, **HARD)
    assert largest(beyond, "mises1").mises1.item() < 6.5 * 0.005 and beyond.P.item() > 5 * found.P_Y1.item()


@pytest.mark.parametrize("micro", ["smooth", "disc_cell", "normal_heights"])
@pytest.mark.parametrize("body", ["layer", "body"])
def test_the_stress_is_the_strength_there(micro, body):
    """Of contacts solved alone, and less than the strength at all smaller loads that are looked at. The soft layer is
    left out under random heights, which take the most time."""
    n, Y = (np.array([0.2, 5.0]), np.array([1e-3, 5e-3])) if micro != "normal_heights" else (np.array([5.0]), [5e-3])
    own = {"h": 0.01, "nu1": 0.4, "nu2": 0.2, "bonding": "bonded", "micro": micro}
    own |= {"Nbar": 250000.0, "Ra": 0.004, "sigma": 1e-4}
    name, shares = "mises1" if body == "layer" else "mises2", np.array([[1.0], [0.9], [0.5], [0.2]])
    found = first_yield(Problem.of(P=1.0, n=n, **own), body, np.array(Y))
    assert found.crossed.all()
    at = Problem.of(a=(shares * found.at).ravel(), n=np.tile(n, 4), **own)
    stress = of_contacts(at, solve(at), names=(name,))[name][0].reshape(4, -1)
    assert_allclose(stress[0], Y, rtol=1e-6)
    np.testing.assert_array_less(stress[1:], np.tile(Y, (3, 1)))


def test_residual_stress_counts_from_the_first_touch():
    own = {"h": 0.02, "n": 5.0, "bonding": "bonded", "micro": "smooth"}
    Y = np.array([0.02])
    problem = Problem.of(P=1.0, **own)
    free, pulled = (first_yield(problem, "layer", Y, residual=residual) for residual in (0.0, 0.015))
    assert pulled.crossed[0] and pulled.at[0] < free.at[0]
    at = Problem.of(a=pulled.at, **own)
    assert of_contacts(at, solve(at), residual=0.015)["mises1"][0] == pytest.approx(Y, rel=1e-6)
    at_once = first_yield(problem, "layer", Y, residual=-0.02)
    assert at_once.crossed[0] and at_once.numbers["P"][0] == 0.0
    assert first_yield(problem, "body", Y, residual=-0.02).at[0] > 0


def test_what_does_not_yield_says_so():
    found = study.first_yield(Y1=50.0, Y2=0.01, h=0.02, n=2.0, micro="smooth")
    codes = {end: found[f"found_{end}"].item() for end in ("Y1", "Y2", "Ya", "Y_punch")}
    assert codes == {"Y1": 1, "Y2": 0, "Ya": 3, "Y_punch": 2} and found.first_yield.item() == 2
    assert np.isnan([found[f"{name}_Y1"].item() for name in ("P", "a", "D", "p0", "r", "z")]).all()
    assert found.P_Y1.attrs["message"].endswith("the layer does not yield up to a = 0.2 R, or is rigid or absent")
    assert found.P_Y_punch.attrs["message"].endswith("is not known: give Y_punch")
    assert found.P_Ya.attrs["message"].endswith("the punch is smooth and has no asperities")
    assert study.decode(found.found_Ya).item() == "no_asperities" and "no_asp" not in str(found.found_Y1.attrs)
    assert "message" not in found.P_Y2.attrs and WIDEST == 0.2


def test_bodies_that_are_rigid_or_not_there():
    rigid = study.first_yield(Y1=0.01, Y2=0.01, h=0.02, n=0.0, nu1=0.3, bonding="bonded", micro="smooth")
    assert (rigid.found_Y1.item(), rigid.found_Y2.item()) == (0, 1)
    bare = study.first_yield(Y1=0.01, Y2=0.01, Y_punch=0.01, **BARE)
    assert (bare.found_Y1.item(), bare.found_Y2.item(), bare.found_Y_punch.item()) == (1, 0, 1)


def test_an_elastic_punch_of_the_same_material_yields_with_the_body():
    found = study.first_yield(Y2=0.01, Y_punch=0.01, m=1.0, nu2=0.3, **BARE)
    assert found.P_Y_punch.item() == pytest.approx(found.P_Y2.item(), rel=1e-6)
    assert found.p0_Y_punch.item() == pytest.approx(0.01 * yield_pressure(0.3), rel=1e-6)


def test_strengths_come_from_the_materials():
    """A hardness is 2.84 yield strengths; what the call gives goes first. Units are those of the call."""
    steel = study.materials.get("steel 52100")
    scene = {"R": "5 mm", "punch": steel.name, "body": steel.name, "base": "half_space", "micro": "smooth"}
    found = study.first_yield(**scene)
    Y = steel.yield_strength or steel.hardness / 2.84
    assert found.p0_Y2.item() == pytest.approx(Y * yield_pressure(steel.nu), rel=1e-6)
    assert found.P_Y2.attrs["units"] == "N" and found.a_Y2.attrs["units"] == "m"
    weak = study.first_yield(Y2="500 MPa", **scene)
    assert weak.p0_Y2.item() == pytest.approx(5e8 * yield_pressure(steel.nu), rel=1e-6)
    assert weak.P_Y_punch.item() == pytest.approx(found.P_Y_punch.item(), rel=1e-6)


def test_the_spread_of_a_strength_counts():
    """Of a half-space P is as the third power of the strength, a as the first; a material brings its spread."""
    scene = {"R": "5 mm", "E2": "210 GPa", "nu2": 0.3, "base": "half_space", "micro": "smooth"}
    found = study.first_yield(Y2="500 ± 50 MPa", **scene)
    for name, power in (("P", 3), ("a", 1), ("D", 2), ("p0", 1)):
        share = found[f"{name}_Y2_spread"].item() / found[f"{name}_Y2"].item()
        assert share == pytest.approx(0.1 * power, rel=2e-3), name
    assert found.P_Y2_spread.attrs["units"] == "N" and "P_Y2_spread" not in study.first_yield(Y2="500 MPa", **scene)
    steel = study.materials.get("steel 316L")
    named = of_bodies("body", R="5 mm", body=steel.name, base="half_space", micro="smooth")
    share = steel.yield_strength_spread / steel.yield_strength
    assert named.P_Y2_spread.item() / named.P_Y2.item() == pytest.approx(3 * share, rel=2e-3)


def test_a_grid_has_its_dimensions():
    found = study.first_yield(Y1=0.01, h=[0.01, 0.02], n=[0.5, 2.0], bonding="bonded", micro="smooth")
    assert dict(found.P_Y1.sizes) == {"h": 2, "n": 2} and "a" not in found.coords
    alone = study.first_yield(Y1=0.01, h=0.02, n=0.5, bonding="bonded", micro="smooth")
    assert found.P_Y1.sel(h=0.02, n=0.5).item() == pytest.approx(alone.P_Y1.item(), rel=1e-6)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"P": 1e-5}, "first_yield: leave out P: it is what is looked for"),
        ({"Y2": -1.0}, "first_yield: Y2 = -1"),
        ({"Y2": 0.01, "mu": -0.1}, "mu = -0.1: must be a finite number, at least 0"),
        ({"Y2": 0.01, "sigma_res": "1 GPa"}, 'sigma_res = "1 GPa": the contact has no units'),
        ({"Y3": 0.01}, 'first_yield: "Y3" is not a parameter'),
    ],
)
def test_what_first_yield_refuses(given, message):
    with pytest.raises(study.StudyError) as raised:
        study.first_yield(**BARE, **given)
    assert str(raised.value).startswith(message)


PROTECTED = {0.0077: False, 0.0095: True, 0.0105: True}


@pytest.fixture(scope="module")
def protected():
    """Thicknesses that protect bodies of these strengths, all in one call, and below some of which they yield."""
    protected = study.h_protect(P=1e-5, Y2=[*PROTECTED], **HARD)
    assert protected.h_yields.attrs["message"] == "h_yields of 1 of 3 cases: no such thickness exists"
    return protected


@pytest.mark.parametrize(("Y2", "yields"), PROTECTED.items(), ids=["bare yields", "early", "late"])
def test_what_protects_the_body(protected, Y2, yields):
    """Under this layer the body's largest stress rises from 0.00773 to 0.01064 before it falls. At the thicknesses that
    are found it is the strength; beyond, and before, it is less."""
    h, least = (protected[name].sel(Y2=Y2).item() for name in ("h_protect", "h_yields"))
    at = Problem.of(P=1e-5, h=[h, 1.02 * h, 3 * h, *([least, 0.98 * least] if yields else [])], **HARD)
    stress = of_contacts(at, solve(at), names=("mises2",))["mises2"][0] / Y2
    assert stress[0] == pytest.approx(1.0, rel=1e-6) and (stress[1:3] < 1).all()
    assert np.isfinite(least) == yields and (not yields or (stress[3] == pytest.approx(1, rel=1e-6) and stress[4] < 1))


def test_nothing_need_protect_a_strong_body():
    found = study.h_protect(P=1e-5, Y2=0.0108, **HARD)
    assert found.h_protect.item() == 0.0 and np.isnan(found.h_yields.item())
    assert found.h_yields.attrs["message"] == "h_yields of 1 of 1 cases: no such thickness exists"


def test_a_thickness_has_the_unit_of_the_call():
    scene = {"R": "5 mm", "E_punch": "210 GPa", "E2": "100 GPa", "nu2": 0.3, "E1": "300 GPa", "nu1": 0.2}
    found = study.h_protect(P="20 N", Y2="400 MPa", bonding="bonded", micro="smooth", **scene)
    assert found.h_protect.attrs["units"] == "m"
    at = study.solve(P="20 N", h=f"{found.h_protect.item()} m", bonding="bonded", micro="smooth", **scene)
    assert largest(at, "mises2").mises2.item() == pytest.approx(4e8, rel=1e-6)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"h": 0.1, "Y2": 0.01}, "h_protect: leave out h: it is what is looked for"),
        ({"a": 0.1, "Y2": 0.01}, "h_protect: leave out a: the load P is given"),
        ({"base": "half_space", "Y2": 0.01}, 'h_protect: base = "half_space" has no layer'),
        ({}, "h_protect needs Y2, the yield strength of the body"),
    ],
)
def test_what_h_protect_refuses(given, message):
    with pytest.raises(study.StudyError) as raised:
        study.h_protect(P=1e-5, **HARD, **given)
    assert str(raised.value).startswith(message)


def test_the_core_does_not_look_where_no_strength_is_known():
    problem = Problem.of(P=1e-5, h=[0.02, 0.02], **HARD)
    assert first_yield(problem, "layer", np.array([0.02, np.nan])).crossed.tolist() == [True, False]
    found = protection(problem, np.array([0.005, np.nan]))
    assert np.isfinite(found.protects).tolist() == [True, False]


def test_asperities_are_as_weak_as_the_weaker_and_unknown_if_one_is():
    rough = {"R": "5 mm", "base": "half_space", "Nbar": "0.1 1/um^2", "Ra": "20 um"}
    weak, hard = study.materials.get("steel 316L"), study.materials.get("steel 52100")
    assert weak.yield_strength < hard.hardness / 2.84
    loads = [
        of_bodies("asperities", punch=punch.name, body=body.name, yield_strength=given, **rough)
        for punch, body, given in ((weak, hard, None), (weak, hard, f"{weak.yield_strength} Pa"))
    ]
    assert loads[0].P_Ya.item() == pytest.approx(loads[1].P_Ya.item(), rel=1e-9)
    unknown = next(name for name in study.materials.names() if np.isnan(study.materials.strength_of(name)))
    assert of_bodies("asperities", punch=unknown, body=hard.name, **rough).found_Ya.item() == 2


def test_the_names_of_loads_say_which_body_yields():
    body = study.first_yield(Y2=0.01, nu2=0.3, **BARE)
    assert body.P_Y2.long_name == "load at which the body first yields"
    asperities = of_bodies(
        "asperities", punch="steel 52100", body="steel 316L", R="5 mm", base="half_space", Nbar="0.1 1/um^2", Ra="20 um"
    )
    assert asperities.P_Ya.long_name == "load at which the asperities first yield"

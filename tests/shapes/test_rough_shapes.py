"""Rough punches of every shape against another code, limits, and what a batch does to them."""

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import JUDGED, difference

from solver import Model, Problem, Status, solve

ROUGH = {"Nbar": 250000.0, "Ra": 0.004}
#: Half-angle in degrees of a cone of slope 0.1.
BLUNT = np.degrees(np.arctan(10.0))
SOFT = {"n": 0.1, "nu1": 0.45, "nu2": 0.3, "bonding": "bonded", "h": 0.04}
HARD = {"n": 5.0, "nu1": 0.3, "nu2": 0.3, "bonding": "frictionless"}
BARE = {"base": "half_space"}
#: Name -> the case, a, P, D of asperities of the law "disc_cell", by another program's equation, Newton's method and
#: law on two meshes, on the half-space operator of this one. They agree to 5e-9 (cone) and 1e-9 or better.
GIVEN = {
    "sphere": ({"shape": "sphere"} | BARE, 0.4, 9.024199115108e-02, 1.680562226884e-01),
    "power": (
        {"shape": "power", "shape_coefficient": 1.0, "shape_power": 4.0, "h": 0.15} | HARD,
        *(0.3, 2.127270364967e-02, 3.552584905941e-02),
    ),
    "cone": ({"shape": "cone", "half_angle": BLUNT} | SOFT, 0.04, 2.952021049691e-05, 4.472876805226e-03),
    "frustum": (
        {"shape": "frustum", "flat_radius": 0.012, "half_angle": BLUNT} | BARE,
        *(0.04, 2.225293177245e-04, 4.791220599186e-03),
    ),
    "blunt_cone": (
        {"shape": "blunt_cone", "tip_radius": 0.16, "half_angle": BLUNT, "h": 0.02} | HARD,
        *(0.04, 3.932369594835e-04, 6.960509813475e-03),
    ),
    "rounded_flat": (
        {"shape": "rounded_flat", "flat_radius": 0.024, "edge_radius": 0.1} | SOFT,
        *(0.04, 2.827087675537e-05, 1.940259220139e-03),
    ),
    "flat": ({"shape": "flat", "flat_radius": 0.04} | BARE, 0.04, 7.566304363388e-05, 1e-3),
}
X = np.array([0.0, 0.4, 1.0])


def solved(case, **more):
    return solve(Problem.of(**(ROUGH | case | more)), X)


@cache
def of_name(name, control, **more):
    """A case of GIVEN; solved once, however many tests ask."""
    case, *values = GIVEN[name]
    return solved(case, **{control: dict(zip("aPD", values, strict=True))[control]}, **more)


@pytest.mark.parametrize("control", ["a", "P", "D"])
@pytest.mark.parametrize("name", GIVEN)
def test_another_code(name, control):
    if name == "flat" and control == "a":
        pytest.skip("the radius of a flat punch is no control")
    answer, (_, *values) = of_name(name, control, rtol=1e-8), GIVEN[name]
    assert answer.status.tolist() == [Status.CONVERGED]
    assert answer.error[0] <= 1e-8
    for key, value in zip("aPD", values, strict=True):
        assert_allclose(getattr(answer, key), value, rtol=1e-8, atol=0)


@pytest.mark.parametrize("name", GIVEN)
def test_profiles_are_no_better_than_the_contact(name):
    answer = of_name(name, "P", rtol=1e-8)
    assert answer.profile_error >= answer.error


def test_under_a_point_the_centre_is_not_known():
    """p0, p_max, A0 and λ on the axis are NaN, and nothing else; elsewhere they are as on a finer mesh."""
    coarse, fine = of_name("cone", "P", rtol=1e-4), of_name("cone", "P", rtol=1e-8)
    for name in ("p0", "p_max", "A0"):
        assert np.isnan(getattr(coarse, name)).all()
    for name in ("a", "P", "D", "Ar_An", "dP_dD", "error", "profile_error", "residual", "model_error"):
        assert np.isfinite(getattr(coarse, name)).all(), name
    for name in ("p", "lam"):
        profile, finer = getattr(coarse, name)[0], getattr(fine, name)[0]
        assert np.isnan(profile).tolist() == [True, False, False]
        assert_allclose(profile[1:], finer[1:], rtol=0, atol=coarse.profile_error[0] * np.nanmax(finer))


@pytest.mark.parametrize("name", ["frustum", "cone", "flat"])
def test_error_encloses_what_a_finer_mesh_gives(name):
    coarse, fine = (of_name(name, "D", rtol=rtol) for rtol in (1e-4, 1e-8))
    names = [key for key in JUDGED if np.isfinite(getattr(fine, key)[0])]
    assert len(names) == (4 if name == "cone" else 6)
    assert difference(coarse, fine, names)[0] <= coarse.error[0] <= 1e-4


@pytest.mark.parametrize("name", ["cone", "rounded_flat", "flat"])
def test_stiffness_is_the_slope_of_the_load(name):
    """dP/dD against a central difference of P by D: its h² is 1e-8, and the rounding of P over h some 1e-8."""
    case, _, _, D = GIVEN[name]
    down, up = (solved(case, D=D * (1 + step), rtol=1e-10) for step in (-1e-4, 1e-4))
    assert_allclose(of_name(name, "D", rtol=1e-8).dP_dD, (up.P - down.P) / (2e-4 * D), rtol=1e-6, atol=0)


@pytest.mark.parametrize("name", GIVEN)
def test_fine_asperities_leave_the_smooth_shape(name):
    """Small dense asperities take little of the depth: P under given D is that of the smooth shape, which has another
    equation, to the order of A/D. With a tenth of A the distance is a tenth or a little more."""
    case, _, _, D = GIVEN[name]
    smooth = solve(Problem.of(**case, D=D, micro="smooth"))
    assert smooth.status.tolist() == [Status.CONVERGED]
    apart = []
    for size in (1e-5, 1e-6):
        rough = solved(case, D=D, Ra=1e3 * size * D, Nbar=1 / (np.pi * 1e3 * (size * D) ** 2), rtol=1e-6)
        apart.append(1 - rough.P[0] / smooth.P[0])
    assert 0 < apart[0] < 3e-4
    assert 0.05 < apart[1] / apart[0] < 0.2


def test_a_small_load_leaves_the_flat_end():
    """Under 1e-10 a frustum and a rounded flat punch touch little beyond b, and their depth is nearly that of the flat
    punch. The edge is 4e-5 of b beyond it: rounding of a is 1e-11 of that distance, and `error` says so."""
    load, case = 1e-10, {"flat_radius": 0.012, "micro": "disc_cell"} | BARE
    flat = solved(case, shape="flat", P=load)
    frustum = solved(case, shape="frustum", half_angle=BLUNT, P=load)
    rounded = solved(case, shape="rounded_flat", edge_radius=0.1, P=load)
    for answer, part in ((frustum, 1e-4), (rounded, 0.01)):  # a/b - 1 is 4e-5 and 8e-3
        assert answer.status.tolist() == [Status.CONVERGED] and 0 < answer.a[0] / 0.012 - 1 < part
        assert_allclose((answer.D, answer.dP_dD), (flat.D, flat.dP_dD), rtol=part, atol=0)
    by_depth = solved(case, shape="frustum", half_angle=BLUNT, D=frustum.D[0])
    assert abs(by_depth.P[0] / load - 1) < frustum.error[0] < 1e-9


def test_a_case_has_the_same_numbers_in_any_company():
    cases = [GIVEN[name][0] | {"P": GIVEN[name][2]} for name in ("cone", "frustum", "sphere", "flat")]
    names = {key for case in cases for key in case}
    filled = {"shape": "paraboloid", "base": "layered", "half_angle": 60.0, "flat_radius": 1.0} | {"h": 1.0, "n": 1.0}
    filled |= {"nu1": 0.3, "nu2": 0.3, "bonding": "bonded"}
    cases.append({"P": 1e-4})
    together = solved({key: np.array([case.get(key, filled.get(key)) for case in cases]) for key in names})
    for i, case in enumerate(cases):
        alone = solved({key: case.get(key, filled.get(key)) for key in names})
        for name in ("a", "P", "D", "Ar_An", "error", "nodes", "status"):
            assert getattr(together, name)[i] == getattr(alone, name)[0], (i, name)


def test_auto_takes_the_exact_layer():
    case = GIVEN["blunt_cone"][0] | {"P": 1e-4}
    exact, auto = solved(case, base="layered"), solved(case, base="auto", accuracy=0.3)
    assert auto.model_used[0] == Model.LAYERED and auto.model_error[0] == 0
    assert auto.P[0] == exact.P[0] and auto.a[0] == exact.a[0]


@pytest.mark.parametrize(
    "more",
    [
        {"base": "thin_layer", "P": 1e-4},
        {"scheme": "picard", "P": 1e-4},
        {"a": 0.012},  # an edge on the flat is no edge
        {"w_adhesion": 1e-6, "P": 1e-4},
        {"shape": "flat", "a": 0.02},
        {"shape": "sphere", "a": 1.0},
    ],
)
def test_what_is_refused(more):
    case = {"shape": "frustum", "flat_radius": 0.012, "half_angle": BLUNT, "h": 0.02, "n": 0.5, "base": "layered"}
    assert solved(case | more).status.tolist() == [Status.INVALID_INPUT]


def test_a_table_ends(tmp_path):
    """A table of a paraboloid gives its contacts, and none beyond its last row."""
    path, r = tmp_path / "tip.csv", np.linspace(0, 0.05, 11)
    path.write_text("r, f\n" + "\n".join(f"{x:.17g}, {x * x / 2:.17g}" for x in r))
    case = {"shape": f"table:{path}"} | BARE
    paraboloid = solved(BARE, P=np.array([1e-5, 1.0]), rtol=1e-8)
    answer = solved(case, P=np.array([1e-5, 1.0]), rtol=1e-8)
    assert answer.status.tolist() == [Status.CONVERGED, Status.OUTSIDE_LAW]
    assert_allclose(answer.a[0], paraboloid.a[0], rtol=1e-8, atol=0)
    assert_allclose(answer.p0[0], paraboloid.p0[0], rtol=1e-8, atol=0)
    assert solved(case, a=0.051).status.tolist() == [Status.OUTSIDE_LAW]
    assert solved(case, D=0.1).status.tolist() == [Status.OUTSIDE_LAW]


@pytest.mark.parametrize(
    ("name", "micro"),
    [
        ("flat", "normal_heights"),
        ("flat", "elastic_plastic"),
        ("rounded_flat", "power_law"),
        ("flat", "square_lattice"),
    ],
)
def test_other_laws_and_a_stack(name, micro):
    """On a stack of one layer the contact is that on the layer; the law is as good as any."""
    case, _, P, _ = GIVEN[name]
    layer = {"h": 0.04, "n": 0.1, "nu": 0.45, "bonding": "bonded"}
    shape = {key: case[key] for key in ("shape", "flat_radius", "edge_radius") if key in case}
    law = {"micro": micro, "B": 0.1, "beta": 0.5, "sigma": 1e-5, "hardness": 0.05, "P": P} | shape
    law = {key: v for key, v in law.items() if key in Problem.of(P=1, micro="smooth", base="half_space").parameters}
    exact = solved(law | {"P": P} | SOFT, base="layered")
    stack = solved(law | {"P": P, "nu2": 0.3}, base="stack", layers=[layer])
    assert exact.status.tolist() == stack.status.tolist() == [Status.CONVERGED]
    assert difference(exact, stack)[0] < 1e-6


def test_a_tip_that_no_panel_can_have_is_as_a_point():
    """The kink behind it is nearer to the axis than rounding in s = sqrt(1 - (b/a)²): p(0) is not known."""
    case, a, P, D = GIVEN["cone"]
    blunt = solved(case | {"shape": "blunt_cone", "tip_radius": 5e-9, "tip": "paraboloid"}, a=a, rtol=1e-4)
    assert blunt.status == Status.TOLERANCE_NOT_MET
    assert_allclose([blunt.P[0], blunt.D[0]], [P, D], rtol=1e-4, atol=0)

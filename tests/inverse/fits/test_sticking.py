"""Fits of contacts that stick: E and the work of adhesion of curves that the solver made."""

import warnings

import numpy as np
import pytest
from conftest import ROOT
from measured_curves import solved, status
from numpy.testing import assert_allclose

import study
from study.inverse.fits.curve import MeasuredCurves
from study.inverse.fits.question import read_question
from study.inverse.fits.tables.branch import branch
from study.inverse.fits.tables.sticking_points import StickingPoints
from study.inverse.fits.tables.term_table import LENGTH, TermTable

GEL = {"R": "5 um", "punch": "rigid", "nu1": 0.45, "E2": "20 kPa", "nu2": 0.45, "h": "3 um", "bonding": "bonded"}
GEL |= {"micro": "smooth"}
SPHERE, CONE = GEL | {"shape": "sphere"}, GEL | {"shape": "cone", "half_angle": 70.0, "R": None}
BARE = {"R": "5 um", "nu2": 0.45, "base": "half_space", "micro": "smooth"}
TRUE = {"E1": "5 kPa", "w_adhesion": "0.4 mJ/m^2"}
MAUGIS = GEL | {"E2": "rigid", "adhesion": "maugis", "sigma0": "2 kPa"}
#: Depths in m from beyond pull-off to 0.2 R.
DEPTHS = np.linspace(-0.5e-6, 1e-6, 40)
STACK = {"R": "5 um", "punch": "rigid", "E2": "rigid", "micro": "smooth"}
STACK |= {"layers": [{"h": "1 um", "E1": "20 kPa", "nu": 0.45, "bonding": "bonded"},
                     {"h": "4 um", "E1": "5 kPa", "nu": 0.45, "bonding": "bonded"}]}  # fmt: skip


def loads(depths, **inputs):
    """P (n,) of the solver, 0 beyond pull-off."""
    inputs = {name: value for name, value in inputs.items() if value is not None}
    numbers = [f"{float(depth)!r} m" for depth in depths]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of validity, which is not the question here
        made = study.solve(**inputs, D=numbers, x=2, profiles=False, progress=False)
    assert np.isin(made.status, (0, 11)).all() and (made.status == 0).any()
    return np.nan_to_num(made.P.values)


def fitted(depths, P, free, **inputs):
    inputs = {name: value for name, value in inputs.items() if value is not None}
    return study.fit({"D": (depths, "m"), "P": (P, "N")}, free=free, progress=False, **inputs)


USUAL = {"contact_point": True, "baseline": True, "tilt": False, "sigma": None, "loss": "linear"}
USUAL |= {"intervals": "profile", "level": 0.95, "plan": False}


def curve_of(inputs, free, **options):
    """The MeasuredCurves of a call at DEPTHS, and its unknowns (1, k) at the values of the call."""
    inputs = {name: value for name, value in inputs.items() if value is not None}
    question = read_question(free, inputs, "D", "P", USUAL | options)
    model = question.model
    p = [float(model.coordinate(name, model.value(name))) for name in model.unknowns]
    curve = MeasuredCurves(TermTable(model), DEPTHS[None], np.array([1e-6]), np.array([1e-8]), question.shifts)
    return curve, np.array([[*p, *np.zeros(len(question.shifts))]])


@pytest.mark.parametrize(
    "inputs",
    [GEL, SPHERE, CONE, GEL | {"adhesion": "dmt"}, MAUGIS],
    ids=["gel", "sphere", "cone", "dmt", "maugis"],
)
def test_the_table_has_the_loads_of_the_solver(inputs):
    """To 3e-5 of the range of loads, where there is a contact, whatever values the table begins with."""
    free, other = ["E1", "w_adhesion", "h"], {"E1": "20 kPa", "w_adhesion": "2 mJ/m^2", "h": "5 um"}
    (_, p), (curve, _) = (curve_of(inputs | begin, free) for begin in (TRUE, other))
    P = loads(DEPTHS, **inputs | TRUE)
    there = P != 0
    if inputs.get("adhesion") == "dmt":
        there = DEPTHS > 0
    assert there.sum() > 15
    assert_allclose((curve.contact(p)[0][0] * 1e-8)[there], P[there], rtol=0, atol=3e-5 * np.ptp(P))


def test_the_last_tile_is_the_one_in_which_the_largest_depth_is():
    """The depth is larger at its end and not at the end of the tile before: each tile takes as long as many curves."""
    question = read_question(["E1"], GEL | {"E1": "20 kPa", "w_adhesion": "2 mJ/m^2", "h": "5 um"}, "D", "P", USUAL)
    deepest = np.geomspace(2e-8, 2e-6, 9)
    terms = np.exp(TermTable(question.model).rows({"E1": np.full((9, 1), 20e3)}, deepest)[0, :, :4])
    depth = terms[:, 1] - terms[:, 3]
    assert (depth[:, -1] > deepest).all() and (depth[:, -1 - LENGTH // 6] <= deepest).all()


@pytest.mark.parametrize("inputs", [GEL, SPHERE, CONE, MAUGIS], ids=["gel", "sphere", "cone", "maugis"])
def test_derivatives_are_those_of_differences(inputs):
    """On the branch and in the ramp beyond its end, by all unknowns and the contact point."""
    free = ["E1", "w_adhesion", "half_angle" if "half_angle" in inputs else "h"]
    curve, p = curve_of(inputs | TRUE, free)
    made = branch(curve.table.rows(curve.values(p), DEPTHS[None].max(axis=1)), DEPTHS[None])
    inside, J = made.D_off[0] + 5e-9 < DEPTHS, curve(p)[1][0]
    assert 5 < inside.sum() < 40
    for i in range(p.shape[1]):
        more, less = p.copy(), p.copy()
        more[0, i], less[0, i] = p[0, i] + 1e-5, p[0, i] - 1e-5
        slope = (curve(more)[0] - curve(less)[0])[0] / 2e-5
        assert_allclose(J[inside, i], slope[inside], rtol=1e-5, atol=1e-6 * np.abs(J[inside, i]).max())


def test_points_are_in_contact_above_the_depth_that_fits_best():
    """A curve that comes off before its branch ends, and one of approach: the points say so."""
    curve, p = curve_of(GEL | TRUE, ["E1", "w_adhesion"])
    made = branch(curve.table.rows(curve.values(p), DEPTHS[None].max(axis=1)), DEPTHS[None])
    P, free = made.sticks.P * 1e8, made.free.P * 1e8
    assert_allclose(free[0, DEPTHS < 0], 0, rtol=0, atol=0)
    for first in (-0.1e-6, 0.0, 0.2e-6):
        off = first > DEPTHS
        y = np.where(off, free, P)
        order = np.random.default_rng(0).permutation(len(DEPTHS))
        points = StickingPoints.of(DEPTHS[None, order], y[:, order], np.ones(y.shape), 3, False)
        contact = points.in_contact(P[:, order], free[:, order], np.zeros(y.shape))
        assert (contact[0] == ~off[order]).all()


CASES = {
    "sphere": (SPHERE, {"E1": 5e3, "w_adhesion": 4e-4}),
    "cone": (CONE, {"E1": 5e3, "w_adhesion": 5e-5}),
    "half_angle": (CONE | {"E1": "5 kPa"}, {"half_angle": 70.0, "w_adhesion": 5e-5}),
    "h": (GEL, {"E1": 5e3, "w_adhesion": 4e-4, "h": 3e-6}),
    "machine": (GEL | {"k_machine": "0.01 N/m"}, {"E1": 5e3, "w_adhesion": 4e-4}),
    "stack": (STACK, {"w_adhesion": 4e-4}),
    "dmt": (GEL | {"adhesion": "dmt"}, {"E1": 5e3, "w_adhesion": 4e-4}),
    "maugis": (MAUGIS, {"E1": 5e3, "w_adhesion": 4e-4}),
    "stress": (MAUGIS | {"E1": "5 kPa"}, {"sigma0": 2e3, "w_adhesion": 4e-4}),
    "half-space": (BARE, {"E2": 5e3, "w_adhesion": 4e-4}),
}  # fmt: skip
UNITS = {"E1": "Pa", "E2": "Pa", "h": "m", "w_adhesion": "J/m^2", "half_angle": "deg", "sigma0": "Pa"}


@pytest.mark.parametrize("name", CASES)
def test_the_truth_comes_back(name):
    """To 1e-4, from bounds in the middle of which it is not, with a contact point and a baseline that are off; to 1e-3
    the stress of a ring, of which the curve says little."""
    inputs, truth = CASES[name]
    texts = {key: f"{value!r} {UNITS[key]}" for key, value in truth.items()}
    P = loads(DEPTHS, **inputs | texts)
    bounds = {key: (f"{value / 3!r} {UNITS[key]}", f"{4 * value!r} {UNITS[key]}") for key, value in truth.items()}
    bounds |= {"half_angle": ("55 deg", "80 deg")} if "half_angle" in truth else {}
    rest = {key: value for key, value in inputs.items() if key not in truth}
    fit = fitted(DEPTHS + 1e-7, P + 2e-9, bounds, **rest, intervals="fisher")
    assert status(fit) == ["converged"]
    for key, value in truth.items():
        assert_allclose(fit[key], value, rtol=1e-3 if key == "sigma0" else 1e-4)
    assert_allclose(fit.D0, 1e-7, rtol=0, atol=1e-11)
    assert_allclose(fit.residual, 0, rtol=0, atol=2e-5 * P.max())


@pytest.mark.parametrize("start", [-5e-6, 1e-4])
def test_where_the_depths_begin_does_not_matter(start):
    """Positions of an instrument are not near 0, by many times the range of the curve."""
    truth = {"E2": 5e3, "w_adhesion": 4e-4}
    P = loads(DEPTHS, **BARE, E2="5 kPa", w_adhesion="0.4 mJ/m^2")
    fit = fitted(DEPTHS + start, P, list(truth), **BARE, E2="8 kPa", w_adhesion="1 mJ/m^2", intervals="fisher")
    assert status(fit) == ["converged"]
    for name, value in truth.items():
        assert_allclose(fit[name], value, rtol=1e-4)
    assert_allclose(fit.D0, start, rtol=0, atol=1e-11)


def test_a_half_angle_without_adhesion():
    P = solved("D", "P", DEPTHS, **{name: value for name, value in CONE.items() if value}, E1="5 kPa")
    fit = fitted(DEPTHS, P, {"half_angle": ("55 deg", "80 deg")}, **CONE, E1="5 kPa", intervals="fisher")
    assert status(fit) == ["converged"]
    assert_allclose(fit.half_angle, 70, rtol=1e-5)


def test_the_bits_of_a_curve_do_not_depend_on_its_company():
    P = loads(DEPTHS, **GEL | TRUE)
    noise = 0.02 * P.max() * np.random.default_rng(3).standard_normal((5, len(P)))
    curves = P * np.linspace(0.5, 2, 5)[:, None] + noise
    about = GEL | {"w_adhesion": "1 mJ/m^2"}
    together = fitted(DEPTHS, curves, ["E1", "w_adhesion"], **about, intervals="fisher")
    for i in (0, 4):
        alone = fitted(DEPTHS, curves[i], ["E1", "w_adhesion"], **about, intervals="fisher")
        for name in ("E1", "w_adhesion", "D0", "w_adhesion_low", "fit_status", "D_valid"):
            assert alone[name].values[0] == together[name].values[i], name


def test_the_bits_of_a_curve_under_maugis():
    P = loads(DEPTHS, **BARE | {"adhesion": "maugis", "sigma0": "2 kPa", "E2": "5 kPa"}, w_adhesion="0.4 mJ/m^2")
    curves = P * np.array([[0.7], [1.0], [1.5]])
    about = BARE | {"adhesion": "maugis", "sigma0": "2 kPa", "w_adhesion": "1 mJ/m^2", "intervals": "fisher"}
    together, alone = (fitted(DEPTHS, part, ["E2", "w_adhesion"], **about) for part in (curves, curves[1]))
    for name in ("E2", "w_adhesion", "D0", "w_adhesion_low", "fit_status"):
        assert alone[name].values[0] == together[name].values[1], name


def test_a_stack_without_a_pull_has_the_fit_without_adhesion():
    """Its modulus too, whose name has the number of the layer."""
    deep = DEPTHS[DEPTHS > 0]
    P = np.concatenate([np.zeros(len(DEPTHS) - len(deep)), loads(deep, **STACK)])
    P += 0.01 * P.max() * np.random.default_rng(1).standard_normal(len(P))
    name, about = "layers.1.E1", STACK | {"layers": [STACK["layers"][0] | {"E1": None}, STACK["layers"][1]]}
    bare = fitted(DEPTHS, P, [name], **about)
    free = {name: None, "w_adhesion": ("1e-6 J/m^2", "2e-3 J/m^2")}
    fit = fitted(DEPTHS, P, free, **about, w_adhesion="1e-3 J/m^2")
    assert fit.no_pull and fit.w_adhesion == 0
    assert fit[name] == bare[name] and fit[f"{name}_low"] <= bare[f"{name}_low"]
    assert fit.covariance.sel(cov_i=name, cov_j=name) == bare.covariance.sel(cov_i=name, cov_j=name)


def test_rings_of_a_rigid_paraboloid_on_a_half_space_are_in_closed_form():
    """Those of the solver are the same, to what is left of narrow ones by subtraction; under an elastic punch, or on a
    layer, they are tabulated."""

    def rings(inputs, *free):
        question = read_question([*free, "w_adhesion"], inputs | {"w_adhesion": "1 mJ/m^2"}, "D", "P", USUAL)
        return TermTable(question.model).rings

    ring = {"adhesion": "maugis", "sigma0": "2 kPa"}
    of_rigid = rings(BARE | ring | {"punch": "rigid", "E2": "5 kPa"}, "E2")
    assert of_rigid.in_closed_form
    x = np.linspace(-5, 0, 6)
    assert_allclose(of_rigid._ratios({}, x, x - 1.0), 1, rtol=0, atol=1e-11)
    elastic = {"punch": None, "E_punch": "50 kPa", "nu_punch": 0.3, "E2": "5 kPa"}
    assert not rings({name: value for name, value in (BARE | ring | elastic).items() if value}, "E2").in_closed_form
    assert not rings(MAUGIS | {"E1": "5 kPa"}, "E1").in_closed_form


def test_spreads_of_other_inputs_make_the_answer_less_sure():
    """By a modulus of the base with ±: E1 follows it as it does when the base has another one."""
    P, free = loads(DEPTHS, **GEL | TRUE), ["E1", "w_adhesion"]
    about = GEL | {"w_adhesion": "0.5 mJ/m^2", "intervals": "fisher"}
    unsure = fitted(DEPTHS, P, free, **about | {"R": "5 ± 0.25 um"})
    other = fitted(DEPTHS, P, free, **about | {"R": "5.25 um"})
    assert_allclose(unsure.E1_spread, np.abs(other.E1 - 5e3), rtol=0.1)


def test_spreads_under_maugis():
    """A punch of another radius makes another fit; a spread of the radius moves w so."""
    about = BARE | {"adhesion": "maugis", "sigma0": "2 kPa", "E2": "5 kPa"}
    P = loads(DEPTHS, **about, w_adhesion="0.4 mJ/m^2")
    about |= {"w_adhesion": "1 mJ/m^2", "contact_point": False, "baseline": False, "intervals": "fisher"}
    usual, unsure, other = (
        fitted(DEPTHS, P, ["w_adhesion"], **about | {"R": R}) for R in ("5 um", "5 ± 0.05 um", "5.05 um")
    )
    assert_allclose(unsure.w_adhesion_spread, np.abs(other.w_adhesion - usual.w_adhesion), rtol=0.1)


def test_of_a_plan_the_spreads_are_those_of_the_fit():
    about = GEL | TRUE
    plan = study.fit({"D": (DEPTHS, "m")}, free=["E1", "w_adhesion"], plan=True, sigma="0.2 nN", **about)
    P = loads(DEPTHS, **about)
    made = fitted(DEPTHS, P, ["E1", "w_adhesion"], **about, sigma="0.2 nN", intervals="fisher")
    assert_allclose(plan.w_adhesion_spread, made.w_adhesion_spread, rtol=1e-2)


@pytest.mark.parametrize(
    "inputs, message",
    [
        (GEL | {"shape": "flat", "flat_radius": "1 um", "R": None}, 'shape = "flat" with w_adhesion'),
        (GEL | {"k_machine": "1 N/m"}, "k_machine"),
    ],
)
def test_what_no_curve_can_say_is_refused(inputs, message):
    free = ["E1", "k_machine"] if "k_machine" in inputs else ["E1", "w_adhesion"]
    with pytest.raises(study.StudyError, match=message):
        fitted(DEPTHS, 0 * DEPTHS, free, **inputs | TRUE)


CELL = {"punch": "rigid", "nu2": 0.5, "base": "half_space", "micro": "smooth", "progress": False}


@pytest.mark.parametrize(
    ("number", "R", "E", "w", "rms"), [(1, 2.5, 1614.2, 3.080e-5, 98.1), (2, 5.0, 267.7, 4.327e-5, 134.04)]
)
def test_all_points_of_a_retraction_stick(number, R, E, w, rms):
    """Where only the deepest tenth stuck, and the rest was Hertz's curve, the points were 106.8 and 145.2 pN off."""
    path = ROOT / f"tests/inverse/misfit/measured/retraction_jkr_{number}.csv"
    fit = study.fit(path, free=["E2", "w_adhesion"], R=f"{R} um", w_adhesion="10 uJ/m^2", intervals="fisher", **CELL)
    assert_allclose([fit.E2.item(), fit.w_adhesion.item()], [E, w], rtol=5e-3)
    assert 1e12 * np.sqrt(np.mean(fit.residual.values**2)) < rms + 0.05
    assert not fit.no_pull


@pytest.mark.parametrize("begin", ["0.1 mJ/m^2", "10 mJ/m^2"])
def test_a_curve_without_a_pull_is_fitted_without_adhesion(begin):
    """Hertz's curve with noise: w = 0, E as without adhesion, whatever w the search begins with; 36 % off before."""
    P = solved("D", "P", DEPTHS, **BARE, E2="5 kPa")
    P = P + 0.01 * P.max() * np.random.default_rng(0).standard_normal(len(P))
    fit = fitted(DEPTHS, P, ["E2", "w_adhesion"], **BARE, w_adhesion=begin, intervals="fisher")
    plain = fitted(DEPTHS, P, ["E2"], **BARE, intervals="fisher")
    assert fit.no_pull and fit.w_adhesion.item() == 0 and fit.E2.item() == plain.E2.item()
    assert "w_adhesion = 0 (no pull)" in str(study.summary(fit))
    assert fit.E2_low < 5e3 < fit.E2_high

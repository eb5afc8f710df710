"""The bounds of every number: one table in the solver; outside, a status of the case, or a message of the study."""

from itertools import product

import numpy as np
import pytest
from solver_cases import ALL_KINDS, KINDS, LOAD, MAIN

import study
from solver import Problem, Status, solve
from solver.known import PARAMETERS
from solver.parameters import CONTROL, ends
from solver.scaling import dimensionless, refused
from study.__main__ import main
from study.inputs.lexicon import PACKAGE
from study.inputs.vocabulary import VOCABULARY
from study.studies.paper.uniform import solve_uniform

#: What tests, `make extremes` and the issue use, and units as far as floating point goes.
USED = {
    "P": (1e-14, 0.1), "a": (1e-6, 1.0), "D": (1e-12, 1.0), "h": (1e-8, 1e3), "n": (1e-8, 1e8), "m": (0.0, 1e8),
    "Ra": (1e-5, 0.1),
    "Nbar": (1e-4, 1e16), "B": (1e-6, 100.0), "beta": (0.022, 1.0), "k": (0.0, 50.0), "nodes": (4, 256),
    "rtol": (1e-12, 0.1), "R": (1e-300, 1e300), "E2": (1e-300, 1e300), "nu1": (-0.9, 0.5), "nu2": (-0.9, 0.5),
    "accuracy": (1e-6, 0.5), "max_iterations": (1, 100_000), "sigma": (0.0, 1.0), "cut": (3.0, 5.0),
    "hardness": (1e-12, 1e12), "yield_strength": (1e-12, 1e12),
    **dict.fromkeys(("Y1", "Y2", "Y_punch"), (1e-12, 1e12)), "half_angle": (1.0, 89.0),
    **dict.fromkeys(("flat_radius", "tip_radius", "edge_radius"), (1e-6, 1.0)), "shape_power": (1.0, 20.0),
    "shape_coefficient": (1e-3, 1e6), "w_adhesion": (0.0, 1.0), **dict.fromkeys(("sigma0", "z0"), (1e-12, 1.0)),
    "k_machine": (0.0, 1e12),
}  # fmt: skip
BOUNDS = {name: ends(own.interval)[:2] for name, own in (CONTROL | PARAMETERS).items() if own.interval}
BOUNDS.pop("table_unit", None)  # it is there where a test before has read a table of a shape
#: What a number of a shape or of adhesion needs beside it; the rest of the case is smooth then.
PUNCHES = {
    "half_angle": {"shape": "cone"},
    "flat_radius": {"shape": "frustum", "half_angle": 60.0},
    "tip_radius": {"shape": "blunt_cone", "half_angle": 60.0},
    "edge_radius": {"shape": "rounded_flat", "flat_radius": 0.2},
    "shape_power": {"shape": "power", "shape_coefficient": 1.0},
    "shape_coefficient": {"shape": "power", "shape_power": 2.0},
    **dict.fromkeys(("w_adhesion", "k_machine", "sigma0", "z0"), {"w_adhesion": 1e-6}),
}
X = np.linspace(0.0, 1.0, 5)


def test_the_bounds_hold_what_is_used():
    assert set(BOUNDS) == set(USED)
    for name, (low, high) in USED.items():
        assert BOUNDS[name][0] <= low and high <= BOUNDS[name][1], name


def test_a_study_has_the_bounds_of_the_solver():
    """rtol alone is narrower: a tolerance of a half is for tests on fixed meshes."""
    own = {name: PACKAGE.parameter(name).interval for name in BOUNDS if name in VOCABULARY}
    known = {name: (CONTROL | PARAMETERS)[name].interval for name in own}
    assert {name: text for name, text in own.items() if text != known[name]} == {"rtol": "[1e-12, 0.1]"}
    assert set(BOUNDS) - set(own) == {"R", "E2"}


def just_outside(name):
    """The next number below and the next above."""
    own = (CONTROL | PARAMETERS)[name]
    low, high, with_low, with_high = ends(own.interval)
    if own.whole:
        return np.array([-1, high + 1])
    if high == np.inf and with_high:  # nothing is above
        return np.array([np.nextafter(low, -np.inf), -np.inf])
    return np.array(
        [np.nextafter(low, -np.inf) if with_low else low, np.nextafter(high, np.inf) if with_high else high]
    )


#: Powers of R = 2 and E2 = 4, which scale without rounding.
UNITS = {
    "P": 16.0,
    "a": 2.0,
    "D": 2.0,
    "h": 2.0,
    "Ra": 2.0,
    "Nbar": 0.25,
    "sigma": 2.0,
    "hardness": 4.0,
    **dict.fromkeys(("yield_strength", "Y1", "Y2", "Y_punch", "sigma0"), 4.0),
    **dict.fromkeys(("flat_radius", "tip_radius", "edge_radius", "z0"), 2.0),
    **dict.fromkeys(("w_adhesion", "k_machine"), 8.0),
}
CASE = MAIN | {"base": "auto", "R": 2.0, "E2": 4.0}
LAWS = dict.fromkeys(("sigma", "cut"), "normal_heights") | dict.fromkeys(
    ("hardness", "yield_strength"), "elastic_plastic"
)


@pytest.mark.parametrize("name", BOUNDS)
def test_a_number_is_allowed_up_to_its_bounds(name):
    """Which are those of a problem in units R = E2* = 1."""
    low, high, with_low, with_high = ends((CONTROL | PARAMETERS)[name].interval)
    inside = [low if with_low else 0.1, high if with_high else 0.1, *(CONTROL | PARAMETERS)[name].also]

    def problem(values):
        law = LAWS.get(name, "smooth" if name in PUNCHES else "power_law")
        case = (
            PUNCHES.get(name, {})
            | ({} if name in CONTROL else {"P": LOAD})
            | CASE
            | {"micro": law, "sigma": 1e-4, "cut": 4.0, name: values}
        )
        return Problem.of(**{key: np.multiply(v, UNITS[key]) if key in UNITS else v for key, v in case.items()})

    allowed = problem(inside)
    assert not refused(allowed, dimensionless(allowed)).any()
    s = solve(problem(just_outside(name)))
    assert s.status.tolist() == [Status.INVALID_INPUT] * 2
    assert np.isnan(s.p0).all() and np.isnan(s.p).all()


def test_a_modulus_that_is_none():
    """At given a the equations do without E2*."""
    s = solve(Problem.of(a=0.04, base="half_space", micro="smooth", E2=[1.0, 0.0, -1.0, np.inf, np.nan]))
    assert s.status.tolist() == [Status.CONVERGED] + [Status.INVALID_INPUT] * 4


@pytest.mark.parametrize("name", ["h", "n", "Ra", "P"])
def test_uniform_meshes_have_the_same_bounds(name):
    case = MAIN | {"P": LOAD, "base": "thin_layer", "micro": "power_law"} | {name: just_outside(name)}
    s = solve_uniform(Problem.of(**case), 4, 5.0, 1e-2, 10)
    assert s.status.tolist() == [Status.INVALID_INPUT] * 2


def corners(base, micro, control):
    """Arguments of ``Problem.of``: every number that counts at its lowest and its highest."""
    names = [control, *["h", "n"] * (base != "half_space"), *["Nbar", "Ra"] * (micro != "smooth")]
    names += ["B", "beta"] * (micro == "power_law")
    rows = product(*(BOUNDS[name] for name in names), ["frictionless", "bonded"])
    columns = dict(zip([*names, "bonding"], zip(*rows, strict=True), strict=True))
    return {name: np.array(values) for name, values in columns.items()} | {"base": base, "micro": micro}


@pytest.mark.parametrize("control", ["P", "D"])
@pytest.mark.parametrize(("base", "micro"), KINDS)
def test_the_corners_of_the_box_are_solved_or_flagged(base, micro, control):
    """Without a warning. Power laws of β = 0.01 are almost steps: their pressure may leave floating point."""
    case = corners(base, micro, control)
    s = solve(Problem.of(**case, rtol=1e-3), X)
    assert not (s.not_finite() | s.out_of_range()).any()
    ends_of = {Status.CONVERGED, *[Status.THIN_LAYER_NOT_APPLICABLE] * (base == "thin_layer")}
    assert set(s.status[case.get("beta", np.ones(1)) == 1.0] if micro == "power_law" else s.status) <= ends_of
    assert set(s.status) <= ends_of | {Status.DIVERGED, Status.TOLERANCE_NOT_MET}


BAD = [("n", 1e308), ("h", 5e-324), ("a", 1.7e-251), ("P", 1e4), ("B", 1e-300), ("beta", 1e-3), ("k", 1e7)]


@pytest.mark.parametrize(("name", "value"), BAD)
def test_a_study_says_what_is_allowed(name, value):
    """At once, and nothing is computed."""
    case = ({} if name == "a" else {"P": LOAD}) | MAIN | {"micro": "power_law", name: value}
    with pytest.raises(study.StudyError) as caught:
        study.solve(**case)
    own = PACKAGE.parameter(name)
    low, high = own.interval[1:-1].split(", ")
    single = "".join(f"{also} or " for also in own.also)
    assert caught.value.messages == (f"solve: {name} = {value}: must be {single}in [{low}, {high}]",)


def test_a_study_file_says_it_with_exit_code_2(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text('[model]\nn = 1e308\nh = 5e-324\nmicro = "smooth"\n[axes]\na = [0.1, 1.7e-251]\n')
    assert main(["run", "s.toml"]) == 2
    assert capsys.readouterr().err.splitlines() == [
        "s.toml: a[1] = 1.7e-251: must be in [1e-9, 1e3]",
        "s.toml: n = 1e+308: must be 0 or in [1e-9, 1e9]",
        "s.toml: h = 5e-324: must be in [1e-12, 1e6]",
    ]
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize(("base", "micro"), ALL_KINDS)
def test_what_no_floating_point_carries_is_not_solved(base, micro):
    """The cases of the issue, in the middle of a batch: they were said to have converged, D = 0 among them."""
    numbers = {"a": 1.7e-251, **({} if base == "half_space" else {"n": 1e308, "h": 5e-324})}
    for name, value in numbers.items():
        case = MAIN | {"a": 0.04, "base": base, "micro": micro, "rtol": 1e-3}
        s = solve(Problem.of(**case | {name: [case[name], value]}))
        assert s.status.tolist() == [Status.CONVERGED, Status.INVALID_INPUT], name


@pytest.mark.parametrize("name", [name for name, own in PARAMETERS.items() if own.choices])
def test_a_word_that_is_no_choice_is_answered_with_all(name):
    with pytest.raises(ValueError, match="must be one of") as error:
        Problem.of(P=LOAD, **MAIN | {name: "nothing"})
    assert all(choice in str(error.value) for choice in PARAMETERS[name].choices)

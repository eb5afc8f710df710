"""What is not given: `solver` and `study` put the same in its place, and ask for what has no default."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import study
from solver import Problem, Status, solve
from solver.known import PARAMETERS
from study.inputs.identity import case_keys
from study.inputs.lexicon import PACKAGE
from study.inputs.reading import from_tables
from study.inputs.vocabulary import VOCABULARY

DEFAULTS = {
    "m": 0.0,
    "nu1": 0.3,
    "nu2": 0.3,
    "bonding": "frictionless",
    "base": "layered",
    "accuracy": 0.01,
    "model_check": "closed_form",
    "micro": "disc_cell",
    "asperities_on": "auto",
    "shape": "paraboloid",
    "tip": "paraboloid",
    "w_adhesion": 0.0,
    "adhesion": "jkr",
    "branch": "stable",
    "scheme": "newton",
    "k": 1.0,
    "rtol": 1e-6,
    "nodes": 0,
    "max_iterations": 0,
    "cut": 4.0,
    "R": 1.0,
    "E2": 1.0,
}
CASE = {"P": 1e-5, "h": 0.02, "n": 0.5, "Nbar": 250000.0, "Ra": 0.004}
THIN = CASE | {"base": "thin_layer"}
APPROXIMATED = {name: value for name, value in THIN.items() if name != "P"}
APPROXIMATED |= {"a": 0.03, "scheme": "picard", "nodes": 12, "max_iterations": 30}
# parameter, a case in which it counts, another value, and what that changes
COUNTS = [
    ("m", CASE, 0.5, "a"),
    ("nu1", CASE | {"bonding": "bonded"}, 0.4, "a"),
    ("nu2", CASE | {"bonding": "bonded"}, 0.4, "a"),
    ("bonding", CASE, "bonded", "a"),
    ("base", CASE, "thin_layer", "a"),
    ("accuracy", CASE | {"base": "auto", "h": 1e-4, "asperities_on": "half_space"}, 1e-6, "a"),
    ("model_check", THIN, "first_order", "model_error"),
    ("micro", CASE, "smooth", "a"),
    ("asperities_on", CASE | {"h": 1e-3}, "half_space", "a"),
    ("scheme", APPROXIMATED | {"scheme": "newton"}, "picard", "P"),
    ("k", APPROXIMATED, 3.0, "P"),
    ("rtol", CASE, 1e-2, "a"),
    ("nodes", CASE, 8, "a"),
    ("max_iterations", CASE, 1, "a"),
    ("cut", CASE | {"micro": "normal_heights", "sigma": 1e-5}, 3.0, "a"),
    ("R", CASE, 2.0, "a"),
    ("E2", CASE, 2.0, "a"),
]


def test_an_unknown_parameter_is_named():
    """Of several the first in the alphabet, in whatever order they are given; and before what is missing."""
    for unknown in (["nu3"], ["nu3", "gamma"], ["gamma", "nu3", "zeta"]):
        with pytest.raises(TypeError, match=f"^unknown parameter {min(unknown)}$"):
            Problem.of(P=1e-5, **dict.fromkeys(unknown, 1.0))


def test_the_table():
    """Of defaults: no other parameter has one, in the solver or in a study."""
    assert {name: own.default for name, own in PARAMETERS.items() if own.default is not None} == DEFAULTS
    of_studies = {name: PACKAGE.parameter(name).default for name in PARAMETERS if name in VOCABULARY}
    assert {name: value for name, value in of_studies.items() if value is not None} == {
        name: value for name, value in DEFAULTS.items() if name not in ("R", "E2")
    }


def test_the_exact_layer_is_the_default_of_both():
    """The load of 1e-5 on the paper's layer: a of the exact layer and of the thin one, 12 % apart."""
    assert_allclose(solve(Problem.of(**CASE)).a, 0.0273, rtol=2e-3)  # three digits are printed
    assert_allclose(study.solve(**CASE).a, 0.0273, rtol=2e-3)
    assert_allclose(solve(Problem.of(**THIN)).a, 0.0307, rtol=2e-3)


@pytest.mark.parametrize(("name", "case", "other", "changed"), COUNTS, ids=[row[0] for row in COUNTS])
def test_both_fronts_have_the_same_default(name, case, other, changed):
    case = {key: value for key, value in case.items() if key != name}
    given = case | {name: DEFAULTS[name]}
    found = [getattr(solve(Problem.of(**arguments)), changed)[0] for arguments in (case, given)]
    if name in VOCABULARY:
        found += [study.solve(**arguments, x=2)[changed].item() for arguments in (case, given)]
    assert_allclose(found, found[0], rtol=1e-11)  # the same cases, solved four times
    another = getattr(solve(Problem.of(**case | {name: other})), changed)[0]
    assert abs(another / found[0] - 1) > 1e-9, "else the parameter does not count"


@pytest.mark.parametrize(("name", "case", "other"), [row[:3] for row in COUNTS if row[0] in VOCABULARY])
def test_a_value_counts_in_the_case_that_has_it(name, case, other):
    """Of two cases one has the default. Exchanged, they are another study, whose results are other ones; and each case
    is found again by its key."""
    rows = [case | {name: DEFAULTS[name]}, case | {name: other}]
    first, second = (from_tables({"cases": cases}, "s", "", "s") for cases in (rows, rows[::-1]))
    assert first.digest != second.digest and first.digest == from_tables({"cases": rows}, "t", "", "t").digest
    keys = case_keys(first.grid).tolist()
    assert keys[0] != keys[1] and keys[::-1] == case_keys(second.grid).tolist()


@pytest.mark.parametrize("name", ["n", "m", "nu1", "k", "nodes", "max_iterations"])
def test_nought_is_a_value(name):
    """Of a case, or of all: it is no gap, in whose place a default would stand."""
    case = {key: value for key, value in CASE.items() if key != name}
    of_cases = from_tables({"cases": [case | {name: 0}, case | {name: 0, "P": 2e-5}]}, "s", "", "s").grid
    assert of_cases.values[name][1].tolist() == [0, 0]
    section = "numerics" if name in ("k", "nodes", "max_iterations") else "model"
    tables = {"model": dict(case), "numerics": {}}
    tables[section][name] = 0
    assert from_tables(tables, "s", "", "s").grid.values[name][1] == 0


MISSING = [
    ({"base": "layered"}, ("n", "Nbar", "Ra"), 'h is missing: base = "layered" needs it'),
    ({"base": "thin_layer"}, ("h", "Nbar", "Ra"), 'n is missing: base = "thin_layer" needs it'),
    ({"base": "auto"}, ("n", "Nbar", "Ra"), 'h is missing: base = "auto" needs it'),
    ({}, ("h", "n", "Ra"), 'Nbar is missing: micro = "disc_cell" needs it'),
    ({"micro": "power_law", "B": 0.1, "beta": 0.5}, ("h", "n", "Nbar"), 'Ra is missing: micro = "power_law" needs it'),
    ({"micro": "power_law", "beta": 0.5}, CASE, 'B is missing: micro = "power_law" needs it'),
    ({"micro": "power_law", "B": 0.1}, CASE, 'beta is missing: micro = "power_law" needs it'),
    ({"base": ["half_space", "layered"]}, ("n", "Nbar", "Ra"), 'h is missing: base = "layered" needs it'),
    (
        {"base": ["layered", "thin_layer"]},
        ("n", "Nbar", "Ra"),
        'h is missing: base = "thin_layer" or "layered" needs it',
    ),
]


@pytest.mark.parametrize(("chosen", "given", "message"), MISSING, ids=[row[-1] for row in MISSING])
def test_what_has_no_default_is_asked_for(chosen, given, message):
    case = chosen | {"P": 1e-5} | {name: CASE[name] for name in given}
    with pytest.raises(ValueError) as caught:
        Problem.of(**case)
    assert str(caught.value) == message
    with pytest.raises(study.StudyError) as caught:
        study.solve(**case)
    hint = ' (without asperities: micro = "smooth")' * ("micro = " in message and "micro" not in case)
    assert caught.value.messages == (f"solve: {message}{hint}",)


def test_all_that_is_missing_is_named():
    needs = {"h": "base", "n": "base", "Nbar": "micro", "Ra": "micro"}
    words = [f'{name} is missing: {selector} = "{DEFAULTS[selector]}" needs it' for name, selector in needs.items()]
    with pytest.raises(ValueError) as caught:
        Problem.of(P=1e-5)
    assert str(caught.value) == "; ".join(words)


def test_what_no_case_needs_is_nan_and_may_be_anything():
    bare = Problem.of(P=1e-5, micro="smooth", base="half_space")
    assert np.isnan([getattr(bare, name)[0] for name in ("h", "n", "Nbar", "Ra", "B", "beta")]).all()
    assert_allclose(solve(bare).a, np.cbrt(0.75e-5), rtol=1e-14)  # Hertz
    for micro, base in (("smooth", "layered"), ("smooth", "auto"), ("disc_cell", "half_space"), ("disc_cell", "auto")):
        case = {"P": [1e-5, 2e-5], "micro": micro, "base": base}
        case |= {"h": 0.02, "n": 0.5} if base != "half_space" else {}
        case |= {"Nbar": 250000, "Ra": 0.004} if micro != "smooth" else {}
        ones = {name: 1.0 for name in ("h", "n", "Nbar", "Ra", "B", "beta") if name not in case}
        found, expected = solve(Problem.of(**case)), solve(Problem.of(**case, **ones))
        assert_array_equal(found.status, Status.CONVERGED)
        assert_allclose(found.a, expected.a, rtol=1e-11)


def test_a_gap_in_a_given_array_is_a_status():
    found = solve(Problem.of(**CASE | {"h": [0.02, np.nan], "Nbar": [250000, 250000]}))
    assert found.status.tolist() == [Status.CONVERGED, Status.INVALID_INPUT]

"""A number that is not finite, or negative where it cannot be, is never a converged one, however it came about."""

from dataclasses import replace

import numpy as np
import pytest
from solver_cases import LOAD, MAIN

from solver import Problem, Status, solve
from solver.smooth import paraboloids
from study.studies.paper.uniform import solve_uniform

X = np.linspace(0.0, 1.0, 5)
#: So small an exponent makes A almost a step of p: p leaves the range of floating point near the edge, and with
#: β = 0.01 in the centre too.
STEP = {"a": 0.0008, "Ra": 0.0057, "Nbar": 250000, "micro": "power_law", "B": 0.1, "beta": 0.022, "base": "half_space"}
ASKED = ("a", "P", "D", "p0", "p_max", "Ar_An", "A0", "dP_dD", "residual", "error", "p", "lam")


def assert_numbers_or_none(s, names=ASKED):
    """Cases said to be solved have all their numbers; those that diverged have none but the given one."""
    solved = np.isin(s.status, (Status.CONVERGED, Status.TOLERANCE_NOT_MET))
    for name in names:
        assert np.all(np.isfinite(getattr(s, name)[solved])), name
        assert name == "a" or np.all(np.isnan(getattr(s, name)[s.status == Status.DIVERGED])), name


@pytest.mark.parametrize("scheme", ["newton", "picard"])
@pytest.mark.parametrize("base", ["half_space", "thin_layer"])
def test_power_laws_that_are_almost_steps(base, scheme):
    beta, k = (v.ravel() for v in np.meshgrid([0.01, 0.022, 0.05, 0.5], [0.0, 1.0, 20.0]))
    s = solve(Problem.of(**STEP | {"beta": beta, "k": k, "base": base, "h": 0.02, "n": 0.5, "scheme": scheme}), X)
    assert Status.DIVERGED in s.status or base == "thin_layer"  # whose springs carry where the asperities do not
    assert s.status[beta == 0.5].min() == Status.CONVERGED or scheme == "picard"
    assert_numbers_or_none(s)


@pytest.mark.parametrize("base", ["half_space", "thin_layer", "auto"])
def test_a_number_that_its_unit_makes_infinite(base):
    """A load in units of R² E2, of which R = 1e200 makes 1e395."""
    s = solve(Problem.of(a=0.04e200, h=0.02e200, n=0.5, micro="smooth", base=base, R=1e200), X)
    assert s.status[0] == Status.DIVERGED
    assert_numbers_or_none(s)


def test_a_number_out_of_bounds_on_a_uniform_mesh():
    """It has no answer; the case beside it has all its numbers."""
    case = MAIN | {"h": [0.02, 0.02e200]}
    s = solve_uniform(Problem.of(a=[0.04, 0.04e200], **case, base="thin_layer", micro="smooth"), 8, 5.0, 1e-2)
    assert s.status.tolist() == [Status.CONVERGED, Status.INVALID_INPUT]
    for name in ("a", "P", "D", "p0", "p_max", "A0"):
        assert np.isfinite(getattr(s, name)).tolist() == [True, False], name


def test_a_negative_number_of_a_way_to_solve(monkeypatch):
    hertz = paraboloids.on_half_space

    def wrong(control, value, x):
        found = hertz(control, value, x)
        return replace(found, D=np.where(value == 0.04, -found.D, found.D))

    monkeypatch.setattr(paraboloids, "on_half_space", wrong)
    s = solve(Problem.of(a=[0.02, 0.04], micro="smooth", base="half_space"), X)
    assert s.status.tolist() == [Status.CONVERGED, Status.DIVERGED]
    assert_numbers_or_none(s)


@pytest.fixture(scope="module")
def good():
    return solve(Problem.of(P=[LOAD, 2 * LOAD], **MAIN, base="thin_layer"), X)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, -1e-3])
@pytest.mark.parametrize("name", ASKED)
def test_every_number_counts(good, name, bad):
    """In the second of two cases; a profile is bad at one radius."""
    assert not (good.not_finite() | good.out_of_range()).any()
    s = copied(good)
    getattr(s, name).reshape(2, -1)[1, -1] = bad
    assert (s.not_finite() | s.out_of_range()).tolist() == [False, True]


@pytest.mark.parametrize("name", ["a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD"])
def test_nought_is_no_answer(good, name):
    s = copied(good)
    getattr(s, name)[1] = 0.0
    assert s.out_of_range().tolist() == [False, True]


@pytest.mark.parametrize("name", ["Ar_An", "lam"])
def test_no_more_than_the_whole_area(good, name):
    s = copied(good)
    getattr(s, name)[1] = 1.001
    assert s.out_of_range().tolist() == [False, True]


def test_what_is_not_given_and_what_did_not_converge(good):
    """NaN where none was asked for, and last numbers of another end, are nobody's fault."""
    s = copied(good)
    s.error[:] = s.model_error[0] = np.nan
    assert s.not_finite().all()
    s = copied(good)
    s.p0[1], s.status[1] = -1.0, Status.TOLERANCE_NOT_MET  # lift-off is told from such numbers
    assert not (s.not_finite() | s.out_of_range()).any()
    for number in (np.nan, np.inf):  # but what has a solution has numbers, also where their error is too large
        s.p0[1] = number
        assert s.not_finite().tolist() == [False, True]
    s.p0[1], s.status[1] = np.nan, Status.ITERATION_LIMIT
    assert not (s.not_finite() | s.out_of_range()).any()


def copied(s):
    return type(s)(**{name: value.copy() for name, value in vars(s).items()})

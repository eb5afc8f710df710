"""Every case of the ranges converges; bad input and limits are said.

Warnings are errors here, as in all tests of the project.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from solver_cases import JUDGED, KINDS, LOAD, MAIN, difference, one, random_cases

from solver import Problem, Status, solve

pytestmark = pytest.mark.usefixtures("each_path")

kinds = pytest.mark.parametrize(("base", "law"), KINDS, ids=["-".join(kind) for kind in KINDS])
NUMBERS = (*JUDGED, "A0", "dP_dD", "residual", "error", "p", "lam")


@kinds
def test_twenty_thousand_random_cases(base, law):
    """P 1e-7…1e-3, Ra 5e-4…1e-2, Nbar Ra² 0.1…10, n 0.05…0.95, h 1e-3…0.1, both bondings."""
    s = solve(Problem.of(**random_cases(20_000, 11), base=base, micro=law))
    assert_array_equal(s.status, Status.CONVERGED)
    assert np.all(s.error <= 1e-6)
    assert s.iterations.max() <= 15
    if law != "smooth":
        assert s.residual.max() <= 1e-12
        assert np.all((s.Ar_An > 0) & (s.Ar_An < 1))


def test_empty_batch():
    s = solve(Problem.of(P=np.zeros(0), **MAIN, base="thin_layer"))
    assert s.a.shape == (0,)
    assert s.p.shape == (0, 2)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("nu1", [-1.0, 0.51]),
        ("nu2", [-1.0, 0.6]),
        ("beta", [1.01]),
        ("rtol", [1.0]),
        ("k", [-0.1, np.nan]),
        ("nodes", [3, 257, -1]),
        ("max_iterations", [-1]),
    ],
)
def test_bounds(name, values):
    s = solve(Problem.of(P=LOAD, **(MAIN | {"base": "thin_layer", "micro": "power_law", name: values})))
    assert_array_equal(s.status, Status.INVALID_INPUT)


@pytest.mark.parametrize("law", ["disc_cell", "smooth"])
def test_where_the_thin_layer_does_not_apply(law):
    """C <= 0: bonded with ν1 = 1/2, n >= 1, or too compliant a base; never solved as if C were 0."""
    n = np.array([0.5, 1.0, 2.0, 0.24, 0.5, 0.5])
    nu1 = np.array([0.5, 0.3, 0.3, 0.45, 0.45, 0.3])
    nu2 = np.array([0.3, 0.3, 0.3, 0.3, 0.3, 0.3])
    s = one(P=LOAD, n=n, nu1=nu1, nu2=nu2, bonding="bonded", micro=law)
    # ν1 = 0.45, ν2 = 0.3 needs alpha = n 0.55/0.7 < 0.25
    assert s.status.tolist() == [4, 4, 4, 0, 4, 0]
    for name in NUMBERS:
        found = getattr(s, name)[s.status == 4]
        assert np.all(found == LOAD) if name == "P" else np.all(np.isnan(found))
    free = one(P=LOAD, n=n, nu1=nu1, nu2=nu2, bonding="frictionless", micro=law)
    assert_array_equal(free.status, Status.CONVERGED)
    assert np.all(np.diff(free.a[:3]) < 0)  # a harder coating, a smaller contact
    assert_allclose(free.a[4], free.a[0], rtol=1e-14, atol=0)  # without friction ν plays no part


def test_converged_is_within_rtol_in_999_of_1000():
    """Power laws of any B and β on a half-space, where 1e-9 takes anything from 24 to 64 nodes."""
    rng = np.random.default_rng(8)
    case = random_cases(800, 21) | {"B": np.exp(rng.uniform(-7, 2.3, 800)), "beta": rng.uniform(0.4, 1, 800)}
    case |= {"base": "half_space", "micro": "power_law"}
    truth = difference(solve(Problem.of(**case, rtol=1e-9)), solve(Problem.of(**case, rtol=0.5, nodes=64)))
    assert (truth <= 1e-9).mean() >= 0.999


def test_the_estimate_follows_the_error_where_asperities_saturate():
    """λ(0) = 0.78 and 1: 32 nodes are right to 1e-12 and 1e-4; the estimate must see it, and a tolerance be met."""
    thin = {"base": "thin_layer"}
    case = thin | {"P": 9.15142e-4, "Ra": 6.480e-3, "Nbar": 0.3781 / 6.48e-3**2, "n": 0.1074, "h": 1.093e-3}
    assert solve(Problem.of(**case, nodes=32, rtol=1e-9)).error[0] < 1e-11
    case = thin | {"P": 4.687e-2, "Ra": 1.334e-2, "Nbar": 0.1254 / 1.334e-2**2, "n": 5.914e-5, "h": 3.326e-7}
    assert solve(Problem.of(**case, rtol=1e-2)).status[0] == Status.CONVERGED


def test_a_low_limit_is_reported():
    s = one(P=LOAD, max_iterations=1, rtol=1e-9)
    assert s.status[0] == Status.ITERATION_LIMIT
    assert s.iterations[0] == 1
    assert s.residual[0] > 1e-12
    for name in NUMBERS:
        assert np.all(np.isfinite(getattr(s, name))), f"the last numbers are kept, {name} as well"


def test_absurd_numbers_are_a_status():
    """Beyond what floating point can carry through the formulas: a flag or numbers, but no warning and no exception."""
    good = MAIN | {"P": LOAD, "R": 1.0, "E2": 1.0}
    for name in good:
        for value in (1e-300, 1e300):
            for law in ("disc_cell", "power_law", "smooth"):
                changed = {name: np.array([good[name], value]), "base": "thin_layer", "micro": law}
                s = solve(Problem.of(**(good | changed)))
                assert s.status[0] == Status.CONVERGED, (name, value)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "exactly one of P, a, D"),
        ({"P": 1.0, "a": 1.0}, "got P, a"),
        ({"P": 1.0, "base": "rubber"}, 'base = "rubber": must be one of half_space'),
        ({"P": 1.0, "bonding": ["bonded", "glued"]}, 'bonding = "glued"'),
        ({"P": 1.0, "scheme": "secant"}, 'scheme = "secant"'),
        ({"P": 1.0, "micro": "gw"}, 'micro = "gw"'),
        ({"P": np.ones((2, 2))}, r"shape \(2, 2\)"),
        ({"P": [1.0, 2.0], "h": [1.0, 2.0, 3.0]}, "broadcast"),
    ],
)
def test_wrong_calls(arguments, message):
    with pytest.raises(ValueError, match=message):
        Problem.of(**arguments)


@pytest.mark.parametrize("x", [0.5, [[0.0]], [-0.1], [1.1], [np.nan]])
def test_wrong_radii(x):
    with pytest.raises(ValueError, match="x must be one-dimensional"):
        solve(Problem.of(P=LOAD, **MAIN, base="thin_layer"), x)


def test_every_status_has_its_sentence():
    assert all(status.meaning for status in Status)
    assert len({status.meaning for status in Status}) == len(Status)

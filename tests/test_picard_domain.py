"""The convergence maps of the successive approximations: size of the cycle, lines of the linear theory, the figure."""

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from solver_cases import MAIN

from solver import Problem, Status, picard, solve
from solver.cases import as_cases, dimensionless
from solver.mesh import mesh
from study import open_results
from study.picard_domain import MAPS, SHARES, cycle_size, theory

CASE = (
    {"a": 0.04} | {name: MAIN[name] for name in ("n", "Nbar", "Ra", "B")} | {"base": "thin_layer", "micro": "power_law"}
)


def approximations(k, count, nodes=32, **case):
    problem = Problem.of(**(CASE | {"beta": 0.5, "h": 0.02} | case), k=k, nodes=nodes)
    cases, law = as_cases(*dimensionless(problem))
    return picard.approximate(cases, np.log(cases.value), law, mesh(nodes), problem.k, np.zeros(1), count)


def test_size_of_the_cycle_is_that_of_the_next_change():
    k = 2.0
    s = solve(Problem.of(**CASE, beta=0.5, h=0.02, scheme="picard", k=k, nodes=32, rtol=1e-9, max_iterations=4))
    one = (("k", "h"), np.array([[s.residual[0]]])), (("k", "h"), np.array([[s.p0[0]]]))
    part = xr.Dataset({"residual": one[0], "p0": one[1]}, {"h": [0.02], "k": [k], "a": 0.04, "n": 0.5})
    assert_allclose(cycle_size(part)[0, 0], approximations(k, 5).change[0], rtol=0.02)


def test_above_the_line_the_whole_contact_settles_and_below_it_swings():
    """Asperities hardly yield: only the half-space part decides."""
    h = np.array([0.002, 0.01])
    whole, _ = theory(CASE | {"B": 1e-6}, h, 0.5, 32)
    for thickness, edge in zip(h, whole, strict=True):
        above, below = (approximations((factor * edge - 1) / 2, 2000, h=thickness, B=1e-6) for factor in (1.1, 0.9))
        assert above.load_change[0] < 1e-6 < 1e-2 < below.load_change[0]


def test_lines_of_the_asperities_are_the_slope_of_their_law():
    h, beta = np.array([0.02]), 0.5
    _, edges = theory(CASE, h, beta, 32)
    p0 = solve(Problem.of(**CASE, beta=beta, h=0.02)).p0
    for share, edge in zip(SHARES, edges, strict=True):
        p = share * p0 * np.array([1 - 1e-6, 1 + 1e-6])
        A = CASE["B"] * CASE["Ra"] * (p / CASE["n"]) ** beta
        assert_allclose(edge, np.diff(A) / np.diff(p) / (2 * h), rtol=1e-6)


def test_pressures_below_the_line_cycle_and_those_above_do_not():
    """k = 0: A'(p) = C at p = 5e-5 E2*; one decade below all nodes swing, one above none."""
    problem = Problem.of(**CASE, beta=0.5, h=0.02, rtol=1e-9)
    grid = mesh(64)
    solution = solve(problem, grid.x).p[0]
    critical = (0.5 * CASE["B"] * CASE["Ra"] / CASE["n"] ** 0.5 / 0.04) ** 2
    first, second = (approximations(0.0, count, nodes=64).q[0] * CASE["n"] for count in (1000, 1001))
    swing = np.abs(first - second)
    assert (swing[solution < 0.1 * critical] > 0.5 * solution[solution < 0.1 * critical]).all()
    assert (swing[solution > 10 * critical] < 1e-2 * solution[solution > 10 * critical]).all()


def test_the_study_holds_cycles_and_answers(results):
    found = open_results(results / "picard_domain.nc")
    status = found["status"].values
    assert set(np.unique(status)) <= {
        Status.CONVERGED,
        Status.ITERATION_LIMIT,
        Status.LIMIT_CYCLE,
        Status.TOLERANCE_NOT_MET,
    }
    assert (status == Status.LIMIT_CYCLE).any()
    for beta, nodes in MAPS:
        size = cycle_size(found.sel(beta=beta, nodes=nodes).transpose("k", "h", ...))
        assert size[-1, -1] < 1e-3 < size[0, 0], "large k and C against small ones"


@pytest.mark.parametrize("k", [0.0, 1.0, 5.0])
def test_the_cycle_shrinks_with_k_as_the_map_says(k):
    assert approximations(2 * k + 1, 2000).change[0] < approximations(k, 2000).change[0]

"""How the paper's successive approximations end: a cycle is told from what is slow, not settled, or beside the load."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import LOAD, MAIN, one

from solver import Problem, Status
from solver.numerics.bracket import false_position
from solver.numerics.mesh import mesh_of
from solver.rough import picard as scheme
from solver.scaling import as_cases, dimensionless


def picard(**case):
    return one(**{"scheme": "picard", "nodes": 32, "micro": "power_law", "base": "thin_layer"} | case)


def test_what_still_falls_is_no_cycle():
    """k = 20 is slow: after 100 approximations |p̂ - p| still falls tenfold in 50, and the load has long settled."""
    s = picard(a=0.04, k=20.0, max_iterations=100)
    assert s.status[0] == Status.ITERATION_LIMIT
    assert_allclose(s.P, one(a=0.04, micro="power_law", base="thin_layer").P, rtol=1e-2, atol=0)


@pytest.mark.parametrize("nodes", [4, 32])
def test_a_load_that_swings_with_the_iterates_is_no_cycle_with_a_result(nodes):
    """Soft asperities on a hard film, without relaxation: full pressure and none in turn, and so does the load."""
    s = picard(a=0.04, k=0.0, B=1.0, beta=0.5, h=1e-3, nodes=nodes)
    assert s.status[0] == Status.ITERATION_LIMIT


def solved(**case):
    """Radius (1,), status and count of the scheme."""
    problem = Problem.of(**(MAIN | {"P": LOAD, "micro": "power_law", "base": "thin_layer"} | case))
    cases = as_cases(dimensionless(problem))
    with np.errstate(all="ignore"):  # as `solver.solve` does
        found, status = scheme.solve(cases, mesh_of(16), np.array([5.0]), np.array([1e-6]), 0)
    return found.at.state, status[0], found.count[0]


def test_a_settled_pressure_at_another_load_is_not_converged(monkeypatch):
    def beside(function, start, tolerance):
        eta, _ = false_position(function, start, tolerance)
        function(eta + 1e-5, np.arange(len(eta)))  # P ~ a^3: 3e-5 of it, and 1e-6 are asked

    assert solved()[1] == Status.CONVERGED
    monkeypatch.setattr(scheme, "false_position", beside)
    assert solved()[1] != Status.CONVERGED


def test_the_approximations_at_all_radii_count(monkeypatch):
    counts = []

    def counted(*arguments):
        fixed = approximate(*arguments)
        counts.append(fixed.count.sum())
        return fixed

    approximate = scheme.approximate
    monkeypatch.setattr(scheme, "approximate", counted)
    *_, total = solved()
    assert len(counts) > 3 and total == sum(counts)

"""How the paper's successive approximations end: a cycle is told from what is slow, not settled, or beside the load."""

from numpy.testing import assert_allclose
from solver_cases import one

from solver import Status


def picard(**case):
    return one(**{"scheme": "picard", "nodes": 32, "micro": "power_law", "base": "thin_layer"} | case)


def test_what_still_falls_is_no_cycle():
    """k = 20 is slow: after 100 approximations |p̂ - p| still falls tenfold in 50, and the load has long settled."""
    s = picard(a=0.04, k=20.0, max_iterations=100)
    assert s.status[0] == Status.ITERATION_LIMIT
    assert_allclose(s.P, one(a=0.04, micro="power_law", base="thin_layer").P, rtol=1e-2, atol=0)

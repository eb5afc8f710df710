"""Hard layers that bend as plates: that nearly lift off in the centre, and films with short waves at the edge."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem, Status, solve
from solver.numerics.mesh import panel_mesh
from solver.rough.equation import evaluate
from solver.rough.newton import solve_on
from solver.rough.results import quantities
from solver.rough.start import first_guess
from solver.scaling import as_cases, dimensionless

pytestmark = pytest.mark.usefixtures("each_path")

#: Smooth spheres, of another equation in long double, at a = E1* = 1: P and D to 12 digits or more, p(0) to 2e-12 on
#: plates and to 4e-11 on films: make_fredholm_reference.py.
REFERENCE = np.genfromtxt(
    Path(__file__).parents[2] / "references" / "fredholm_reference.csv", delimiter=",", names=True, dtype=None
)
PLATES, FILMS = (REFERENCE[REFERENCE["set"] == name] for name in ("plates", "films"))


@pytest.mark.parametrize("control", ["a", "P", "D"])
def test_rounding_of_a_small_pressure(control):
    """p(0) is 20 to 160 times smaller than the largest pressure. It was up to 12 times as far off as `error` here, a
    hundred times in other cases, and farther than rtol."""
    n, h, P, D, p0 = (PLATES[name] for name in ("n", "h_a", "P", "D", "p0"))
    assert len(PLATES) == len(FILMS) == 3
    a = 0.01
    truth = {"a": np.full(3, a), "P": P * n * a**3, "D": D * a**2, "p0": p0 * n * a}
    for rtol in (1e-6, 1e-9, 1e-10):
        found = solve(Problem.of(**{control: truth[control]}, h=h * a, n=n, micro="smooth", rtol=rtol))
        error = np.max([np.abs(getattr(found, name) / own - 1) for name, own in truth.items()], axis=0)
        assert (error < found.error).all(), f"{rtol}: {error / found.error}"
        assert (error < rtol)[found.status == Status.CONVERGED].all()


def test_a_plate_without_a_small_pressure():
    """Where p(0) is no small part of the largest pressure, rounding does not count, even under a hard layer."""
    found = solve(Problem.of(a=0.01, h=[1e-3, 0.1], n=[20.0, 2e4], micro="smooth", rtol=1e-10))
    assert (found.status == Status.CONVERGED).all()


def test_narrow_panels_at_the_edge():
    """Of a smooth punch on films that are plates, on panels down to 1e-4 of s. P was off by up to 1e-7 there: at the
    nodes next to the edge J0(kx) - J0(k) was rounding. 1e-10 leaves room for other kernels of BLAS."""
    n, h, P, D = (FILMS[name] for name in ("n", "h_a", "P", "D"))
    mesh = panel_mesh(12, (0.0, *np.geomspace(1e-4, 1.0, 18)))
    cases = as_cases(dimensionless(Problem.of(a=0.01, h=h * 0.01, n=n, micro="smooth")))
    with np.errstate(divide="ignore"):  # the sparse law of a punch without asperities, at the edge
        found = solve_on(evaluate(cases, first_guess(cases, mesh), mesh), 60)
    own = quantities(found.at)
    assert found.closed.all()
    assert_allclose(own.P, P * n * 0.01**3, rtol=1e-10)
    assert_allclose(own.D, D * 0.01**2, rtol=1e-10)

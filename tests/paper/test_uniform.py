"""The paper's own way: its mesh, its halving, its successive approximations; second order towards Newton's answer."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import ellipk
from solver_cases import LOAD, MAIN, difference, one

from solver import Problem, Status
from solver.contact import picard
from solver.numerics.bracket import bisection
from solver.numerics.mesh import HERTZ
from solver.scaling import as_cases, dimensionless
from study.paper import uniform
from study.paper.uniform import solve_uniform, uniform_mesh


def paper(intervals=40, k=2.0, tolerance=1e-5, **case):
    problem = Problem.of(**(MAIN | {"base": "thin_layer", "micro": "power_law"} | case))
    return solve_uniform(problem, intervals, k, tolerance)


def test_the_operator_on_hertz_converges_as_piecewise_linear_must():
    """Hertz's pressure has a root at the edge: the error falls like h^1.5 everywhere."""
    inner, edge = [], []
    for intervals in (40, 80, 160):
        grid = uniform_mesh(intervals)
        far = grid.x <= 0.5
        inner.append(np.abs(grid.K @ grid.s + grid.edge @ grid.s - HERTZ * (1 + grid.s**2))[far].max())
        edge.append(abs(grid.edge @ grid.s - HERTZ))
    assert inner[-1] < 3e-4
    assert np.all(np.array(inner[:-1]) / inner[1:] > 2.5)
    assert np.all(np.array(edge[:-1]) / edge[1:] > 2.5)


def test_the_operator_is_exact_for_a_pressure_without_curvature():
    """p = 1 - x: its displacement of the centre is (π/2) ∫ p dx = π/4, of the edge ∫ (1 - x) K(x) x dx."""
    grid = uniform_mesh(7)
    p = 1 - grid.x
    u, w = np.polynomial.legendre.leggauss(400)
    x = (u + 1) / 2
    assert_allclose((grid.K @ p + grid.edge @ p)[-1], np.pi / 4, rtol=1e-9, atol=0)
    assert_allclose(grid.edge @ p, (w / 2) @ ((1 - x) * ellipk(x**2) * x), rtol=1e-8, atol=0)


def test_weights_are_the_trapezoidal_rule():
    grid = uniform_mesh(10)
    assert_allclose(grid.w @ (1 - grid.x), np.trapezoid(np.linspace(0, 1, 11) * np.linspace(1, 0, 11), dx=0.1))


@pytest.mark.parametrize(("base", "k"), [("thin_layer", 5.0), ("half_space", 20.0)])
@pytest.mark.parametrize("control", ["P", "a", "D"])
def test_second_order_towards_newton(base, k, control):
    newton = one(P=LOAD, micro="power_law", rtol=1e-10, base=base)
    errors = []
    for intervals in (20, 40, 80):
        s = paper(intervals, k, 1e-5, base=base, **{control: getattr(newton, control)})
        assert s.status[0] == Status.CONVERGED
        errors.append(difference(s, newton)[0])
    assert errors[-1] < 1e-3
    assert np.all(np.array(errors[:-1]) / errors[1:] > 2.5)


def test_a_smooth_punch_on_a_layer():
    newton = one(P=LOAD, micro="smooth", rtol=1e-10)
    s = paper(160, 5.0, P=LOAD, micro="smooth")
    assert s.status[0] == Status.CONVERGED
    assert difference(s, newton, ("a", "P", "D", "p0"))[0] < 5e-4


def test_what_does_not_settle_says_so():
    """k = 0 on a fine mesh cycles at the edge; on a half-space k = 1 is far too little."""
    assert paper(160, 0.0, a=0.04).status[0] == Status.LIMIT_CYCLE
    assert paper(40, 1.0, P=LOAD, base="half_space").status[0] == Status.ITERATION_LIMIT


@pytest.mark.parametrize("base", ["thin_layer", "half_space"])
def test_to_follow_the_pressure_saves_approximations_and_changes_nothing_else(base):
    problem = Problem.of(**(MAIN | {"micro": "power_law", "P": [LOAD, 0.3 * LOAD], "base": base}))
    cases = as_cases(dimensionless(problem))
    given = cases, uniform_mesh(40), np.full(2, 20.0), np.full(2, 1e-6), 2000, bisection
    (anew, status), (followed, same) = picard.solve(*given), picard.solve(*given, follow=True)
    assert (status == Status.CONVERGED).all() and (same == Status.CONVERGED).all()
    assert_allclose(followed.at.state.eta, anew.at.state.eta, rtol=0, atol=1e-6)
    assert (followed.count < 0.7 * anew.count).all()


def test_a_mesh_of_several_blocks_of_rows_is_that_of_one(monkeypatch):
    whole = uniform_mesh(100)
    monkeypatch.setattr(uniform, "_ROWS", 1000)
    assert_allclose(whole.K, uniform_mesh.__wrapped__(100).K, rtol=0, atol=1e-15)


def test_bad_cases_are_a_status_and_harm_no_neighbour():
    nu = {"bonding": ["bonded", "frictionless", "frictionless"], "nu1": [0.5, 0.3, 0.3], "nu2": [0.5, 0.3, 0.3]}
    s = paper(P=[LOAD, LOAD, -1.0], **nu)
    assert s.status.tolist() == [Status.THIN_LAYER_NOT_APPLICABLE, Status.CONVERGED, Status.INVALID_INPUT]
    assert_allclose(s.a[1], paper(P=LOAD).a[0], rtol=1e-12)
    assert np.isnan(s.a[[0, 2]]).all()


def test_units():
    ours, theirs = paper(P=LOAD), paper(P=LOAD * 1e-4 * 2e11, h=2e-4, Ra=4e-5, Nbar=2.5e9, R=0.01, E2=2e11)
    assert_allclose(theirs.a, 0.01 * ours.a, rtol=1e-9)
    assert_allclose(theirs.p0, 2e11 * ours.p0, rtol=1e-9)


@pytest.mark.parametrize("case", [{"base": "layered"}, {"base": "half_space", "micro": "smooth"}])
def test_what_the_paper_has_not_is_refused(case):
    with pytest.raises(ValueError, match="one micro law on thin_layer, or a rough one on half_space"):
        paper(P=LOAD, **case)


def test_bisection_halves_to_its_tolerance_and_gives_up_nan():
    calls = np.zeros(3, dtype=int)

    def cubic(x, index):
        calls[index] += 1
        return np.where((index == 2) & (np.abs(x) < 0.09), np.nan, (x - np.array([0.3, -7.0, 0.0])[index]) ** 3)

    x, g = bisection(cubic, np.zeros(3), np.array([1e-3, 1e-6, 1e-3]))
    assert abs(x[0] - 0.3) < 1e-3 and abs(x[1] + 7) < 1e-6
    assert abs(g[0]) < 1e-9
    assert calls[2] == 3 and calls[1] > calls[0] > 8


def test_much_relaxation_gets_more_approximations():
    """k = 100 settles after 742, where the paper's own k takes less than 200."""
    s = paper(20, k=100.0, a=0.04, base="half_space")
    assert s.status[0] == Status.CONVERGED and 200 < s.iterations[0] < 40 * 101

"""The paper's own way: its mesh, its halving, its successive approximations; second order towards Newton's answer."""

import doctest

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import ellipk
from solver_cases import LOAD, MAIN, difference, one

from solver import Problem, Status
from study.studies.paper import uniform
from study.studies.paper.uniform import halved, rows, solve_uniform, uniform_mesh


def paper(intervals=40, k=2.0, tolerance=1e-5, **case):
    problem = Problem.of(**(MAIN | {"base": "thin_layer", "micro": "power_law"} | case))
    return solve_uniform(problem, intervals, k, tolerance)


def test_its_example():
    """pytest looks for examples in packages, and studies are none."""
    assert doctest.testmod(uniform) == (0, 4)


def test_the_operator_on_hertz_converges_as_piecewise_linear_must():
    """Of sqrt(1 - x²) it is π²/16 (2 - x²); the root at the edge makes the error fall like h^1.5 everywhere."""
    inner, edge = [], []
    for intervals in (40, 80, 160):
        x = np.arange(intervals + 1) / intervals
        error = np.abs(rows(np.arange(intervals + 1), intervals) @ np.sqrt(1 - x**2) - np.pi**2 / 16 * (2 - x**2))
        inner.append(error[x <= 0.5].max())
        edge.append(error[-1])
    assert inner[-1] < 3e-4
    assert np.all(np.array(inner[:-1]) / inner[1:] > 2.5)
    assert np.all(np.array(edge[:-1]) / edge[1:] > 2.5)


def test_the_operator_is_exact_for_a_pressure_without_curvature():
    """p = 1 - x: its displacement of the centre is (π/2) ∫ p dx = π/4, of the edge ∫ (1 - x) K(x) x dx."""
    grid = uniform_mesh(7)
    u, w = np.polynomial.legendre.leggauss(400)
    x = (u + 1) / 2
    edge = (w / 2) @ ((1 - x) * ellipk(x**2) * x)
    assert_allclose((grid.K @ (1 - grid.x))[0], np.pi / 4 - edge, rtol=1e-8, atol=0)


def test_a_mesh_of_several_blocks_of_rows_is_that_of_one(monkeypatch):
    whole = uniform_mesh(100)
    monkeypatch.setattr(uniform, "ROWS", 1000)
    assert_allclose(whole.K, uniform_mesh.__wrapped__(100).K, rtol=0, atol=1e-15)


def test_weights_are_the_trapezoidal_rule():
    grid = uniform_mesh(10)
    assert_allclose(grid.w @ (1 - grid.x), np.trapezoid(np.linspace(0, 1, 11) * np.linspace(1, 0, 11), dx=0.1))


@pytest.mark.parametrize(("base", "k"), [("thin_layer", 5.0), ("half_space", 20.0)])
@pytest.mark.parametrize("control", ["P", "a"])
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


def test_much_relaxation_gets_more_approximations():
    """k = 100 settles after 742, where the paper's own k takes less than 200."""
    s = paper(20, k=100.0, a=0.04, base="half_space")
    assert s.status[0] == Status.CONVERGED and 200 < s.iterations[0] < 40 * 101


def test_what_does_not_settle_says_so():
    """k = 0 on a fine mesh cycles at the edge; on a half-space k = 1 is far too little."""
    assert paper(160, 0.0, a=0.04).status[0] == Status.ITERATION_LIMIT
    assert paper(40, 1.0, P=LOAD, base="half_space").status[0] == Status.ITERATION_LIMIT


def test_what_diverges_has_no_numbers_and_harms_no_neighbour():
    """From p = 0 the asperities of the exact law would have to yield more than at full contact."""
    pair = {"P": [LOAD, LOAD], "base": ["half_space", "thin_layer"], "micro": ["disc_cell", "power_law"]}
    found = paper(20, 20.0, **pair)
    assert found.status.tolist() == [Status.DIVERGED, Status.CONVERGED]
    numbers = np.array([found.a, found.P, found.D, found.p0, found.p_max, found.Ar_An, found.A0])
    assert np.isnan(numbers[:, 0]).all() and np.isfinite(numbers[:, 1]).all()


def test_to_follow_the_pressure_saves_approximations():
    """The search for the radius under a load takes far less than each of its 25 radii from p = 0."""
    given, anew = (
        paper(40, 20.0, 1e-6, **{"base": "half_space", name: v}).iterations[0] for name, v in (("P", LOAD), ("a", 0.03))
    )
    assert given < 0.7 * 25 * anew


def test_bases_and_laws_mix_and_each_case_is_as_if_alone():
    mixed = {"P": [LOAD, 2 * LOAD, LOAD, LOAD], "base": ["thin_layer", "half_space", "thin_layer", "half_space"],
             "micro": ["power_law", "power_law", "smooth", "disc_cell"]}  # fmt: skip
    whole = paper(20, 20.0, 1e-5, **mixed)
    for i in range(4):
        alone = paper(20, 20.0, 1e-5, **{name: values[i] for name, values in mixed.items()})
        assert_allclose(
            [getattr(whole, name)[i] for name in ("a", "D", "p_max")],
            [alone.a[0], alone.D[0], alone.p_max[0]],
            rtol=1e-9,
        )  # rounding, amplified


def test_what_is_out_of_bounds_has_no_numbers_and_harms_no_neighbour():
    found = paper(P=[LOAD, -1.0])
    assert found.status.tolist() == [Status.CONVERGED, Status.INVALID_INPUT]
    assert np.isnan([found.p0[1], found.P[1], found.a[1]]).all()
    assert found.p0[0] == pytest.approx(paper(P=LOAD).p0[0], rel=1e-9)


def test_bonded_layers_have_their_compliance():
    exact = one(P=LOAD, micro="power_law", rtol=1e-8, bonding="bonded", nu1=0.3, nu2=0.2)
    assert difference(paper(80, 20.0, 1e-5, P=LOAD, bonding="bonded", nu1=0.3, nu2=0.2), exact)[0] < 1e-3


def test_an_elastic_punch_is_refused():
    with pytest.raises(ValueError, match="the punch of the paper is rigid: m must be 0"):
        paper(P=LOAD, m=[0.0, 0.1])


@pytest.mark.parametrize("case", [{"base": "layered"}, {"base": "half_space", "micro": "smooth"}])
def test_what_the_paper_has_not_is_refused(case):
    with pytest.raises(ValueError, match="thin_layer, or rough cases on half_space, not"):
        paper(P=LOAD, **case)


def test_halving_ends_at_its_tolerance_and_gives_up_nan():
    calls = np.zeros(3, dtype=int)

    def cubic(x, index):
        calls[index] += 1
        return np.where((index == 2) & (np.abs(x) < 0.09), np.nan, (x - np.array([0.3, -7.0, 0.0])[index]) ** 3)

    x = halved(cubic, np.zeros(3), np.array([1e-3, 1e-6, 1e-3]).max())
    assert abs(x[0] - 0.3) < 1e-3 and abs(x[1] + 7) < 1e-3
    assert calls[2] == 3 and calls[1] > calls[0] > 8

"""The largest pressure in the central spot of asperities that feel the body, and spots that lift off."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from solver import Problem, solve
from solver.kernels.two_layers import TwoLayers
from solver.laws.cell.peak import pressures
from solver.laws.cell.rows import of_kernel
from solver.laws.cell.spot import Cell, spots
from solver.models.spot_pressure import lifts_off
from study.rules import strength
from study.rules.rule import RULES

H = 0.001
GIVEN = {"h": H, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded", "base": "layered", "Nbar": 1 / (8 * H) ** 2, "Ra": 0.05}


def in_spot(problem, solution, i, lattice):
    """The largest pressure of the spot of a case, and its radius over b, by the equation itself."""
    m = problem.m[i]
    layers = TwoLayers(*(np.array([value]) for value in (problem.n[i], 0.25, 0.3, True)))
    spot = spots(Cell(lattice, 8.0, of_kernel(layers, m)), [np.sqrt(solution.lam[i, 0] / np.pi)])
    r = np.linspace(0, 1, 4001)
    q = pressures(spot, np.sqrt((1 - r) * (1 + r)))[0] * problem.n[i] / (1 + m) * 8 * H / 0.05
    return q.max(), r[q.argmax()]


@pytest.mark.parametrize("micro, lattice", [("disc_cell", "disc"), ("square_lattice", "square")])
def test_it_is_that_of_the_equation(micro, lattice):
    """1e-6, the radius to 1e-3; in the middle it is p_max to the last bit."""
    problem = Problem.of(P=[2e-5, 1e-4, 1e-7, 1e-4], n=[1.8, 20.0, 20.0, 20.0], m=[0, 0, 0, 0.5], micro=micro, **GIVEN)
    solution = solve(problem)
    for i in range(4):
        p_spot, r_spot = in_spot(problem, solution, i, lattice)
        assert solution.p_spot[i] == pytest.approx(p_spot, rel=1e-6)
        assert solution.r_spot[i] == pytest.approx(r_spot, abs=1e-3)
    ring = solution.r_spot > 0
    assert ring.tolist() == [False, True, False, True]
    assert (solution.p_spot[~ring] == solution.p_max[~ring]).all() and (solution.p_spot >= solution.p_max).all()


def test_other_laws_are_the_disc_cell_in_the_limit():
    """Heights that are alike, and spots as hard as can be; softer ones have less in the ring."""
    kinds = {"micro": ["disc_cell", "normal_heights", "elastic_plastic", "elastic_plastic"]}
    problem = Problem.of(P=1e-4, n=20.0, sigma=1e-10, hardness=[np.nan, np.nan, 1e6, 0.1], **kinds, **GIVEN)
    solution = solve(problem)
    ratio = solution.p_spot / solution.p_max
    assert_allclose(ratio[1:3], ratio[0], rtol=1e-4)
    assert_allclose(solution.r_spot[1:3], solution.r_spot[0], rtol=1e-4)
    assert 1 < ratio[3] < ratio[0] and solution.plastic_share[3] > 0.5


def test_under_the_highest_summit_it_is_that_of_its_own_load():
    """Larger heights press with fewer spots; the middle of the highest is p_max, and its ring has more."""
    problem = Problem.of(P=1e-4, n=30.0, sigma=2e-5, micro=["normal_heights", "uniform_heights"], **GIVEN)
    solution = solve(problem)
    assert (solution.p_spot > 1.3 * solution.p_max).all() and (solution.r_spot > 0.6).all()


def test_what_does_not_feel_the_body_has_none():
    kinds = {"micro": ["disc_cell", "disc_cell", "smooth", "disc_cell"]}
    on = {"asperities_on": ["layer", "half_space", "auto", "auto"], "base": ["layered", "layered", "layered", "auto"]}
    problem = Problem.of(P=1e-4, n=20.0, **GIVEN | kinds | on)
    solution = solve(problem)
    assert np.isfinite(solution.p_spot).tolist() == np.isfinite(solution.r_spot).tolist() == [True, False, False, True]
    contact = study.solve(P=1e-4, n=20.0, x=2, asperities_on="half_space", **GIVEN)
    assert not {"p_spot", "r_spot"} & {*contact}


def test_it_is_in_the_units_of_the_problem():
    problem = Problem.of(P=1e-4, n=20.0, **GIVEN)
    scaled = {"R": 3.0, "E2": 5.0, "P": 1e-4 * 45, "h": 3 * H, "Nbar": GIVEN["Nbar"] / 9, "Ra": 0.15}
    one, other = solve(problem), solve(Problem.of(n=20.0, **GIVEN | scaled))
    assert_allclose(other.p_spot, 5 * one.p_spot, rtol=1e-9)
    assert_allclose(other.r_spot, one.r_spot, rtol=1e-9)


def test_a_summary_has_it():
    contact = study.solve(P=1e-4, n=20.0, x=9, **GIVEN)
    (line,) = [line for line in study.summary(contact).splitlines() if "pspot" in line]
    assert line.endswith(f"at {contact.r_spot.item():.2g} of its radius")


def test_a_spot_lifts_off_and_words_say_so(monkeypatch):
    """A plate 1e5 times as hard as the body, whose spots are wider than 3.1 h; the law ends before that."""
    given = {"n": 1e5, "h": H, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded", "Nbar": 1 / (60 * H) ** 2, "Ra": 0.05}
    problem = Problem.of(a=[0.1, 0.1], **given)
    assert lifts_off(problem, np.pi * (np.array([2.9, 3.4]) / 60) ** 2).tolist() == [False, True]
    assert not lifts_off(problem.but(n=1e3), np.array([0.5, 0.5])).any()
    contact = study.solve(P=1e-4, n=20.0, x=2, **GIVEN)
    assert not contact.validity & 16384
    monkeypatch.setattr(strength, "lifts_off", lambda problem, lam: lam > 0)
    contact = study.solve(P=1e-4, n=20.0, x=2, **GIVEN)
    assert contact.validity & 16384 and RULES["spot_lifts_off"].sentence in study.summary(contact)

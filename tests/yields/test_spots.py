"""The stress under asperities: two scales added as tensors."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from yielding import first_yield

import study
from solver import Problem, solve
from solver.fields.contact import of_contacts as fields_of
from solver.yields import spots
from solver.yields.asperities import hertz_part, stress_on_axis
from solver.yields.first import first_yield as first_crossing
from solver.yields.peaks import chebyshev_nodes

ROUGH = {"Nbar": 250000.0, "Ra": 0.004}
LAYER = {"h": 0.02, "n": [0.5, 5.0, 20.0], "nu1": 0.25, "nu2": 0.3, "bonding": "bonded"}


def test_in_the_centre_it_is_what_the_two_scales_make():
    """The stress of the contact as a whole from `solver.fields`, that of the spot from another function, which has it
    at the depth of the largest difference alone: so this is the largest, or a little less."""
    problem = Problem.of(P=[1e-6, 1e-5, 1e-4], **LAYER, **ROUGH)
    solution = solve(problem)
    largest, r, z = spots.of_contacts(problem, solution)
    E = np.array(LAYER["n"])
    p0s, c = hertz_part(solution.p_max, solution.p0, E, ROUGH["Nbar"], ROUGH["Ra"])
    for i in range(3):
        one = problem.take([i])
        whole = fields_of(one, solution.take([i]), np.zeros(1), z[i : i + 1]).inside
        sr, sz = (whole[name][0, 0, 0] for name in ("sr", "sz"))
        p = solution.p0[i]
        tension = (sr - sz - p * (1 - 2 * 0.25) / 2) / p0s[i]
        expected = p0s[i] * stress_on_axis(0.25, c[i], p / p0s[i], tension)
        assert largest[i] == pytest.approx(expected, rel=2e-4)
    assert_allclose(r, 0.0, atol=1e-6)


def test_half_as_many_spots_would_do(monkeypatch):
    problem = Problem.of(P=[1e-6, 1e-5, 1e-4], **LAYER, **ROUGH)
    solution = solve(problem)
    usual = spots.of_contacts(problem, solution, mu=0.3)
    monkeypatch.setattr(spots, "_SPOTS", 33)
    monkeypatch.setattr(spots, "_MANY", 14)
    monkeypatch.setattr(spots, "_RADII", np.sin(np.pi / 4 * (1 + chebyshev_nodes(33))))
    assert_allclose(spots.of_contacts(problem, solution, mu=0.3), usual, rtol=1e-6, atol=1e-9)


def test_what_has_no_asperities_is_not_a_number():
    problem = Problem.of(P=1e-5, h=0.02, n=2.0, micro=["smooth", "disc_cell"], **ROUGH)
    assert np.isfinite(spots.of_contacts(problem, solve(problem))).tolist() == [[False, True]] * 3


def test_of_other_laws_the_largest_spot_in_the_centre_counts():
    problem = Problem.of(P=1e-5, base="half_space", micro=["hex_lattice", "disc_cell"], **ROUGH)
    (lattice, cell), r, _ = spots.of_contacts(problem, solve(problem))
    assert r[0] == 0 and lattice == pytest.approx(cell, rel=0.1)


def test_spots_that_yield_are_taken_for_elastic_ones():
    """The pressure of the contact as a whole is another one, and has a small part in the stress."""
    case = {"a": 0.05, "Nbar": 1e6, "Ra": 1e-3, "base": ["half_space", "layered"], "h": 0.02, "n": 5.0}
    elastic, plastic = Problem.of(**case), Problem.of(**case, micro="elastic_plastic", hardness=0.02)
    solutions = solve(elastic), solve(plastic)
    assert (solutions[1].P < 0.9 * solutions[0].P).all(), "many spots yield"
    wanted, stress = (spots.of_contacts(*both)[0] for both in zip((elastic, plastic), solutions, strict=True))
    assert stress == pytest.approx(wanted, rel=0.03)


def test_first_yield_of_asperities():
    """Where it is found the stress is the strength. Under the elastic-plastic law it is the same load, and no share of
    the area has yielded before."""
    own = {"h": 0.02, "n": 5.0, "bonding": "bonded", **ROUGH}
    found = study.first_yield(yield_strength=0.05, **own)
    assert (found.found_Ya.item(), found.first_yield.item()) == (0, 3)
    at = Problem.of(a=found.a_Ya.item(), **own)
    assert spots.of_contacts(at, solve(at))[0, 0] == pytest.approx(0.05, rel=1e-6)
    plastic = study.first_yield(hardness=2.84 * 0.05, micro="elastic_plastic", **own)
    assert plastic.P_Ya.item() == pytest.approx(found.P_Ya.item(), rel=1e-6)


def test_first_yield_of_the_body_is_under_the_law_of_the_contact():
    """Asperities that yield spread the load: the body yields under more of it than below elastic ones."""
    case = {"base": "half_space", "Nbar": 1e6, "Ra": 1e-3, "micro": ["disc_cell", "elastic_plastic"], "hardness": 0.02}
    crossing = first_crossing(Problem.of(P=1.0, **case), "body", np.full(2, 0.01))
    contact = solve(Problem.of(a=crossing.at, **case))
    assert_allclose(contact.P, crossing.numbers["P"], rtol=1e-6, atol=0)
    assert abs(contact.P[1] / contact.P[0] - 1) > 0.01


def test_asperities_are_as_strong_as_the_softer_material():
    scene = {"R": "5 mm", "punch": "steel 52100", "layer": "DLC a-C:H", "h": "200 um", "body": "steel 52100"}
    scene |= {"bonding": "bonded", "Nbar": "0.1 1/um^2", "Ra": "20 um"}
    named = first_yield("asperities", **scene)
    steel = study.materials.get("steel 52100").hardness
    given = first_yield("asperities", hardness=f"{steel} Pa", **scene)
    assert named.P_Ya.item() == pytest.approx(given.P_Ya.item(), rel=1e-9)

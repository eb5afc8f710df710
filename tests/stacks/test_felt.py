"""Asperities that feel a stack of layers, and a graded layer, which is cut in few sublayers below them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import difference

from solver import Problem, Status, scaling, solve
from solver.models import law_error
from solver.yields import spots
from solver.yields.below import central_spot

CASE = {"a": 0.03, "Nbar": 250000.0, "Ra": 0.004, "micro": "square_lattice", "rtol": 1e-4}
GRADED = {"nu": 0.3, "profile": "exponential", "bonding": "bonded"}


@pytest.mark.parametrize("pitch", [4.0, 24.0])
def test_finer_sublayers_change_less_than_the_error(pitch, monkeypatch):
    """Twice as many of them below the asperities, as `model_error` has it; it is below 2 %."""
    problem = Problem.of(**CASE, layers=[GRADED | {"h": 0.002 / pitch, "n": [4.0, 1.0]}], sublayers=8)
    few = solve(problem)
    monkeypatch.setattr(scaling, "_SUBLAYERS", 8)
    monkeypatch.setattr(scaling, "_WIDEST", 200.0)
    more = solve(problem)
    assert few.status == more.status == Status.CONVERGED
    change = difference(few, more, ("D", "p_max", "Ar_An"))
    cut = law_error._CUT * np.log(4.0)
    assert 1e-5 < change < cut < few.model_error < 0.02


def test_a_graded_layer_of_one_modulus_is_a_uniform_one():
    uniform = {"h": 5e-4, "n": 4.0, "nu": 0.3, "bonding": "bonded"}
    graded, alone = (
        solve(Problem.of(**CASE, layers=[layer])) for layer in (GRADED | uniform | {"n": [4.0, 4.0]}, uniform)
    )
    for name in ("D", "p_max", "Ar_An"):
        assert_allclose(getattr(graded, name), getattr(alone, name), rtol=1e-8, err_msg=name)


def test_a_thin_layer_between_is_felt():
    """A soft one below the first, of a tenth of its thickness, under spots as wide as both; a stiff one is not."""
    top = {"h": 5e-4, "n": 4.0, "bonding": "bonded"}
    between = [{"h": 5e-5, "n": n, "bonding": "bonded"} for n in (0.005, 4.0)]
    soft, stiff = (solve(Problem.of(**CASE, layers=[top, layer])) for layer in between)
    one = solve(Problem.of(**CASE, layers=[top | {"h": 5.5e-4}]))
    assert soft.p_max < 0.8 * stiff.p_max and abs(stiff.p_max / one.p_max - 1) < 1e-6


def test_below_a_spot_on_a_uniform_layer_above_a_graded_one():
    """As on uniform layers where the modulus hardly changes; where it falls the body below has more of the load."""
    top = {"h": 0.008, "n": 5.0, "nu": 0.2, "bonding": "bonded"}
    below = [top | {"h": 0.012}, *(GRADED | {"h": 0.012, "n": [5.0, n], "nu": 0.2} for n in (5.000005, 1.0))]
    rough = {"P": 1e-4, "Nbar": 100.0, "Ra": 0.02, "asperities_on": "layer", "micro": "disc_cell", "nu2": 0.3}
    largest, of_spots = [], []
    for layer in below:
        problem = Problem.of(layers=[top, layer], sublayers=2 if "profile" in layer else 0, **rough)
        solution = solve(problem)
        largest.append(central_spot.of_contacts(problem, solution))
        of_spots.append(spots.of_contacts(problem, solution)[0])
    for name, values in largest[0].items():
        assert_allclose(largest[1][name], values, rtol=3e-5, err_msg=name)
    assert_allclose(of_spots[1], of_spots[0], rtol=1e-6)
    assert largest[2]["mises2_spot"][0] > 1.05 * largest[0]["mises2_spot"][0]
    assert_allclose(of_spots[2], largest[2]["mises1_spot"][0], rtol=1e-6)


def below_a_spot(layer, monkeypatch, sublayers, **case):
    """Solved, the largest stresses below the central spot, and below any, on one layer under coarse asperities."""
    monkeypatch.setattr(scaling, "_SUBLAYERS", sublayers)
    rough = {"P": 1e-4, "Nbar": 100.0, "Ra": 0.02, "asperities_on": "layer", "micro": "disc_cell", "nu2": 0.3}
    problem = Problem.of(layers=[layer], **rough | case)
    solution = solve(problem)
    return problem, solution, {name: v[0, 0] for name, v in central_spot.of_contacts(problem, solution).items()}


TOP = {"h": 0.02, "n": 5.0, "nu": 0.2, "bonding": "bonded"}
ONE_MODULUS = GRADED | TOP | {"n": [5.0, 5.000005]}


def test_below_the_central_spot_on_a_graded_layer_of_one_modulus(monkeypatch):
    """As on the uniform layer, in the sublayers and below them."""
    one, cut = (below_a_spot(layer, monkeypatch, 2)[2] for layer in (TOP, ONE_MODULUS))
    for name, value in one.items():
        assert_allclose(cut[name], value, rtol=2e-5, err_msg=name)


@pytest.mark.parametrize("heights", [{}, {"micro": "normal_heights", "sigma": 0.002, "cut": 3.0}])
def test_below_any_spot_on_a_graded_layer_of_one_modulus(monkeypatch, heights):
    """By a table of radii, and below the highest summit of random heights."""
    both = (below_a_spot(layer, monkeypatch, 2, **heights)[:2] for layer in (TOP, ONE_MODULUS))
    one, cut = (spots.of_contacts(*solved)[0, 0] for solved in both)
    assert one > 0 and abs(cut / one - 1) < 1e-4


def test_stresses_below_a_spot_converge_with_sublayers(monkeypatch):
    """A layer softer by 5 at its bottom: twice as many change them by less than 1 %, which they change the load by."""
    layer = GRADED | TOP | {"n": [5.0, 1.0]}
    few, many = (below_a_spot(layer, monkeypatch, sublayers)[2] for sublayers in (2, 4))
    for name in ("mises1_spot", "mises2_spot", "tau_interface_spot"):
        assert 0 < abs(many[name] / few[name] - 1) < 0.01, name

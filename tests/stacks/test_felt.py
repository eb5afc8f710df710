"""Asperities that feel a stack of layers, and a graded layer, which is cut in few sublayers below them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import difference

from solver import Problem, Status, scaling, solve
from solver.models import asperity_error

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
    cut = asperity_error._CUT * np.log(4.0)
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

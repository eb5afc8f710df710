"""What asperities err on a layer thinner than their pitch, beside cells in which the layer is resolved."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem, solve
from solver.models.cell_error import cell_error, of_one_law
from solver.scaling import law_of

#: (n, pitch/h, p_max of the cell over that of the law) at the pressure at which the law says λ = 0.05: square lattice,
#: ν 0.25 and 0.3, bonded. They are those of the periodic cell with one asperity on the layer, solved with all waves.
RESOLVED = [
    (0.2, 4, 1.02), (0.2, 8, 1.13), (0.2, 16, 1.39), (3, 4, 0.97), (3, 8, 0.80), (3, 16, 0.57),
    (10, 4, 0.93), (10, 8, 0.53), (10, 16, 0.25), (50, 4, 0.90), (50, 8, 0.27), (50, 16, 0.089),
]  # fmt: skip
ROUGH = {"Nbar": 1e6, "Ra": 0.01, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded"}


@pytest.mark.parametrize(("n", "pitch", "ratio"), RESOLVED)
def test_the_error_is_of_the_size_of_that_of_resolved_cells(n, pitch, ratio):
    """Right where it is small, too small by up to a factor of 2 where it is 1, and large where that is."""
    problem = Problem.of(P=1e-7, n=n, h=1e-3 / pitch, micro="square_lattice", **ROUGH)
    pressures = np.geomspace(1e-5, 1, 400)
    p0 = np.interp(0.05, law_of(problem).at(pressures[None]).lam[0], pressures)
    (error,), true = of_one_law(problem, np.array([p0]), np.array([np.inf])), abs(1 / ratio - 1)
    assert 0.5 * true - 0.005 < error < (1.3 if true < 3 else 3.5) * true + 0.005


def test_of_the_depth_it_is_that_of_the_asperities():
    """Of n = 1, and the same Poisson ratios, nothing lies below; where nearly all of D is A, D errs as A does."""
    same = Problem.of(P=1e-7, n=1.0, h=1e-4, micro="square_lattice", **ROUGH | {"nu1": 0.3})
    assert of_one_law(same, np.array([0.01]), np.array([1e-9])) < 1e-10
    soft = Problem.of(P=1e-7, n=0.2, h=1e-3 / 4, micro="square_lattice", **ROUGH)
    p0 = np.array([1e-3])
    A = law_of(soft).at(p0[None]).A[0]
    assert 0.05 < of_one_law(soft, p0, A)[0] < 0.15, "A is 0.92 of that of the law at λ = 0.05"


def test_up_to_a_pitch_of_h_there_is_none():
    given = {"a": [0.05, 0.05, 0.05], "n": 5.0, "h": [1.0001e-3, 2e-3, 0.01], "micro": "disc_cell", **ROUGH}
    assert (solve(Problem.of(**given)).model_error == 0).all()
    bare = solve(Problem.of(**given | {"base": "half_space"}))
    assert (bare.model_error == 0).all() and solve(Problem.of(**given | {"micro": "smooth"})).model_error[0] == 0


def test_it_grows_with_the_pitch_and_with_units_it_is_the_same():
    given = {"a": 0.05, "n": 10.0, "micro": ["disc_cell", "hex_lattice", "normal_heights"], "sigma": 1e-8, **ROUGH}
    errors = [solve(Problem.of(h=h, **given)).model_error for h in (9.9e-4, 2.5e-4)]
    assert (np.diff(errors, axis=0) > 0).all() and (errors[0] < 0.01).all()
    problem = Problem.of(h=2.5e-4, **given)
    solution = solve(problem)
    units = {"a": 0.05 * 3, "h": 2.5e-4 * 3, "Nbar": 1e6 / 9, "Ra": 0.03, "sigma": 3e-8, "R": 3.0, "E2": 7.0}
    again = Problem.of(**given | units)
    assert_allclose(cell_error(again, solve(again)), cell_error(problem, solution), rtol=1e-9)

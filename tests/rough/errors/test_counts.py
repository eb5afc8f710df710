"""What a solution says of the way to it: the steps of a case are its own, on all its meshes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import LOAD, one

from solver import Problem, Status, solve
from solver.rough import newton as loop


@pytest.fixture
def steps(monkeypatch, numpy_path) -> list[int]:
    """Grows by the steps of each loop that is run."""
    found = []

    def counted(*arguments):
        iterated = iterate(*arguments)
        found.append(iterated.count.sum())
        return iterated

    iterate = loop.iterate
    monkeypatch.setattr(loop, "iterate", counted)
    return found


def test_a_smooth_thin_layer_counts_its_own_steps():
    """Not those of the slowest in the batch; on all meshes: two a mesh under a load, on 12, 16, 22, 32 nodes here."""
    case = {"D": 1e-3, "h": [1e-4, 0.02, 2.0], "base": "thin_layer", "micro": "smooth", "nodes": 12}
    together, alone = one(**case), [one(**case | {"h": h}) for h in case["h"]]
    assert together.iterations.tolist() == [s.iterations[0] for s in alone]
    assert len(set(together.iterations)) > 1
    climbing = one(P=LOAD, h=1e-6, base="thin_layer", micro="smooth", rtol=1e-6)
    assert (climbing.nodes[0], climbing.iterations[0]) == (32, 8)


def test_a_rough_case_counts_the_steps_on_all_its_meshes(steps):
    s = one(P=LOAD, base="thin_layer", micro="power_law", h=2e-4, n=0.5, Ra=0.02, Nbar=1e5)
    assert len([count for count in steps if count > 0]) > 1 and s.iterations[0] == sum(steps)


#: A stiff plate under a power law, whose depth hardly depends on the radius: Newton on both may leave the branch.
PLATE = {"D": 0.062427, "h": 4.53858e-3, "n": 72990.57, "Ra": 1.5483e-3, "Nbar": 16350611.0, "bonding": "frictionless",
         "base": "layered", "micro": "power_law", "B": 0.1, "beta": 0.5}  # fmt: skip


def test_what_newton_leaves_is_found_by_its_radius(steps, monkeypatch):
    """Newton from far away is made to fail: without the search no mesh and no panels find it. Its steps are counted
    with the others."""

    def near(start, *arguments):
        found = iterate(start, *arguments)
        return found._replace(closed=found.closed & ((start.cases.control == "a") | (found.count < 4)))

    iterate = loop.iterate
    monkeypatch.setattr(loop, "iterate", near)
    s = solve(Problem.of(**PLATE))
    assert s.status[0] == Status.CONVERGED and s.error[0] <= 1e-6
    counted = sum(steps)
    by_radius = solve(Problem.of(**{name: value for name, value in PLATE.items() if name != "D"}, a=s.a))
    assert_allclose(by_radius.D, PLATE["D"], rtol=2e-6, atol=0)  # twice the tolerance
    assert s.iterations[0] == counted > 100


def test_a_step_changes_the_radius_by_no_more_than_a_factor():
    """From a poor first guess, of a film between soft and stiff: 14 steps in all, without a limit to each 50."""
    film = {"h": 2.7e-7, "n": 4.7e-8, "Ra": 100.0, "Nbar": 11529.0, "base": "thin_layer", "micro": "disc_cell"}
    s = solve(Problem.of(P=1.72e-5, **film))
    assert s.status[0] == Status.CONVERGED and s.iterations[0] < 30


def test_the_residual_of_smooth_thin_layers_is_measured():
    """Rounding of the equation for the edge, which is not zero for all of twenty."""
    s = one(D=np.geomspace(1e-4, 1e-2, 20), base="thin_layer", micro="smooth")
    assert 0 < s.residual.max() <= 1e-13

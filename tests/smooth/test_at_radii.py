"""Contacts that stick, given by their radii: the search for pull-off changes none of their numbers."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solver import Problem, solve
from solver.smooth.adhesion import adhesive
from solver.solve import solve_at_radii

USUAL = {"a": [0.01, 0.05, 0.2], "w_adhesion": 1e-5, "micro": "smooth"}
X = np.array([0.0, 0.4, 0.9])
LAYER = {"h": [0.01, 0.1, 1.0], "n": [0.1, 1.0, 30.0], "nu1": 0.4, "nu2": 0.3, "bonding": "bonded", "base": "layered"}
BARE = {"base": "half_space", "nu2": 0.3}
LAWS = {"jkr": LAYER, "punch": LAYER | {"m": 0.5}, "dmt": BARE | {"adhesion": "dmt"}, "cone": LAYER | {"shape": "cone"}}
LAWS |= {"maugis": BARE | {"adhesion": "maugis", "sigma0": 0.05}, "auto": LAYER | {"base": "auto"}}
LAWS["cone"] |= {"half_angle": 75.0}


def contacts(law: str, **change) -> Problem:
    return Problem.of(**{name: value for name, value in (USUAL | LAWS[law] | change).items() if value is not None})


@pytest.mark.parametrize("law", LAWS)
def test_the_numbers_are_those_of_solve(law):
    problem = contacts(law)
    usual, quick = solve(problem, X), solve_at_radii(problem, X)
    assert_array_equal(quick.status, usual.status)
    for name in ("a", "P", "D", "dP_dD", "p0", "p"):
        assert_allclose(getattr(quick, name), getattr(usual, name), rtol=1e-12, atol=1e-14)


def test_nothing_is_searched(monkeypatch):
    monkeypatch.setattr(adhesive, "pulled", None)
    assert np.isfinite(solve_at_radii(contacts("jkr"), X).P).all()


def test_other_contacts_are_refused():
    for problem in (contacts("jkr", w_adhesion=0.0), contacts("jkr", a=None, P=1e-5)):
        with pytest.raises(ValueError, match="given by their radii"):
            solve_at_radii(problem, X)

"""Random heights: the mean field against spheres and periodic cells with every asperity resolved, on coarse meshes."""

import numpy as np
import pytest
import validate_heights as heights
from numpy.testing import assert_allclose
from rough_sphere import asperities, width

from solver import Problem, solve
from solver.laws import LAWS


def test_what_is_drawn():
    """The heights have the law's standard deviation, and keep to its cut."""
    for micro in ("normal_heights", "uniform_heights"):
        found = heights.random_heights(micro, 0.3, 200, [0])
        assert abs(found.mean()) < 4 * 0.3 / 200 and abs(found.std() / 0.3 - 1) < 0.015
        assert abs(found).max() < heights.highest(micro, 0.3)


def test_the_lowest_of_the_asperities_nearby():
    """A high summit reaches into the cells beside it."""
    summits = np.zeros((5, 5))
    summits[3, 2] = 0.3
    x, y = np.array([0.0, 0.4, 0.6, 1.0]), np.zeros(4)
    assert_allclose(asperities(x, y, 1.0, 1.0, summits), [0.0, 0.18 - 0.3, 0.08 - 0.3, -0.3], atol=1e-15)


def test_spheres_of_random_heights():
    """Two draws on a coarse mesh: depth of the mean plane, and width, of the law. Equal heights would be 13 % too deep
    and 6 % too narrow."""
    case = heights.SPHERES[-1]._replace(counts=(6,))
    D, wide = np.mean([heights.sphere(case, draw)["meshes"][0] for draw in range(2)], axis=0)[:2]
    given = {"P": case.P, "base": "half_space", "Nbar": case.pitch**-2, "Ra": heights.RA}
    x = np.linspace(0, 1, 201)
    s = solve(Problem.of(**given, micro=case.micro, sigma=case.sigma), x)
    flat = solve(Problem.of(**given, micro="disc_cell"), x)
    assert abs((s.D[0] - heights.highest(case.micro, case.sigma)) / D - 1) < 0.015 and flat.D[0] / D - 1 > 0.1
    assert abs(s.a[0] * width(x, s.p[0], x) / wide - 1) < 0.015
    assert flat.a[0] * width(x, flat.p[0], x) / wide - 1 < -0.05


def test_periodic_cells():
    """Two draws on a coarse mesh: the law is 0.04 A* too deep, and has λ to 5 %. Equal heights are 0.15 A* deeper."""
    law = LAWS["normal_heights"].at(0.03, 1.0, **heights.ONES, sigma=0.3 / np.pi, cut=heights.CUT)
    A, lam = np.mean([heights.cell(0.3, 0.03, draw, meshes=(124,))["meshes"][0] for draw in range(2)], axis=0)
    assert 0.02 < np.pi * (law.A - A) - heights.CUT * 0.3 < 0.06
    assert abs(law.lam / lam - 1) < 0.05


def test_what_is_kept_is_not_solved_again(tmp_path):
    """Another key is another contact, and what was interrupted is none."""
    solved = []

    def solve_once():
        solved.append(1)
        return {"D": np.array(len(solved))}

    def interrupted():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        heights.stored(tmp_path, ("sphere", 1), interrupted)
    found = [int(heights.stored(tmp_path, ("sphere", key), solve_once)["D"]) for key in (1, 2, 1)]
    assert found == [1, 2, 1] and len(solved) == 2

"""Contacts at the ends of what a shape may touch: next to what is flat, and near the last row of a table."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rows import SMOOTH

from solver import Problem, Status, solve


@pytest.mark.parametrize("body", [{"base": "half_space"}, {"h": 0.01, "n": 0.3}], ids=["half_space", "layered"])
def test_a_frustum_that_hardly_touches_is_a_flat_punch(body):
    """Under so little a - b is below 1e-9 of b, in the end below rounding: D, dP/dD and the pressure are those of
    the flat punch to 1e-8 then, though p is 0 at the edge; and so is the load at such a depth."""
    case = {"micro": "smooth", "flat_radius": 0.012} | body
    for punch in ({"shape": "frustum", "half_angle": 70.0}, {"shape": "rounded_flat", "edge_radius": 1e-9}):
        for control, values in (("P", [1e-13, 1e-16, 1e-20]), ("D", [1e-11, 1e-13, 1e-16])):
            answer, flat = (
                solve(Problem.of(**case, **{control: values}, **v), [0, 0.5, 1]) for v in (punch, {"shape": "flat"})
            )
            assert np.all(answer.status == Status.CONVERGED)
            for name in ("P", "D", "dP_dD"):
                assert_allclose(getattr(answer, name), getattr(flat, name), rtol=1e-8, atol=0)
            assert_allclose(answer.p[:, :2], flat.p[:, :2], rtol=1e-8, atol=0)
            assert np.all(answer.p[:, 2] == 0)


def test_the_end_of_a_profile(tmp_path):
    """A depth that a half-space has only beyond the last row of a table, and the layer before it: P and D at the radius
    that is found are those of the radius, to 1e-9."""
    path, r = tmp_path / "tip.csv", np.linspace(0, 0.6, 13)
    np.savetxt(path, np.column_stack([r, r**2 / 2 + 0.1 * r]), delimiter=",")
    layer = {"h": 0.385, "n": 266.8, "nu1": 0.207, "bonding": "frictionless", "m": 0.4, "w_adhesion": 0.156} | SMOOTH
    case = layer | {"shape": f"table:{path}"}
    by_depth = solve(Problem.of(D=0.996, **case))
    assert by_depth.status == Status.CONVERGED
    by_radius = solve(Problem.of(a=by_depth.a, **case))
    assert_allclose([by_radius.P, by_radius.D], [by_depth.P, by_depth.D], rtol=1e-9, atol=0)

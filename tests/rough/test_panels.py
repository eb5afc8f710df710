"""Panels: the mesh of several polynomials, and the cases that no single one resolves."""

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from solver_cases import JUDGED, difference

from solver import Problem, Status, solve
from solver.body.tables import between, table
from solver.kernels.two_layers import SAMPLER
from solver.numerics.mesh import mesh_of, panel_mesh
from solver.shapes.paraboloid import HERTZ

BREAKS = (0.0, 0.01, 0.05, 0.3, 0.31, 0.32, 0.6, 1.0)
#: Near full contact under a thin layer: the asperities saturate at s² = Z/3, inside the contact.
CORNER = {
    "a": 0.1,
    "h": np.array([1e-4, 1e-6]),
    "n": np.array([1e-2, 1e-4]),
    "Ra": np.array([0.02, 0.01]),
    "Nbar": np.array([1.5e4, 5e4]),
    "base": "thin_layer",
}


@cache
def near_full_contact():
    """The cases CORNER at 1e-9, which three tests look at."""
    return solve(Problem.of(**CORNER, rtol=1e-9))


def test_the_half_space_on_panels():
    mesh = panel_mesh(12, BREAKS)
    assert mesh.n == 84 and mesh.order == 12 and mesh.s[-1] == 1
    assert_allclose(mesh.K @ mesh.s, HERTZ * mesh.s**2, rtol=0, atol=3e-15)
    assert_allclose(mesh.edge @ mesh.s, HERTZ, rtol=1e-14, atol=0)
    assert_allclose(mesh.w @ mesh.s**3, 1 / 5, rtol=1e-13, atol=0)


def test_panels_and_one_polynomial_agree():
    """On a function that both resolve, between the nodes too."""
    one, many, s = mesh_of(40), panel_mesh(12, BREAKS), np.linspace(0, 1, 23)
    values = np.sin(5 * s)
    assert_allclose(many.basis(s) @ np.sin(5 * many.s), values, rtol=0, atol=1e-11)
    assert_allclose(many.rows(s) @ np.sin(5 * many.s), one.rows(s) @ np.sin(5 * one.s), rtol=0, atol=1e-11)


def test_a_mesh_that_is_built_anew_finds_its_tables():
    """The 16 latest meshes of panels are kept, their tables longer: identity is the number of nodes and the panels."""
    first, width, points = panel_mesh(12, BREAKS), BREAKS[1], np.array([0.3, 0.9])
    kept = table(first, SAMPLER, -3, 0, True), between(-3, 0, points)
    for i in range(16):
        panel_mesh(4, (0.0, width + (i + 1) / 100, 1.0))
    again = panel_mesh(12, BREAKS)
    assert again is not first and again == first and hash(again) == hash(first)
    assert table(again, SAMPLER, -3, 0, True) is kept[0] and between(-3, 0, points) is kept[1]
    moved, fewer = (*BREAKS[:3], 0.29, *BREAKS[4:]), (0.0, *BREAKS[2:])
    others = [panel_mesh(11, BREAKS), panel_mesh(12, moved), panel_mesh(12, fewer), 12]
    assert first not in others and len({first, again, *others}) == 5


def test_the_corner_is_there():
    Z = 2 / (np.pi * CORNER["Nbar"]) / CORNER["Ra"] / 0.1**2
    assert np.all((Z / 3 > 1e-3) & (Z / 3 < 0.9))


def test_cases_near_full_contact_are_solved_on_panels():
    """One polynomial does not reach 1e-9; panels do, and agree with themselves at 1e-11 and the polynomial."""
    s, finer = near_full_contact(), solve(Problem.of(**CORNER, rtol=1e-11))
    assert np.all(s.status == Status.CONVERGED)
    assert np.all(s.nodes > 96)
    assert np.all(difference(s, finer) < 1e-9)
    single = solve(Problem.of(**CORNER, rtol=1e-9, nodes=96))
    assert np.all(single.status == Status.TOLERANCE_NOT_MET)
    assert np.all(difference(s, single) < single.error)


def test_panels_resolve_the_real_area_as_well():
    """Of asperities that almost saturate: panels that resolve the pressure alone leave Ar/An 1e-6 off."""
    case = {"P": 5.95e-5, "h": 3.298e-8, "n": 2.5976e-5, "bonding": "bonded", "Ra": 0.01565672, "Nbar": 283436553.0}
    s = solve(Problem.of(**case, base="thin_layer", micro="disc_cell", rtol=1e-6))
    assert s.status[0] == Status.CONVERGED and s.nodes[0] > 96


@pytest.mark.parametrize("control", ["P", "D"])
def test_panels_serve_every_control(control):
    by_radius = near_full_contact()
    case = {name: value for name, value in CORNER.items() if name != "a"}
    found = solve(Problem.of(**case, **{control: getattr(by_radius, control)}, rtol=1e-9))
    assert np.all(found.status == Status.CONVERGED)
    assert np.all(difference(found, by_radius, JUDGED) < 1e-8)


def test_a_case_on_panels_has_the_same_numbers_in_any_company():
    easy = {"h": 0.02, "n": 0.5, "Ra": 0.004, "Nbar": 250000.0}
    mixed = {name: np.append(CORNER[name], easy[name]) for name in easy} | {"a": 0.1, "base": "thin_layer"}
    alone, together = solve(Problem.of(**CORNER)), solve(Problem.of(**mixed))
    for name in JUDGED:
        assert_allclose(getattr(together, name)[:2], getattr(alone, name), rtol=1e-13, atol=0)
    assert together.nodes[2] < 96

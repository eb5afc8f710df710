"""The closed form over k: against Hertz's, at any depth, and against the waves."""

import numpy as np
import pytest
from field_rows import table
from numpy.testing import assert_allclose

from solver.fields import normal, sliding
from solver.fields.half_space import on_surface
from solver.fields.pressure import Pressure
from solver.numerics.mesh import mesh_of, panel_mesh

MESHES = [mesh_of(6), mesh_of(64), panel_mesh(12, (0.0, 0.0625, 0.25, 0.5, 0.75, 1.0))]


@pytest.mark.parametrize("mesh", MESHES, ids=["few", "many", "panels"])
def test_hertz(mesh):
    """To 1e-13 of p0, from the surface down; 64 nodes lose the most."""
    rows = table("hertz_halfspace")
    pressure, r, z = Pressure(mesh, mesh.s[None]), np.unique(rows["r"]), np.unique(rows["z"])
    for nu in np.unique(rows["nu"]):
        here = rows[rows["nu"] == nu]
        field = normal.components(normal.in_closed_form(pressure, r, z, np.array([nu])), 1 - nu)
        for name, values in field.items():
            at_rows = values[0][np.searchsorted(z, here["z"]), np.searchsorted(r, here["r"])]
            some = np.isfinite(here[name])
            assert_allclose(at_rows[some], here[name][some], rtol=0, atol=1e-13)


@pytest.mark.parametrize("mesh", MESHES, ids=["few", "many", "panels"])
def test_what_the_closed_form_takes_of_a_power_of_s(mesh):
    """Abel's function, the mean and the edge of p = s^j."""
    r, s = np.array([0.0, 0.3, 0.9, 1.0, 1.5]), np.linspace(0, 1, 23)
    for j, beta in ((1, 2.0), (2, np.pi / 2), (3, 4 / 3)):  # Euler's beta function of 1/2, (j + 1)/2
        pressure = Pressure(mesh, mesh.s[None] ** j)
        assert_allclose(pressure.density(s)[0], 2 * s ** (j - 1) / beta, rtol=0, atol=3e-12)
        inside = (1 - np.sqrt(np.maximum(1 - r**2, 0)) ** (j + 2)) / (j + 2) / np.maximum(r, 0.1) ** 2
        assert_allclose(pressure.mean(r)[0], np.where(r == 0, 0.5, inside), rtol=0, atol=1e-14)
        assert_allclose(pressure.at_edge(), 0.0, rtol=0, atol=1e-14)
    assert_allclose(Pressure(mesh, np.ones((1, mesh.n))).at_edge(), 1.0, rtol=1e-14, atol=0)


def test_near_the_surface_it_is_that_of_the_surface():
    """At the edge stresses differ by the root of the depth."""
    pressure, r = Pressure(MESHES[1], MESHES[1].s[None]), np.array([0.0, 1e-9, 0.5, 1 - 1e-9, 1.0, 1 + 1e-9, 1.5])
    for closed_form in (normal.in_closed_form, sliding.in_closed_form):
        for z in (1e-20, 1e-14, 1e-8):
            deep, surface = closed_form(pressure, r, np.array([z, 0.0]), np.array([0.3]))[:, 0].swapaxes(0, 1)
            assert_allclose(deep, surface, rtol=0, atol=4 * np.sqrt(z) + 1e-13)


def test_on_the_surface_friction_has_hertz_closed_form():
    """E_1 = pi r/4, E_3 = 0 inside; outside by f = asin(1/r)."""
    r = np.array([0.0, 0.2, 0.999, 1.0, 1.0001, 1.2, 4.0])
    E1, E3 = on_surface(Pressure(MESHES[0], MESHES[0].s[None]), r)[:, 0]
    f = np.arcsin(1 / np.maximum(r, 1))
    assert_allclose(E1, np.where(r <= 1, np.pi * r / 4, r * (f - np.sin(f) * np.cos(f)) / 2), rtol=0, atol=1e-14)
    outside = r * (np.sin(2 * f) / 4 - np.sin(4 * f) / 8)
    assert_allclose(E3, np.where(r <= 1, 0.0, outside), rtol=0, atol=1e-14)

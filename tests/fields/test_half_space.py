"""The closed form over k: against Hertz's, at any depth, and against the waves."""

import numpy as np
import pytest
from field_rows import table
from numpy.testing import assert_allclose

from solver.body.tables import transform
from solver.fields import normal, sliding
from solver.fields.field import integrals
from solver.fields.half_space import on_surface
from solver.fields.pressure import Pressure
from solver.kernels.two_layers import TwoLayers
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


STEEP = panel_mesh(12, (0.0, 2.0**-8, 2.0**-6, 0.0625, 0.25, 0.5, 0.75, 0.875, 0.9375, 1.0))


@pytest.mark.parametrize("mesh", [*MESHES, STEEP], ids=["few", "many", "panels", "steep"])
def test_short_waves_come_from_the_edge(mesh):
    """p^ of a window at the edge is that of all of p, with a jump there or with the smoothest edge."""
    k = np.concatenate([np.linspace(3, 490, 20), np.geomspace(501, 4000, 60)])
    for j in (0, 1, 3, 5):
        pressure = Pressure(mesh, mesh.s[None] ** j)
        assert_allclose(pressure.transform(k), pressure.values @ transform(mesh, k).T, rtol=0, atol=1e-15)


@pytest.mark.parametrize("load", [normal.NORMAL, sliding.SLIDING], ids=["normal", "sliding"])
def test_rows_near_the_surface_are_those_of_the_waves(load):
    """Where the two ways meet they agree, for any pressure: a larger radius beside others makes rows near. And stresses
    are the same without displacements."""
    random = np.random.default_rng(0)
    mesh, h = MESHES[1], np.array([0.6, 0.9])
    values = np.array([mesh.s * np.polynomial.chebyshev.chebval(2 * mesh.s - 1, random.normal(size=20)) for _ in h])
    layers = TwoLayers(np.array([0.2, 6.0]), np.array([0.5, 0.1]), np.array([0.2, 0.3]), np.array([True, False]))
    r, z = np.array([0.0, 0.7, 0.999, 1.0, 1.2]), np.array([[0.07, 0.1, 0.2], [0.08, 0.1, 0.2]])
    pressure, body = Pressure(mesh, values), np.zeros(3, dtype=bool)
    waves = integrals(load, layers, h, pressure, r, z, body)
    near = integrals(load, layers, h, pressure, np.append(r, 20.0), z, body)
    assert_allclose(near[..., :-1], waves, rtol=0, atol=1e-11 * np.abs(waves).max())
    stresses = integrals(load.of_stresses(), layers, h, pressure, np.append(r, 20.0), z, body)
    assert_allclose(stresses, near[: load.stresses], rtol=0, atol=1e-14 * np.abs(waves).max())


#: As the mesh of a cone: panels that halve towards the tip.
TIP = panel_mesh(16, (0.0, 0.25, 0.6, *(np.sqrt(1 - 4.0**-j) for j in range(1, 16)), 1.0))


def test_short_waves_of_a_tip():
    """Those of a cone's pressure, arcosh(1/r), are (1 - cos k)/k². Where windows are used they are as near to these as
    p^ of all of p: panels of 16 points leave 1e-11 out of the logarithm."""
    k = np.concatenate([np.linspace(3, 490, 20), np.geomspace(501, 8000, 60), np.geomspace(1e4, 1e5, 9)])
    pressure = Pressure(TIP, np.arctanh(np.minimum(TIP.s, 1 - 1e-15))[None])
    assert_allclose(pressure.transform(k)[0], (1 - np.cos(k)) / k**2, rtol=0, atol=2e-11)
    some = k[:-9]
    assert_allclose(pressure.transform(some), pressure.values @ transform(TIP, some).T, rtol=0, atol=1e-12)


def test_short_waves_of_a_kink():
    """Narrow panels in the middle, about a jump of p': of (1 - 2r) r² inside r = 1/2, and of s. Wide panels leave 1e-11
    out of r in s."""
    kink = np.sqrt(1 - (0.5 + np.append(-(4.0 ** -np.arange(1, 9)), 4.0 ** -np.arange(8, 0, -1))[::-1]) ** 2)
    mesh = panel_mesh(16, tuple(np.unique([0.0, 0.3, *kink, np.sqrt(0.75), 1.0])))
    x, k = np.sqrt(1 - mesh.s**2), np.geomspace(501, 9000, 40)
    pressure = Pressure(mesh, np.stack([np.maximum(1 - 2 * x, 0.0) * x**2, mesh.s]))
    assert_allclose(pressure.transform(k), pressure.values @ transform(mesh, k).T, rtol=0, atol=1e-11)

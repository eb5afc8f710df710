"""Short waves, which are those of the edge alone, against closed forms."""

import numpy as np
from numpy.testing import assert_allclose
from scipy.special import jv

from solver.fields.points import edge_waves
from solver.fields.pressure import Pressure
from solver.numerics.mesh import mesh_of, panel_mesh
from solver.numerics.quadrature import gauss_legendre

MESH = mesh_of(16)


def test_the_transform_of_hertz_and_of_a_flat_punch():
    k = np.geomspace(1.0, 2e4, 300)
    flat = Pressure(MESH, np.zeros((1, 16)), np.ones(1))
    for pressure, exact in ((Pressure(MESH, MESH.s[None]), (np.sin(k) / k - np.cos(k)) / k**2), (flat, np.sin(k) / k)):
        assert_allclose(edge_waves.transform(pressure, k)[0], exact, rtol=0, atol=2e-12)


def test_narrow_panels_away_from_the_edge_have_short_waves_of_their_own():
    assert edge_waves.have_edge_waves(MESH)
    assert not edge_waves.have_edge_waves(panel_mesh(8, (0.0, 0.4, 0.401, 0.402, 1.0)))


def test_the_product_with_a_bessel_function():
    """∫ p^ J0(kr) k e^(-kz) dk of k beyond the window, next to the edge, is that with J0 itself."""
    pressure, z = Pressure(MESH, MESH.s[None] + 0.5 * MESH.s[None] ** 3), 0.02
    ends = np.linspace(edge_waves.LEAST, 2500.0, 160)
    t, w = gauss_legendre(20)
    k, weight = ((ends[:-1, None] + np.diff(ends)[:, None] * t).ravel(), (np.diff(ends)[:, None] * w).ravel())
    weight = weight * k * np.exp(-k * z) * (1 - edge_waves.longer(k))
    f, direct = edge_waves.of_edge(pressure, k), pressure.transform(k)[0]
    for r in (0.85, 0.99, 1.0, 1.01, 1.15):
        octave = np.array([edge_waves.last_octave(np.array([r]))[0]])
        window = edge_waves.shorter(k, octave)[0] / (1 - edge_waves.longer(k))
        J = edge_waves.bessels(k, np.array([r]), f * window, 2)
        for m in (0, 1, 2, 3):
            exact = (weight * direct * jv(m, k * r)).sum()
            assert_allclose((weight * J[m]).sum(), exact, rtol=0, atol=3e-12)

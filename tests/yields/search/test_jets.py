"""Stresses at points with their derivatives, against stresses on grids and their differences."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver.fields.pressure import Pressure
from solver.kernels.two_layers import TwoLayers
from solver.numerics.mesh import mesh_of
from solver.yields.loaded import Loaded
from solver.yields.search.jets import Jets

STEP = 1e-3
#: Region, whether u is the root, u, and the depth in h: at the interface, in the film next to its edge, and away.
POINTS = [
    ("layer", False, 0.6, 0.4),
    ("layer", False, 0.985, 0.9),
    ("above", False, 1.01, 1.0),
    ("body", False, 0.985, 1.5),
    ("body", False, 1.4, 2.0),
    ("inside", False, 0.5, 0.0),
    ("inside", True, 0.2, 0.0),
    ("outside", True, -0.3, 0.0),
]


def loaded(h, mu, bare=False):
    """Two cases under pressures that are zero at the edge, with a stretched layer."""
    mesh = mesh_of(16)
    bodies = (1.0, 1.0), (0.3, 0.5), (0.3, 0.5), (True, True)
    layers = TwoLayers(*map(np.array, bodies if bare else ((3.0, 0.4), (0.2, 0.4), (0.3, 0.5), (True, False))))
    pressure = Pressure(mesh, np.stack([mesh.s + 0.3 * mesh.s**3, mesh.s**3 - 0.5 * mesh.s**5 + 0.2 * mesh.s**4]))
    return Loaded(layers, h * np.array([1.0, 0.9]), pressure, bare, mu, np.array([0.0 if bare else 0.1, 0.0]))


def checked(bodies, region, root, u, depths):
    jets = Jets(bodies)
    for case in (0, 1):
        v, body = depths[case], region == "body"

        def at(u, v):
            radius = np.sqrt(1 - u * abs(u)) if root else u
            return bodies.take([case]).stresses(np.array([radius]), np.array([v]), body)[:, 0, :, 0, 0]  # noqa: B023

        for side in range(len(bodies.signs)):
            points = (np.array([value]) for value in (case, side, root, u, v))
            jet = jets(region, *points)[..., 0]
            here, right, left = (at(u + step, v)[:, side] for step in (0.0, STEP, -STEP))
            assert_allclose(jet[0], here, rtol=0, atol=3e-10)
            assert_allclose(jet[1], (right - left) / (2 * STEP), rtol=0, atol=0.03 * np.abs(jet[1]).max() + 1e-6)
            second = (right - 2 * here + left) / STEP**2
            assert_allclose(jet[3], second, rtol=0, atol=0.05 * np.abs(jet[3]).max() + 1e-3)
            if region in ("layer", "body"):
                low, high = (at(u, v + step)[:, side] for step in (-STEP / 10, STEP / 10))
                assert_allclose(jet[2], (high - low) / (STEP / 5), rtol=0, atol=0.03 * np.abs(jet[2]).max() + 1e-6)


@pytest.mark.parametrize("mu", [0.0, 0.3])
@pytest.mark.parametrize(("region", "root", "u", "depth"), POINTS)
@pytest.mark.parametrize("h", [0.3, 0.02])
def test_the_jet_of_a_point(h, region, root, u, depth, mu):
    bodies = loaded(h, mu)
    checked(bodies, region, root, u, depth * bodies.h)


@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_the_jet_of_a_half_space(mu):
    bodies = loaded(1.0, mu, bare=True)
    checked(bodies, "body", False, 0.8, np.array([0.3, 0.1]))
    checked(bodies, "inside", True, 0.3, np.zeros(2))

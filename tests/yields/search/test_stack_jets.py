"""Stresses at points of stacks with their derivatives, against stresses on grids and their differences."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem
from solver.fields.pressure import Pressure
from solver.fields.stacks.section import Section
from solver.numerics.mesh import mesh_of
from solver.scaling import dimensionless
from solver.yields.stacked.stack_jets import StackJets

STEP = 1e-3
MESH = mesh_of(16)
PRESSURE = Pressure(MESH, (MESH.s + 0.3 * MESH.s**3)[None])
LAYERS = [
    {"h": 0.15, "n": 3.0, "nu": 0.2, "bonding": "bonded"},
    {"h": 0.3, "n": 0.4, "nu": 0.45, "bonding": "frictionless"},
    {"h": 0.1, "n": 5.0, "nu": 0.3, "bonding": {"cn": 0.01, "ct": 0.02}},
]
GRADED = [{"h": 0.3, "n": [4.0, 1.5], "nu": [0.2, 0.4], "profile": "exponential", "bonding": "bonded"}, LAYERS[2]]
#: Number of the layer, the part of it, whether u is the root, u, and the depth.
POINTS = [
    (0, "layer", False, 0.6, 0.05),
    (0, "layer", False, 0.97, 0.13),
    (0, "lower", False, 1.03, 0.15),
    (1, "upper", False, 0.97, 0.15),
    (1, "layer", False, 1.4, 0.3),
    (2, "layer", False, 0.5, 0.5),
    (3, "body", False, 0.2, 0.9),
    (0, "inside", True, 0.2, 0.0),
    (0, "outside", True, -0.3, 0.0),
]


def section(layers, mu):
    """Graded layers are cut into few, as derivatives need no more."""
    scaled = dimensionless(Problem.of(a=1.0, micro="smooth", nu2=0.3, layers=layers, sublayers=1))
    return Section.of(scaled, np.ones(1), PRESSURE, mu, np.full(len(layers), 0.1))


def checked(case, number, part, root, u, v):
    jets = StackJets(case)

    def at(u, v):
        radius = np.sqrt(1 - u * abs(u)) if root else u
        return case.stresses(np.array([radius]), np.array([v]), np.array([number]))[:, :, 0, 0]

    for side in range(len(case.signs)):
        points = (np.array([value]) for value in (0, side, root, u, v))
        jet = jets((number, part), *points)[..., 0]
        here, right, left = (at(u + step, v)[:, side] for step in (0.0, STEP, -STEP))
        assert_allclose(jet[0], here, rtol=0, atol=3e-10)
        assert_allclose(jet[1], (right - left) / (2 * STEP), rtol=0, atol=0.03 * np.abs(jet[1]).max() + 1e-6)
        second = (right - 2 * here + left) / STEP**2
        assert_allclose(jet[3], second, rtol=0, atol=0.05 * np.abs(jet[3]).max() + 1e-3)
        if part in ("layer", "body"):
            low, high = (at(u, v + step)[:, side] for step in (-STEP / 10, STEP / 10))
            assert_allclose(jet[2], (high - low) / (STEP / 5), rtol=0, atol=0.03 * np.abs(jet[2]).max() + 1e-6)
            bent = (high - 2 * here + low) / (STEP / 10) ** 2
            assert_allclose(jet[5], bent, rtol=0, atol=0.05 * np.abs(jet[5]).max() + 1e-2)


@pytest.mark.parametrize("mu", [0.0, 0.3])
@pytest.mark.parametrize(("number", "part", "root", "u", "depth"), POINTS)
def test_the_jet_of_a_point(number, part, root, u, depth, mu):
    checked(section(LAYERS, mu), number, part, root, u, depth)


@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_next_to_the_edge_of_a_film(mu):
    """Where short waves are those of the edge."""
    film = section([LAYERS[0] | {"h": 0.015}, LAYERS[1]], mu)
    for number, part, u, depth in ((0, "layer", 0.99, 0.013), (0, "lower", 1.01, 0.015), (1, "layer", 0.99, 0.03)):
        checked(film, number, part, False, u, depth)


@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_the_jet_in_a_graded_layer(mu):
    """The modulus at the depth itself counts, with its derivatives."""
    case = section(GRADED, mu)
    for number, part, root, u, depth in ((0, "layer", False, 0.7, 0.2), (0, "lower", False, 1.1, 0.3)):
        checked(case, number, part, root, u, depth)
    checked(case, 0, "inside", True, 0.2, 0.0)

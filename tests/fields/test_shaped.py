"""Fields under punches of other shapes than the paraboloid, flat ones and what sticks among them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem, solve
from solver.fields.contact import of_contacts

R, Z = np.array([0.0, 0.5, 0.9, 1.2]), np.array([0.0, 1e-3, 0.03, 0.1, 1.0, 3.0])
LAYER = {"base": "layered", "h": 0.05, "nu1": 0.3, "nu2": 0.25, "bonding": "bonded", "micro": "smooth"}
BARE = {"base": "half_space", "nu2": 0.3, "micro": "smooth"}


def solved(**case):
    """A problem and its solution."""
    problem = Problem.of(**case)
    return problem, solve(problem)


def of_flat_on_axis(P, a, z):
    """sz below a flat punch, Sneddon 1946."""
    return -P / (2 * np.pi * a**2) * (1 + 3 * z**2) / (1 + z**2) ** 2


def test_flat_punch_on_a_half_space():
    problem, solution = solved(shape="flat", flat_radius=0.1, D=[0.01, 0.02], **BARE)
    fields = of_contacts(problem, solution, R, Z)
    assert_allclose(fields.inside["sz"][0, :, 0], of_flat_on_axis(solution.P[0], 0.1, Z), rtol=1e-13, atol=0)
    # the surface goes down evenly, by D, and outside by D (2/pi) arcsin(a/r)
    assert_allclose(fields.inside["uz"][1, 0], [0.02, 0.02, 0.02, 0.04 / np.pi * np.arcsin(1 / 1.2)], rtol=1e-13)
    assert_allclose(
        fields.inside["sz"][0, 0, :3], -solution.P[0] / (0.02 * np.pi * np.sqrt(1 - R[:3] ** 2)), rtol=1e-13
    )


@pytest.mark.parametrize("control", [{"D": 0.01}, {"P": 2e-3}])
def test_stresses_have_the_unit_of_the_problem(control):
    """Those of a flat punch follow from its depth: a length of the problem, which need not be 1 in it."""
    flat, units = {"shape": "flat", "flat_radius": 0.1, "h": 0.05, "n": 3.0} | control, {"P": 3.0 * 2.0**2, "D": 2.0}
    problem, solution = solved(**LAYER | flat)
    scaled = {name: value * units[name] for name, value in control.items()}
    in_units = solved(**LAYER | flat | scaled | {"flat_radius": 0.2, "h": 0.1, "R": 2.0, "E2": 3.0})
    inside = of_contacts(problem, solution, R, Z).inside
    for name, values in of_contacts(*in_units, R, Z).inside.items():
        unit = 2.0 if name.startswith("u") else 3.0
        assert_allclose(values / unit, inside[name], rtol=1e-12, atol=1e-14)


def test_the_edge_of_a_flat_punch():
    problem, solution = solved(shape="flat", flat_radius=0.1, D=[0.01, -0.01], w_adhesion=1e-2, **BARE)
    inside = of_contacts(problem, solution, np.array([1.0]), np.array([0.0, 1e-6]), mu=0.2).inside
    for name in ("sr", "st", "sz"):
        assert inside[name][:, 0, 0].tolist() == [-np.inf, np.inf]
    assert np.all(np.isfinite(inside["sz"][:, 1])) and np.all(inside["trz"][:, 0] == 0)


@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_flat_punch_on_a_layer_of_the_same_material(mu):
    """Waves and closed forms of a layer which is nearly that of the body, against closed forms alone."""
    case = BARE | LAYER | {"n": 1.000001, "nu2": 0.3, "h": 0.07}
    flat = {"shape": "flat", "flat_radius": 0.1, "D": 0.01}
    layered, bare = (of_contacts(*solved(**flat, **c), R, Z, mu=mu).inside for c in (case, BARE))
    for name, values in bare.items():
        assert_allclose(layered[name], values, rtol=0, atol=2e-6 * np.abs(values).max())  # n - 1 is 1e-6


def test_flat_punch_on_a_layer():
    """It is the limit of a rounded one, whose pressure is finite: differences fall like the 2/3 power of its edge."""
    punch = {"flat_radius": 0.1, "P": 1e-3, "n": 5.0}
    flat = of_contacts(*solved(shape="flat", **punch, **LAYER), R, Z[4:]).inside
    away = []
    for edge in (1e-4, 1e-5):
        problem, solution = solved(shape="rounded_flat", edge_radius=edge, **punch, **LAYER)
        scale = 0.1 / solution.a[0]
        rounded = of_contacts(problem, solution, R * scale, Z[4:] * scale).inside
        away.append([np.abs(rounded[name] - flat[name]).max() / np.abs(flat[name]).max() for name in flat])
    assert np.max(away[1]) < 1e-3
    assert_allclose(np.divide(*away), 10 ** (2 / 3), rtol=0.1)


def test_what_sticks_on_a_half_space():
    """Hertz and a flat punch that pulls; with P < 0 too."""
    problem, solution = solved(P=[1e-5, -1e-5], w_adhesion=1e-5, **BARE)
    fields, a = of_contacts(problem, solution, R, Z), solution.a
    of_edge = -np.sqrt(8 * np.pi * a**3 * 1e-5)
    for i in range(2):
        wanted = -2 * a[i] / np.pi / (1 + Z**2) + of_flat_on_axis(of_edge[i], a[i], Z)
        assert_allclose(fields.inside["sz"][i, :, 0], wanted, rtol=1e-11, atol=0)
    assert np.all(fields.error < 1e-9)


def test_what_sticks_on_a_layer():
    """The field is that of the shape at the same radius, and that of a flat punch which pulls with the rest."""
    layer = LAYER | {"n": 0.2}
    for punch in ({}, {"shape": "cone", "half_angle": 80.0}):
        problem, solution = solved(P=1e-5, w_adhesion=1e-6, **punch, **layer)
        a = solution.a[0]
        shape = solved(a=a, **punch, **layer)
        rest = solution.P[0] - shape[1].P[0]
        flat = solved(shape="flat", flat_radius=a, P=-rest, **layer)
        whole, free, pulls = (of_contacts(*parts, R[1:], Z[1:]).inside for parts in ((problem, solution), shape, flat))
        for name, values in whole.items():
            assert_allclose(values, free[name] - pulls[name], rtol=0, atol=1e-7 * np.abs(free[name]).max())


def test_cone_on_a_half_space():
    """sz on the axis below a cone, from Boussinesq's formula for each ring of Sneddon's pressure."""
    problem, solution = solved(shape="cone", half_angle=70.0, a=0.1, **BARE)
    z = np.array([0.05, 0.3, 1.0])
    fields = of_contacts(problem, solution, np.array([0.0]), z)
    # p = (E cot/2) acosh(a/r), and a ring has -3 p r z³/(r² + z²)^(5/2) dr
    t, w = np.polynomial.legendre.leggauss(400)
    r, weight = ((t + 1) / 2) ** 2, w * (t + 1) / 2
    p = np.arccosh(1 / r) / (2 * np.tan(np.radians(70.0)))
    wanted = -(3 * p * r * z[:, None] ** 3 / (r**2 + z[:, None] ** 2) ** 2.5) @ weight
    assert_allclose(fields.inside["sz"][0, :, 0], wanted, rtol=1e-6, atol=0)  # the sum of rings is right to 1e-7

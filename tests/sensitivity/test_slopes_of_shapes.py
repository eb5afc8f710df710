"""Sensitivities of contacts under other shapes than a paraboloid: closed forms, and differences of the solver."""

import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem, Status, solve
from solver.sensitivity import QUANTITIES, sensitivities
from solver.sensitivity.differences import by_differences
from solver.sensitivity.inputs import inputs_of

#: Asperities and a layer, on which a contact has all inputs.
ROUGH = {"Nbar": 250000.0, "Ra": 0.004, "micro": "disc_cell", "h": 0.04, "n": 0.3}
BLUNT = {"half_angle": 84.0, "flat_radius": 0.012}


def logs(problem, x=(), inputs=None):
    solution = solve(problem)
    assert (solution.status == Status.CONVERGED).all()
    return sensitivities(problem, solution, x, inputs)


def of(result, quantity, name):
    return result.logs[quantity][:, result.inputs.index(name)]


def test_smooth_cone_on_a_half_space():
    """P = (π/2) E a² cot α and D = (π/2) a cot α: d ln tan α/d ln α = 2 α/sin 2α. The pressure on the axis is infinite,
    and has no sensitivity."""
    result = logs(Problem.of(P=[1e-5, 1e-3], half_angle=70.0, shape="cone", base="half_space", micro="smooth", m=0.3))
    angle = np.radians(140.0) / np.sin(np.radians(140.0))
    by_m = 0.3 / 1.3  # E = E2*/(1 + m)
    wanted = {"a": (0.5, angle / 2, by_m / 2), "D": (0.5, -angle / 2, by_m / 2)}
    wanted |= {"dP_dD": (0.5, angle / 2, -by_m / 2), "P": (1.0, 0.0, 0.0), "Ar_An": (0.0, 0.0, 0.0)}
    for quantity, numbers in wanted.items():
        for name, number in zip(("P", "half_angle", "m"), numbers, strict=True):
            assert_allclose(of(result, quantity, name), number, rtol=0, atol=1e-7)  # 1e-10/1e-3, and 1e-3 to the fourth
    for quantity in ("p0", "p_max"):
        assert np.isnan(result.logs[quantity]).all()


def test_smooth_flat_punch_on_a_half_space():
    """P = 2 E b D, p(0) = E D/(π b)."""
    case = {"shape": "flat", "flat_radius": 0.1, "base": "half_space", "micro": "smooth"}
    result = logs(Problem.of(D=1e-3, **case), x=(0.0, 1.0))
    wanted = {"a": (0, 1), "P": (1, 1), "D": (1, 0), "p0": (1, -1), "dP_dD": (0, 1)}
    for quantity, numbers in wanted.items():
        for name, number in zip(("D", "flat_radius"), numbers, strict=True):
            assert_allclose(of(result, quantity, name), number, rtol=0, atol=1e-7)
    p = result.p[0, result.inputs.index("D")]
    assert_allclose(p[0], 1e-3 / (np.pi * 0.1), rtol=1e-7)
    assert np.isnan(p[1])  # it is infinite


#: Shape, its numbers, control, and the input by which derivatives are compared.
CASES = [
    ({"shape": "sphere", "D": 0.02}, "h"),
    ({"shape": "power", "shape_power": 3.0, "shape_coefficient": 1.0, "P": 1e-4}, "shape_power"),
    ({"shape": "cone", "half_angle": 80.0, "P": 1e-4}, "half_angle"),
    ({"shape": "frustum", "D": 2e-3} | BLUNT, "flat_radius"),
    ({"shape": "rounded_flat", "flat_radius": 0.012, "edge_radius": 0.1, "a": 0.03}, "edge_radius"),
    ({"shape": "flat", "flat_radius": 0.03, "P": 1e-4}, "flat_radius"),
]


@pytest.mark.parametrize(("case", "name"), CASES)
def test_rough(case, name):
    """Against central differences of the solver, whose h² times a third derivative is up to 1e-5 under a cone."""
    base = {"base": "half_space"} if name in ("flat_radius", "edge_radius") else {}
    problem, h = Problem.of(**(ROUGH | case | base), rtol=1e-8), 1e-3
    result = logs(problem, inputs=(name,))
    value = getattr(problem, name)
    up, down = (solve(problem.but(**{name: value * (1 + step)}, rtol=1e-9)) for step in (h, -h))
    for quantity in (q for q in QUANTITIES if q != "A0"):
        wanted = (np.log(getattr(up, quantity)) - np.log(getattr(down, quantity))) / (2 * h)
        if case["shape"] == "cone" and quantity in ("p0", "p_max"):
            assert np.isnan(wanted).all() and np.isnan(of(result, quantity, name)).all()
            continue
        assert_allclose(of(result, quantity, name), wanted, rtol=3e-5, atol=3e-5, err_msg=quantity)


def test_what_does_not_act_is_0_and_a_mixed_batch_is_its_cases():
    case = {"shape": np.array(["sphere", "paraboloid", "cone"]), "half_angle": 80.0, "P": 1e-4} | ROUGH
    problem = Problem.of(**case)
    inputs = ("P", "half_angle", "flat_radius", "w_adhesion")
    result = logs(problem, inputs=inputs)
    assert of(result, "a", "half_angle")[:2].tolist() == [0.0, 0.0] and of(result, "a", "half_angle")[2] > 1
    for i in range(3):
        alone = logs(problem.take([i]), inputs=inputs)
        for name in ("P", "half_angle"):
            assert_allclose(of(alone, "D", name)[0], of(result, "D", name)[i], rtol=1e-7, atol=1e-12)
    assert (of(result, "a", "w_adhesion") == 0).all() and (of(result, "a", "flat_radius") == 0).all()


@pytest.mark.parametrize("P", [1e-5, -2e-5])
def test_what_sticks_on_a_half_space(P):
    """JKR: P = (4/3) a³ - s a^(3/2) with s = sqrt(8 π w), D = a² - sqrt(2 π a w), of sizes that may be negative."""
    w = 1e-5
    problem = Problem.of(P=P, w_adhesion=w, base="half_space", micro="smooth")
    solution, result = solve(problem), logs(problem)
    a, s, t = solution.a[0], np.sqrt(8 * np.pi * w), np.sqrt(2 * np.pi * w)
    D, dP_da, dD_da = a**2 - t * a**0.5, 4 * a**2 - 1.5 * s * a**0.5, 2 * a - t / (2 * a**0.5)
    by_w = s * a**1.5 / 2 / (a * dP_da)  # of ln a, as P stays: dP by ln w is -s a^(3/2)/2
    assert_allclose(of(result, "a", "P"), P / (a * dP_da), rtol=1e-6)
    assert_allclose(of(result, "a", "w_adhesion"), by_w, rtol=1e-6)
    assert_allclose(of(result, "D", "P"), P * dD_da / dP_da / D, rtol=1e-6)
    assert_allclose(of(result, "D", "w_adhesion"), (dD_da * a * by_w - t * a**0.5 / 2) / D, rtol=1e-6)


def test_of_no_load_and_no_contact():
    """A load of 0 has no logarithm, and a punch that is pulled off no numbers."""
    sticks = {"w_adhesion": 1e-5, "base": "half_space", "micro": "smooth"}
    result = logs(Problem.of(P=0.0, **sticks))
    assert np.isnan(result.logs["P"]).all() and of(result, "a", "P") == 0
    assert_allclose(of(result, "a", "w_adhesion"), 1 / 3, rtol=1e-6)  # a³ ~ w
    problem = Problem.of(P=-1.0, **sticks)
    assert all(np.isnan(values).all() for values in sensitivities(problem, solve(problem)).logs.values())


#: Smooth contacts whose radius is found from their load or depth; adhesion under control and shape of other kinds.
SMOOTH = {
    "cone": {"shape": "cone", "half_angle": 75.0, "P": 1e-5},
    "sphere": {"shape": "sphere", "D": 1e-3},
    "rounded flat": {"shape": "rounded_flat", "flat_radius": 0.02, "edge_radius": 0.3, "P": 1e-5},
    "pulled": {"P": -1e-6, "w_adhesion": 1e-6},
    "without a load": {"P": 0.0, "w_adhesion": 1e-6},
    "unstable": {"P": -1e-6, "w_adhesion": 1e-6, "branch": "unstable"},
    "dmt": {"P": 1e-6, "w_adhesion": 1e-6, "adhesion": "dmt"},
}


@pytest.mark.parametrize("name", SMOOTH)
def test_smooth_contacts_are_solved_at_their_radius(name, monkeypatch):
    """To the numbers of contacts that are solved under their control, which takes up to 40 times as long."""
    problem, x = Problem.of(**SMOOTH[name], h=0.02, n=0.5, base="layered", micro="smooth"), (0.5,)
    solution = solve(problem, x)
    inputs = tuple(i for i in inputs_of(problem) if np.isfinite(getattr(problem, i, 1.0)).all())
    with np.errstate(all="ignore"):  # p(0) of a cone is infinite
        logs, profiles, slopes = by_differences(problem, inputs, QUANTITIES, x, fine=True)
    monkeypatch.setattr(sys.modules["solver.sensitivity.sensitivities"], "by_differences", None)
    result = sensitivities(problem, solution, x, inputs)
    for quantity in ("P", "D"):
        atol = 1e-8 * abs(slopes[quantity]).max()
        assert_allclose(result.slopes[quantity][0], slopes[quantity][:, 0], rtol=0, atol=atol, err_msg=quantity)
    for quantity in ("a", "D", "dP_dD"):  # 1e-12 over the step of 1e-3, and the step to the fourth
        assert_allclose(result.logs[quantity][0], logs[quantity][:, 0], rtol=0, atol=1e-8, err_msg=quantity)
    assert_allclose(result.p[0], profiles[0][:, 0], rtol=0, atol=1e-8 * abs(profiles[0]).max())

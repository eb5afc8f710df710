"""Contacts on stacks of layers: against another code, one layer, thin films, thin layers, and sums of compliances."""

import csv
import pickle
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Model, Problem, Status, solve
from solver.layers import MOST
from solver.sensitivity import sensitivities

REFERENCES = Path(__file__).parents[1] / "references"
SMOOTH, ROUGH = {"micro": "smooth"}, {"Nbar": 250000, "Ra": 0.004}
QUANTITIES = ("a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD")


def rows(name):
    with open(REFERENCES / name, newline="") as file:
        return {row["stack"]: row for row in csv.DictReader(file)}


STACKS, CONTACTS = rows("stacks.csv"), rows("given_stack_contact.csv")


def given(name):
    """The layers and base of a row of stacks.csv in units of R = 100 h1, and the modulus of the unit there."""
    row, R = STACKS[name], float(CONTACTS[name]["R_over_h1"])
    layers = [tuple(map(float, text.split())) for text in row["layers_top_first_h_Estar_nu"].split("|")]
    rigid = row["base_Estar_nu"] == "rigid"
    unit, nu2 = (layers[0][1], 0.3) if rigid else map(float, row["base_Estar_nu"].split())
    stack = []
    for (h, E, nu), text in zip(layers, row["interfaces_below_each"].split("|"), strict=True):
        word, *springs = text.split()
        bonding = {key: float(v) * unit / R for key, v in (part.split("=") for part in springs)} if springs else word
        stack.append({"h": h / R, "n": E / unit, "nu": nu, "bonding": bonding})
    return {"layers": stack, "rigid_base": rigid, "nu2": nu2}, unit, R


@pytest.mark.parametrize("control", ["a", "P", "D"])
@pytest.mark.parametrize("name", STACKS)
def test_another_code(name, control):
    """1e-10, which is asked for; a Fredholm equation in long double."""
    stack, unit, R = given(name)
    row = {key: float(value) for key, value in CONTACTS[name].items() if key != "stack"}
    exact = {"a": row["a_over_h1"] / R, "P": row["P"] / unit / R**2, "D": row["D"] / R}
    contact = solve(Problem.of(**{control: exact[control]}, **stack, **SMOOTH, rtol=1e-10))
    assert contact.status == Status.CONVERGED and contact.model_used == Model.SMOOTH_STACK
    for quantity, value in (exact | {"dP_dD": row["S_flat_punch"] / unit / R}).items():
        assert_allclose(getattr(contact, quantity), value, rtol=1e-10, atol=0)
    assert np.abs(contact.P / exact["P"] - 1) <= contact.error


@pytest.mark.parametrize("name", STACKS)
def test_another_code_with_adhesion(name):
    """1e-9, which is asked for: load and depth of an edge that tears, at a radius; and back, on the branch on which the
    radius is. Near pull-off the `error` of a radius is above 1e-9, so 1e-8 is the tolerance."""
    stack, unit, R = given(name)
    row = {key: float(value) for key, value in CONTACTS[name].items() if key != "stack"}
    stack |= {"w_adhesion": row["w"] / unit / R} | SMOOTH
    exact = {"a": row["a_over_h1"] / R, "P": row["P_JKR"] / unit / R**2, "D": row["D_JKR"] / R}
    for control in "aPD":
        off = 0.0 if control == "a" else solve(Problem.of(**{control: exact[control]}, **stack)).a_off[0]
        branch = "unstable" if exact["a"] < off else "stable"
        contact = solve(Problem.of(**{control: exact[control]}, **stack, branch=branch, rtol=1e-8))
        assert contact.status == Status.CONVERGED
        for quantity, value in exact.items():
            assert_allclose(getattr(contact, quantity), value, rtol=1e-9, atol=0)


@pytest.mark.parametrize("control", ["a", "P", "D"])
@pytest.mark.parametrize("kind", [SMOOTH, ROUGH], ids=["smooth", "rough"])
def test_one_layer_is_layered(kind, control):
    """1e-10, which is asked for: octaves of h/a, bonded and not, soft, stiff, on a rigid base, an elastic punch."""
    n, h = (v.ravel() for v in np.meshgrid([0.0, 0.05, 1.5, 20.0], [3e-3, 0.02, 0.3]))
    bonding = np.where(np.arange(len(n)) % 2, "bonded", "frictionless")
    layer = {"h": h, "n": n, "nu1": 0.4, "nu2": 0.2, "bonding": bonding, "m": np.where(h > 0.1, 0.3, 0.0)} | kind
    value = np.full(len(n), 0.05)
    if control != "a":
        value = getattr(solve(Problem.of(a=value, **layer, rtol=1e-10)), control)
    exact = solve(Problem.of(**{control: value}, **layer, rtol=1e-10))
    stack = {name: layer[name] for name in layer if name not in ("h", "n", "nu1", "bonding")}
    one = [{"h": h, "n": n, "nu": 0.4, "bonding": bonding}]
    contact = solve(Problem.of(**{control: value}, layers=one, **stack, rtol=1e-10))
    assert exact.status.tolist() == contact.status.tolist() == [Status.CONVERGED] * len(n)
    for name in QUANTITIES:
        assert_allclose(getattr(contact, name), getattr(exact, name), rtol=1e-10, atol=0)


@pytest.mark.parametrize("cut", [2.0**-7, 2.0**-10, 2.0**-14])
def test_a_layer_cut_very_near_its_surface(cut):
    """The first layer is a film of h1/a down to 6e-5 on more of the same, and H/a is of the order of 1: it is the layer
    itself, to 1e-10. Its error is not more than 5e-8."""
    a, h, n = 0.05, np.array([0.05, 0.05, 0.5, 0.02]), np.array([0.5, 20.0, 0.05, 0.3])
    exact = solve(Problem.of(a=a, h=h, n=n, nu1=0.3, bonding="bonded", rtol=1e-10, **SMOOTH))
    layers = [{"h": cut * a, "n": n, "bonding": "bonded"}, {"h": h - cut * a, "n": n, "bonding": "bonded"}]
    contact = solve(Problem.of(a=a, layers=layers, rtol=1e-7, **SMOOTH))
    assert np.all(contact.status == Status.CONVERGED) and np.all(contact.error < 1e-7)
    for name in ("P", "D", "p0"):
        assert_allclose(getattr(contact, name), getattr(exact, name), rtol=1e-10, atol=0)


def test_thin_layer_of_a_stack():
    """Its springs are the sum of those of the layers; the exact stack comes near it, as its model error says."""
    layers = [{"h": 4e-4, "n": 0.3, "bonding": "bonded"}, {"h": 6e-4, "n": 0.1, "bonding": {"cn": 1e-3, "ct": 0.0}}]
    case = {"a": 0.1, "layers": layers, **ROUGH, "asperities_on": "half_space"}
    thin, exact = solve(Problem.of(base="thin_layer", **case)), solve(Problem.of(**case))
    assert thin.model_used == Model.THIN_STACK and thin.status == exact.status == Status.CONVERGED
    off = np.abs(thin.P / exact.P - 1)
    assert 0.1 * thin.model_error < off < 3 * thin.model_error < 0.1
    without = [layers[0], layers[1] | {"bonding": "bonded"}]
    assert np.abs(solve(Problem.of(**case | {"layers": without})).P / exact.P - 1) > 5 * off, "springs count"


def test_thin_layers_that_do_not_apply():
    stiff = [{"h": 1e-3, "n": 50.0, "bonding": "bonded"}]
    contact = solve(Problem.of(a=0.1, layers=stiff, base="thin_layer", **SMOOTH))
    assert contact.status == Status.THIN_LAYER_NOT_APPLICABLE


def test_auto_is_the_exact_stack():
    case = {"a": 0.1, "layers": [{"h": 0.02, "n": 2.0}, {"h": 0.1, "n": 0.5}], **SMOOTH}
    auto, exact = solve(Problem.of(base="auto", accuracy=0.1, **case)), solve(Problem.of(**case))
    assert auto.P == exact.P and auto.model_used == Model.SMOOTH_STACK and auto.model_error == 0


def test_units():
    """Lengths in R, moduli in E2, springs in R/E2."""
    layers = [{"h": 0.02, "n": 2.0, "bonding": {"cn": 0.01, "ct": 0.3}}, {"h": 0.1, "n": 0.5}]
    one = solve(Problem.of(P=1e-5, layers=layers, **ROUGH))
    R, E = 3.0, 7.0
    springs = {"cn": 0.01 * R / E, "ct": 0.3 * R / E}
    other = [{"h": 0.02 * R, "n": 2.0, "bonding": springs}, {"h": 0.1 * R, "n": 0.5}]
    case = {"Nbar": ROUGH["Nbar"] / R**2, "Ra": ROUGH["Ra"] * R, "R": R, "E2": E}
    two = solve(Problem.of(P=1e-5 * E * R**2, layers=other, **case))
    assert_allclose([two.a / R, two.D / R, two.p0 / E], [one.a, one.D, one.p0], rtol=1e-12)


@pytest.mark.parametrize("control", ["P", "a"])
@pytest.mark.parametrize("kind", [SMOOTH, ROUGH], ids=["smooth", "rough"])
def test_sensitivities(kind, control):
    """Against contacts with one input moved, solved to 1e-11."""
    layers = [
        {"h": 0.02, "n": 2.0, "nu": 0.2, "bonding": {"cn": 0.004, "ct": 0.01}},
        {"h": 0.03, "n": 0.5, "nu": 0.4, "bonding": "bonded"},
    ]
    problem = Problem.of(**{control: 2e-5 if control == "P" else 0.04}, layers=layers, rtol=1e-11, nodes=40, **kind)
    solved = sensitivities(problem, solve(problem))
    assert {"layers.2.h", "layers.2.n", "layers.2.nu", "layers.1.cn", "layers.1.ct", "h", "n"} <= {*solved.inputs}
    for name in ("h", "n", "nu1", "layers.2.h", "layers.2.n", "layers.2.nu", "layers.1.cn", "nu2"):
        step, value = 1e-4, getattr(problem, name)
        moves = [value + sign * step * (1.0 if "nu" in name else value) for sign in (1, -1)]
        up, down = (solve(problem.but(**{name: moved})) for moved in moves)
        place = solved.inputs.index(name)
        for quantity in ("a", "P", "D", "p0", "dP_dD"):
            difference = np.log(getattr(up, quantity) / getattr(down, quantity)) / (2 * step)
            assert_allclose(solved.logs[quantity][:, place], difference, rtol=1e-5, atol=1e-7, err_msg=name)


def test_a_batch_of_many_kinds():
    """Each case as when it is alone."""
    base = np.array(["stack", "half_space", "thin_stack", "stack"])
    layers = [{"h": 0.01, "n": np.array([1.0, 2.0, 0.5, 3.0]), "bonding": "bonded"}, {"h": 0.02, "n": 0.5}]
    problem = Problem.of(P=1e-5, base=base, layers=layers, **ROUGH)
    together = solve(problem)
    for i in range(4):
        alone = solve(problem.take([i]))
        assert alone.status == together.status[i] and alone.model_used == together.model_used[i]
        assert_allclose(alone.P, together.P[i], rtol=1e-12) and assert_allclose(alone.D, together.D[i], rtol=1e-9)


def test_one_layer_on_a_rigid_base():
    """It needs no list."""
    listed = solve(Problem.of(a=0.05, layers=[{"h": 0.1, "n": 1.0}], rigid_base=True, **SMOOTH))
    assert solve(Problem.of(a=0.05, h=0.1, rigid_base=np.True_, **SMOOTH)).P == listed.P


def test_a_batch_travels():
    problem = Problem.of(a=0.05, layers=[{"h": 0.01, "n": 1.0}, {"h": 0.02, "n": 0.5}], **SMOOTH)
    assert solve(pickle.loads(pickle.dumps(problem))).P == solve(problem).P


BAD = {
    "too many": ({"layers": [{"h": 0.01, "n": 1.0}] * (MOST + 1)}, "17 layers: at most 16"),
    "beside": ({"layers": [{"h": 0.01, "n": 1.0}], "h": 0.1}, "h is given beside layers"),
    "a key": ({"layers": [{"h": 0.01, "n": 1.0, "thick": 1}]}, "layers.1.thick"),
    "springs": ({"layers": [{"h": 0.01, "n": 1.0, "bonding": {"k": 1}}]}, "springs have cn and ct"),
    "missing": ({"layers": [{"h": 0.01, "n": 1.0}, {"n": 1.0}]}, "layers.2.h is missing"),
    "none": ({"base": "stack", "h": 0.1, "n": 1.0}, "layers are missing"),
    "rigid": ({"layers": [{"h": 0.01, "n": 2.0}], "rigid_base": True}, "layers.1.n = 2.0"),
    "layered": ({"layers": [{"h": 0.01, "n": 2.0}], "base": "layered"}, "has one layer"),
    "no list": ({"layers": 3}, "must be a list of layers"),
    "one that is none": ({"layers": [{"h": 0.01, "n": 1.0}, 3]}, "must be a list of layers"),
    "no layers": ({"layers": []}, "must be a list of layers"),
    "both names": ({"layers.1.h": 0.01, "h": 0.1, "n": 1.0}, "layers.1.h is h, which is given too"),
    "a ratio on a rigid base": ({"rigid_base": True, "h": 0.1, "n": 0.5}, "layers.1.n = 0.5"),
}


@pytest.mark.parametrize("kind", BAD)
def test_bad_input(kind):
    parameters, message = BAD[kind]
    with pytest.raises((ValueError, TypeError)) as caught:
        Problem.of(a=0.05, **parameters, **SMOOTH)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    "bad", [{"h": -1.0}, {"n": 0.0}, {"nu": 0.6}, {"bonding": {"cn": -1.0, "ct": 0.0}}, {"h": np.nan}]
)
def test_numbers_out_of_bounds(bad):
    layers = [{"h": 0.01, "n": 1.0}, {"h": 0.01, "n": 1.0} | bad]
    contact = solve(Problem.of(a=0.05, layers=layers, **SMOOTH))
    assert contact.status == Status.INVALID_INPUT and np.isnan(contact.P)


def test_calls_without_layers_do_not_know_of_them():
    Problem.of(a=0.05, layers=[{"h": 0.01, "n": 1.0}] * 3, **SMOOTH)
    assert not [name for name in Problem.of(a=0.05, h=0.1, n=1.0, **SMOOTH).parameters if "layers" in name]

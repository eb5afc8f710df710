"""Contacts under a load or depth that more than one radius has: the smallest without tension inside."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rows import SMOOTH

from solver import Problem, Status, solve

#: A depth that the outer branch has too; and one with its maximum and minimum within 15 % of the radius.
HARD = [
    {"shape": "cone", "half_angle": 79.48288854432212, "h": 0.08029935140194301, "n": 4934.663571603588,
     "nu1": 0.2700721809181697, "nu2": -0.717054587276066, "bonding": "bonded", "a": 0.056489577406684435},
    {"shape": "blunt_cone", "tip_radius": 0.10560026834286122, "half_angle": 79.0706095931896, "tip": "sphere",
     "h": 0.002128515208255405, "n": 444.25995706570944, "nu1": 0.044664359109773955, "nu2": 0.052228006892108936,
     "bonding": "frictionless", "a": 0.01974734123043458},
]  # fmt: skip
#: Six layers under a cone: the first is thin and hard, and p < 0 at r = 0.02 ... 0.03 a.
RING = {"shape": "cone", "half_angle": 68.56417948462777, "nu2": -0.7131240350146949, "a": 0.03773120969680942}
SIX = [
    {"h": 0.000852011539927073, "n": 249.1821991793629, "nu": 0.398250309775224, "bonding": "frictionless"},
    {"h": 0.001505487836006277, "n": 0.0671244294996554, "nu": -0.17293496154852772, "bonding": "frictionless"},
    {"h": 0.0032733026231162293, "n": 1318.3829277645907, "nu": -0.1761734424916448, "bonding": "bonded"},
    {"h": 0.010095224368760213, "n": 418.05331118309607, "nu": -0.006192246469873708, "bonding": "bonded"},
    {"h": 0.0009489546833422138, "n": 0.024491036926102085, "nu": 0.3522488324270586, "bonding": "bonded"},
    {"h": 0.005258598164295309, "n": 298.76043742964964, "nu": -0.8786906929179196, "bonding": "bonded"},
]
SHAPES = ("paraboloid", "sphere", "cone", "berkovich", "power", "frustum", "blunt_cone", "rounded_flat")


def round_trips(case, rtol=1e-6):
    """Solve by a, then by D, by P: the converged contacts by a and, by control, those by its value and their distance
    in a over what both errors allow."""
    contact = solve(Problem.of(**case, **SMOOTH, rtol=rtol))
    ended = np.flatnonzero(contact.status == Status.CONVERGED)
    rest = {name: v[ended] if isinstance(v, np.ndarray) else v for name, v in case.items() if name != "a"}
    contact, again = contact.take(ended), {}
    for control in "DP":
        other = solve(Problem.of(**{control: getattr(contact, control)}, **rest, **SMOOTH, rtol=rtol))
        off = np.abs(other.a / contact.a - 1) / (1e-9 + 10 * (contact.error + other.error))
        again[control] = other, off
    return contact, again


@pytest.mark.parametrize("case", HARD, ids=["cone", "ball_cone"])
def test_the_inner_branch(case):
    """The same radius to 1e-10 by a, D and P; D(a) has a maximum a little above it."""
    a, rest = case["a"], {name: v for name, v in case.items() if name != "a"}
    contact = solve(Problem.of(**case, **SMOOTH))
    assert contact.status == Status.CONVERGED
    for control in "DP":
        other = solve(Problem.of(**{control: getattr(contact, control)}, **rest, **SMOOTH))
        assert other.status == Status.CONVERGED
        assert_allclose(other.a, a, rtol=1e-10, atol=0)
    assert solve(Problem.of(D=3 * contact.D, **rest, **SMOOTH)).status == Status.LIFT_OFF


def test_a_ring_of_tension_between_the_radii():
    """It is lift_off whatever the radii of the profile are. A sphere, without a tip, has none."""
    for x in ([], [0.0, 1.0], np.linspace(0, 1, 201)):
        contact = solve(Problem.of(**RING, layers=SIX, **SMOOTH), x=x)
        assert contact.status == Status.LIFT_OFF
    smooth = {"shape": "sphere", "a": RING["a"], "nu2": RING["nu2"], "layers": SIX} | SMOOTH
    assert solve(Problem.of(**smooth), x=np.linspace(0, 1, 201)).status == Status.CONVERGED


def body(rng, a, hard):
    size = len(a)
    ratio, n = ((0.2, 2), (50, 900)) if hard else ((0.1, 4), (1e-2, 900))
    drawn = [np.exp(rng.uniform(*np.log(ends), size)) for ends in (ratio, n)]
    nu1, nu2 = rng.uniform(-0.9, 0.5, (2, size))
    return {"h": a / drawn[0], "n": drawn[1], "nu1": nu1, "nu2": nu2,
            "bonding": rng.choice(["bonded", "frictionless"], size), "m": rng.choice([0, 0, 0.4], size)}  # fmt: skip


@pytest.mark.parametrize("hard", [True, False], ids=["hard", "any"])
def test_round_trips(hard):
    """Random contacts of every shape on layers: each that exists at its radius is found by its depth and its load."""
    rng, found = np.random.default_rng(61), 0
    for name in SHAPES:
        a = np.exp(rng.uniform(*np.log((0.005, 0.3)), 12))
        sharp, part = np.exp(rng.uniform(*np.log((0.02, 0.8)), 12)), rng.uniform(0.05, 0.97, 12)
        angle = np.degrees(np.arctan(1 / sharp))
        numbers = {"cone": {"half_angle": angle}, "frustum": {"flat_radius": part * a, "half_angle": angle}}
        numbers |= {"power": {"shape_power": rng.choice([1.0, 1.5, 3.0], 12), "shape_coefficient": sharp}}
        numbers |= {"blunt_cone": {"tip_radius": part * a / sharp, "half_angle": angle}}
        numbers |= {"rounded_flat": {"flat_radius": part * a, "edge_radius": a / sharp}}
        contact, again = round_trips({"shape": name, "a": a} | numbers.get(name, {}) | body(rng, a, hard))
        found += len(contact.a)
        for control, (other, off) in again.items():
            assert np.all(other.status == Status.CONVERGED), (name, control, other.status)
            assert np.all(off < 1), (name, control)
    assert found > 60


def test_round_trips_on_stacks_and_graded_layers():
    bonded = {"nu": 0.3, "bonding": "bonded"}
    stack = {"layers": [{"h": 0.03, "n": 300.0} | bonded, {"h": 0.02, "n": 0.5} | bonded]}
    graded = {"layers": [{"h": 0.03, "n": [400.0, 20.0], "profile": "exponential"} | bonded], "sublayers": 4}
    for layers in (stack, graded):
        case = {"shape": "blunt_cone", "tip_radius": 0.01, "half_angle": 75.0} | layers
        contact, again = round_trips(case | {"a": np.array([0.005, 0.015, 0.026])}, rtol=1e-3)
        assert len(contact.a) == 3
        for other, off in again.values():
            assert np.all(other.status == Status.CONVERGED) and np.all(off < 1)


def test_rough_contacts_on_the_inner_branch():
    """With asperities too the radius by D is the given one; the search from the first guess ends far outside."""
    case = {"shape": "cone", "half_angle": 88.25767917606053, "h": 0.017134126430877878, "n": 3646.680492302806,
            "nu1": 0.02071309522254039, "nu2": -0.34850173431473086, "bonding": "frictionless"}  # fmt: skip
    case |= {"micro": "power_law", "B": 0.1, "beta": 0.5, "Nbar": 250000.0, "Ra": 0.004}
    contact = solve(Problem.of(a=0.01318423400786949, **case))
    other = solve(Problem.of(D=contact.D, **case))
    assert contact.status == other.status == Status.CONVERGED
    assert_allclose(other.a, contact.a, rtol=1e-9, atol=0)

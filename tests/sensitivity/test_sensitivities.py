"""Sensitivities against central differences of the solver, of random contacts of every law, base and control."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from solver import Model, Problem, Status, register, solve
from solver.known import PARAMETERS
from solver.laws import disc_cell
from solver.laws.law import Law
from solver.sensitivity import QUANTITIES, sensitivities

#: Below this no reference is right: the solver's rounding over its step, 1e-11/1e-3, and the step to the fourth power.
#: The contract's bar is max(50 rtol, 1e-6), relative to derivatives above 1.
BAR = 5e-5
#: dP/dD is a second derivative: under laws that are tables, it has the error of the curvature of a table.
TABLE = 2e-3
CONTROLS = ("P", "a", "D")
IDENTICAL = ("smooth", "disc_cell", "power_law", "square_lattice")
BASES = ("half_space", "thin_layer", "layered", "auto")


def contacts(micro, base, control, size=4, seed=0, **fixed):
    """Random contacts: a/R from 0.003 to 0.2, layers from far thinner to far thicker, half of them bonded."""
    random = np.random.default_rng([seed, len(micro), len(base), ord(control)])

    def of(low, high):
        return 10 ** random.uniform(low, high, size)

    Ra = of(-4, -2)
    Nbar = of(-3, 0) / Ra**2
    case = {"m": np.where(random.random(size) < 0.5, 0.0, of(-2, 1)), "base": base, "micro": micro}
    case |= {"h": of(-3, 0), "n": of(-2, 2), "bonding": np.where(random.random(size) < 0.5, "bonded", "frictionless")}
    case |= {"nu1": random.uniform(0, 0.3, size), "nu2": random.uniform(0.3, 0.45, size), "accuracy": 0.1}
    case |= {"Nbar": Nbar, "Ra": Ra, "B": of(-1, 1), "beta": random.uniform(0.3, 0.9, size)}
    case |= {"sigma": of(-1, 0.5) / (np.pi * Nbar * Ra)}
    a = of(-2.5, -0.7)
    case |= {"a": a, "D": 0.7 * a**2, "P": 1.3 * a**3} | fixed
    return Problem.of(**{name: v for name, v in case.items() if name in PARAMETERS or name == control})


def moved(problem, name, step):
    """The problem with an input larger by this part of itself; a Poisson ratio by `step`."""
    own = problem.value if name == problem.control else getattr(problem, name)
    new = own + step * (1 if name in ("nu1", "nu2") else own)
    if name == problem.control:
        return Problem(problem.control, new, problem.parameters, problem.known)
    return problem.but(**{name: new})


def joined(problems):
    """One problem of the cases of several of the same control."""
    every = {name: np.concatenate([p.parameters[name] for p in problems]) for name in problems[0].parameters}
    return Problem(problems[0].control, np.concatenate([p.value for p in problems]), every, problems[0].known)


def differences(problem, names, quantity, x=()):
    """Derivatives by the inputs `names` of `quantity`, a function of a solution, by differences of the fourth order:
    one for each name. All moved cases are solved together."""
    exact, h, size = problem.but(rtol=1e-11), 1e-3, len(problem)
    moves = [moved(exact, name, step) for name in names for step in (h, -h, h / 2, -h / 2)]
    every = solve(joined(moves), x)
    values = [quantity(every.take(np.arange(i * size, (i + 1) * size))) for i in range(len(moves))]
    quartets = [values[i : i + 4] for i in range(0, len(values), 4)]
    return [(4 * (near_up - near_down) / h - (up - down) / (2 * h)) / 3 for up, down, near_up, near_down in quartets]


def acting(problem):
    """The inputs on which the answer of some case depends."""
    names = [name for name, own in PARAMETERS.items() if own.interval and not own.whole]
    names = [name for name in names if name not in ("k", "rtol", "accuracy", "R", "E2")]  # R = E2 = 1 are units
    used = [name for name in names if np.any(problem.known.uses(name, lambda key: getattr(problem, key)))]
    return [problem.control, *used]


def errors(problem, inputs=None):
    """(input, quantity) -> largest error of the derivative, relative to derivatives above 1, of the cases solved."""
    solution = solve(problem)
    found, right = sensitivities(problem, solution), solution.status == Status.CONVERGED
    assert right.any()
    names = [name for name in QUANTITIES if name != "A0" or problem.rough().all()]
    worst, inputs = {}, inputs or acting(problem)
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = differences(problem, inputs, lambda s: np.log(np.array([getattr(s, own) for own in names])))
    for name, wanted in zip(inputs, slopes, strict=True):
        for own, reference in zip(names, wanted, strict=True):
            mine = found.logs[own][:, found.inputs.index(name)]
            known = right & np.isfinite(reference)
            assert np.isfinite(mine[right]).all(), (name, own)
            error = np.abs(mine - reference)[known] / np.maximum(1.0, np.abs(reference[known]))
            worst[name, own] = error.max(initial=0.0)
    return worst


@pytest.mark.parametrize(
    ("micro", "base", "control"),
    [(micro, base, CONTROLS[i % 3]) for i, (micro, base) in enumerate(product(IDENTICAL, BASES))],
)
def test_random_contacts(micro, base, control):
    worst = errors(contacts(micro, base, control))
    assert max(worst.values()) < BAR, max(worst, key=worst.get)


@pytest.mark.parametrize(
    ("micro", "base", "control"), [("normal_heights", "layered", "P"), ("uniform_heights", "half_space", "D")]
)
def test_random_heights(micro, base, control):
    """One contact: each moved case has tables of its own."""
    problem = contacts(micro, base, control, size=1, m=0.0, bonding="frictionless")
    for (name, quantity), error in errors(problem, ("sigma", "Nbar")).items():
        assert error < (TABLE if quantity == "dP_dD" else BAR), (name, quantity)


def test_smooth_half_space_is_hertz():
    problem = Problem.of(P=[1e-6, 1e-3], base="half_space", micro="smooth", m=0.3)
    found = sensitivities(problem, solve(problem), inputs=("P", "m"))
    by_m = 0.3 / 1.3  # E = E2*/(1 + m)
    for name, wanted in {"a": (1, by_m), "D": (2, 2 * by_m), "p0": (1, -2 * by_m), "dP_dD": (1, -2 * by_m)}.items():
        np.testing.assert_allclose(found.logs[name], np.tile(wanted, (2, 1)) / 3, rtol=0, atol=3e-8)  # STEP²


@pytest.mark.parametrize("base", ["layered", "auto"])
def test_what_does_not_act_is_0(base):
    problem = contacts("disc_cell", base, "P", bonding="frictionless", m=0.0)
    found = sensitivities(problem, solve(problem))
    for name in ("nu1", "nu2", "m", "B", "beta", "sigma"):
        column = found.inputs.index(name)
        assert all((values[:, column] == 0).all() for values in found.logs.values())


def test_rigid_base_and_failed_cases():
    problem = contacts("disc_cell", "layered", "P", size=3, n=[0.0, 0.0, 0.5], nu1=0.3, P=[1e-5, 1e-5, -1.0])
    found = sensitivities(problem, solve(problem))
    assert (found.logs["p_max"][:2, found.inputs.index("n")] == 0).all()
    assert (found.logs["p_max"][:2, found.inputs.index("h")] != 0).all()
    assert all(np.isnan(values[2]).all() for values in found.logs.values())


@pytest.mark.parametrize(
    ("model", "case"),
    [
        (Model.SMOOTH_THIN_LAYER, {"h": 1e-4, "Nbar": 1e10, "Ra": 1e-3}),
        (Model.SMOOTH_LAYER_ALONE, {"h": 30.0, "Nbar": 1e10, "Ra": 1e-3}),
        (Model.LAYER_ALONE, {"h": 10.0, "Nbar": 250000.0, "Ra": 4e-3}),
        (Model.THIN_LAYER, {"h": 1e-3, "Nbar": 250000.0, "Ra": 4e-3, "asperities_on": "half_space"}),
    ],
)
def test_auto_stays_at_its_model(model, case):
    problem = contacts("disc_cell", "auto", "P", size=1, P=2e-5, n=0.5, m=0.2, bonding="frictionless", **case)
    assert solve(problem).model_used == model
    worst = errors(problem)
    assert max(worst.values()) < BAR, max(worst, key=worst.get)


@pytest.mark.parametrize(
    ("micro", "inputs"), [("disc_cell", "P h n Nbar"), ("smooth", "P h n"), ("uniform_heights", "sigma")]
)
def test_profiles(micro, inputs):
    problem, x = contacts(micro, "layered", "P", size=1), np.linspace(0, 1, 13)
    solution = solve(problem, x)
    found = sensitivities(problem, solution, x)
    names = inputs.split()
    for name, slopes in zip(names, differences(problem, names, lambda s: np.array([s.p, s.lam]), x), strict=True):
        column = found.inputs.index(name)
        for profile, wanted, scale in zip(("p", "lam"), slopes, (solution.p[:, :1], 1.0), strict=True):
            np.testing.assert_allclose(getattr(found, profile)[:, column] / scale, wanted / scale, rtol=0, atol=2e-4)


def test_units():
    """Derivatives of logarithms do not depend on the units; those of p have the unit of p."""
    case, x = {"n": 0.5, "nu1": 0.3, "m": 0.1}, [0.0, 0.5]
    plain = Problem.of(P=2e-5, h=0.02, Nbar=250000, Ra=0.004, **case)
    R, E2 = 5e-3, 2e11
    scaled = Problem.of(P=2e-5 * E2 * R**2, h=0.02 * R, Nbar=250000 / R**2, Ra=0.004 * R, R=R, E2=E2, **case)
    first, second = (sensitivities(problem, solve(problem, x), x) for problem in (plain, scaled))
    for name in QUANTITIES:
        np.testing.assert_allclose(first.logs[name], second.logs[name], rtol=0, atol=1e-9)  # rounding over STEP
    np.testing.assert_allclose(first.p * E2, second.p, rtol=1e-7, atol=0.1)


@pytest.mark.usefixtures("forgetful")
def test_law_of_ones_own():
    """A law of which only the necessary functions are known."""
    parts = {name: getattr(disc_cell.LAW, name) for name in ("scales", "curve", "area", "peak", "edge", "parameters")}
    register(Law(name="own", version="1", **parts))
    own, known = (contacts(micro, "layered", "D", size=2, seed=3) for micro in ("own", "disc_cell"))
    own = known.but(micro="own")
    first, second = (sensitivities(problem, solve(problem)) for problem in (own, known))
    for name in QUANTITIES:
        mine, other = (np.sort(s.logs[name], axis=1) for s in (first, second))
        np.testing.assert_allclose(mine[:, [0, -1]], other[:, [0, -1]], rtol=0, atol=1e-7)  # rounding over STEP


def test_panels():
    """A case on panels, found again on panels of its own."""
    problem = Problem.of(P=1.2e-3, h=1.26e-4, n=7.7e-5, Nbar=2240, Ra=5.75e-3, base="thin_layer", rtol=1e-8)
    assert solve(problem).nodes[0] > 96
    worst = errors(problem, ("P", "h", "Ra"))
    assert max(worst.values()) < BAR, max(worst, key=worst.get)


@pytest.mark.parametrize("x", [[], [0.0, 0.5]])
def test_a_solution_that_is_not_found_again(x):
    """It is solved with moved inputs, which gives the same to their error, 1e-9/1e-3 and 1e-3²."""
    problem = contacts("disc_cell", "layered", "P", size=2, bonding="frictionless", asperities_on="half_space")
    solution = solve(problem, x)
    first, second = (sensitivities(problem, s, x) for s in (solution, replace(solution, D=1.01 * solution.D)))
    for name in QUANTITIES:
        np.testing.assert_allclose(first.logs[name], second.logs[name], rtol=0, atol=1e-5)
        assert (first.logs[name] != second.logs[name]).any()
    np.testing.assert_allclose(first.p, second.p, rtol=1e-4, atol=1e-5 * solution.p0.max())


def test_of_whatever_has_numbers():
    """A tolerance that is not met leaves a contact, and an iteration that stops half-way none."""
    problem = contacts("disc_cell", "layered", "P", size=2, nodes=6, rtol=1e-12, max_iterations=[0, 1])
    solution = solve(problem)
    assert solution.status.tolist() == [Status.TOLERANCE_NOT_MET, Status.ITERATION_LIMIT]
    logs = sensitivities(problem, solution).logs["a"]
    assert np.isfinite(logs[0]).all() and np.isnan(logs[1]).all()


def test_asperities_of_several_laws_that_are_added_afterwards():
    """A smooth punch is solved for both, and each has the asperities of its own law."""
    case = {"h": 1e-4, "n": 0.5, "Nbar": 1e10, "Ra": 1e-3, "B": 0.01, "beta": 0.5, "base": "auto", "accuracy": 0.1}
    both = Problem.of(P=2e-5, micro=["disc_cell", "power_law"], **case)
    solution = solve(both)
    assert (solution.model_used == Model.SMOOTH_THIN_LAYER).all()
    together = sensitivities(both, solution).logs["A0"]
    for i in range(2):
        alone = both.take([i])
        np.testing.assert_allclose(together[i], sensitivities(alone, solve(alone)).logs["A0"][0], rtol=0, atol=1e-7)

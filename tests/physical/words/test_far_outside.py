"""What is far outside the model is said before it is solved; of what is not nothing is said."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from conftest import STUDIES

import study
from solver import Problem, laws, solve
from solver.closed_forms import hertz
from solver.known import PACKAGE
from solver.models.estimate import estimate
from study import solving
from study.data.dataset import model_attributes
from study.in_words import FarOutside, far_outside, sentences
from study.inputs.reading import read
from study.rules.rule import RULES, validity_of

BALL = {"R": "5 mm", "punch": "steel 52100", "P": "5 N", "Ra": "2 um", "bonding": "bonded"}
FILM = BALL | {"layer": "PTFE", "h": "10 nm", "body": "steel 52100", "Nbar": "0.1 1/um^2"}
FILM |= {"asperities_on": "half_space"}
SPOTS = ("Nbar", "Ra", "asperities_on")
LINING = FILM | {"h": "0.2 mm"}
SIZE = 300


class Began(Exception):
    """The solver was asked to solve."""


@pytest.fixture
def unsolved(monkeypatch):
    """Nothing is solved: what is said is said before."""

    def began(*_):
        raise Began

    monkeypatch.setattr(solving, "solved", began)


def said_before(**given) -> list[str]:
    """The warnings before a contact is solved."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with pytest.raises(Began):
            study.solve(**given)
    return [str(one.message) for one in caught]


@pytest.mark.parametrize(
    "change",
    [{}, {"Nbar": "100 1/um^2"}, {"P": None, "a": "0.1 mm"}, {"P": ["1 N", "5 N"]}, {"base": "auto"}],
    ids=["few asperities", "many asperities", "radius", "two loads", "auto"],
)
def test_a_film_of_ptfe_is_said_to_be_far_outside_before_it_is_solved(unsolved, change):
    (text,) = said_before(**{name: value for name, value in (FILM | change).items() if value is not None})
    first, *sentences = text.splitlines()
    assert "far outside what the model describes" in first and sentences
    assert first.startswith("at least half of these contacts are" if change.get("P") else "this contact is")
    assert {*sentences} <= {rule.sentence for rule in RULES.values() if rule.mask}


@pytest.mark.parametrize("progress", [False, None, True])
def test_progress_has_nothing_to_do_with_it(unsolved, progress):
    assert len(said_before(progress=progress, **FILM)) == 1


def test_the_warning_is_at_the_line_of_the_call(unsolved):
    with pytest.warns(FarOutside) as caught, pytest.raises(Began):
        study.solve(**FILM)
    assert caught[0].filename == __file__


ORDINARY = {
    "lining": LINING,
    "thin layer": FILM | {"base": "thin_layer", "bonding": "frictionless"},
    "hard film": FILM | {"layer": "DLC a-C:H"},
    "smooth film": {name: FILM[name] for name in FILM if name not in SPOTS} | {"micro": "smooth"},
    "half-space": {"R": "5 mm", "E2": "1 GPa", "P": "5 N", "Nbar": "0.1 1/um^2", "Ra": "2 um", "base": "half_space"},
    "of no law": FILM | {"asperities_on": "auto"},  # a pitch of more than 300 h
    "one of three": LINING | {"h": ["10 nm", "0.2 mm", "0.3 mm"]},
    "without units": {"P": 1e-5, "h": 2e-6, "n": 0.003, "Nbar": 2.5e6, "Ra": 4e-4},
}


@pytest.mark.parametrize("name", ORDINARY)
def test_of_other_contacts_nothing_is_said_before(unsolved, name):
    """Neither where nothing is far outside, nor where it is solved at once, nor of a few of many."""
    assert said_before(**ORDINARY[name]) == []


def test_a_law_of_ones_own_is_judged_by_what_is_given(unsolved):
    """Its functions may fail, and are called where that is told. The pitch of its asperities says enough."""
    law = replace(laws.LAWS["disc_cell"], name="somebodys", version="1")
    (text,) = said_before(**FILM | {"micro": law})
    assert text.splitlines()[1:] == [RULES["pitch_not_small_against_h"].sentence]
    assert said_before(**LINING | {"micro": law}) == []


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.stem)
def test_no_study_of_the_book_is_far_outside(path):
    assert far_outside(read(path)) == []


def contacts(control: str) -> dict[str, np.ndarray]:
    """Random rough contacts on exact layers, many of them outside the model."""
    random = np.random.default_rng(43)

    def spread(low: float, high: float) -> np.ndarray:
        return np.exp(random.uniform(np.log(low), np.log(high), SIZE))

    h, a, Ra = spread(1e-5, 1), spread(1e-3, 0.3), spread(1e-5, 0.1)
    value = {"P": spread(1e-9, 1e-2), "a": a, "D": a**2 * spread(0.5, 2)}[control]
    found = {control: value, "h": h, "n": spread(1e-3, 1e2), "m": random.choice([0, 0.1, 1], SIZE)}
    found |= {"Nbar": 1 / (h * spread(0.02, 100)) ** 2, "Ra": Ra, "sigma": 0.3 * Ra, "B": 0.5, "beta": 0.6}
    found |= {"micro": random.choice(["disc_cell", "square_lattice", "uniform_heights", "power_law"], SIZE)}
    found |= {"bonding": random.choice(["bonded", "frictionless"], SIZE), "rtol": 1e-3, "base": "layered"}
    return {name: np.broadcast_to(values, SIZE) for name, values in found.items()}


def beyond(given: dict, results: dict, times: float) -> np.ndarray:
    """(B,) bool: a limit of the model is exceeded so many times."""
    unknown = {"status": np.zeros(SIZE), "model_used": np.full(SIZE, np.nan), "model_error": np.full(SIZE, np.nan)}
    variables = {name: xr.Variable("case", values) for name, values in (given | results | unknown).items()}
    variables["model_used"].attrs = model_attributes()
    return validity_of(variables, times).values > 0


@pytest.mark.parametrize("control", ["P", "a", "D"])
def test_random_contacts(control):
    """None that exceeds no limit is said to be far outside. Of those that exceed one 50 times nine of ten are: under a
    given radius the pressure of a film of rubber is guessed far too low."""
    given = contacts(control)
    problem = Problem.of(**given)
    solution, guess = solve(problem), estimate(problem)
    results = {name: getattr(solution, name) for name in ("a", "D", "p0", "p_max", "A0")} | {"lam0": solution.lam[:, 0]}
    solved = solution.status == 0
    inside, outside = ~beyond(given, results, 1) & solved, beyond(given, results, 50) & solved
    said = np.any([*sentences._exceeded(given, PACKAGE).values()], axis=0)
    assert solved.mean() > 0.9 and inside.sum() > 20 and outside.sum() > 80
    assert not said[inside].any() and said[outside].mean() > 0.9
    if control == "P":
        ratio = guess["a"][solved] / solution.a[solved]
        assert ((ratio > 0.5) & (ratio < 2)).mean() > 0.97


def test_the_estimate_of_hertz_contacts():
    """Asperities so fine and dense that they do not yield: all is known but the depth, of which it is half, the height
    of the punch at r = a."""
    P, E = np.geomspace(1e-9, 1e-6, 4), np.array([1.0, 1.0, 2.0, 1e3])
    found = estimate(Problem.of(P=P, h=1e3, n=E, Nbar=1e18, Ra=1e-7))
    expected = hertz(P=P, E=E)
    for name, values in (("a", expected.a), ("D", expected.D / 2), ("p0", expected.p0)):
        np.testing.assert_allclose(found[name], values, rtol=0.01, err_msg=name)


def test_the_estimate_of_what_is_refused_is_unknown():
    given = {name: values[:2].copy() for name, values in contacts("P").items()}
    given["P"][0] = -1.0
    assert [np.isnan(values).tolist() for values in estimate(Problem.of(**given)).values()] == [[True, False]] * 6


def test_a_large_grid_is_looked_at_here_and_there(unsolved, monkeypatch):
    sizes = []
    real = sentences._exceeded
    monkeypatch.setattr(
        sentences, "_exceeded", lambda given, known: (sizes.append(len(given["micro"])), real(given, known))[1]
    )
    loads = [f"{load} N" for load in np.linspace(1, 5, 250)]
    assert len(said_before(**FILM | {"P": loads})) == 1 and said_before(**LINING | {"P": loads}) == []
    assert all(50 < size <= sentences.MOST for size in sizes) and len(sizes) == 2

"""base = "auto": never less accurate than asked, each case on the model it says, no case worse off than by name."""

from functools import cache

import numpy as np
import pytest
from conftest import ROOT
from scipy.integrate import quad
from solver_cases import JUDGED, difference

import study
from solver import Model, Problem, Status, solve
from solver.laws.disc_cell import contact_fraction, largest_pressure
from solver.models.auto import bounds
from solver.problem import far_apart
from study.inputs.grid import columns
from study.inputs.reading import read

EVERY = 29  # prime: meets all materials, n and h
CONTACT = {"h": 0.02, "n": 0.5, "Nbar": 250000.0, "Ra": 0.004}


@cache
def grid(name):
    """A thinned validity study (dict of columns) and its true solution: on the exact layer."""
    whole = read(ROOT / f"studies/evidence/{name}.toml").grid
    given = columns(whole, np.arange(whole.size))
    exact = np.flatnonzero(given["base"] == "layered")[::EVERY]
    given = {key: column[exact] for key, column in given.items()}
    return given, solve(Problem.of(**given))


def same(found, expected, index=slice(None), names=(*JUDGED, "A0", "dP_dD"), rtol=1e-9):
    for name in names:
        np.testing.assert_allclose(getattr(found, name)[index], getattr(expected, name)[index], rtol=rtol, err_msg=name)


@pytest.mark.parametrize("name", ["validity", "validity_load"])
@pytest.mark.parametrize("accuracy", [0.1, 0.03, 0.01, 1e-3])
def test_accuracy_is_kept_and_the_error_is_within_the_bound(name, accuracy):
    given, true = grid(name)
    found = solve(Problem.of(**given | {"base": "auto", "accuracy": accuracy}))
    assert (found.status == Status.CONVERGED).all() and (true.status == Status.CONVERGED).all()
    error = difference(found, true)
    close = (given["micro"] == "smooth") | ~far_apart(given["Nbar"], given["h"])
    assert found.model_error[close].max() <= accuracy
    assert (error <= found.model_error + 4e-6).all(), "to the errors of both solutions, rtol 1e-6"
    exact = found.model_error == 0
    assert close[exact].all(), "farther apart asperities on a half-space err"
    assert not exact.all()
    smooth = given["micro"] == "smooth"
    assert (found.model_used[exact] == np.where(smooth, Model.SMOOTH_LAYERED, Model.LAYERED)[exact]).all()


def test_accuracy_is_kept_at_given_depth():
    given, _ = grid("validity")
    given = {key: column for key, column in given.items() if key != "P"} | {"D": 1e-3}
    true = solve(Problem.of(**given))
    for accuracy in (0.1, 0.01):
        found = solve(Problem.of(**given | {"base": "auto", "accuracy": accuracy}))
        assert (found.status == 0).all() and difference(found, true).max() <= accuracy


@pytest.mark.parametrize("control", ["P", "a", "D"])
def test_accuracy_is_kept_for_any_roughness_and_hard_coatings(control):
    """Asperities from too fine to matter to dominant, layers 1000 times softer to 100 times harder than the body."""
    rng, size = np.random.default_rng(5), 150
    Ra, value = 10 ** rng.uniform(-6, -2, size), {"P": (-7, -3), "a": (-2, -1), "D": (-4, -2)}[control]
    given = {
        control: 10 ** rng.uniform(*value, size),
        "Ra": Ra,
        "Nbar": 10 ** rng.uniform(-1, 1, size) / Ra**2,
        "h": 10 ** rng.uniform(-3.5, 1, size),
        "n": 10 ** rng.uniform(-3, 2, size),
        "nu1": rng.uniform(0, 0.5, size),
        "bonding": rng.choice(["frictionless", "bonded"], size),
        "micro": rng.choice(["disc_cell", "power_law", "smooth"], size),
        "asperities_on": "half_space",
        "B": 0.3,
        "beta": 0.53,
    }
    true = solve(Problem.of(**given, base="layered"))
    for accuracy in (0.9, 0.1, 0.01):
        found = solve(Problem.of(**given, base="auto", accuracy=accuracy))
        known = (true.status == 0) & (true.error < 1e-5)
        assert (found.status[known] == 0).all()
        assert (difference(found, true) <= found.model_error + 1e-5)[known].all()
        close = known & ((given["micro"] != "disc_cell") | ~far_apart(given["Nbar"], given["h"]))
        assert len(np.unique(found.model_used)) > 4 and found.model_error[close].max() <= accuracy


@pytest.mark.parametrize(("control", "value"), [("a", 0.02), ("P", 1e-5), ("D", 4e-4)])
def test_accuracy_is_kept_where_asperities_yield_at_once(control, value):
    """A ~ p^β of β below 1/3: they touch in a wide ring around the smooth contact. A is 1e-6 to 1e-2 of a²."""
    beta, share = (v.ravel() for v in np.meshgrid([0.02, 0.05, 0.1, 0.2, 0.3], 10.0 ** np.arange(-6, -1)))
    Ra = share * 0.02**2 / (0.1 * 0.013**beta)
    case = {control: value, "h": 2e3, "n": 0.5, "micro": "power_law", "B": 0.1, "beta": beta, "Ra": Ra, "Nbar": Ra**-2}
    true, found = solve(Problem.of(**case)), solve(Problem.of(**case, base="auto", accuracy=0.3))
    known = (true.status == 0) & (found.model_used == Model.SMOOTH_LAYER_ALONE)
    assert known.sum() > 10
    assert (difference(found, true) <= found.model_error + true.error)[known].all()


def test_no_bound_above_a_third_is_trusted():
    """It is of first order: the exact layer is solved there, whatever `accuracy` is."""
    given = CONTACT | {"P": 1e-5, "h": np.geomspace(1e-3, 3.0, 40), "asperities_on": "half_space"}
    found = solve(Problem.of(**given, base="auto", accuracy=0.99))
    least = np.min(list(bounds(Problem.of(**given, base="auto")).values()), axis=0)
    assert ((least > 0.3) & (least < 0.99)).any(), "some that accuracy alone would allow"
    assert ((found.model_used == Model.LAYERED) == (least > 0.3)).all() and not (least > 0.3).all()


def test_every_model_is_used_and_named():
    given, _ = grid("validity")
    used = solve(Problem.of(**given | {"base": "auto", "accuracy": 0.1})).model_used
    stacks = {model for model in Model if "STACK" in model.name}
    assert set(used.tolist()) == set(Model) - {Model.NONE, Model.HALF_SPACE, Model.SMOOTH_HALF_SPACE} - stacks


def test_a_case_has_the_numbers_of_the_model_it_names():
    given, true = grid("validity")
    given = given | {"base": "auto", "accuracy": 0.1}
    found = solve(Problem.of(**given), [0.0, 0.5, 1.0])
    named = {Model.THIN_LAYER: "thin_layer", Model.LAYERED: "layered", Model.SMOOTH_LAYERED: "layered"}
    rough = given["micro"] != "smooth"
    for model, base in named.items():
        index = (found.model_used == model) & (rough == (model in (Model.THIN_LAYER, Model.LAYERED)))
        assert index.any()
        same(found, solve(Problem.of(**given | {"base": base})), index)
    alone = solve(Problem.of(**given | {"base": "half_space", "E2": given["n"]}))
    same(found, alone, found.model_used == np.where(rough, Model.LAYER_ALONE, Model.SMOOTH_LAYER_ALONE))
    assert found.p.shape == found.lam.shape == (len(true.a), 3)


@pytest.mark.parametrize("law", [{"micro": "disc_cell"}, {"micro": "power_law", "B": 0.1, "beta": 0.57}])
def test_asperities_of_a_smooth_solution(law):
    """Eqs (6), (11)-(13) of Hertz's pressure p(0) s, Ar/An against an adaptive rule."""
    P, Ra = 1e-4, 1e-6
    given = {"P": P, "Ra": Ra, "Nbar": 1 / Ra**2, "h": 10.0, "n": 0.9}
    found = solve(Problem.of(**given, **law, base="auto", accuracy=0.1), [0.0, 0.3, 0.99, 1.0])
    smooth = solve(Problem.of(**given, micro="smooth", base="half_space", E2=0.9))
    assert found.model_used == Model.SMOOTH_LAYER_ALONE and 0 < found.model_error < 0.1
    same(found, smooth, names=("a", "P", "D", "p0"))
    spots = given["n"], given["Nbar"], given["Ra"]
    np.testing.assert_allclose(found.lam, contact_fraction(found.p, *spots), rtol=1e-12)
    area = quad(lambda t: 6 * t**5 * contact_fraction(found.p0[0] * t**3, *spots), 0, 1, epsabs=1e-13, epsrel=1e-13)
    np.testing.assert_allclose(found.Ar_An, area[0], rtol=1e-9)
    np.testing.assert_allclose(found.p_max, largest_pressure(found.p0, *spots), rtol=1e-12)
    exact = solve(Problem.of(**given, **law, base="layered"))
    assert difference(found, exact) <= found.model_error
    np.testing.assert_allclose(found.A0, exact.A0, rtol=0.1)


def test_asked_for_by_name():
    bases = ["half_space", "thin_layer", "layered"]
    for micro, shift in (("disc_cell", 0), ("smooth", 1)):
        found = solve(Problem.of(P=1e-5, **CONTACT, base=bases, micro=micro))
        assert found.model_used.tolist() == [m + shift for m in (Model.HALF_SPACE, Model.THIN_LAYER, Model.LAYERED)]
        assert found.model_error[[0, 2]].tolist() == [0, 0] and 0.02 < found.model_error[1] < 1
    refused = solve(Problem.of(P=1e-5, **CONTACT, nu1=0.5, bonding="bonded", base="thin_layer"))
    assert refused.status == Status.THIN_LAYER_NOT_APPLICABLE and np.isnan(refused.model_error)


@pytest.mark.parametrize("name", ["validity", "validity_load"])
def test_model_error_of_a_named_thin_layer(name):
    """Of first order it is right below 0.3, free of cost it is right to a factor; smooth, as its docstring says."""
    given, true = grid(name)
    for check, micro, low, high in (
        ("first_order", "smooth", 0.85, 1.7),
        ("first_order", "disc_cell", 0.75, 1.7),
        ("closed_form", "smooth", 0.24, 4.6),
    ):
        found = solve(Problem.of(**given | {"base": "thin_layer", "model_check": check}))
        error = difference(found, true)
        chosen = (given["micro"] == micro) & (found.status == 0) & (error > 1e-3) & (error < 0.3)
        assert chosen.sum() > 20
        ratio = found.model_error[chosen] / error[chosen]
        assert low < ratio.min() and ratio.max() < high, (check, micro, ratio.min(), ratio.max())
        same(found, solve(Problem.of(**given | {"base": "thin_layer"})))


def test_any_units():
    given = {"P": [1e-5, 1e-4], "n": 0.5, "base": "auto", "accuracy": 0.1}
    one = solve(Problem.of(**given, h=[1e-4, 0.02], Nbar=250000, Ra=0.004))
    R, E2 = 0.03, 7e10
    physical = given | {"P": np.array(given["P"]) * E2 * R**2, "h": np.array([1e-4, 0.02]) * R}
    two = solve(Problem.of(**physical, Nbar=250000 / R**2, Ra=0.004 * R, R=R, E2=E2))
    assert one.model_used.tolist() == two.model_used.tolist()
    np.testing.assert_allclose(two.a / R, one.a, rtol=1e-9)
    np.testing.assert_allclose(two.p_max / E2, one.p_max, rtol=1e-9)
    np.testing.assert_allclose(two.model_error, one.model_error, rtol=1e-6)


def test_neighbours_and_order_do_not_matter():
    given, _ = grid("validity")
    given = given | {"base": "auto", "accuracy": 0.03}
    whole = solve(Problem.of(**given))
    order = np.random.default_rng(1).permutation(len(whole.a))[:40]
    part = solve(Problem.of(**{key: np.asarray(v)[order] if np.ndim(v) else v for key, v in given.items()}))
    assert part.model_used.tolist() == whole.model_used[order].tolist()
    np.testing.assert_allclose(part.a, whole.a[order], rtol=1e-9)


def test_a_cheap_model_that_fails_costs_no_result():
    """A scheme that fails on them, no thin layer, a poisoned case."""
    given = CONTACT | {"P": 1e-5, "scheme": "picard", "k": 1.0, "max_iterations": 12, "accuracy": 0.1, "h": 2e-3}
    tried = solve(Problem.of(**given, base=["auto", "layered"]))
    assert tried.status[0] == tried.status[1] != 0 and tried.model_used.tolist() == [Model.LAYERED] * 2
    solved = solve(Problem.of(**given | {"scheme": "newton", "max_iterations": 0}, base="auto"))
    assert solved.status == 0 and solved.model_used == Model.THIN_LAYER
    rubber = solve(Problem.of(**CONTACT, P=1e-5, nu1=0.5, bonding="bonded", base="auto", accuracy=0.1))
    assert rubber.status == 0 and rubber.model_used == Model.LAYERED
    poisoned = solve(Problem.of(P=[1e-5, np.nan, 1e-5], **CONTACT, base="auto", accuracy=[0.1, 0.1, 1.0]))
    assert poisoned.status.tolist() == [Status.CONVERGED, Status.INVALID_INPUT, Status.INVALID_INPUT]
    assert poisoned.model_used[1:].tolist() == [Model.NONE] * 2


@pytest.mark.parametrize("control", [{"P": 1e-5}, {"a": 0.02}], ids=str)
def test_both_estimates_agree_on_thin_films_where_the_closed_form_is_exact(control):
    given = control | {"h": [1e-5, 3e-5, 1e-4], "n": 0.1, "micro": "smooth", "base": "thin_layer"}
    free, dear = (solve(Problem.of(**given, model_check=check)) for check in ("closed_form", "first_order"))
    np.testing.assert_allclose(dear.model_error, free.model_error, rtol=0.01)
    auto_film = solve(Problem.of(**given | {"base": "auto", "accuracy": 0.05}))
    assert (auto_film.status == 0).all() and (auto_film.model_used != Model.SMOOTH_LAYERED).all()


def test_in_a_study():
    given = {"P": 1e-5, "Nbar": 250000, "Ra": 0.004, "h": [2e-3, 0.02, 2.0], "n": 0.5}
    found = study.solve(**given, base="auto", accuracy=[0.1, 1e-3], x=3)
    assert (found.model_error <= found.accuracy).all() and found.accuracy.dims == ("accuracy",)
    names = dict(zip(found.model_used.flag_values.tolist(), found.model_used.flag_meanings.split(), strict=True))
    assert names[int(found.model_used.sel(h=0.02, accuracy=1e-3))] == "layered"
    for wrong in (0.0, 1.0):
        with pytest.raises(study.StudyError, match=r"accuracy = .*: must be in \(0, 1\)"):
            study.solve(**given, base="auto", accuracy=wrong)
    with pytest.raises(study.StudyError, match='model_check = "dear": must be one of "closed_form", "first_order"'):
        study.solve(**given, base="thin_layer", model_check="dear")

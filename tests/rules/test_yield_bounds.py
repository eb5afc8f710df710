"""Bounds of stresses beside the search, and the masks 512 and 1024 of strengths that are known."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from solver import Problem, solve
from solver.laws import LAWS
from solver.yields import spots
from solver.yields.contact import of_contacts
from study.arrays.labelled import Labelled
from study.data.contacts import Contacts
from study.data.dataset import model_attributes
from study.rules import strength, yield_bounds
from study.rules.rule import numbers

pytestmark = pytest.mark.filterwarnings("ignore:this contact is beyond")
STEEL = "steel 52100"
BALL = {"R": "10 mm", "punch": STEEL, "x": 2}


def variables(problem, solution):
    """The numbers of contacts as rules have them."""
    arrays = dict(problem.parameters)
    arrays |= {name: getattr(solution, name) for name in ("P", "a", "D", "p0", "p_max", "A0", "status", "model_used")}
    arrays |= {"lam0": solution.lam[:, 0], "model_error": solution.model_error}
    labelled = {name: Labelled("case", np.asarray(values)) for name, values in arrays.items()}
    labelled["model_used"].attrs = model_attributes()
    return numbers(labelled)


def random_contacts(seed, count):
    """Far beyond real ones: layers of nearly any thickness and stiffness, and bare bodies, smooth and rough."""
    rng = np.random.default_rng(seed)
    a, n, nu = 10 ** rng.uniform(-4, -0.7, count), 10 ** rng.uniform(-3, 3, count), [0, 0.2, 0.3, 0.45, 0.5]
    words = {name: rng.choice(several, count) for name, several in {
        "micro": ["smooth", "disc_cell", "hex_lattice"], "bonding": ["bonded", "frictionless"],
        "base": ["layered", "layered", "half_space"], "nu1": nu, "nu2": nu, "m": [0.0, 1.0, 10.0],
    }.items()}  # fmt: skip
    Nbar, Ra = 10 ** rng.uniform(0, 4, count) / (np.pi * a**2), a * 10 ** rng.uniform(-2, 2, count)
    problem = Problem.of(a=a, h=a * 10 ** rng.uniform(-0.7, 1.5, count), n=n, Nbar=Nbar, Ra=Ra, **words)
    return problem, solve(problem, [0.0, 1.0])


def test_stresses_are_within_their_bounds():
    problem, solution = random_contacts(7, 12)
    v, names = variables(problem, solution), ("mises1", "mises2")
    searched, bounds = of_contacts(problem, solution, names=names, coarse=True), yield_bounds.of_bodies(v)
    for name in names:
        stress, known = searched[name][0], np.isfinite(searched[name][0])
        low, high = (np.broadcast_to(bound, stress.shape) for bound in bounds[name])
        assert known.sum() > 3 and (low[known] <= stress[known] * 1.12).all(), "coarse"
        assert (stress[known] <= high[known] * (1 + 1e-8)).all()
        assert (high[known] < 50 * stress[known]).sum() > known.sum() / 3, "of use"
    stress, alone = spots.of_contacts(problem, solution)[0], yield_bounds.one_asperity(v)
    known = np.isfinite(stress)
    stress = np.minimum(stress, alone)[known]
    low, high = (bound[known] for bound in yield_bounds.of_asperities(v))
    assert len(stress) > 4 and (low <= stress).all() and (stress <= high).all()
    assert (low > 0).sum() > len(stress) / 4 and np.isfinite(high).sum() > len(stress) / 2, "of use"


def test_on_a_bare_body_under_a_ball_the_bound_is_the_stress():
    problem = Problem.of(P=[1e-6, 1e-5, 1e-4], base="half_space", nu2=[0.0, 0.3, 0.5], micro="smooth")
    solution = solve(problem)
    low, high = yield_bounds.of_bodies(variables(problem, solution))["mises2"]
    stress = of_contacts(problem, solution, names=("mises2",))["mises2"][0]
    assert_allclose([low, high], [stress, stress], rtol=1e-8)


def test_where_bounds_decide_nothing_is_searched_for(monkeypatch):
    """A ball on steel, and asperities far from yield and far beyond."""
    monkeypatch.setattr(strength, "solve", None)
    smooth = study.solve(**BALL, body=STEEL, base="half_space", P=["1 N", "5 kN"], micro="smooth")
    assert (smooth.validity.values & 512 > 0).tolist() == [False, True]
    coated = {"layer": "DLC a-C:H", "h": "5 um", "bonding": "bonded", "body": STEEL}
    assert not study.solve(**BALL, **coated, P="10 N", micro="smooth").validity & 512
    rough = {"body": "PMMA", "base": "half_space", "Nbar": "0.1 1/um^2", "Ra": "5 um"}
    assert (study.solve(**BALL, **rough, P=["1e-7 uN", "1 N"]).validity.values & 1024 > 0).tolist() == [False, True]


@pytest.mark.parametrize("cases", [1, 3], ids=["alone", "several"])
def test_a_named_material_that_flows_has_the_mask(cases):
    """PMMA, 1 µm on glass: by its own strength, 63 MPa, and by one beside it."""
    film = {"R": "10 um", "punch": "rigid", "layer": "PMMA", "h": "1 um", "bonding": "bonded"}
    film |= {
        "body": "glass soda-lime",
        "micro": "smooth",
        "x": 2,
        "P": "1 mN" if cases == 1 else ["1 nN", "30 uN", "1 mN"],
    }
    contact = study.solve(**film)
    stress = study.extremes(contact).mises1.values
    assert_allclose(np.ravel(contact.validity.values & 512 > 0), np.ravel(stress > 63e6))
    assert contact.validity.attrs["strength_from"] == "layer: material, body: hardness"
    assert not study.solve(**film, Y1="2 GPa").validity.values.ravel()[-1] & 512, "what is given in the call goes first"
    assert "The layer yields" in study.summary(contact.isel(P=-1) if cases > 1 else contact)
    kept = contact.where(contact.validity == 0)
    assert np.isnan(np.ravel(kept.a.values)[-1]) and not np.ravel(study.feasible(contact, validity=0).values)[-1]


@pytest.mark.parametrize(
    ("given", "source"),
    [({}, "hardness"), ({"body": "steel 316L"}, "material"), ({"Y2": "1 GPa"}, "call"), ({"body": "copper"}, None)],
)
def test_where_a_strength_is_from(given, source):
    contact = study.solve(**{"body": STEEL} | BALL | given, base="half_space", micro="smooth", P="1 N")
    assert contact.validity.attrs.get("strength_from") == source


def test_a_material_of_ones_own_has_its_strength_in_the_words_too():
    mine = dataclasses.replace(study.materials.get("PMMA"), name="mine", yield_strength=1e5, yield_strength_spread=1e4)
    contact = study.solve(**BALL, body=mine, base="half_space", micro="smooth", P="1 mN")
    assert contact.validity.item() == 512 and contact.validity.attrs["strength_from"] == "material"
    assert "the yield strength, 100 ± 10 kPa" in study.summary(contact)


def test_asperities_have_the_strength_of_the_softer_surface():
    """From the hardness of 52100 over 2.84; an elastic-plastic law says it by its share."""
    rough = {"base": "half_space", "Nbar": "1 1/um^2", "Ra": "5 um", "P": "2 N"}
    for body, punch in (("PMMA", STEEL), (STEEL, "PMMA")):
        contact = study.solve(R="10 mm", punch=punch, body=body, x=2, **rough)
        assert (
            contact.validity.item() & 1024
            and "asperities: material" in contact.validity.attrs["strength_from"] + "asperities: material"
        )
    flows = study.solve(R="10 mm", punch="copper", body="PMMA", x=2, **rough)
    assert flows.validity.item() & 1024, "the softer of both is no harder than the one that is known"
    stress = spot_stress(contact := study.solve(**BALL, body=STEEL, **rough))
    for share in (0.999, 1.001):
        mine = dataclasses.replace(study.materials.get(STEEL), name="mine", hardness=share * 2.84 * stress)
        flags = study.solve(R="10 mm", punch=mine, body=STEEL, x=2, **rough).validity.item()
        assert bool(flags & 1024) == (share < 1)
    assert not study.solve(**BALL, body="PMMA", micro="elastic_plastic", hardness="200 MPa", **rough).validity & 1024
    assert contact.validity.attrs["strength_from"] == "hardness"


def spot_stress(contact):
    """In Pa, of one rough contact in SI units."""
    contact = Contacts.of(contact, "test")
    return (spots.of_contacts(contact.problem, solve(contact.problem))[0] * contact.units[0]).item()


@pytest.mark.parametrize(
    "micro", [name for name, law in LAWS.items() if law.rough and not law.yielded and "Ra" in law.parameters]
)
def test_the_mask_of_asperities_has_its_right_value(micro):
    """By Hertz: separate asperities on a bare body yield where their pressure p0s is q Y."""
    case = {"a": 0.005, "base": "half_space", "Nbar": 1e6, "Ra": 0.001, "micro": micro, "x": 2}
    case |= {"sigma": 1e-9} if "heights" in micro else {}
    contact = study.solve(**case, rtol=1e-5)
    p0s = contact.p_max - 2 / np.pi * contact.p0 * np.arcsin(np.sqrt(contact.lam0))
    assert contact.lam0 < 0.3
    for share, flag in ((0.8, True), (1.25, False)):
        Y = share * float(p0s) / 1.612797
        assert bool(study.solve(**case, rtol=1e-5, yield_strength=Y).validity.item() & 1024) == flag

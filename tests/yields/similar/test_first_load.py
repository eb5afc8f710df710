"""First yield by the tables of a pair of bodies, beside steps from contact to contact."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem
from solver.numerics.caches import Cache
from solver.yields import first, protect
from solver.yields.crossing import NUMBERS, Crossing
from solver.yields.similar import stress_table, unit_contacts
from solver.yields.similar.first_load import put_first_loads
from solver.yields.similar.unit_contacts import Sought

FILM = {"n": 2.0, "nu1": 0.25, "nu2": 0.3, "m": 0.6, "bonding": "bonded", "micro": "smooth"}


@pytest.fixture
def fresh(monkeypatch):
    """No table is kept yet."""
    monkeypatch.setattr(stress_table, "_cache", Cache(2_000_000))


def by_steps(monkeypatch):
    for module in (first, protect):
        monkeypatch.setattr(module, "are_similar", lambda problem, _: np.zeros(len(problem), dtype=bool))


def same_crossings(one, other):
    assert one.crossed.tolist() == other.crossed.tolist() and one.unsolved.tolist() == other.unsolved.tolist()
    for name in NUMBERS:  # a depth hardly follows from the stress where films bend
        assert_allclose(one.numbers[name], other.numbers[name], rtol=2e-6, err_msg=name)
    assert_allclose([one.r, one.z], [other.r, other.z], rtol=0, atol=2e-3)


@pytest.mark.parametrize(("body", "mu"), [("layer", 0.0), ("body", 0.3), ("punch", 0.0)])
def test_tables_have_the_crossing_of_single_steps(fresh, monkeypatch, body, mu):
    """One layer is thin, one as thick as the contact, one 40 times; the last does not yield."""
    own = FILM | {"h": np.array([0.005, 0.05, 1.5, 0.05]), "n": np.array([5.0, 0.3, 2.0, 2.0])}
    problem, strength = Problem.of(P=1.0, **own), np.array([0.01, 0.003, 0.004, 5.0])
    strength = strength * (1e-3 if body == "body" else 1.0) ** np.array([0, 0, 1, 0])
    by_tables = first.first_yield(problem, body, strength, mu, punch=np.full(4, 0.2))
    by_steps(monkeypatch)
    same_crossings(by_tables, first.first_yield(problem, body, strength, mu, punch=np.full(4, 0.2)))
    assert by_tables.crossed.tolist() == [True, True, True, False]


def test_thicknesses_that_protect_are_those_of_single_steps(fresh, monkeypatch):
    problem, strength = Problem.of(P=1e-5, **FILM | {"h": 1.0, "n": np.array([0.2, 10.0])}), np.array([0.005, 0.0095])
    by_tables = protect.protection(problem, strength, 0.2)
    by_steps(monkeypatch)
    for one, other in zip(by_tables, protect.protection(problem, strength, 0.2), strict=True):
        assert_allclose(one, other, rtol=2e-6)


def test_a_pair_of_bodies_needs_one_contact_more_for_each_strength(fresh, monkeypatch):
    """Once its tables are kept: the polynomial through four of their nodes is that close, except where the place of the
    stress jumps between them. The third film yields at its interface (z = h = 0.986 a), the others at z = 0.47 a and
    0.48 a: it takes the secant method three contacts more. Values do not depend on what is kept, nor on the company."""
    strengths, counts = np.array([0.004, 0.006, 0.009]), []
    problem = Problem.of(P=1.0, **FILM | {"h": np.full(3, 0.02)})
    together = first.first_yield(problem, "layer", strengths)
    inner = unit_contacts.unit_contacts

    def counted(scaled, t, sought=None, punch=None, coarse=False):
        counts.append(len(t) * (sought is not None))
        return inner(scaled, t, sought, punch, coarse)

    monkeypatch.setattr(stress_table, "unit_contacts", counted)
    again = first.first_yield(problem, "layer", strengths)
    assert counts[0] == 3 and counts[1:] == [1] * (len(counts) - 1) and len(counts) <= 4
    assert_allclose(again.z * again.numbers["a"], [0.00386, 0.00627, 0.02], rtol=2e-3)
    monkeypatch.setattr(stress_table, "_cache", Cache(2_000_000))
    alone = first.first_yield(problem.take([1]), "layer", strengths[1:2])
    for name in NUMBERS:
        assert_allclose(again.numbers[name], together.numbers[name], rtol=1e-10)
        assert_allclose(alone.numbers[name], together.numbers[name][1], rtol=1e-10)


def test_what_yields_before_the_first_node_is_unsolved(fresh):
    """A start beyond the crossing, as of a search that must not say that it is the first."""
    problem, made = Problem.of(P=1.0, **FILM | {"h": 0.05}), Crossing.none(1)
    reach = np.array([0.15]), np.array([0.2])
    put_first_loads(made, problem, np.arange(1), np.array([1e-4]), (Sought("layer", 0.0), None, False), reach)
    assert not made.crossed[0] and made.unsolved[0] and np.isnan(made.numbers["P"][0])

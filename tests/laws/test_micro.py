"""Micro laws: against 50-digit references, against the paper's equations as written, inverse pairs, limits."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solver.laws import LAWS
from solver.laws import disc_cell as micro
from solver.laws.law import inverse

TABLE = np.genfromtxt(Path(__file__).parents[1] / "references" / "micro_reference.csv", delimiter=",", names=True)


def test_table_spans_isolated_spots_to_full_contact():
    assert_allclose(TABLE["lam"][[0, -1]], [1e-12, 1 - 1e-12], rtol=1e-14, atol=0)


def test_an_inverse_that_is_not_found_is_nan():
    """Of a value that stays below its target, beside some that are found."""
    target = np.array([0.5, 2.0, np.nan, 0.0, 1e-9])
    with np.errstate(all="ignore"):  # as in the solver
        found = inverse(lambda y: (y / (1 + y), 1 / (1 + y) ** 2), target, np.ones(5))
    assert_allclose(found, [1.0, np.nan, np.nan, 0.0, 1e-9], rtol=1e-8)


@pytest.mark.parametrize("name", ["q", "g", "dq", "dg"])
def test_curve_against_reference(name):
    assert_allclose(getattr(micro.spot_curve(TABLE["y"]), name), TABLE[name], rtol=1e-14, atol=0)


def test_pressure_to_spot():
    assert_allclose(micro.spot_from_pressure(TABLE["q"]), TABLE["y"], rtol=1e-14, atol=0)


def test_displacement_to_spot_where_well_conditioned():
    """dln y/dln g grows towards full contact, where g saturates: the inverse is as good as its condition allows."""
    condition = TABLE["g"] / (TABLE["y"] * TABLE["dg"])
    error = np.abs(micro.spot_from_displacement(TABLE["g"]) / TABLE["y"] - 1)
    assert np.all(error < 1e-14 * np.maximum(condition, 1))
    assert condition.min() < 0.51  # g ~ y² for isolated spots
    assert condition.max() > 1e6


def test_physical_functions_against_reference():
    """A, λ and pmax at a given pressure, E1*, Nbar and Ra of a physical scene."""
    E, Nbar, Ra = 0.7, 1.3e5, 3e-3
    p_star, A_star = micro.scales(E, Nbar, Ra)
    p = p_star * TABLE["q"]
    assert_allclose(micro.displacement(p, E, Nbar, Ra), A_star * TABLE["g"], rtol=1e-13, atol=0)
    assert_allclose(micro.contact_fraction(p, E, Nbar, Ra), TABLE["lam"], rtol=1e-13, atol=0)
    assert_allclose(micro.largest_pressure(p, E, Nbar, Ra), p_star * TABLE["p_max"], rtol=1e-13, atol=0)


def test_equations_as_the_paper_writes_them():
    """(7), (6), (11), (13) with b and B̄; arccos costs digits near full contact, so λ stays below 0.999 here."""
    rng = np.random.default_rng(2)
    E, Ra, Nbar_Ra2 = (np.exp(rng.uniform(*np.log(r), 4000)) for r in ((1e-2, 1e3), (1e-6, 1), (1e-3, 1e3)))
    Nbar, p = Nbar_Ra2 / Ra**2, E * np.exp(rng.uniform(np.log(1e-9), np.log(10), 4000))
    keep = micro.contact_fraction(p, E, Nbar, Ra) < 0.999
    assert keep.sum() > 2000
    E, Ra, Nbar, p = (v[keep] for v in (E, Ra, Nbar, p))
    cell = 1 / np.sqrt(np.pi * Nbar)
    b = np.sqrt(micro.contact_fraction(p, E, Nbar, Ra) / (np.pi * Nbar))  # (11)
    gap = np.sqrt((cell - b) * (cell + b))
    assert_allclose(p * (cell**2 * np.arccos(b / cell) + b * gap), 2 * E * b**3 / (3 * Ra), rtol=3e-12, atol=0)
    assert_allclose(micro.displacement(p, E, Nbar, Ra), b**2 / Ra - 2 * p / E * gap, rtol=3e-12, atol=0)
    p_max = 2 * E * b / (np.pi * Ra) + 2 * p / np.pi * np.arcsin(b / cell)
    assert_allclose(micro.largest_pressure(p, E, Nbar, Ra), p_max, rtol=1e-12, atol=0)


def test_isolated_spots_are_hertz_contacts():
    """P1 = p/Nbar on one asperity: b³ = 3 P1 Ra/(4 E), A = b²/Ra, pmax = 2 E b/(pi Ra); the rest vanishes as b/B̄."""
    E, Nbar, Ra, p = 2.0, 1e4, 1e-3, 1e-16
    b = np.cbrt(3 * p / Nbar * Ra / (4 * E))
    assert_allclose(micro.displacement(p, E, Nbar, Ra), b**2 / Ra, rtol=1e-5, atol=0)
    assert_allclose(micro.contact_fraction(p, E, Nbar, Ra), np.pi * Nbar * b**2, rtol=1e-5, atol=0)
    assert_allclose(micro.largest_pressure(p, E, Nbar, Ra), 2 * E * b / (np.pi * Ra), rtol=1e-5, atol=0)


def test_full_contact():
    """A → B̄²/(3 Ra), λ → 1, and pmax - p → what it takes to flatten the asperity (2 E B̄/(pi Ra) × 1)."""
    E, Nbar, Ra = 1.0, 1e4, 1e-3
    cell, p = 1 / np.sqrt(np.pi * Nbar), 1e8
    assert_allclose(micro.displacement(p, E, Nbar, Ra), cell**2 / (3 * Ra), rtol=1e-12, atol=0)
    assert_allclose(micro.contact_fraction(p, E, Nbar, Ra), 1, rtol=1e-14, atol=0)
    assert_allclose(micro.largest_pressure(p, E, Nbar, Ra) / p, 1, rtol=1e-6, atol=0)


@pytest.mark.parametrize("function", [micro.displacement, micro.contact_fraction, micro.largest_pressure])
def test_monotone_and_zero_at_no_pressure(function):
    p = np.concatenate([[0.0], np.geomspace(1e-15, 1, 500)])
    values = function(p, 1.0, 250000.0, 0.004)
    assert values[0] == 0
    assert np.all(np.diff(values) > 0)


def test_scaling():
    """A/Ra, λ and pmax/E1* depend on p/E1* and Nbar Ra² only."""
    p = np.geomspace(1e-6, 1e-1, 9)
    for name, unit in (("displacement", (1, 0)), ("contact_fraction", (0, 0)), ("largest_pressure", (0, 1))):
        function = getattr(micro, name)
        scaled = function(2e11 * p, 2e11, 4.0 / 1e-6**2, 1e-6) / 1e-6 ** unit[0] / 2e11 ** unit[1]
        assert_allclose(scaled, function(p, 1.0, 4.0, 1.0), rtol=1e-13, atol=0)


@pytest.mark.parametrize("plain", [False, True], ids=["own_inverses", "inverses_of_any_law"])
@pytest.mark.parametrize("name", ["disc_cell", "power_law"])
def test_law_derivatives_and_inverses(name, plain):
    """Of the law as it is; and with the inverses that any law has, which does not bring its own."""
    none = dict.fromkeys(("from_pressure", "from_displacement", "guess"))
    law = replace(LAWS[name], **none) if plain else LAWS[name]
    law = law.bind(np.array([0.5]), Nbar=np.array([250000.0]), Ra=0.004, B=0.1, beta=np.array([0.53]))
    y = np.geomspace(1e-3, 30, 40)[None, :]
    step = 1e-5 * y
    below, at, above = (law.evaluate(v) for v in (y - step, y, y + step))
    assert_allclose((above.q - below.q) / (2 * step), at.dq, rtol=1e-8, atol=0)
    assert_allclose((above.g - below.g) / (2 * step), at.dg, rtol=2e-8, atol=0)
    assert_allclose(law.from_pressure(at.q), y, rtol=1e-13, atol=0)
    assert_allclose(law.from_displacement(at.g), y, rtol=1e-11, atol=0)
    assert_allclose(law.guess(at.q), y, rtol=0.4, atol=0)
    gamma, beta = law.edge()
    small = law.evaluate(np.array([[1e-7]]))
    assert_allclose(gamma * small.q[0] ** beta, small.g[0], rtol=1e-6, atol=0)
    assert_allclose(law.sparse(small.g), small.q, rtol=1e-6, atol=0)
    if name == "disc_cell":
        with np.errstate(all="ignore"):  # as in the solver
            assert np.isnan(law.from_displacement(np.array([[0.34, 1.0]]))).all()
    if plain or name == "disc_cell":
        assert_array_equal(law.from_pressure(np.array([[0.0, -1.0, np.nan]])), [[0, 0, np.nan]])


def test_outside_the_law():
    assert_array_equal(micro.spot_from_pressure([0.0, -1.0, np.nan]), [0, 0, np.nan])
    assert_array_equal(micro.spot_from_displacement([0.0, -1.0, 1 / 3, 1.0, np.nan]), [0, 0, np.nan, np.nan, np.nan])
    assert_allclose(
        micro.spot_from_pressure([1e-290, 1e140]), [(np.pi / 2 * 1e-290) ** (1 / 3), 2e140], rtol=1e-12, atol=0
    )

"""Lattices of asperities: the table and the curves through it, their ends, and contacts that have these laws."""

import csv

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from solver_cases import LOAD, difference, random_cases
from test_micro_lattice import lattice

import study
from solver import Problem, solve
from solver.laws import LAWS
from solver.laws.disc_cell import displacement
from solver.laws.lattice import ENDS, ERROR, FILE, read

NAMES = ("square", "hex")
BOTH = pytest.mark.parametrize("name", NAMES)
#: Sum of 1/R over the lattice less its integral, over -π: 3.900265/π of the square lattice, 3.921034/π of the other.
SUMS = {"square": 1.2414929, "hex": 1.2481031}
#: Largest relative difference between A, λ, p_max of the table and of the polynomials.
FITTED = (8e-6, 4e-5, 2e-6)


def at(name, p, Nbar=1.0):
    """A, λ, p_max at the mean pressure p, E = Ra = 1."""
    return LAWS[f"{name}_lattice"].at(p, 1.0, Nbar=Nbar, Ra=1.0)


def curve(name, y):
    with np.errstate(all="ignore"):  # as in the solver
        return LAWS[f"{name}_lattice"].curve(y)


@BOTH
def test_against_conjugate_gradients_on_a_coarse_grid(name):
    """Of 96 points a cell: A errs little there, p_max is half a mesh beside the summit, λ counts points."""
    for p in (0.003, 0.03, 0.1, 0.3, 0.6):
        A, lam, p_max = lattice(p, name == "hex")
        found = at(name, p, 2 / np.sqrt(3) if name == "hex" else 1.0)
        assert_allclose(found.A, A, rtol=5e-4, atol=0)
        assert_allclose(found.p_max, p_max, rtol=2e-3, atol=0)
        assert_allclose(found.lam, lam, rtol=0.03, atol=0)


@BOTH
def test_the_curves_go_through_the_table(name):
    p, *values = read(name)
    assert len(p) == 41 and p[0] < 1e-8 and p[-1] > 0.6
    for found, value, most in zip(at(name, p), values, FITTED, strict=True):
        assert_allclose(found, value, rtol=most, atol=0)


@BOTH
def test_the_table_is_as_accurate_as_it_says(name):
    """Its changes from a grid of half the points, with what the polynomials add, are within the error of the law."""
    with FILE.open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["lattice"] == name]
    A, lam, p_max = ([float(row[f"{key}_change"]) for row in rows] for key in ("A", "lam", "p_max"))
    assert max(A) < 3e-6 and max(p_max) < 3e-6 and max(lam) < 1.6e-4
    assert max(lam) + FITTED[1] < ERROR


@BOTH
def test_isolated_spots(name):
    """Hertz, less the field of the others: A = (9 p²/16)^(1/3) - c p, λ = π b², p_max = 2 b/π, b = (3 p/4)^(1/3)."""
    p = np.array([1e-12, 1e-9, 1e-6])
    found, b = at(name, p), np.cbrt(0.75 * p)
    assert_allclose(found.A, b**2 - SUMS[name] * p, rtol=2e-6, atol=0)
    assert_allclose(found.lam, np.pi * b**2, rtol=1e-5, atol=0)
    assert_allclose(found.p_max, 2 * b / np.pi, rtol=1e-5, atol=0)
    c = (b**2 - found.A) / p
    assert_allclose(c[1:], SUMS[name], rtol=0.02, atol=0)


@BOTH
def test_full_contact(name):
    """The mean relief: 1/12 and 0.0802; and p_max - p of a relief that is flattened."""
    found = at(name, np.array([1.0, 3.0, 1e3]))
    relief = {"square": 1 / 12, "hex": 0.08018754}[name]
    assert_allclose(found.A, relief, rtol=1e-4, atol=0)
    assert_allclose(found.A[1:], relief, rtol=1e-7, atol=0)
    assert_allclose(found.p_max[1:] - [3.0, 1e3], ENDS[name]["above"], rtol=1e-10, atol=0)
    assert_allclose(found.lam[1:], 1, rtol=0, atol=1e-6)
    assert (found.lam <= 1).all()


def test_how_much_the_disc_cell_overestimates():
    """2 % at λ = 0.04, 5 % at 0.17, 10 % at 0.4, 24 % and 29 % near full contact on the two lattices."""
    p = np.geomspace(1e-3, 3, 400)
    for name, ends in (("square", (0.24, 0.29)), ("hex", (0.29, 0.34))):
        found = at(name, p)
        error = displacement(p, 1.0, 1.0, 1.0) / found.A - 1
        assert_allclose(np.interp([0.04, 0.17, 0.4], found.lam, error), [0.02, 0.05, 0.105], rtol=0, atol=0.008)
        assert ends[0] < error[-1] < ends[1]


@BOTH
def test_curves_rise_and_are_smooth(name):
    """As far as A grows in float64; the derivatives are those of the curves."""
    y = np.geomspace(1e-9, 20, 4000)
    law, found = LAWS[f"{name}_lattice"], curve(name, y)
    assert (found.dq > 0).all() and (found.dg > 0).all()
    for rising in (found.q, found.g[y < 6], law.area(y, found.q)[y < 6], law.peak(y, found.q)):
        assert (np.diff(rising) > 0).all()
    step = 1e-5 * y
    below, above = curve(name, y - step), curve(name, y + step)
    assert_allclose((above.q - below.q) / (2 * step), found.dq, rtol=1e-8, atol=0)
    assert_allclose((above.g - below.g) / (2 * step), found.dg, rtol=1e-8, atol=1e-9)
    beyond = curve(name, np.array([1e2, 1e5, 1e12]))
    assert_array_equal(beyond.g, LAWS[f"{name}_lattice"].curve.args[0].A.limit)
    assert (beyond.dg >= 0).all()


@BOTH
def test_inverses(name):
    law = LAWS[f"{name}_lattice"].bind(np.ones(1), Nbar=np.ones(1), Ra=np.ones(1))
    y = np.geomspace(1e-6, 4, 60)[None, :]
    found = law.evaluate(y)
    assert_allclose(law.from_pressure(found.q), y, rtol=1e-14, atol=0)
    assert_allclose(law.from_displacement(found.g), y, rtol=1e-11, atol=0)
    with np.errstate(all="ignore"):
        assert_array_equal(law.from_pressure(np.array([[0.0, -1.0, np.nan]])), [[0, 0, np.nan]])
        assert_array_equal(law.from_displacement(np.array([[0.0, -1.0, 0.27, np.nan]])), [[0, 0, np.nan, np.nan]])
        assert_allclose(law.from_pressure(np.array([[1e-290, 1e140]])), [[1e-290 ** (1 / 3), 1e140]], rtol=1e-12)
    gamma, beta = law.edge()
    small = law.evaluate(np.array([[1e-7]]))
    assert_allclose(gamma * small.q[0] ** beta, small.g[0], rtol=1e-6, atol=0)


@pytest.fixture(scope="module")
def cases():
    """Random cases with P, a or D given: keyword arguments of ``Problem.of``, base -> a list of three."""

    def of(base):
        case = random_cases(24, 17) | {"base": base}
        P = case.pop("P")
        found = solve(Problem.of(P=P, micro="disc_cell", **case, rtol=1e-4))
        return [case | {"P": P}, case | {"a": found.a}, case | {"D": found.D}]

    return {base: of(base) for base in ("half_space", "thin_layer", "layered")}


@pytest.mark.parametrize(
    ("base", "name"), [("half_space", "square"), ("thin_layer", "hex"), ("layered", "square"), ("half_space", "hex")]
)
def test_accuracy(base, name, cases):
    """Every case converges, the truth (on 96 nodes) is within the error, and that within rtol; in as many steps, on as
    many nodes as with the disc cell."""
    for case in cases[base]:
        fine = solve(Problem.of(**case, micro=f"{name}_lattice", nodes=96, rtol=1e-10))
        for rtol in (1e-6, 1e-9):
            found = solve(Problem.of(**case, micro=f"{name}_lattice", rtol=rtol))
            disc = solve(Problem.of(**case, micro="disc_cell", rtol=rtol))
            assert (found.status == 0).all() and (found.error <= rtol).all()
            assert (difference(found, fine) <= np.maximum(found.error, 1e-10)).all()
            assert found.iterations.mean() <= 1.1 * disc.iterations.mean()
            assert found.nodes.mean() <= 1.1 * disc.nodes.mean()


@BOTH
def test_through_a_study(name):
    """Its own error is in model_error, with all that a law gives; spots that merge are no reason to doubt it."""
    given = {"P": [LOAD, 100 * LOAD], "h": 0.02, "n": 0.5, "Nbar": 250_000.0, "Ra": 0.004, "x": 5}
    base = ["half_space", "thin_layer", "layered", "auto"]
    found, disc = (study.solve(**given, base=base, micro=law) for law in (f"{name}_lattice", "disc_cell"))
    assert (found.status == 0).all()
    exact = found.model_error.sel(base=["half_space", "layered"])
    assert_allclose(exact, ERROR, rtol=1e-12, atol=0)
    assert (found.model_error >= ERROR).all()
    assert (abs(found.D / disc.D - 1) < 0.02).all() and (found.A0 < disc.A0).all()
    assert ((disc.validity & 16) > 0).any() and ((found.validity & 16) == 0).all()
    assert_allclose(study.derived.peak_pressure(found), found.p_max, rtol=1e-12, atol=0)

"""What is known without the solver of rows of golden_numbers.csv: closed forms, and the laws from their equations."""

import csv
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq
from scipy.special import ndtr

import solver.laws
from solver.problem import far_apart

REFERENCES = Path(__file__).parents[2] / "references"
LINES = (REFERENCES / "golden_numbers.csv").read_text(encoding="utf-8").splitlines()
#: What two rows of one contact share.
NUMBERS = ("a", "P", "D", "p0", "p_max", "Ar_An", "A0", "dP_dD", "p_0.3", "p_0.95", "lam_0.3", "lam_0.95")
#: Heights: the largest relative errors of A and λ that docs/model.md promises.
HEIGHTS = {"normal_heights": (5e-6, 2e-4), "uniform_heights": (3e-5, 2e-4), "table:golden_histogram.csv": (1e-4, 5e-4)}


def converged():
    """The converged rows, as dicts of floats and of the texts that are none."""
    rows = [{name: number(text) for name, text in row.items()} for row in csv.DictReader(LINES[1:])]
    return [row for row in rows if row["status"] == 0]


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def those(**words):
    """The converged rows that have these values; there are some."""
    rows = [row for row in converged() if all(row[name] == value for name, value in words.items())]
    assert rows
    return rows


def of_law(micro):
    """Id and row of the converged rows of a micro law, of asperities on a half-space: not farther apart than h."""
    rows = [row for row in those(micro=micro) if row["base"] in ("half_space", "thin_layer") or not far(row)]
    return [pytest.param(row, id=f"{micro}-{i}") for i, row in enumerate(rows)]


def far(row):
    return bool(far_apart(row["Nbar"], row["h"]))


def modulus(row):
    """What the asperities feel: E2* without a layer, else E1*, which is the unit of moduli on a rigid base; with the
    punch."""
    own = 1.0 if row["base"] == "half_space" or row["n"] == 0 else row["n"]
    return own * row["E2"] / (1 + row["m"])


def test_an_elastic_punch_on_a_half_space_is_hertz():
    for row in those(base="half_space", micro="smooth", m=0.5):
        a, E = row["a"], modulus(row)
        expected = {"P": 4 / 3 * E * a**3, "D": a**2, "p0": 2 / np.pi * E * a, "dP_dD": 2 * E * a}
        assert_allclose([row[name] for name in expected], [*expected.values()], rtol=1e-14, atol=0)


def test_a_thin_layer_on_a_rigid_base_is_springs():
    """(3) with A1 = 0: C p = D - r²/2, and C = h without friction."""
    for row in those(base="thin_layer", micro="smooth", n=0.0):
        D, C = row["D"], row["h"]
        expected = {"a": np.sqrt(2 * D), "P": np.pi * D**2 / C, "p0": D / C, "dP_dD": 2 * np.pi * D / C}
        expected |= {f"p_{x:g}": D * (1 - x**2) / C for x in (0.3, 0.95)}
        assert_allclose([row[name] for name in expected], [*expected.values()], rtol=1e-13, atol=0)


def test_springs_and_asperities_have_their_edge_at_the_depth():
    """Where p(a) = 0 nothing but the shape is left of (3): D = a²/2."""
    rows = [row for row in those(base="thin_layer", n=0.0) if row["m"] == 0]
    assert {row["micro"] for row in rows} == {"smooth", "disc_cell"}
    for row in rows:
        assert row["D"] == pytest.approx(row["a"] ** 2 / 2, rel=1e-13)


def test_heights_without_a_spread_are_the_disc_cell():
    """To the rounding of Ar/An, which laws with corners take from another quadrature."""
    (row,) = those(micro="normal_heights", sigma=0.0)
    same_contact(row, rtol=1e-12)


def same_contact(row, rtol):
    """The row has the numbers of the disc cell at the same load on a half-space."""
    (disc,) = those(micro="disc_cell", base="half_space", control="P", rtol=row["rtol"])
    assert_allclose([row[name] for name in NUMBERS], [disc[name] for name in NUMBERS], rtol=rtol, atol=0)


def heights(row, size=20_000):
    """ζ (size,), the depths below the highest summit in R, and the shares of the summits there."""
    if row["micro"] == "normal_heights":
        ends = np.linspace(row["cut"], -row["cut"], size + 1)
        return row["sigma"] * (row["cut"] - (ends[1:] + ends[:-1]) / 2), -np.diff(ndtr(ends)) / np.ptp(ndtr(ends))
    if row["micro"] == "uniform_heights":
        z, share = np.zeros(1), np.ones(1)
        step = 2 * np.sqrt(3) * row["sigma"]
    else:
        z, share = np.loadtxt(REFERENCES / "golden_histogram.csv", delimiter=",", skiprows=2, unpack=True)
        step = z[1] - z[0]
    within = (np.arange(size // len(z)) + 0.5) / (size // len(z)) * step
    depth = (z.max() - z)[:, None] + within
    return depth.ravel(), np.repeat(share / share.sum(), size // len(z)) / (size // len(z))


def spots(row):
    """p*, A* and the means of load and λ at q = p/p* and δ = A/A*, by the equations of docs/model.md."""
    cell, E = 1 / np.sqrt(np.pi * row["Nbar"]), modulus(row)
    p_star, A_star = 2 * E * cell / (3 * row["Ra"]), cell**2 / row["Ra"]
    zeta, share = heights(row)

    def means(q, delta):
        approach, k = delta - zeta / A_star, 2 / 3 * q
        v = np.clip(np.sqrt(np.maximum(k**2 + 1 - approach, 0)) - k, 0, 1)
        c = np.sqrt(1 - v**2)
        load = 2 / np.pi * (c**3 + q * (np.arccos(v) - v * c)) + 3 / np.pi * np.maximum(approach - 1, 0)
        return share @ load, share @ c**2

    return p_star, A_star, means


def approach(q, means):
    """δ at which the mean load is q."""
    return np.exp(brentq(lambda ln: np.log(max(means(q, np.exp(ln))[0], 1e-99) / q), -9.0, 9.0, xtol=1e-9))


@pytest.mark.parametrize("row", [param for micro in HEIGHTS for param in of_law(micro)])
def test_heights_by_a_sum_over_many_summits(row):
    """A(p(0)), and λ at r = 0.3 a, where p is known."""
    of_A, of_lam = HEIGHTS[row["micro"]]
    p_star, A_star, means = spots(row)
    assert row["A0"] == pytest.approx(A_star * approach(row["p0"] / p_star, means), rel=of_A)
    q = row["p_0.3"] / p_star
    assert row["lam_0.3"] == pytest.approx(means(q, approach(q, means))[1], rel=of_lam)


@pytest.mark.parametrize("row", [param for micro in ("square_lattice", "hex_lattice") for param in of_law(micro)])
def test_lattices_by_the_rows_of_their_table(row):
    """A(p(0)), p_max, and λ at r = 0.3 a, by cubic splines through the rows, not by what the solver fits to them."""
    with (Path(solver.laws.__file__).parent / "lattices.csv").open(encoding="utf-8", newline="") as file:
        rows = [r for r in csv.DictReader(file) if r["lattice"] == row["micro"].removesuffix("_lattice")]
    table = {name: np.log([float(r[name]) for r in rows]) for name in ("p", "A", "lam", "p_max")}
    pitch, E = 1 / np.sqrt(row["Nbar"]), modulus(row)

    def of(name, p):
        return np.exp(CubicSpline(table["p"], table[name])(np.log(p * row["Ra"] / (E * pitch))))

    assert row["A0"] == pytest.approx(of("A", row["p0"]) * pitch**2 / row["Ra"], rel=2e-4)
    assert row["p_max"] == pytest.approx(of("p_max", row["p0"]) * E * pitch / row["Ra"], rel=2e-4)
    assert row["lam_0.3"] == pytest.approx(of("lam", row["p_0.3"]), rel=2e-4)


def test_the_table_of_a_law_is_the_disc_cell():
    """Its rows are, and the contact is within the model error."""
    p, A, lam, p_max = np.loadtxt(REFERENCES / "golden_law.csv", delimiter=",", skiprows=2, unpack=True)
    disc = solver.laws.LAWS["disc_cell"].at(p, 1.0, Nbar=250_000.0, Ra=0.004)
    for rows, expected in ((A, disc.A), (lam, disc.lam), (p_max, disc.p_max)):
        assert_allclose(rows, expected, rtol=6e-6, atol=0)
    (row,) = those(micro="table:golden_law.csv", base="half_space", m=0.0)
    same_contact(row, rtol=row["model_error"])

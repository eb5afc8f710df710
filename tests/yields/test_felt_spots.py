"""The largest stress below asperities that feel the coated body, and the load at which they first yield."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from yielding import first_yield

import study
from solver import Problem, solve
from solver.fields.below_spots import below_spot
from solver.fields.contact import of_contacts as fields_of
from solver.fields.invariants import mises
from solver.kernels.two_layers import TwoLayers
from solver.laws import cell_axis
from solver.laws.cell.members import Member
from solver.laws.cell.rows import of_kernel
from solver.laws.cell.spot import Cell
from solver.laws.cell.spot import spots as spots_of
from solver.numerics.caches import Cache
from solver.yields import spots
from solver.yields.below import felt_spots, spot_table
from solver.yields.below.felt_cells import FeltCell
from solver.yields.peaks import chebyshev_nodes

REFERENCES = Path(__file__).parents[1] / "fields" / "references" / "micro_axis.csv"
ROWS = np.genfromtxt(REFERENCES, delimiter=",", names=True, dtype=None, encoding="utf-8")
H = 0.02
LAYER = {"h": H, "nu1": 0.25, "nu2": 0.3, "bonding": "bonded", "base": "layered", "Ra": 0.2}


def far_apart(pitch: float) -> float:
    """Nbar of asperities with this pitch over h."""
    return 1 / (pitch * H) ** 2


def test_on_a_half_space_the_spot_is_that_of_the_references():
    """Few spots, where the disc of the cell and the waves of the lattice are the same: 4e-6 of p0s at λ = 0.001."""
    row = next(row for row in ROWS if row["nu"] == 0.3 and row["lam"] == 0.001 and row["macro"] == "halfspace_centre")
    layers = TwoLayers(*(np.array([value]) for value in (1.0, 0.3, 0.3, True)))
    cell = Cell("disc", 0.1, of_kernel(layers, 0.0))
    b = np.sqrt(0.001 / np.pi)
    spot, z = spots_of(cell, [b]), b * np.linspace(0.3, 0.7, 200)
    sr, _, sz, _ = below_spot(cell, spot, layers, np.zeros(1), z, False)[..., 0] * (np.pi / (2 * b))
    p = row["p_over_p0s"]
    assert_allclose(spot.p_max[0] * np.pi / (2 * b), row["pmax_over_p0s"], rtol=1e-8)
    whole = np.abs(sr - sz - p * (0.5 + 0.3) + p)
    assert_allclose(whole.max(), row["max_abs_sr_minus_sz"], rtol=0, atol=5e-6)


@pytest.mark.parametrize("n, pitch, bonding", [(0.2, 6.0, "bonded"), (2.0, 3.0, "frictionless"), (10.0, 8.0, "bonded")])
def test_in_the_centre_it_is_the_cell_and_the_nominal_pressure(n, pitch, bonding):
    """On the axis, from `cell_axis` and `solver.fields`, at 60 depths: what these miss is 1e-3 of the stress. The
    largest is there, unless it is beside the axis, and then more."""
    given = LAYER | {"bonding": bonding}
    problem = Problem.of(P=2e-5, n=n, Nbar=far_apart(pitch), **given)
    solution = solve(problem)
    (largest,), (r,), (z,) = spots.of_contacts(problem, solution)
    a, lam = solution.a[0], solution.lam[0, 0]
    b = np.sqrt(lam / np.pi) * pitch * H
    depths = min(1.5 * b, H) * np.linspace(0, 1, 60)
    sr, sz = cell_axis("disc", lam, pitch, depths / (pitch * H), n, 0.25, 0.3, bonding)
    unit = n * pitch * H / 0.2
    whole = fields_of(problem, solution, np.zeros(1), depths / a).inside
    stress = np.abs(unit * (sr - sz) + (whole["sr"] - whole["sz"])[0, :, 0])
    assert largest == pytest.approx(stress.max(), rel=1e-3) and largest >= stress.max() * (1 - 1e-6)
    assert r == pytest.approx(0.0, abs=1e-6) and z * a == pytest.approx(depths[stress.argmax()], abs=0.03 * b)


def test_where_pitch_and_layer_are_alike_it_is_that_of_a_half_space():
    """To 1.5 % where spots are small, as the disc of the cell and the lattice differ by some percent of p."""
    problem = Problem.of(P=1e-6, n=[0.5, 5.0], Nbar=far_apart(1.05), **LAYER)
    felt, other = (spots.of_contacts(some, solve(some)) for some in (problem, problem.but(asperities_on="half_space")))
    assert_allclose(felt[0], other[0], rtol=1.5e-2)
    assert_allclose(felt[2], other[2], rtol=2e-2)


def test_twice_as_many_nodes_change_nothing(monkeypatch):
    """1e-6, on soft layers and on hard ones that bend, in sliding too."""
    problem = Problem.of(P=[1e-5, 1e-4], n=[0.2, 20.0], Nbar=far_apart(6.0), **LAYER)
    solution = solve(problem)
    usual = spots.of_contacts(problem, solution, mu=0.2, residual=[0.0, 0.1])
    monkeypatch.setattr(spot_table, "_cache", Cache(4e7))
    for module, numbers in (
        (spot_table, {"_DEPTHS": 22, "_RADII": 25, "_FEW": 17, "_MORE": (9, 6, 2)}),
        (felt_spots, {"_NODES": 14}),
        (spots, {"_SPOTS": 25, "_RADII": np.sin(np.pi / 4 * (1 + chebyshev_nodes(25)))}),
    ):
        for name, value in numbers.items():
            monkeypatch.setattr(module, name, value)
    finer = spots.of_contacts(problem, solution, mu=0.2, residual=[0.0, 0.1])
    assert_allclose(finer[0], usual[0], rtol=1e-6)
    assert_allclose(finer[1:], usual[1:], atol=2e-3)


def test_beside_the_axis_there_may_be_more():
    """At the edge of a spot of b = h/2 on a film 100 times as hard as the body a fifth more; the field there is that of
    `below_spot`."""
    n, pitch, lam = 100.0, 20.0, np.pi * 0.025**2
    layers = TwoLayers(*(np.array([value]) for value in (n, 0.25, 0.3, True)))
    cell = Cell("hex", pitch, of_kernel(layers, 0.0))
    b = np.sqrt(lam / np.pi)
    member = Member(("of a test",), cell, np.sqrt(0.55 / np.pi), True)
    cells = spot_table.table_of(FeltCell(member, np.array([b]), 0.0, layers, 1.0, 1.0))
    assert cells.small.shape[1:] == (4, 14, 17)
    depths = spot_table.deepest(b, 1 / pitch) * (1 + chebyshev_nodes(14)) / 2
    field = below_spot(
        cell, spots_of(cell, [b]), layers, b * np.sin(np.pi / 4 * (1 + chebyshev_nodes(17))), depths, False
    )
    largest = np.abs(field).max()
    assert_allclose(cells.at(np.array([b]))[0], field, rtol=0, atol=1e-6 * largest)
    stresses = mises(*field)
    assert stresses.max() > 1.15 * stresses[:, 0].max()


def test_the_first_load_at_which_they_yield():
    """There the stress is the strength; a layer of the body's own material is felt as none of any thickness."""
    own = {"n": 1.0, "nu1": 0.3, "nu2": 0.3, "bonding": "bonded", "base": "layered", "Ra": 0.2, "Nbar": far_apart(3.0)}
    found = first_yield("asperities", yield_strength=0.02, h=[H, H / 2], asperities_on="layer", **own)
    assert_allclose(found.P_Ya[0], found.P_Ya[1], rtol=1e-5)
    at = Problem.of(a=found.a_Ya.values, h=[H, H / 2], **own)
    assert_allclose(spots.of_contacts(at, solve(at))[0], 0.02, rtol=1e-6)
    assert found.found_Ya.values.tolist() == [0, 0]


def test_stacks_and_smooth_contacts_have_none():
    stack = study.solve(P=1e-5, layers=[{"h": H, "n": 2.0, "nu": 0.3}, {"h": H, "n": 0.5, "nu": 0.3}], nu2=0.3,
                        Nbar=far_apart(4.0), Ra=0.2, base="stack", x=2)  # fmt: skip
    assert stack.asperities_used == 2 and np.isfinite(stack.p_spot)
    problem = Problem.of(P=1e-5, n=2.0, micro=["smooth", "disc_cell"], Nbar=far_apart(4.0), **LAYER)
    assert np.isfinite(spots.of_contacts(problem, solve(problem))).tolist() == [[False, True]] * 3

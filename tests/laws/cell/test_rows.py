"""The cell on a coated body against rows of an independent solution, and its limits."""

import csv

import numpy as np
import pytest
from conftest import ROOT
from numpy.testing import assert_allclose

from solver.laws import cell_axis, cell_rows, disc_cell
from solver.laws.cell import spot, sums

#: Layers (h, n, nu) from the top, on a body of modulus 1 and Poisson's ratio 0.3.
STACKS = {
    "stack_a": [(1, 3, 0.25), (2, 0.5, 0.35)],
    "stack_b": [(1, 0.1, 0.45), (0.5, 10, 0.2)],
    "stack_c": [(1, 5, 0.3), (1, 5, 0.3)],
}


def rows(name: str) -> list[dict]:
    with (ROOT / f"tests/references/given_cell_{name}.csv").open() as file:
        return list(csv.DictReader(file))


def law_of(row: dict) -> tuple:
    lattice, lam, pitch = row.get("lattice", "disc"), float(row["lam"]), float(row["l_over_h"])
    interface, m = row.get("bonding_or_stack", row.get("bonding")), float(row.get("m") or 0)
    if interface in STACKS:
        return cell_rows(lattice, lam, pitch, m=m, layers=STACKS[interface], nu2=0.3)
    return cell_rows(lattice, lam, pitch, *(float(row[name]) for name in ("n", "nu1", "nu2")), interface, m)


@pytest.mark.parametrize("name", ["law", "disc"])
def test_rows_of_an_independent_solution(name):
    """1e-10, to which the rows are good."""
    for row in rows(name):
        wanted = [float(row[column]) for column in ("p", "A", "p_max")]
        assert_allclose(law_of(row), wanted, rtol=1.2e-10, atol=0, err_msg=str(row))


def test_stresses_on_the_axis_of_an_independent_solution():
    """The rows have ten digits after the comma; 1e-10 of p_max, the largest stress there is."""
    for row in rows("axis"):
        case = row["lattice"], *(float(row[name]) for name in ("lam", "l_over_h"))
        bodies = *(float(row[name]) for name in ("n", "nu1", "nu2")), row["bonding"]
        stresses = cell_axis(*case, [float(row["z"])], *bodies, side=int(row["side"]))
        wanted = [[float(row["sr"])], [float(row["sz"])]]
        assert_allclose(stresses, wanted, rtol=0, atol=1e-10 * cell_rows(*case, *bodies)[2], err_msg=str(row))


LAYER = 10.0, 0.25, 0.3, "bonded"


@pytest.mark.parametrize("lattice", ["square", "hex", "disc"])
def test_a_thick_layer_is_a_half_space_and_one_of_the_bodys_material_too(lattice):
    """The layer adds what falls as e^(-2 Gh) of the longest wave: at a pitch of h/10 nothing, and the ratio of the
    differences at two pitches is that of these exponentials, of which the factor before it moves the rate by 15 %."""
    bare = cell_rows(lattice, 0.1, 1e-3, *LAYER)
    assert_allclose(cell_rows(lattice, 0.1, 0.1, *LAYER), bare, rtol=1e-15)
    assert_allclose(cell_rows(lattice, 0.1, 8.0, 1.0, 0.3, 0.3, "bonded"), bare, rtol=1e-13)
    off = [abs(cell_rows(lattice, 0.1, pitch, *LAYER)[1] / bare[1] - 1) for pitch in (0.6, 1.0)]
    longest = 2 * np.pi / sums.LATTICES["square" if lattice == "square" else "hex"]
    longest *= 1 if lattice == "square" else 2 / np.sqrt(3)
    assert_allclose(np.log(off[1] / off[0]), 2 * longest * (1 / 0.6 - 1), rtol=0.15)


def test_the_disc_cell_on_a_half_space_is_the_papers():
    """Eqs (6), (7) and (13), in units E = l = Ra = 1."""
    lam = np.array([1e-8, 0.01, 0.2, 0.7])
    p, A, p_max = cell_rows("disc", lam, 1e-3, 1.0, 0.3, 0.3, "bonded")
    law = disc_cell.LAW.at(p, 1.0, Nbar=1.0, Ra=1.0)
    assert_allclose(law.lam, lam, rtol=1e-13)
    assert_allclose([A, p_max], [law.A, law.p_max], rtol=1e-13)


def test_few_spots_are_the_lone_one_and_the_neighbours_act_as_b():
    """p and p_max of the lone asperity; A less b² is 2 N(0) times its load over 2 pi (docs/model.md)."""
    lam = np.array([1e-12, 1e-10])
    b = np.sqrt(lam / np.pi)
    p, A, p_max = cell_rows("hex", lam, 5.0, *LAYER)
    assert_allclose([p, p_max], [4 / 3 * b**3, 2 * b / np.pi], rtol=1e-9)
    more = (A - b**2) / b**3
    assert_allclose(more[0], more[1], rtol=1e-4)  # A is b² to the rounding of a part in b
    N = spot.pieces(spot.Cell("hex", 5.0, lambda u: 0 * u), 0.1).at(np.zeros(1))[0]
    bare = (cell_rows("hex", lam, 1e-3, *LAYER)[1] - b**2) / b**3
    assert_allclose(bare[1], 4 / (3 * np.pi) * N[0], rtol=1e-4)


def test_from_a_pitch_on_an_integral_stands_for_the_short_waves(monkeypatch):
    """Against all waves of the lattice, 18,000 of them."""
    case = "hex", 0.3, 40.0, 0.2, 0.25, 0.3, "bonded"
    split = cell_rows(*case)
    monkeypatch.setattr(sums, "SPLIT", 1e9)
    sums.waves.cache_clear()
    assert_allclose(split, cell_rows(*case), rtol=1e-12)
    sums.waves.cache_clear()


@pytest.mark.parametrize("n", [1e-3, 30.0])
def test_more_points_change_nothing(n, monkeypatch):
    case = "square", [0.01, 0.4], [60.0, 8.0], n, 0.25, 0.3, "bonded"
    usual = cell_rows(*case)
    monkeypatch.setattr(spot, "_LEAST", 120)
    monkeypatch.setattr(spot, "_WIDEST", 2.0)
    assert_allclose(usual, cell_rows(*case), rtol=1e-11)  # the rounding of a plate of n = 30, some thousand eps


def test_at_the_surface_the_stress_is_the_pressure_of_the_spot_less_the_nominal_one():
    p, _, p_max = cell_rows("square", 0.05, 8.0, *LAYER)
    for z in (0.0, 1e-12):
        assert_allclose(cell_axis("square", 0.05, 8.0, [z], *LAYER)[1], p - p_max, rtol=1e-9)


def test_normal_stress_and_displacement_pass_the_interface():
    """sz is the same on both of its sides; sr is not."""
    above, below = (cell_axis("hex", 0.1, 4.0, [0.25], *LAYER, side=side) for side in (0, 1))
    assert_allclose(above[1], below[1], rtol=1e-10)
    assert abs(above[0] / below[0] - 1) > 0.5


def test_an_elastic_punch_is_a_softer_layer():
    """(L + m)/(1 + m) of the modulus E1*/(1 + m): of a half-space the same law with the modulus of both."""
    stiff, both = cell_rows("square", 0.2, 1e-3, *LAYER), cell_rows("square", 0.2, 1e-3, *LAYER, 3.0)
    assert_allclose(both, np.array(stiff) / [4, 1, 4], rtol=1e-14)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"lattice": "triangle"}, 'lattice = "triangle": must be one of square, hex, disc'),
        ({"lam": 0.9}, "lam = 0.9"),
        ({"lam": 0.0}, "lam = 0.0"),
        ({"l_over_h": -1.0}, "l_over_h = -1.0"),
        ({"n": -1.0}, "n = -1.0"),
        ({"n": np.nan}, "n = nan"),
        ({"nu1": 0.6}, "nu1 = 0.6"),
        ({"bonding": "glued"}, "bonding = glued"),
        ({"m": np.inf}, "m = inf"),
        ({"layers": [(1, 3, 0.25)], "interfaces": []}, "interfaces: has 0 of 1"),
        ({"layers": [(1, 3, 0.25)], "interfaces": ["glued"]}, 'interfaces: "glued"'),
        ({"layers": [(-1, 3, 0.25)]}, "h = -1.0"),
    ],
)
def test_bad_arguments_are_named(change, words):
    case = {"lattice": "square", "lam": 0.1, "l_over_h": 2.0, "n": 3.0, "nu1": 0.3, "nu2": 0.3, "bonding": "bonded"}
    with pytest.raises(ValueError, match=words):
        cell_rows(**case | change)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"bonding": "glued"}, "bonding = glued"),
        ({"lam": 0.9}, "lam = 0.9"),
        ({"lattice": "triangle"}, "lattice"),
        ({"n": np.nan}, "n = nan"),
        ({"nu2": 0.6}, "nu2 = 0.6"),
        ({"m": -1.0}, "m = -1.0"),
        ({"side": 2}, "side = 2"),
        ({"z": [0.6]}, "z = 0.6: must be finite, at least 0 and at most h = 0.5"),
        ({"z": [0.4], "side": 1}, "z = 0.4: must be finite, at least 0 and at least h = 0.5"),
        ({"z": [-0.1]}, "z = -0.1"),
        ({"z": [np.nan]}, "z = nan"),
    ],
)
def test_bad_arguments_of_the_axis_are_named(change, words):
    """A misspelt interface was taken for a frictionless one."""
    case = {"lattice": "square", "lam": 0.1, "l_over_h": 2.0, "z": [0.1], "n": 3.0, "nu1": 0.3, "nu2": 0.3}
    with pytest.raises(ValueError, match=words):
        cell_axis(**case | {"bonding": "bonded"} | change)

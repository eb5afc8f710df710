"""The largest stresses, against an independent solution and against grids."""

import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solver import Problem, solve
from solver.fields import waves
from solver.fields.contact import of_contacts as fields_of
from solver.fields.invariants import mises
from solver.fields.pressure import Pressure
from solver.kernels.two_layers import TwoLayers
from solver.numerics.mesh import mesh_of
from solver.yields import contact
from solver.yields.contact import of_contacts
from solver.yields.extremes import are_starts, extremes, regions
from solver.yields.loaded import Loaded

FOLDER = Path(__file__).parents[1] / "fields" / "references"
ROWS = np.genfromtxt(FOLDER / "extremes.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
NAMES = {"vM_layer": "mises1", "vM_base": "mises2", "tresca_layer": "tresca1", "sr_interface_layer": "sr_interface1"}
ASPERITIES = {"Nbar": 250000.0, "Ra": 0.004}


def loaded(rows: np.ndarray, residual: float = 0.0) -> Loaded:
    """Hertz's pressure, or that to the third power, on the layer of a row."""
    row, mesh = rows[0], mesh_of(6)
    nu2 = row["nu2"] if np.isfinite(row["nu2"]) else 0.3  # of a rigid body any
    layers = TwoLayers(*(np.array([v]) for v in (row["n"], row["nu1"], nu2)), np.array([row["bonded"] == 1]))
    pressure = Pressure(mesh, mesh.s[None] ** (3 if row["config"] == "G8" else 1))
    return Loaded(layers, np.array([row["h"]]), pressure, False, row["mu"], np.array([residual]))


@pytest.mark.parametrize("mu", [0.0, 0.25])
@pytest.mark.parametrize("config", np.unique(ROWS["config"]))
def test_extremes_of_references(config, mu):
    """Values have 7 digits there, places 1e-3."""
    rows = ROWS[(ROWS["config"] == config) & (ROWS["mu"] == mu)]
    if not len(rows):
        return
    made = extremes(loaded(rows))
    for row in rows:
        value, r, z = made[NAMES.get(row["quantity"], row["quantity"])][:, 0]
        assert_allclose(value, row["value"], rtol=1e-6, atol=1e-8, err_msg=row["quantity"])
        assert_allclose([r, z], [row["x"], row["z"]], rtol=0, atol=1e-3, err_msg=row["quantity"])
    if config == "G7":
        assert np.isnan(made["mises2"]).all() and np.isfinite(made["mises1"]).all(), "a rigid body has no stress"
    if config == "G1" and mu == 0:
        for name in ("tau_interface", "sr_interface1"):
            assert made[name][0] == 0 and np.isnan(made[name][1:]).all(), "neither shear nor tension"


def test_residual_stress_is_the_layers():
    rows = ROWS[(ROWS["config"] == "G4") & (ROWS["mu"] == 0)]
    without, stretched = extremes(loaded(rows)), extremes(loaded(rows, 0.5))
    assert_allclose(stretched["sr_interface1"], without["sr_interface1"] + [[0.5], [0], [0]], rtol=1e-9, atol=1e-6)
    for name in ("mises2", "tau_interface", "sz_interface_min"):
        assert_allclose(stretched[name], without[name], rtol=1e-9)


def test_a_batch_of_solved_contacts():
    """Each as it is alone, and nowhere on a fine grid is a stress larger; a half-space is body 2, also at its surface;
    what is not solved is NaN."""
    kinds = {
        "base": ["layered", "layered", "half_space", "layered", "thin_layer"],
        "h": [0.02, 0.003, 0.02, 0.02, 0.02],
        "n": [0.5, 10.0, 1.0, 0.0, 0.5],
        "nu1": [0.3, 0.3, 0.3, 0.3, 0.5],
    }
    problem = Problem.of(a=0.03, **kinds, **ASPERITIES, bonding="bonded", R=2.0, E2=3.0)
    solution = solve(problem)
    assert solution.status.tolist() == [0, 0, 0, 0, 4]
    made = of_contacts(problem, solution)
    assert all(np.isnan(values[:, 4]).all() for values in made.values())
    assert np.isnan(made["mises1"][:, 2]).all() and np.isnan(made["mises2"][:, 3]).all()
    assert np.isfinite(made["mises2"][:, :3]).all() and np.isfinite(made["s1_surface"][0, :4]).all()
    for i in range(4):
        alone = of_contacts(problem.take([i]), solution.take([i]))
        h = 100.0 if i == 2 else problem.h[i] / solution.a[i]
        z = np.concatenate([np.linspace(0, min(h, 2), 30), np.linspace(h, h + 2, 30)])
        fields = fields_of(problem.take([i]), solution.take([i]), np.linspace(0, 2, 50), z).inside
        values = mises(*(fields[name][0] for name in ("sr", "st", "sz", "trz")))
        layer = values[z <= h].max()
        assert_allclose(made["mises2" if i == 2 else "mises1"][0, i], layer, rtol=2e-3, err_msg="next to it on a grid")
        assert made["mises2" if i == 2 else "mises1"][0, i] >= layer * (1 - 1e-12)
        for name in ("mises1", "mises2", "s1_surface"):
            assert_allclose(made[name][0, i], alone[name][0, 0], rtol=1e-7)


def test_contacts_are_searched_some_at_a_time(monkeypatch):
    """Three times as many take no more memory, and a number that the parts divide leaves no part without contacts."""
    monkeypatch.setattr(contact, "_TOGETHER", 8)
    problem = Problem.of(P=np.geomspace(1e-6, 1e-4, 24), base="half_space", nu2=0.3, micro="smooth")
    solution, most = solve(problem), []
    for rows in (np.arange(8), np.arange(24)):
        tracemalloc.start()
        try:
            largest = of_contacts(problem.take(rows), solution.take(rows))["mises2"]
            most.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
    assert most[1] < 1.5 * most[0], most
    assert_allclose(largest[0] / solution.p0, largest[0, 0] / solution.p0[0], rtol=1e-9)


@pytest.mark.parametrize(("h", "n", "region"), [(0.005, 30.0, "inside"), (0.06, 0.2, "layer"), (3.0, 0.05, "layer")])
def test_coarse_grids_take_half_of_the_waves(h, n, region, monkeypatch):
    """With panels half as long and p^ from the whole contact, coarse stresses change by less than 1e-9: 20 Gauss points
    integrate a wave over 40 radians that well. In these regions both rules end at the same wave."""
    mesh, ratio = mesh_of(16), np.full(1, 0.3)
    pressure = Pressure(mesh, (mesh.s + 0.4 * mesh.s**3)[None])
    layers = TwoLayers(np.full(1, n), ratio, ratio, np.ones(1, dtype=bool))
    loaded = Loaded(layers, np.full(1, h), pressure, False, 0.3, np.zeros(1))
    grid = regions(loaded)[region]
    monkeypatch.setattr(waves, "_AT_ONCE", 10**9)  # otherwise the rows end at other waves
    half = loaded.stresses(grid.radius(grid.u), grid.v, grid.body, roughly=True)
    monkeypatch.setattr(waves, "_ROUGH_RADIANS", 20.0)
    monkeypatch.setattr(waves.edge_waves, "transform", Pressure.transform)
    whole = loaded.stresses(grid.radius(grid.u), grid.v, grid.body, roughly=True)
    assert_allclose(half, whole, rtol=0, atol=1e-9)


def test_where_climbs_begin():
    """At peaks of the grid that may be the largest, at places that are nearly as high as the best, and nowhere if the
    pressure is not known."""
    values = np.array([[[0.998, 1.0, 0.996, 0.3, 0.9, 0.2, 0.8]]])
    assert are_starts(values, 1.0, 0.1).ravel().tolist() == [True, True, False, False, True, False, False]
    assert not are_starts(values, 1.0, np.nan).any()

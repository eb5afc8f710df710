"""The largest stresses below the central spot of asperities that feel the coated body."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from solver import Problem, solve
from solver.fields.below_spots import below_spot
from solver.fields.contact import of_contacts as fields_of
from solver.kernels.two_layers import TwoLayers
from solver.laws import cell_axis
from solver.laws.cell.rows import of_kernel
from solver.laws.cell.spot import Cell, spots
from solver.yields.below import central_spot

H, PITCH = 0.02, 6.0
GIVEN = {"h": H, "nu1": 0.25, "nu2": 0.3, "base": "layered", "Nbar": 1 / (PITCH * H) ** 2, "Ra": 0.2}
HARD = {"n": 10.0, "bonding": "bonded", **GIVEN}


def solved(**given):
    problem = Problem.of(**{"P": 2e-5} | given)
    return problem, solve(problem)


@pytest.mark.parametrize("n, bonding", [(10.0, "bonded"), (0.3, "frictionless")])
def test_they_are_the_cell_and_the_nominal_pressure(n, bonding):
    """From `cell_axis`, `below_spot` and `solver.fields`, at many depths and radii: what these miss is 1e-3."""
    problem, solution = solved(n=n, bonding=bonding, **GIVEN)
    found = {name: values[:, 0] for name, values in central_spot.of_contacts(problem, solution).items()}
    a, lam, l = solution.a[0], solution.lam[0, 0], PITCH * H
    unit = n * l / 0.2

    def on_axis(z, side):
        sr, sz = cell_axis("disc", lam, PITCH, z / l, n, 0.25, 0.3, bonding, side=side)
        whole = fields_of(problem, solution, np.zeros(1), z / a)
        field = whole.inside if len(z) > 1 else (whole.above, whole.below)[side]
        return unit * np.array([sr, sz]) + [np.atleast_2d(field[name])[0].ravel()[: len(z)] for name in ("sr", "sz")]

    layer, body = np.linspace(0, 0.999, 80) * H, np.linspace(1.001, 8, 150) * H
    for name, z, side in (("mises1_spot", layer, 0), ("mises2_spot", body, 1)):
        sr, sz = on_axis(z, side)
        stress = np.abs(sr - sz)
        assert found[name][0] == pytest.approx(stress.max(), rel=5e-3) and found[name][0] > stress.max() * (1 - 1e-6)
    assert found["sr_interface1_spot"].tolist() == pytest.approx([on_axis(np.array([H]), 0)[0, 0], H / a], rel=1e-6)
    layers = TwoLayers(*(np.array([value]) for value in (n, 0.25, 0.3, bonding == "bonded")))
    cell, r = Cell("disc", PITCH, of_kernel(layers, 0.0)), np.linspace(0, (4 / 3) ** 0.25 / 2, 200)
    spot = spots(cell, [np.sqrt(lam / np.pi)])
    _, _, sz, trz = unit * below_spot(cell, spot, layers, r, np.array([1 / PITCH]), True)[:, 0]
    above = fields_of(problem, solution, r * l / a, np.zeros(0)).above
    tension, shear = (sz + above["sz"][0]).max(), np.abs(trz + above["trz"][0]).max()
    assert found["sz_interface_spot_max"][0] == pytest.approx(tension, rel=2e-3)
    if bonding == "bonded":
        assert found["tau_interface_spot"].tolist() == pytest.approx([shear, H / a], rel=1e-3)
    else:
        assert found["tau_interface_spot"][0] == 0 and np.isnan(found["tau_interface_spot"][1])


def test_more_nodes_change_nothing(monkeypatch):
    problem, solution = solved(**HARD)
    usual = central_spot.of_contacts(problem, solution, mu=0.2, residual=0.1)
    monkeypatch.setattr(central_spot, "_NODES", 18)
    for name, values in central_spot.of_contacts(problem, solution, mu=0.2, residual=0.1).items():
        assert_allclose(values[0], usual[name][0], rtol=1e-6, err_msg=name)


def test_heights_that_are_alike_are_the_disc_cell():
    alike, cells = (solved(**HARD, micro=micro, sigma=1e-9) for micro in ("normal_heights", "disc_cell"))
    for name, values in central_spot.of_contacts(*alike).items():
        assert_allclose(values, central_spot.of_contacts(*cells)[name], rtol=1e-5)


def test_what_is_not_there_is_not_a_number():
    """On a rigid body no stress in it, without tension 0 and no place; none on a half-space or of smooth contacts."""
    problem, solution = solved(**HARD | {"n": [0.0, 10.0, 10.0, 10.0]},
                               asperities_on=["auto", "auto", "half_space", "auto"],
                               micro=["disc_cell", "disc_cell", "disc_cell", "smooth"])  # fmt: skip
    found = central_spot.of_contacts(problem, solution)
    assert np.isfinite(found["mises2_spot"][0]).tolist() == [False, True, False, False]
    for name in ("mises1_spot", "sr_interface1_spot", "tau_interface_spot", "sz_interface_spot_max"):
        assert np.isfinite(found[name][0]).tolist() == [True, True, False, False], name
    close, ended = solved(**HARD | {"Nbar": 1 / (1.2 * H) ** 2})
    value, z = central_spot.of_contacts(close, ended)["sz_interface_spot_max"][:, 0]
    assert value == 0 and np.isnan(z)


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_in_units_they_are_the_same():
    """study.extremes over the dimensions of a contact; none of the names where no asperity feels a layer."""
    pure = study.extremes(P=2e-5, x=2, **HARD)
    scene = {"R": "10 mm", "E2": "91 GPa", "nu2": 0.3, "P": f"{2e-5 * 1e11 * 1e-4} N", "h": "0.2 mm"}
    scene |= {"Nbar": f"{HARD['Nbar'] * 1e4} 1/m^2", "Ra": "2 mm"}
    physical = study.extremes(**HARD | scene, x=2)
    for name in central_spot.SPOT_EXTREMES:
        assert physical[name].item() == pytest.approx(1e11 * pure[name].item(), rel=1e-9)
        assert physical[f"{name}_z"].item() == pytest.approx(pure[f"{name}_z"].item(), rel=1e-6)
        assert physical[name].attrs["units"] == "Pa"
    assert pure.mises1_spot > 10 * pure.mises1 and pure.mises2_spot > 2 * pure.mises2
    half_space = study.extremes(P=2e-5, x=2, asperities_on="half_space", **HARD)
    assert not {*central_spot.SPOT_EXTREMES} & {*half_space}

"""The fields of solved contacts: rough ones against an independent solution, and every kind against what it must be."""

import numpy as np
import pytest
from field_rows import table
from numpy.testing import assert_allclose

from solver import Problem, solve
from solver.fields import of_pressure
from solver.fields.contact import of_contacts
from solver.fields.invariants import invariants
from solver.fields.sliding import in_plane

ROUGH = table("stress_rough")
ASPERITIES = {"Nbar": 250000.0, "Ra": 0.004}
LAYER = {"h": 0.02, "n": 3.0, "nu1": 0.2, "nu2": 0.4, "bonding": "bonded"}


@pytest.mark.parametrize("case", np.unique(ROUGH["case"]))
def test_rough_contacts(case):
    """Within `error` of the largest stress, which is below 1e-6 of p0 at rtol 1e-8."""
    rows = ROUGH[ROUGH["case"] == case]
    given = {name: rows[name][0] for name in ("P", "h", "n", "nu1", "nu2", "bonding", "Nbar", "Ra")}
    problem = Problem.of(**given, rtol=1e-8)
    solution = solve(problem)
    r, z = np.unique(rows["r_over_a"]), np.unique(rows["z"])
    fields = of_contacts(problem, solution, r, z / rows["a"][0])
    column, row = np.searchsorted(r, rows["r_over_a"]), np.searchsorted(z, rows["z"])
    at_h = np.isclose(rows["z"], rows["h"], rtol=1e-9)
    assert at_h.any() and fields.error < 1e-6
    for name in ("sr", "st", "sz", "trz"):
        at_interface = np.where(rows["side"] == 1, fields.below[name][0, 0, column], fields.above[name][0, 0, column])
        values = np.where(at_h, at_interface, fields.inside[name][0, row, column])
        largest = max(np.abs(fields.inside[name]).max(), rows["p0"][0])
        assert_allclose(values, rows[f"{name}_over_p0"] * rows["p0"][0], rtol=0, atol=fields.error[0] * largest)


def test_a_smooth_contact_is_that_of_hertz():
    """On a half-space, whose E2* and R have units; nothing is at an interface that is not there."""
    problem = Problem.of(
        a=[2.0, 5.0], base="half_space", micro="smooth", nu2=0.4, bonding="frictionless", R=100.0, E2=7.0
    )
    solution = solve(problem)
    r, z = np.array([0.0, 0.7, 1.0, 1.5]), np.array([0.0, 0.01, 0.5, 3.0])
    fields = of_contacts(problem, solution, r, z, mu=0.2)
    wanted = of_pressure(
        lambda x: np.sqrt(1 - x**2), r, z[:, None], h=1.0, n=1.0, nu1=0.4, nu2=0.4, bonding="bonded", mu=0.2
    )
    for name, values in fields.inside.items():
        unit = solution.p0 * (solution.a / 7.0 if name.startswith("u") else 1.0)
        assert_allclose(values, unit[:, None, None] * wanted[name], rtol=0, atol=1e-12 * unit.max())
        assert np.isnan(fields.above[name]).all() and np.isnan(fields.below[name]).all()


def test_a_batch_of_many_kinds():
    """Each case has the numbers that it has alone, whatever its base, law, punch and units; one that is not solved has
    NaN. The surface bears the pressure of the profile, and a thin layer has the field of the exact one."""
    kinds = [
        {"a": 0.03, **LAYER, **ASPERITIES},
        {"a": 0.03, **LAYER, "micro": "smooth", "m": 0.5},
        {"a": 0.03, **LAYER, **ASPERITIES, "n": 0.2, "base": "thin_layer"},
        {"a": 0.03, **LAYER, "n": 0.0, "nu1": 0.5, "micro": "smooth"},
        {"a": 0.03, **LAYER, **ASPERITIES, "base": "auto", "accuracy": 0.5},
        {"a": 0.03, **LAYER, **ASPERITIES, "base": "half_space", "E2": 3.0, "R": 2.0},
        {"a": 0.03, **LAYER, "micro": "smooth", "nu1": 0.5, "base": "thin_layer"},
    ]
    names = sorted({name for kind in kinds for name in kind})
    defaults = {"base": "layered", "micro": "disc_cell", "m": 0.0, "accuracy": 0.01, "E2": 1.0, "R": 1.0, **ASPERITIES}
    batch = Problem.of(**{name: [kind.get(name, defaults.get(name)) for kind in kinds] for name in names})
    x = np.array([0.0, 0.4, 0.8])
    solution = solve(batch, x)
    assert solution.status.tolist() == [0, 0, 0, 0, 0, 0, 4]
    z = np.array([0.0, 0.3, 1.0])
    fields = of_contacts(batch, solution, x, z, mu=0.1)
    for name, values in fields.inside.items():
        assert np.isnan(values[-1]).all() and np.isnan(fields.below[name][-1]).all()
        assert np.isfinite(values[:3]).all()
        for i in (0, 2, 5):
            alone = of_contacts(batch.take([i]), solution.take([i]), x, z, mu=0.1)
            assert_allclose(values[i], alone.inside[name][0], rtol=1e-9, atol=1e-12)
    assert_allclose(fields.inside["sz"][:6, 0], -solution.p[:6], rtol=2e-6)
    assert np.isnan(fields.below["sz"][3]).all() and np.isfinite(fields.above["sz"][3]).all()
    assert np.isnan(fields.above["sz"][5]).all()
    for name in ("sz", "trz"):
        soft = [0, 1, 2, 4]
        assert_allclose(fields.above[name][soft], fields.below[name][soft], rtol=0, atol=1e-12)


def test_errors_that_finer_solutions_confirm():
    """No stress is farther off than `error` times the largest, also at the very edge."""
    problem = Problem.of(P=1e-5, h=[0.02, 0.01, 0.005, 0.02], n=[0.1, 2.0, 10.0, 0.5], bonding="bonded", **ASPERITIES)
    r, z = np.linspace(0, 1.3, 14), np.array([0.0, 0.1, 0.3, 0.8])
    solution = solve(problem)
    fields = of_contacts(problem, solution, r, z)
    exact = of_contacts(problem.but(rtol=1e-11), solution, r, z)
    largest = np.max(
        [np.abs(values).max(axis=(1, 2)) for name, values in exact.inside.items() if name[0] in "st"], axis=0
    )
    for name in ("sr", "st", "sz", "trz"):
        off = np.abs(fields.inside[name] - exact.inside[name]).max(axis=(1, 2))
        assert np.all(off <= fields.error * largest)
    assert np.all(fields.error < 1e-6)


def test_invariants():
    """Those of the tensor, by its eigenvalues; in the plane of sliding those of pressure and friction together."""
    random = np.random.default_rng(0)
    sr, st, sz, trz = random.normal(size=(4, 50))
    made = invariants(sr, st, sz, trz)
    tensor = np.zeros((50, 3, 3))
    tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 2, 2] = sr, st, sz
    tensor[:, 0, 2] = tensor[:, 2, 0] = trz
    s3, s2, s1 = np.linalg.eigvalsh(tensor).T
    for values, wanted in zip(made[:3], (s1, s2, s3), strict=True):
        assert_allclose(values, wanted, rtol=0, atol=1e-14)
    deviator = tensor - np.trace(tensor, axis1=1, axis2=2)[:, None, None] * np.eye(3) / 3
    assert_allclose(made.mises, np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2))), rtol=1e-14)
    assert_allclose(made.tresca, s1 - s3, rtol=1e-13)


def test_the_plane_of_sliding():
    """Ahead and behind are mirror images: friction changes its sign in sr, and not in the shear stress."""
    field = of_pressure(lambda x: np.sqrt(1 - x**2), 0.6, 0.2, h=0.5, n=2.0, nu1=0.3, nu2=0.3, bonding="bonded", mu=0.3)
    ahead, behind = (in_plane(field, np.array(side)) for side in (False, True))
    for name in ("sr", "st", "sz", "uz"):
        assert_allclose(ahead[name] + behind[name], 2 * field[name], rtol=1e-14)
        assert_allclose(ahead[name] - behind[name], 2 * field[f"{name}_c"], rtol=1e-13)
    assert_allclose(ahead["trz"] - behind["trz"], 2 * field["trz"], rtol=1e-14)
    assert_allclose(ahead["ur"] + behind["ur"], 2 * (field["ux_0"] + field["ux_2"]), rtol=1e-14)

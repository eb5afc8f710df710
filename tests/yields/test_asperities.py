"""The stress on the axis of a spot against references, and the mask that is made of it."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import study
from solver import Problem, solve
from solver.closed_forms import yield_pressure
from solver.yields import spots
from solver.yields.asperities import hertz_part, stress_on_axis

REFERENCES = Path(__file__).parents[1] / "fields" / "references" / "micro_axis.csv"
ROWS = np.genfromtxt(REFERENCES, delimiter=",", names=True, dtype=None, encoding="utf-8")
STEEL = {"R": "5 mm", "E2": "210 GPa", "base": "half_space", "Nbar": "1 1/um^2", "Ra": "5 um", "x": 2}


def test_the_largest_difference_on_the_axis():
    """The references have seven to nine digits: the one of six decimals is 3e-9 off."""
    nu, p = ROWS["nu"], ROWS["p_over_p0s"]
    further = {"none": -p * (1 - 2 * nu) / 2, "halfspace_centre": 0 * p, "membrane_tension": 0.3 + p * (1 + 2 * nu) / 2}
    tension = np.choose([[*further].index(name) for name in ROWS["macro"]], [*further.values()])
    assert_allclose(
        stress_on_axis(nu, np.sqrt(ROWS["lam"]), p, tension), ROWS["max_abs_sr_minus_sz"], rtol=0, atol=5e-9
    )
    p0s, c = hertz_part(ROWS["pmax_over_p0s"], p, np.pi / 2 / np.sqrt(ROWS["lam"]), 1 / np.pi, 1.0)
    assert_allclose([p0s, c / np.sqrt(ROWS["lam"])], 1.0, rtol=0, atol=1e-11)


def test_a_spot_that_is_alone_is_a_sphere():
    nu = np.array([-0.5, 0.0, 0.3, 0.5])
    assert_allclose(stress_on_axis(nu, 1e-5, 0.0) * yield_pressure(nu), 1.0, rtol=0, atol=5e-9)


@pytest.mark.filterwarnings("ignore:this contact is beyond")
@pytest.mark.parametrize("micro", ["disc_cell", "square_lattice", "normal_heights"])
def test_the_mask_needs_a_strength(micro):
    case = STEEL | {"micro": micro} | ({"sigma": "10 nm"} if micro == "normal_heights" else {})
    for strengths in ({"yield_strength": "1 GPa"}, {"hardness": "2.84 GPa"}):
        contact = study.solve(**case, **strengths, P=["1e-12 N", "1 N"])
        assert (contact.validity.values & 1024 > 0).tolist() == [False, True]
    assert "asperities would yield" in study.summary(contact.isel(P=1))
    bare = study.solve(**case, P=["1e-12 N", "1 N"])
    assert not (bare.validity & 1024).any() and (bare.p_max == contact.p_max).all()


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_the_mask_begins_where_the_stress_is_the_strength():
    """Of the disc cell; an elastic-plastic law says it by its share."""
    problem = Problem.of(P=1e-6, base="half_space", Nbar=250_000.0, Ra=0.004)
    stress = spots.of_contacts(problem, solve(problem))[0, 0]
    given = {"P": 1e-6, "base": "half_space", "Nbar": 250_000.0, "Ra": 0.004, "x": 2}
    flags = study.solve(**given, yield_strength=[0.999999 * stress, 1.000001 * stress]).validity
    assert (flags.values & 1024 > 0).tolist() == [True, False]
    assert not study.solve(**given, yield_strength=stress / 2, micro="elastic_plastic").validity & 1024

"""The least-squares fit of Section 4.1 of the paper."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import least_squares

from solver import fit_power_law
from solver.laws.disc_cell import displacement
from solver.laws.power_law_fit import power_law_error, pressures


@pytest.mark.parametrize(("Nbar_Ra2", "B", "beta"), [(4, 0.0919, 0.4908), (1, 0.3157, 0.5342), (0.25, 1.0006, 0.5664)])
def test_converged_fits_of_table_1(Nbar_Ra2, B, beta):
    fit = fit_power_law(Nbar_Ra2)
    assert_allclose([fit.B, fit.beta], [B, beta], rtol=0, atol=5e-5)


@pytest.mark.parametrize(
    ("Nbar_Ra2", "B", "beta", "error"), [(4, 0.1, 0.5, 7.7), (1, 0.3, 0.53, 4.2), (0.25, 1, 0.57, 2.5)]
)
def test_errors_of_the_printed_fits(Nbar_Ra2, B, beta, error):
    assert_allclose(100 * power_law_error(B, beta, Nbar_Ra2), error, rtol=0, atol=0.05)


@pytest.mark.parametrize("mesh", ["uniform", "graded"])
def test_against_a_general_minimiser(mesh):
    fit = fit_power_law(0.7, p_max=0.05, step=5e-4, mesh=mesh)
    p = pressures(1e-4, 0.05, 5e-4, mesh)
    A = displacement(p, 1.0, 0.7, 1.0)
    tight = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15}
    x = least_squares(lambda v: (np.exp(v[0]) * p ** v[1] - A) / A.max(), [0, 0.5], **tight).x
    assert_allclose([fit.B, fit.beta], [np.exp(x[0]), x[1]], rtol=1e-7, atol=0)


@pytest.mark.parametrize("mesh", ["uniform", "graded"])
def test_the_gradient_of_the_misfit_vanishes(mesh):
    B, beta, _ = fit_power_law(2.0, mesh=mesh)
    p = pressures(1e-4, 0.025, 1e-4, mesh)
    power = p**beta
    rest = displacement(p, 1.0, 2.0, 1.0) - B * power
    for column in (power, power * np.log(p)):
        assert abs(rest @ column) < 1e-12 * np.abs(column) @ np.abs(B * power)


def test_pressures_of_both_meshes():
    uniform, graded = (pressures(1e-4, 0.025, 1e-4, mesh) for mesh in ("uniform", "graded"))
    assert len(uniform) == len(graded) == 250
    assert_allclose(np.diff(uniform), 1e-4, rtol=1e-10, atol=0)
    assert_allclose(np.diff(np.log(graded)), np.log(250) / 249, rtol=1e-10, atol=0)
    for p in (uniform, graded):
        assert_allclose(p[[0, -1]], [1e-4, 0.025], rtol=1e-14, atol=0)


def test_a_graded_mesh_fits_low_pressures_better():
    low = (1e-4, 1e-3)
    assert fit_power_law(4.0, mesh="graded", check=low).max_error < fit_power_law(4.0, check=low).max_error


def test_isolated_spots_are_fitted_by_hertz():
    """A = p^(2/3) (3/(4 Nbar Ra²))^(2/3) exactly in the limit of no interaction."""
    fit = fit_power_law(1e-3, p_min=1e-14, p_max=1e-12, step=1e-14)
    assert_allclose([fit.beta, fit.B], [2 / 3, (0.75 / 1e-3) ** (2 / 3)], rtol=2e-2, atol=0)
    assert fit.max_error > 0.1  # it does not extend to the pressures of the paper


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"Nbar_Ra2": 0}, "Nbar_Ra2 = 0: must be > 0"),
        ({"Nbar_Ra2": -1.0}, "must be > 0"),
        ({"Nbar_Ra2": np.nan}, "must be > 0"),
        ({"Nbar_Ra2": np.inf}, "finite"),
        ({"p_min": 0.0}, "0 < p_min < p_max"),
        ({"p_min": 0.1}, "p_min = 0.1, p_max = 0.025"),
        ({"p_max": np.inf}, "0 < p_min < p_max"),
        ({"p_max": np.nan}, "0 < p_min < p_max"),
        ({"step": 0.0}, "step = 0.0: must be > 0"),
        ({"step": 1.0}, "at most p_max - p_min"),
        ({"step": np.nan}, "step = nan"),
        ({"mesh": "log"}, 'mesh = "log"'),
        ({"check": (0.0, 0.1)}, "0 < low < high"),
        ({"check": (0.2, 0.1)}, "0 < low < high"),
    ],
)
def test_wrong_calls(arguments, message):
    with pytest.raises(ValueError, match=message.replace("(", r"\(")):
        fit_power_law(**({"Nbar_Ra2": 4.0} | arguments))


def test_density_and_radius_are_not_taken_for_a_range_of_pressures():
    with pytest.raises(TypeError):
        fit_power_law(250000, 0.004)

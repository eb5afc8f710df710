"""The least-squares fit of Section 4.1 of the paper."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import least_squares as minimiser

from solver import fit_power_law
from solver.laws.disc_cell import displacement
from solver.laws.fit import PRESSURES, least_squares, power_law_error


@pytest.mark.parametrize(("Nbar_Ra2", "B", "beta"), [(4, 0.0919, 0.4908), (1, 0.3157, 0.5342), (0.25, 1.0006, 0.5664)])
def test_converged_fits_of_table_1(Nbar_Ra2, B, beta):
    fit = fit_power_law(Nbar_Ra2)
    assert_allclose([fit.B, fit.beta], [B, beta], rtol=0, atol=5e-5)


@pytest.mark.parametrize(
    ("Nbar_Ra2", "B", "beta", "error"), [(4, 0.1, 0.5, 7.7), (1, 0.3, 0.53, 4.2), (0.25, 1, 0.57, 2.5)]
)
def test_errors_of_the_printed_fits(Nbar_Ra2, B, beta, error):
    assert_allclose(100 * power_law_error(B, beta, Nbar_Ra2), error, rtol=0, atol=0.05)


@pytest.mark.parametrize("p", [PRESSURES, np.linspace(1e-4, 0.05, 100), np.geomspace(1e-4, 0.05, 100)])
def test_against_a_general_minimiser(p):
    A = displacement(p, 1.0, 0.7, 1.0)
    tight = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15}
    x = minimiser(lambda v: (np.exp(v[0]) * p ** v[1] - A) / A.max(), [0, 0.5], **tight).x
    assert_allclose(least_squares(p, A), [np.exp(x[0]), x[1]], rtol=1e-7, atol=0)


@pytest.mark.parametrize("p", [PRESSURES, np.geomspace(1e-4, 0.025, 250)])
def test_the_gradient_of_the_misfit_vanishes(p):
    A = displacement(p, 1.0, 2.0, 1.0)
    B, beta = least_squares(p, A)
    power = p**beta
    for column in (power, power * np.log(p)):
        assert abs((A - B * power) @ column) < 1e-12 * np.abs(column) @ np.abs(B * power)


def test_pressures_of_the_paper():
    assert len(PRESSURES) == 250
    assert_allclose(np.diff(PRESSURES), 1e-4, rtol=1e-10, atol=0)
    assert_allclose(PRESSURES[[0, -1]], [1e-4, 0.025], rtol=1e-14, atol=0)


def test_isolated_spots_are_fitted_by_hertz():
    """A = p^(2/3) (3/(4 Nbar Ra²))^(2/3) exactly in the limit of no interaction."""
    p = np.linspace(1e-14, 1e-12, 100)
    B, beta = least_squares(p, displacement(p, 1.0, 1e-3, 1.0))
    assert_allclose([beta, B], [2 / 3, (0.75 / 1e-3) ** (2 / 3)], rtol=2e-2, atol=0)
    assert power_law_error(B, beta, 1e-3) > 0.1  # it does not extend to the pressures of the paper


@pytest.mark.parametrize("product", [0, -1.0, np.nan, np.inf])
def test_a_product_out_of_bounds(product):
    with pytest.raises(ValueError, match=f"Nbar_Ra2 = {product}: must be > 0 and finite"):
        fit_power_law(product)


def test_density_and_radius_are_not_taken_for_a_range_of_pressures():
    with pytest.raises(TypeError):
        fit_power_law(250000, 0.004)

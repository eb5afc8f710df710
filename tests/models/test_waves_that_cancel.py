"""Bonded layers in which long waves and short ones cancel, so that a thin layer errs by what is of second order."""

from functools import cache

import numpy as np
import pytest
from solver_cases import difference

from solver import Model, Problem, solve
from solver.models.auto import bounds


@cache
def where_waves_cancel(n, nu1, nu2):
    """Rough contacts on a bonded layer, without their control, and the solutions at a = 0.01."""
    x, share = (v.ravel() for v in np.meshgrid([1e-3, 1e-2, 0.1], 10.0 ** np.arange(-5, 1)))
    given = {"h": 0.01 * x, "n": n, "nu1": nu1, "nu2": nu2, "bonding": "bonded", "Ra": 1e-3}
    given |= {"asperities_on": "half_space"}  # as on the thin layer
    given["Nbar"] = 1 / (np.pi * 1e-7 * share * x)
    return given, solve(Problem.of(a=0.01, **given, rtol=1e-7))


@pytest.mark.parametrize("control", ["a", "P", "D"])
@pytest.mark.parametrize(("n", "nu1", "nu2"), [(0.353, 0.42, 0.42), (0.0887, 0.4, 0.45), (0.129, -0.95, 0.5)])
def test_kappa_of_waves_that_cancel(n, nu1, nu2, control):
    """κ of these bonded materials is nearly 0, and a smooth punch errs little. Asperities yield to some waves more than
    to others: the error is that of the waves that no longer cancel. The bound of "auto" is twice that or more."""
    contacts, exact = where_waves_cancel(n, nu1, nu2)
    given = contacts | {control: getattr(exact, control)}
    thin = solve(Problem.of(**given, rtol=1e-7, base="thin_layer"))
    assert (exact.status == 0).all() and (thin.status == 0).all()
    assert (difference(thin, exact) <= 4 * thin.model_error / 2).all()
    chosen = solve(Problem.of(**given, rtol=1e-7, base="auto", accuracy=1e-3))
    assert (difference(chosen, exact) <= chosen.model_error + chosen.error + exact.error).all()


@pytest.mark.parametrize("control", ["a", "P", "D"])
@pytest.mark.parametrize(
    ("n", "nu1", "nu2", "m"), [(3.1795e-3, 0.3725874, 0.466, 0.755), (5.734e-3, 0.372679, 0.1191, 0.748)]
)
def test_a_smooth_punch_where_waves_cancel(n, nu1, nu2, m, control):
    """What is of second order is left of the error. Without a least κ it is up to 27 times the bound of "auto"."""
    layer = {"h": 0.01 * np.geomspace(1e-3, 0.1, 9), "n": n, "nu1": nu1, "nu2": nu2, "bonding": "bonded", "m": m}
    exact = solve(Problem.of(a=0.01, **layer, micro="smooth", rtol=1e-8))
    again = layer | {control: getattr(exact, control), "micro": "smooth", "rtol": 1e-8}
    thin, bound = solve(Problem.of(**again, base="thin_layer")), bounds(Problem.of(**again, base="auto"))
    assert (exact.status == 0).all() and (thin.status == 0).all()
    assert (difference(thin, exact) <= 0.9 * bound[Model.SMOOTH_THIN_LAYER]).all()

"""The effective load of bodies that creep, against closed forms and quadrature, and the contacts under it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

import study

GEL = {"J0": 1.0, "J": [3.0], "tau": [1.0]}
HELD = [0.0, 0.11, 0.2, 1.01, 3.0], [0.0, 1.1e-4, 2e-4, 2e-4, 2e-4]


def test_a_load_that_rises_and_stays():
    loads = study.effective_load(*HELD, GEL)
    assert_allclose(loads[[1, 3, 4]], [1.2750e-4, 5.5808e-4, 7.6693e-4], rtol=4e-5)
    contacts = study.solve(P=loads[[1, 3, 4]], h=0.05, n=0.0, nu1=0.45, bonding="bonded", micro="smooth")
    assert_allclose(contacts.D, [1.121589e-3, 2.304388e-3, 2.679889e-3], rtol=4e-7)


def test_a_step_is_the_compliance():
    """From the first time on, or at two equal times."""
    t = np.array([0.0, 0.0, 1e-9, 0.3, 40.0])
    assert_allclose(study.effective_load(t[1:], [2.0] * 4, GEL), 2 * (1 - 3 * np.expm1(-t[1:])), rtol=1e-14)
    assert_allclose(study.effective_load(t, [0.0, *[2.0] * 4], GEL)[1:], 2 * (1 - 3 * np.expm1(-t[1:])), rtol=1e-14)


def test_a_smooth_load_with_two_terms():
    prony = {"J0": 0.5, "J": [1.0, 2.0], "tau": [0.01, 7.0]}
    t = np.linspace(0, 2, 4001)

    def under(s):
        past = sum(J * -np.expm1(-(2 - s) / tau) for J, tau in ((1.0, 0.01), (2.0, 7.0)))
        return (0.5 + past) * 2 * s

    assert_allclose(study.effective_load(t, t**2, prony)[-1], quad(under, 0, 2, points=[1.9])[0], rtol=1e-6)


def test_more_times_change_nothing():
    """The load is linear between the times, whatever the length of a step beside a retardation time."""
    prony = {"J0": 0.0, "J": [1.0, 2.0, 3.0], "tau": [1e-3, 1.0, 1e5]}
    t = np.union1d(np.linspace(0, 2, 3000), [0.5])
    coarse = study.effective_load([0, 0.5, 2], [0, 1, 1.5], prony)
    fine = study.effective_load(t, np.interp(t, [0, 0.5, 2], [0, 1, 1.5]), prony)
    assert_allclose(fine[[np.searchsorted(t, 0.5), -1]], coarse[1:], rtol=1e-11)


def test_an_elastic_body():
    assert_allclose(study.effective_load([0, 1, 2], [0, 1, 4], {"J0": 1.0}), [0, 1, 4], rtol=0, atol=0)


@pytest.mark.parametrize(
    ("t", "P", "prony", "message"),
    [
        ([0, 1, 2], [0, 2, 1], GEL, "P falls at t = 2: only a load that never falls"),
        ([0, 1], [-1, 0], GEL, "P falls at t = 0"),
        ([0, 2, 1], [0, 1, 2], GEL, "t falls"),
        ([0, 1], [0, 1, 2], GEL, "must be two rows of one length"),
        ([0, np.nan], [0, 1], GEL, "t must be finite"),
        ([0, 1], ["a", 1], GEL, "must be numbers"),
        ([0, 1], [0, 1], {"J": [1], "tau": [1]}, "prony = "),
        ([0, 1], [0, 1], {"J0": 1, "J": [1], "tau": [0]}, "tau must be above 0"),
        ([0, 1], [0, 1], {"J0": 1, "J": [1, 2], "tau": [1]}, "two rows of one length"),
    ],
)
def test_what_is_refused(t, P, prony, message):
    with pytest.raises(ValueError, match="effective_load: ") as error:
        study.effective_load(t, P, prony)
    assert message in str(error.value)

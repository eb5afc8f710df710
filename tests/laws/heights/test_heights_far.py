"""Asperities whose heights spread far more than A*, and pressures far above p*: no table ends before full contact."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

import study
from solver.laws import LAWS, heights


@pytest.mark.parametrize(
    ("sigma", "q"), [(2, 1e6), (20, 1e3), (232, 1e2), (1e3, 1e4), (1e5, 40), (1e5, 1e9), (1e12, 1.0)]
)
@np.errstate(all="ignore")  # as in the solver
def test_heights_far_beyond_the_relief(sigma, q):
    """Where heights spread far more than A*, or the pressure is far above p*, A of the law carries that pressure: by
    quadrature over the spots and over the filled cells. The rounding of q - <f> grows as q."""
    cut, k = 4.0, 2 * q / 3
    one = np.ones(1)
    law = heights.LAW.bind(one, Nbar=one, Ra=one, sigma=one * sigma / np.pi, cut=one * cut)
    A = law.at(np.array([[q]]) * law.p_star).A[0, 0] / law.A_star[0]
    if q > 1e3 * sigma:
        assert_allclose(A, cut * sigma + 1 / 3, rtol=5e-6)
        return

    def load(depth):
        v = max(0.0, (1 - depth) / (k + np.sqrt(max(k * k + 1 - depth, 0.0))))
        spot = np.sqrt(max(1 - v * v, 0.0))
        return 2 / np.pi * (spot**3 + q * (np.arctan2(spot, v) - v * spot)) + 3 / np.pi * max(depth - 1, 0.0)

    ends = np.unique(np.clip([0.0, A - 1, A, A + 2 * k], 0.0, 2 * cut * sigma))
    share = 2 * quad(lambda x: np.exp(-((cut - x) ** 2) / 2), 0, cut, epsrel=1e-12)[0]
    found = sum(
        quad(lambda x: load(A - sigma * x) * np.exp(-((cut - x) ** 2) / 2) / share, low, high, epsrel=1e-11)[0]
        for low, high in pairwise(ends / sigma)
    )
    assert_allclose(found, q, rtol=3e-5)  # q by the table, 5e-6, and its exponent of A up to 5/2


@pytest.mark.parametrize("cut", [3.0, 4.5, 5.0])
@pytest.mark.parametrize("sigma", [0.01, 0.1, 1.0, 100.0])
@np.errstate(all="ignore")  # as in the solver
def test_every_pressure_has_its_spots(sigma, cut):
    """Where the few highest summits end and the many begin, q(y) is steep: Newton's method alone swings over it."""
    q = np.geomspace(1e-10, 1e4, 400)[None]
    law = LAWS["normal_heights"].bind(np.ones(1), Nbar=1 / np.pi, Ra=1.0, sigma=sigma, cut=cut)
    assert_allclose(law.evaluate(law.from_pressure(q)).q, q, rtol=1e-12)


def test_auto_and_the_peak_pressure_find_them():
    """A smooth punch for a rough one, and the largest pressure of the profile, here that in the centre."""
    heights = {"micro": "normal_heights", "cut": 5.0, "Nbar": 3e9, "Ra": 1e-4, "sigma": 4e-8}
    found = study.solve(a=np.geomspace(1e-3, 0.03, 12), base="half_space", **heights)
    assert_allclose(study.derived.peak_pressure(found), found.p_max, rtol=1e-9)
    chosen = study.solve(a=np.geomspace(1e-3, 0.03, 12), h=1e3, n=0.5, base="auto", accuracy=0.3, **heights)
    assert (found.status == 0).all() and (chosen.status == 0).all()

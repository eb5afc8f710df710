"""How many summits of random heights touch: the share by distribution functions, and the mask of few spots."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import norm

import study
from solver.laws import LAWS, heights


def test_the_share_that_touches():
    depth = np.array([[0.0, 0.3, 1.0], [2.5, 7.9, 20.0]])  # below the highest, over sigma
    for cut in (3.0, 4.0, 5.0):
        found = LAWS["normal_heights"].touching(2e-6 * depth, sigma=2e-6, cut=cut, Nbar=1.0, Ra=1.0)
        low = norm.cdf(np.maximum(cut - depth, -cut))
        # cut at both sides, and normalised; the quadrature is exact to rounding
        assert_allclose(found, (norm.cdf(cut) - low) / (norm.cdf(cut) - norm.cdf(-cut)), rtol=1e-11, atol=1e-14)
    found = LAWS["uniform_heights"].touching(2e-6 * depth, sigma=2e-6)
    assert_allclose(found, np.minimum(1, depth / np.sqrt(12)), rtol=1e-13)
    bins = heights.histogram("table:x.csv", np.array([0.0, 1.0, 2.0]), np.array([1.0, 2.0, 1.0]), "")
    assert_allclose(bins.touching(np.array([0.5, 1.5, 2.5, 9.0])), [0.125, 0.5, 0.875, 1.0], rtol=1e-13)


@pytest.mark.filterwarnings("ignore:this contact is beyond")
def test_few_that_touch_are_few_spots():
    """Of 2300 asperities under the ball less than 100 touch; nothing was said, since all were counted."""
    pytest.importorskip("pint")
    steel = {"R": "20 mm", "E2": "200 GPa", "base": "half_space", "Ra": "50 um", "Nbar": "2e4 1/mm^2", "x": 2}
    heights = {"micro": ["disc_cell", "normal_heights"], "sigma": ["0 um", "0.5 um"]}
    found = study.solve(**steel, **heights, P=["1 N", "5 N"])
    rough = found.sel(micro="normal_heights", sigma="0.5 um")
    assert study.derived.number_of_spots(rough).sel(P="1 N") > 2000
    assert rough.validity.values.tolist() == [2, 0]
    assert "Fewer than 100 asperities touch" in study.summary(rough.sel(P="1 N"))
    assert (found.validity.sel(micro="disc_cell") == 0).all() and (found.validity.sel(sigma="0 um") == 0).all()

"""The form of a ball is no roughness: a quadratic or the sphere that fits takes it off, and its radius is said."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from surfaces import random_surface

from study import roughness


@pytest.mark.parametrize("form", ["quadratic", "sphere", 1e-3, "1 mm"])
def test_a_ball_of_1_mm_under_a_roughness(form):
    """With the plane its curvature counted: three times the spread of the heights."""
    z, step = random_surface(256, 8)
    z, step = z * 48e-9 / z.std(), 2e-7
    x = (np.arange(256) - 80) * step
    ball = np.sqrt(1e-6 - np.add.outer(x**2, x**2)) - 1e-3
    flat = roughness.measure(roughness.height_map(z, dx=step))
    round_ = roughness.measure(roughness.height_map(z + ball, dx=step), form=form)
    # the form also takes what waves of the roughness as long as the scan have of it
    assert_allclose(round_.sigma_summits, flat.sigma_summits, rtol=0.03)
    assert roughness.measure(roughness.height_map(z + ball, dx=step)).sigma_summits > 2 * flat.sigma_summits
    if form == "sphere":
        assert "fitted radius" in round_.filter

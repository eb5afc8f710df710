"""Missing points of a scan: filled in where they are few, refused where they are many."""

import numpy as np
import pytest

from study import roughness

STEP = 1e-7


def surface(seed):
    """Heights (256, 256) of a random surface with waves of 12 points and longer, rms 50 nm."""
    random, k = np.random.default_rng(seed), np.fft.fftfreq(256)
    z = np.fft.ifft2(np.fft.fft2(random.standard_normal((256, 256))) * (np.hypot(*np.meshgrid(k, k)) < 1 / 12)).real
    return 50e-9 * z / z.std()


def holed(seed, share):
    z = surface(seed)
    holes = np.random.default_rng(seed + 1).random(z.shape) < share
    return z, np.where(holes, np.nan, z)


@pytest.mark.parametrize("seed", range(4))
def test_filling_one_point_in_a_hundred_changes_the_numbers_by_less_than_one_percent(seed):
    whole, holes = holed(seed, 0.009)  # a little below the limit of 1 %, which the share of a random mask may exceed
    before, after = (roughness.measure(roughness.height_map(z, dx=STEP, dy=STEP)) for z in (whole, holes))
    np.testing.assert_allclose([after.Nbar, after.Ra], [before.Nbar, before.Ra], rtol=0.01, atol=0)


def test_more_are_refused_with_the_share_and_both_ways_out():
    with pytest.raises(ValueError, match=r"2\.\d+ %(.|\n)*skip"):
        roughness.height_map(holed(0, 0.025)[1], dx=STEP, dy=STEP)

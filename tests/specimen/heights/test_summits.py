"""Summits that are counted point by point: flat tops, borders, gaps, and grids of any shape."""

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose

from study.specimen import roughness
from study.specimen.heights import scan_peaks

BUMP = np.exp(-(np.linspace(-3, 3, 21) ** 2))


@pytest.mark.parametrize("top", [[(0, 0)], [(0, 0), (0, 1)], [(0, 0), (1, 0)], [(0, 0), (1, 1)], [(0, 1), (1, 0)],
                                 [*itertools.product((0, 1), repeat=2)], [(0, 0), (0, 1), (0, 2)]])  # fmt: skip
def test_a_flat_top_is_one_summit(top):
    """Of points at one height, in whichever direction they lie."""
    z = np.multiply.outer(BUMP, BUMP)
    for i, j in top:
        z[10 + i, 10 + j] = 1.5
    assert scan_peaks.counted_summits(z, (1.0, 1.0)).counted == 1
    profile = BUMP.copy()
    profile[10 : 10 + len(top)] = 1.5
    assert scan_peaks.counted_summits(profile, (1.0,)).counted == 1


def test_none_on_a_slope_or_at_the_border():
    slope = np.add.outer(np.arange(20.0), np.arange(20.0))
    assert scan_peaks.counted_summits(slope, (1.0, 1.0)) is None
    assert scan_peaks.counted_summits(-np.abs(np.arange(20.0) - 19), (1.0,)) is None


@pytest.mark.parametrize("method", ["moments", "summits"])
def test_gaps_are_no_area(method):
    """A corner of a third of the map that was not measured: the density is that of the rest, the number of summits that
    of its area."""
    x, y = np.meshgrid(np.arange(96.0), np.arange(64.0))
    z = np.cos(2 * np.pi * x / 8) * np.cos(2 * np.pi * y / 8)
    whole = roughness.measure(roughness.height_map(z, dx=1, unit="um"), method=method)
    z[y < 32] = np.where(x[y < 32] < 64, np.nan, z[y < 32])
    part = roughness.measure(roughness.height_map(z, dx=1, unit="um", missing="skip"), method=method)
    assert_allclose(part.Nbar, whole.Nbar, rtol=0.05)
    assert_allclose(part.summits / whole.summits, 2 / 3, rtol=0.05)
    assert_allclose(part.Ra, whole.Ra, rtol=0.02)


@pytest.mark.parametrize("first", [0, 1])
def test_summits_between_two_lags_need_both(first):
    """Rows are 2/3 of a column apart: neighbours are 1.5 rows away, between lag 1, where every row of numbers has gaps
    beside it, and lag 2, where it has none."""
    z = np.cos(np.add.outer(np.arange(40.0), 2 * np.arange(40.0)) / 4)
    z[first::2] = np.nan
    assert scan_peaks.counted_summits(z, (1.0, 1.5)) is None


def test_a_summit_between_two_lags_must_be_one_for_both():
    """The only one at lag 1 has a higher point two rows away, in the last row, which is none."""
    z = np.full((5, 3), -1.0)
    z[:, 1] = [0.0, 1.0, 0.0, 2.0, 3.0]
    assert scan_peaks.counted_summits(z, (1.0, 1.0)).counted == 1
    assert scan_peaks.counted_summits(z, (1.0, 1.5)) is None

"""How much memory the statistics of a map take, in arrays of its size, and that blocks of rows change nothing."""

import tracemalloc

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.ndimage import gaussian_filter

from study import roughness
from study.specimen.heights import form, memory, row_jumps, scan_peaks, spikes


@pytest.mark.parametrize("method", ["moments", "summits"])
def test_a_map_is_measured_in_four_arrays(method):
    """Beside the heights of the caller: the scan, the heights without form, and what is computed from them."""
    z = 1e-7 * gaussian_filter(np.random.default_rng(1).standard_normal((1024, 1500)), 2)
    tracemalloc.start()
    try:
        scan = roughness.height_map(z, dx=1e-6, dy=1.3e-6)
        most = [tracemalloc.get_traced_memory()[1] / z.nbytes]
        tracemalloc.reset_peak()
        roughness.measure(scan, method=method)
        most.append(tracemalloc.get_traced_memory()[1] / z.nbytes)
    finally:
        tracemalloc.stop()
    assert most[0] < 2.5 and most[1] < 4.0, most


#: What may be asked beside the heights, each of which took from 5.1 to 48 arrays at once.
WAYS = [
    ({}, {"form": "sphere", "method": "summits"}),
    ({}, {"rows": "median", "form": "quadratic", "cutoff": [3e-6, 6e-6]}),
    ({"missing": "skip"}, {"rows": "median", "form": "sphere", "cutoff": 3e-6}),
    ({"despike": 5}, {}),
]


@pytest.mark.parametrize("how, what", WAYS)
def test_a_file_is_read_and_measured_in_less_than_five_arrays(how, what, tmp_path):
    """The file, the scan and what is computed from it, with gaps in 1 % of the points where they are skipped."""
    random = np.random.default_rng(3)
    z = gaussian_filter(random.standard_normal((1024, 1024)), 2)
    z[random.random(z.shape) < 0.01 * (how.get("missing") == "skip")] = np.nan
    np.save(tmp_path / "map.npy", z)
    tracemalloc.start()
    try:
        roughness.measure(roughness.read(tmp_path / "map.npy", unit="um", height_unit="nm", dx=1.0, **how), **what)
        most = tracemalloc.get_traced_memory()[1] / z.nbytes
    finally:
        tracemalloc.stop()
    assert most < 5.0, most


def test_blocks_of_lines_take_the_low_pass_and_the_spikes_of_the_whole_map(monkeypatch):
    """A map with gaps, in blocks of a few lines and at once, by the same numbers."""
    random = np.random.default_rng(4)
    z = gaussian_filter(random.standard_normal((60, 45)), 2)
    z[random.random(z.shape) < 0.05], z[20, 30] = np.nan, 9.0

    def answers():
        low = scan_peaks.low_pass(z, (1.0, 1.0), 6.0)
        sphere = form.without_form(z, (1.0, 1.0), 500.0, "map")[0]
        return low, sphere, spikes.despiked(z, 5, "map")[0], row_jumps.aligned(z)

    once = answers()
    monkeypatch.setattr(memory, "_BLOCK", 200)
    for block, whole in zip(answers(), once, strict=True):
        assert_allclose(block, whole, rtol=0, atol=1e-12)


def test_blocks_of_rows_are_the_whole_map(monkeypatch):
    """The form, and the jumps of rows with missing points: in blocks of three rows, and at once."""
    random = np.random.default_rng(2)
    z = random.standard_normal((50, 40)) + np.cumsum(random.standard_normal(50))[:, None]
    z[random.random(z.shape) < 0.02] = np.nan
    once = form.without_form(z, (1.0, 1.0), "quadratic", "map")[0], row_jumps.jumps(z)
    assert once[1] is not None
    monkeypatch.setattr(memory, "_BLOCK", 120)
    rest, jumps = form.without_form(z, (1.0, 1.0), "quadratic", "map")[0], row_jumps.jumps(z)
    assert_allclose(rest, once[0], rtol=0, atol=1e-13)
    assert_allclose(jumps, once[1], rtol=1e-12, atol=0)

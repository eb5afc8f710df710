"""How much memory the statistics of a map take, in arrays of its size, and that blocks of rows change nothing."""

import tracemalloc

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.ndimage import gaussian_filter

from study import roughness
from study.specimen.heights import form, memory, row_jumps


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
